//! A scene with another law or another observer constant for all its followers: what comparisons are made of.

use scene::{Follow, Role, Scene, SensingKind, VehicleKind};
use vocabulary::{LawKind, TimeMode};

/// What differs from the scene as it is written.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Variant {
    /// The law of every follower.
    pub law: Option<LawKind>,
    /// ε of every observer, s.
    pub epsilon: Option<f64>,
}

impl Variant {
    /// Another law.
    pub fn law(kind: LawKind) -> Self {
        Self { law: Some(kind), ..Self::default() }
    }

    /// Output feedback with an observer constant, s.
    pub fn epsilon(epsilon: f64) -> Self {
        Self { law: Some(LawKind::OutputFeedback), epsilon: Some(epsilon) }
    }

    /// The scene so changed, with what changes on its way.
    pub fn give(self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        scene.for_every_robot(|robot| {
            let Role::Follow(follow) = &mut robot.role else { return };
            if let Some(kind) = self.law {
                (follow.law.kind, follow.law.file, follow.law.text) = (kind, None, None);
            }
            if let Some(epsilon) = self.epsilon {
                follow.observer.epsilon = [epsilon; 2];
                follow.observer.adaptive = false;
            }
        });
        scene
    }
}

/// A law in four letters, as papers have it.
pub(crate) fn short(kind: LawKind) -> &'static str {
    match kind {
        LawKind::FullState => "FSFB",
        LawKind::RobustState => "RSFB",
        LawKind::OutputFeedback => "OFB",
    }
}

/// The three laws, in descending order of what they have to know.
pub(crate) const LAWS: [LawKind; 3] = [LawKind::FullState, LawKind::RobustState, LawKind::OutputFeedback];

/// Built-in law and ε, s, of the scene's first follower.
pub(crate) fn of(scene: &Scene) -> Option<(LawKind, f64)> {
    let follow = followers(scene).next()?;
    Some((follow.law.built_in()?, follow.observer.epsilon[0]))
}

/// The follower parameters of a scene.
fn followers(scene: &Scene) -> impl Iterator<Item = &Follow> {
    scene.robots.iter().filter_map(|robot| match &robot.role {
        Role::Follow(follow) => Some(&**follow),
        Role::Lead { .. } => None,
    })
}

/// Robots from which on comparisons would take longer than they tell.
const MANY: usize = 30;

/// Why the three laws cannot be compared on a scene, if they cannot.
pub(crate) fn laws_apart(scene: &Scene) -> Option<&'static str> {
    if followers(scene).next().is_none() {
        Some("nobody follows")
    } else if followers(scene).any(|follow| follow.sensing.kind != SensingKind::Truth) {
        Some("followers measure, and two of the laws need more than measurements tell")
    } else if followers(scene).any(|follow| follow.law.custom().is_some()) {
        Some("followers have a law of their own")
    } else if scene.robots.iter().any(|robot| robot.vehicle.kind != VehicleKind::Unicycle) {
        Some("gains on wheels are found for output feedback, and would not fit the other laws")
    } else if scene.robots.len() > MANY {
        Some("there are too many robots to run the scene over and over")
    } else {
        None
    }
}

/// Why observer constants cannot be compared on a scene, if they cannot.
pub(crate) fn constants_apart(scene: &Scene) -> Option<&'static str> {
    if !followers(scene).any(|follow| follow.law.observes()) {
        Some("no observer runs")
    } else if followers(scene).any(|follow| follow.sensing.kind == SensingKind::Camera) {
        Some("drawing for cameras over and over takes minutes: `echelon budget --epsilon` does it")
    } else if followers(scene).any(|follow| follow.sensing.kind != SensingKind::Truth) {
        Some("ε follows from the noise of measurements: `echelon budget --epsilon` compares")
    } else if scene.time.mode == TimeMode::Continuous {
        Some("continuous time takes steps of an eighth of ε, and small ones do not come to an end")
    } else if scene.robots.len() > MANY {
        Some("there are too many robots to run the scene over and over")
    } else {
        None
    }
}

//! What is compared: ways of sensing, observers, observer constants; and the scene changed to each.

use crate::{Error, SceneRun};
use scene::{Follow, Role, Scene, SensingKind};
use vocabulary::{ObserverKind, TimeMode};

/// How followers sense in one run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SensingLevel {
    /// They are told the truth.
    Truth,
    /// By corners of tags, with so many pixels of noise.
    Pixels(f64),
    /// By the pictures of their cameras.
    Camera,
}

impl SensingLevel {
    /// In words, with the noise.
    pub fn name(self) -> String {
        match self {
            Self::Pixels(pixels) => format!("geometric {pixels} px"),
            other => other.word().to_owned(),
        }
    }

    /// The word for its kind in tables of numbers.
    pub fn word(self) -> &'static str {
        match self {
            Self::Truth => "truth",
            Self::Pixels(_) => "geometric",
            Self::Camera => "camera",
        }
    }

    /// The noise of its corners, px, where it has one.
    pub fn pixels(self) -> Option<f64> {
        match self {
            Self::Pixels(pixels) => Some(pixels),
            Self::Truth | Self::Camera => None,
        }
    }
}

/// What makes rates of measurements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ObserverChoice {
    /// The high-gain observer, as the scene has it.
    HighGain,
    /// The dual unscented filter.
    Unscented,
    /// The high-gain observer with one ε, s, for everybody; `None` lets it follow from the noise.
    Constant(Option<f64>),
}

impl ObserverChoice {
    /// In words, with its constant.
    pub fn name(self) -> String {
        match self {
            Self::HighGain => "high-gain".to_owned(),
            Self::Unscented => "unscented".to_owned(),
            Self::Constant(Some(epsilon)) => format!("ε {epsilon} s"),
            Self::Constant(None) => "ε adaptive".to_owned(),
        }
    }
}

/// One run of a comparison.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BudgetCase {
    /// How followers sense.
    pub level: SensingLevel,
    /// What makes rates of what they see.
    pub observer: ObserverChoice,
}

impl BudgetCase {
    /// The scene with everybody sensing and observing so.
    pub fn give(self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        scene.for_every_robot(|robot| {
            let Role::Follow(follow) = &mut robot.role else { return };
            match self.level {
                SensingLevel::Truth => follow.sensing.kind = SensingKind::Truth,
                SensingLevel::Pixels(pixels) => {
                    follow.sensing.kind = SensingKind::Geometric;
                    follow.sensing.pixel_noise = pixels;
                }
                SensingLevel::Camera => follow.sensing.kind = SensingKind::Camera,
            }
            let observer = &mut follow.observer;
            observer.kind = match self.observer {
                ObserverChoice::Unscented => ObserverKind::Unscented,
                ObserverChoice::HighGain | ObserverChoice::Constant(_) => ObserverKind::HighGain,
            };
            if let ObserverChoice::Constant(constant) = self.observer {
                observer.adaptive = constant.is_none();
                observer.epsilon = constant.map_or(observer.epsilon, |epsilon| [epsilon; 2]);
            }
        });
        scene
    }

    /// The changed scene's run.
    ///
    /// # Errors
    /// [`Error::Usage`] where the scene cannot run so.
    pub fn build(self, scene: &Scene) -> Result<SceneRun, Error> {
        let refused = |error| Error::Usage(format!("as `{}`: {error}", self.level.name()));
        SceneRun::new(self.give(scene)).map_err(refused)
    }
}

/// Noise of corners of the scene's first follower, px.
pub(super) fn pixel_noise(scene: &Scene) -> f64 {
    scene.followers().next().map_or(0.0, |(_, follow)| follow.sensing.pixel_noise)
}

/// Refuses scenes whose followers cannot go by measurements, and says what to change.
///
/// # Errors
/// [`Error::Usage`] for such a scene.
pub fn check(scene: &Scene) -> Result<(), Error> {
    if scene.followers().next().is_none() {
        let text = "the scene has no followers, and so no errors of following: give a robot `leader`, `distance` and \
                    `bearing`";
        return Err(Error::Usage(text.to_owned()));
    }
    let other = |(_, follow): &(&str, &Follow)| !follow.law.observes();
    if let Some((name, _)) = scene.followers().find(other) {
        return Err(Error::Usage(format!(
            "`{name}` does not follow by output feedback, and other laws need more than measurements tell: write `law = {{ \
             kind = \"output-feedback\" }}` for it, or --set robots.{name}.law.kind=output-feedback"
        )));
    }
    if scene.time.mode == TimeMode::Continuous {
        let text = "mode `continuous` has no measurements: use --set time.mode=sampled";
        return Err(Error::Usage(text.to_owned()));
    }
    // What only scenes with sensors have to fulfil is checked where scenes are read.
    let sensing =
        BudgetCase { level: SensingLevel::Pixels(0.0), observer: ObserverChoice::HighGain }.give(scene);
    Scene::parse(&sensing.to_toml(), "the scene with sensing by tags", &[])
        .map(drop)
        .map_err(|errors| Error::Usage(errors.to_string()))
}

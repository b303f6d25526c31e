//! What is compared: ways of sensing, observers, observer constants; and the scene changed to each.

use crate::failure::Failure;
use scene::{Follow, Role, Scene, SensingKind};
use simulation::Setup;
use vocabulary::{LawKind, ObserverKind, TimeMode};

/// How followers sense in one run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Level {
    /// They are told the truth.
    Truth,
    /// By corners of tags, with so many pixels of noise.
    Pixels(f64),
    /// By the pictures of their cameras.
    Camera,
}

impl Level {
    pub(crate) fn name(self) -> String {
        match self {
            Self::Truth => "truth".to_owned(),
            Self::Pixels(pixels) => format!("geometric {pixels} px"),
            Self::Camera => "camera".to_owned(),
        }
    }

    /// The word for its kind in tables of numbers.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Truth => "truth",
            Self::Pixels(_) => "geometric",
            Self::Camera => "camera",
        }
    }

    /// The noise of its corners, px, where it has one.
    pub(crate) fn pixels(self) -> Option<f64> {
        match self {
            Self::Pixels(pixels) => Some(pixels),
            Self::Truth | Self::Camera => None,
        }
    }
}

/// What makes rates of looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Observer {
    /// The high-gain observer, as the scene has it.
    HighGain,
    /// The dual unscented filter.
    Unscented,
    /// The high-gain observer with one ε, s, for everybody; `None` lets it follow from the noise.
    Constant(Option<f64>),
}

impl Observer {
    pub(crate) fn name(self) -> String {
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
pub(crate) struct Case {
    pub(crate) level: Level,
    pub(crate) observer: Observer,
}

impl Case {
    /// The scene with everybody sensing and observing so.
    pub(crate) fn give(self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        scene.for_every_robot(|robot| {
            let Role::Follow(follow) = &mut robot.role else { return };
            match self.level {
                Level::Truth => follow.sensing.kind = SensingKind::Truth,
                Level::Pixels(pixels) => {
                    follow.sensing.kind = SensingKind::Geometric;
                    follow.sensing.pixel_noise = pixels;
                }
                Level::Camera => follow.sensing.kind = SensingKind::Camera,
            }
            let observer = &mut follow.observer;
            observer.kind = match self.observer {
                Observer::Unscented => ObserverKind::Unscented,
                Observer::HighGain | Observer::Constant(_) => ObserverKind::HighGain,
            };
            if let Observer::Constant(constant) = self.observer {
                observer.adaptive = constant.is_none();
                observer.epsilon = constant.map_or(observer.epsilon, |epsilon| [epsilon; 2]);
            }
        });
        scene
    }

    /// The changed scene's run.
    pub(crate) fn build(self, scene: &Scene) -> Result<Setup, Failure> {
        let refused = |error| Failure::Usage(format!("as `{}`: {error}", self.level.name()));
        simulation::build(&self.give(scene)).map_err(refused)
    }
}

/// Refuses scenes whose followers cannot go by looks, and says what to change.
pub(crate) fn check(scene: &Scene) -> Result<(), Failure> {
    let followers = || {
        scene.robots.iter().filter_map(|robot| match &robot.role {
            Role::Follow(follow) => Some((robot.name.as_str(), &**follow)),
            Role::Lead { .. } => None,
        })
    };
    if followers().next().is_none() {
        let text = "the scene has no followers, and so no errors of following: give a robot `leader`, `distance` and \
                    `bearing`";
        return Err(Failure::Usage(text.to_owned()));
    }
    let other = |(_, follow): &(&str, &Follow)| follow.law.kind != LawKind::OutputFeedback;
    if let Some((name, _)) = followers().find(other) {
        return Err(Failure::Usage(format!(
            "`{name}` does not follow by output feedback, and other laws have to know more than looks tell: write `law = {{ \
             kind = \"output-feedback\" }}` for it, or --set robots.{name}.law.kind=output-feedback"
        )));
    }
    if scene.time.mode == TimeMode::Continuous {
        let text = "mode `continuous` knows no looks: use --set time.mode=sampled";
        return Err(Failure::Usage(text.to_owned()));
    }
    // What only scenes that look have to fulfil is checked where scenes are read.
    let looking = Case { level: Level::Pixels(0.0), observer: Observer::HighGain }.give(scene);
    Scene::parse(&looking.to_toml(), "the scene with sensing by tags", &[])
        .map(drop)
        .map_err(|errors| Failure::Usage(errors.to_string()))
}

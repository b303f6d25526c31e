//! What lies beyond the paper: sensitivities, set points that can be held, stability over ε and period, chains.

use super::chain::{self, EdgeGain};
use super::reach::{self, Reach};
use super::sensitivity::{self, Sensitivities};
use super::{ChannelSensitivity, Discretisation, LongestPeriod};
use scene::{Follow, Scene, SensingKind, SwitchingKind};
use simulation::BuildError;
use vocabulary::{LawKind, math};

/// Stability over ε and period, of the distance channel of the first follower by output feedback.
#[derive(Debug, Clone, PartialEq)]
pub struct StabilityChart {
    /// Its name.
    pub follower: String,
    /// Its gains.
    pub channel: ChannelSensitivity,
    /// Of the scene, s.
    pub epsilon: f64,
    /// Of the scene, s.
    pub period: f64,
    /// Constants looked at, s.
    pub epsilons: Vec<f64>,
    /// The longest stable period at each of them.
    pub borders: Vec<(Discretisation, Vec<LongestPeriod>)>,
}

/// Periods that a chart covers, s.
pub const PERIODS: [f64; 2] = [1e-4, 1.0];
/// Robots times seconds up to which every gain is tried without being asked.
const LIGHT: f64 = 150.0;

/// Everything beyond the paper.
#[derive(Debug, Clone)]
pub struct Beyond {
    /// Or why there are none.
    pub sensitivities: Result<Sensitivities, String>,
    /// Set points that every follower can hold.
    pub reach: Vec<Reach>,
    /// `None` where nobody follows by output feedback.
    pub chart: Option<StabilityChart>,
    /// How disturbances go down the chain.
    pub chain: Vec<EdgeGain>,
}

impl Beyond {
    /// Of a scene, with its sensitivities, which take runs of their own.
    ///
    /// # Errors
    /// [`BuildError`] where the scene cannot run.
    pub fn of(scene: &Scene, sensitivities: Result<Sensitivities, String>) -> Result<Self, BuildError> {
        Ok(Self {
            reach: reach::reach(scene)?,
            chart: chart(scene),
            chain: chain::gains(scene)?,
            sensitivities,
        })
    }
}

/// How much work it is to try every gain of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SensitivityCost {
    /// Cameras take pictures in every run: too much.
    Pictures,
    /// So many runs that take long.
    Heavy(u64),
    /// So many quick runs.
    Light(u64),
}

impl SensitivityCost {
    /// Of a scene.
    pub fn of(scene: &Scene) -> Self {
        if scene.followers().any(|(_, follow)| follow.sensing.kind == SensingKind::Camera) {
            return Self::Pictures;
        }
        let wheels = scene.robots.iter().any(|robot| robot.vehicle.kind.has_wheels());
        let heavy = wheels || scene.robots.len() as f64 * scene.time.duration > LIGHT;
        let runs = 1 + 2 * sensitivity::gains(scene).len() as u64;
        if heavy { Self::Heavy(runs) } else { Self::Light(runs) }
    }
}

/// The channels of a follower by output feedback, distance and bearing, near its set point; `None` of another law.
pub fn channels(follow: &Follow) -> Option<[ChannelSensitivity; 2]> {
    if follow.law.built_in() != Some(LawKind::OutputFeedback) {
        return None;
    }
    let (law, observer) = (&follow.law, &follow.observer);
    // The slope of the sign is not a number; near its set point only K acts then.
    let smooth = law.switching == SwitchingKind::Tanh;
    Some([0, 1].map(|channel| {
        let k = law.k[channel];
        let steep = if smooth { law.beta[channel] * law.slope[channel] } else { 0.0 };
        ChannelSensitivity {
            gain: k,
            stiffness: k * k + steep,
            alpha1: observer.alpha1[channel],
            alpha2: observer.alpha2[channel],
        }
    }))
}

fn chart(scene: &Scene) -> Option<StabilityChart> {
    let (name, follow, [channel, _]) =
        scene.followers().find_map(|(name, follow)| Some((name, follow, channels(follow)?)))?;
    let observer = &follow.observer;
    let epsilons: Vec<f64> = (0..=48).map(|i| 1e-4 * math::powf(10_f64, f64::from(i) / 12.0)).collect();
    let border = |how: Discretisation| {
        let at = |epsilon: &f64| channel.longest_period(how, *epsilon, PERIODS);
        (how, epsilons.iter().map(at).collect())
    };
    let borders = Discretisation::ALL.map(border).to_vec();
    let (epsilon, period) = (observer.epsilon[0], scene.time.period);
    Some(StabilityChart { follower: name.to_owned(), channel, epsilon, period, epsilons, borders })
}

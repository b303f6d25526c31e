//! What lies beyond the paper: sensitivities, reach, stability over ε and period, chains.

use crate::failure::Failure;
use crate::interrupt;
use crate::progress::Progress;
use scene::{Follow, Role, Scene, SensingKind, SwitchingKind};
use simulation::certify::chain::{self, EdgeGain};
use simulation::certify::reach::{self, Reach};
use simulation::certify::sensitivity::{self, Sensitivities};
use simulation::certify::{ChannelSensitivity, Discretisation, LongestPeriod};
use std::sync::atomic::{AtomicU64, Ordering};
use vocabulary::{LawKind, counted};

/// All of it.
pub(super) struct Beyond {
    /// Or why there are none.
    pub(super) sensitivities: Result<Sensitivities, String>,
    pub(super) reach: Vec<Reach>,
    pub(super) chart: Option<Chart>,
    pub(super) chain: Vec<EdgeGain>,
}

/// Stability over ε and period, of the distance channel of the first follower by output feedback.
pub(super) struct Chart {
    /// Its name.
    pub(super) follower: String,
    pub(super) channel: ChannelSensitivity,
    /// Of the scene, s.
    pub(super) epsilon: f64,
    /// Of the scene, s.
    pub(super) period: f64,
    /// Constants looked at, s.
    pub(super) epsilons: Vec<f64>,
    pub(super) borders: Vec<(Discretisation, Vec<LongestPeriod>)>,
}

/// Periods that the chart covers, s.
pub(super) const PERIODS: [f64; 2] = [1e-4, 1.0];
/// Robots times seconds up to which every gain is tried without being asked.
const LIGHT: f64 = 150.0;

pub(super) fn look(scene: &Scene, asked: bool, quiet: bool) -> Result<Beyond, Failure> {
    let build = |error: simulation::BuildError| Failure::Usage(error.to_string());
    Ok(Beyond {
        reach: reach::reach(scene).map_err(build)?,
        chart: chart(scene),
        chain: chain::gains(scene).map_err(build)?,
        sensitivities: sensitivities(scene, asked, quiet)?,
    })
}

fn sensitivities(scene: &Scene, asked: bool, quiet: bool) -> Result<Result<Sensitivities, String>, Failure> {
    let pictures = followers(scene).any(|(_, follow)| follow.sensing.kind == SensingKind::Camera);
    if pictures {
        return Ok(Err("left out: cameras take pictures in every run".to_owned()));
    }
    let wheels = scene.robots.iter().any(|robot| robot.vehicle.kind.has_wheels());
    let heavy = wheels || scene.robots.len() as f64 * scene.time.duration > LIGHT;
    let runs = 1 + 2 * sensitivity::gains(scene).len() as u64;
    if heavy && !asked {
        return Ok(Err(format!(
            "left out: {} of this scene take long; ask for them with --sensitivity",
            counted(runs, "run")
        )));
    }
    let what = format!("Trying every gain, {}", counted(runs, "run"));
    let progress = Progress::begin(&what, runs, quiet || !heavy);
    let done = AtomicU64::new(0);
    let look = || {
        done.fetch_add(1, Ordering::Relaxed);
        !interrupt::asked()
    };
    // The bar is not made for several threads: it goes on by itself.
    let found = sensitivity::sensitivities(scene, look).map_err(|error| Failure::Usage(error.to_string()))?;
    progress.at(done.load(Ordering::Relaxed));
    progress.end();
    found.map(Ok).ok_or_else(|| Failure::Interrupted("nothing was certified".into()))
}

fn followers(scene: &Scene) -> impl Iterator<Item = (&str, &Follow)> {
    scene.robots.iter().filter_map(|robot| match &robot.role {
        Role::Lead { .. } => None,
        Role::Follow(follow) => Some((robot.name.as_str(), &**follow)),
    })
}

fn chart(scene: &Scene) -> Option<Chart> {
    let (name, follow) = followers(scene).find(|(_, follow)| follow.law.kind == LawKind::OutputFeedback)?;
    let (k, observer) = (follow.law.k[0], &follow.observer);
    // The slope of the sign is not a number; near its set point only K acts then.
    let smooth = follow.law.switching == SwitchingKind::Tanh;
    let steep = if smooth { follow.law.beta[0] * follow.law.slope[0] } else { 0.0 };
    let channel = ChannelSensitivity {
        gain: k,
        stiffness: k * k + steep,
        alpha1: observer.alpha1[0],
        alpha2: observer.alpha2[0],
    };
    let epsilons: Vec<f64> = (0..=48).map(|i| 1e-4 * 10_f64.powf(f64::from(i) / 12.0)).collect();
    let border = |how: Discretisation| {
        let at = |epsilon: &f64| channel.longest_period(how, *epsilon, PERIODS);
        (how, epsilons.iter().map(at).collect())
    };
    let borders = Discretisation::ALL.map(border).to_vec();
    let (epsilon, period) = (observer.epsilon[0], scene.time.period);
    Some(Chart { follower: name.to_owned(), channel, epsilon, period, epsilons, borders })
}

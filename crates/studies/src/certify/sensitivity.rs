//! How the settled error answers to every gain: the scene run again with each gain a little larger and a little smaller.

use laws::Parameter;
use metrics::RootMeanSquare;
use rayon::prelude::*;
use scene::{Follow, Role, Scene, SwitchingKind};
use simulation::{BuildError, Simulation, build};
use vocabulary::{LawKind, math};

/// A gain is changed by this share, up and down.
const SHARE: f64 = 0.02;
/// The settled error is taken over this last part of the run.
const LATE: f64 = 0.2;
/// Below this, m or rad, an error has settled to zero and says nothing about gains.
const ZERO: f64 = 1e-8;

/// A gain of law or observer; channel 0 is distance, 1 bearing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Gain {
    /// K.
    K(usize),
    /// β.
    Beta(usize),
    /// Slope of tanh.
    Slope(usize),
    /// ε.
    Epsilon(usize),
    /// α1.
    Alpha1(usize),
    /// α2.
    Alpha2(usize),
    /// A parameter of custom laws.
    Own {
        /// Its name.
        name: String,
        /// Its symbol in the first law that has it.
        symbol: String,
    },
}

impl Gain {
    /// Symbol, with its channel if it has one.
    pub fn symbol(&self) -> String {
        let (symbol, channel) = match self {
            Self::Own { symbol, .. } => return symbol.clone(),
            Self::K(i) => ("k", i),
            Self::Beta(i) => ("β", i),
            Self::Slope(i) => ("slope", i),
            Self::Epsilon(i) => ("ε", i),
            Self::Alpha1(i) => ("α1", i),
            Self::Alpha2(i) => ("α2", i),
        };
        format!("{symbol} {}", ["distance", "bearing"][*channel])
    }

    /// Multiplies it.
    fn scale(&self, follow: &mut Follow, factor: f64) {
        *match self {
            Self::K(i) => &mut follow.law.k[*i],
            Self::Beta(i) => &mut follow.law.beta[*i],
            Self::Slope(i) => &mut follow.law.slope[*i],
            Self::Epsilon(i) => &mut follow.observer.epsilon[*i],
            Self::Alpha1(i) => &mut follow.observer.alpha1[*i],
            Self::Alpha2(i) => &mut follow.observer.alpha2[*i],
            Self::Own { name, .. } => {
                let Some(value) = own_value(follow, name) else { return };
                follow.law.parameters.entry(name.clone()).or_insert(value)
            }
        } *= factor;
    }

    /// Whether a follower's law uses it.
    fn acts_on(&self, follow: &Follow) -> bool {
        match self {
            // One percent of nothing is nothing.
            Self::Own { name, .. } => own_value(follow, name).is_some_and(|value| value != 0.0),
            Self::K(_) => follow.law.built_in().is_some(),
            Self::Beta(_) => is_robust(follow),
            Self::Slope(_) => is_robust(follow) && follow.law.switching == SwitchingKind::Tanh,
            Self::Epsilon(_) | Self::Alpha1(_) | Self::Alpha2(_) => follow.law.observes(),
        }
    }
}

/// The parameter called `name` of a follower's custom law.
fn own_value(follow: &Follow, name: &str) -> Option<f64> {
    let declared = &follow.law.custom()?.declaration().parameters;
    let index = declared.iter().position(|parameter| parameter.name == name)?;
    follow.law.values().get(index).copied()
}

/// The parameters of all custom laws of a scene, each name once.
fn own_parameters(scene: &Scene) -> Vec<Gain> {
    let mut all: Vec<Gain> = vec![];
    let laws = scene.followers().filter_map(|(_, follow)| follow.law.custom());
    for Parameter { name, symbol, .. } in laws.flat_map(|law| &law.declaration().parameters) {
        if !all.iter().any(|gain| matches!(gain, Gain::Own { name: known, .. } if known == name)) {
            all.push(Gain::Own { name: name.clone(), symbol: symbol.clone() });
        }
    }
    all
}

/// Whether a follower's law has a switching term.
fn is_robust(follow: &Follow) -> bool {
    follow.law.built_in().is_some_and(|kind| kind != LawKind::FullState)
}

/// What one gain does, when it is changed on all edges together.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivity {
    /// Which gain.
    pub gain: Gain,
    /// Per edge: by how many percent the settled error of [distance, bearing] grows when the gain grows by one percent
    /// (d ln e / d ln gain); `None` where the error settles to zero.
    pub edges: Vec<[Option<f64>; 2]>,
}

/// Settled errors, and what every gain does to them.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivities {
    /// Root mean square over the last fifth of the run, per edge, [m, rad].
    pub settled: Vec<[f64; 2]>,
    /// Gains that act.
    pub gains: Vec<Sensitivity>,
}

/// The gains that act in a scene.
pub fn gains(scene: &Scene) -> Vec<Gain> {
    let kinds: [fn(usize) -> Gain; 6] =
        [Gain::K, Gain::Beta, Gain::Slope, Gain::Epsilon, Gain::Alpha1, Gain::Alpha2];
    let all = kinds.into_iter().flat_map(|gain| [gain(0), gain(1)]).chain(own_parameters(scene));
    let follows = |gain: &Gain| scene.followers().any(|(_, follow)| gain.acts_on(follow));
    all.filter(follows).collect()
}

/// Runs the scene as it is and twice for every gain, on all cores; `look` is told of every run that is done and says
/// whether to go on. `None` when it said no.
///
/// # Errors
/// [`BuildError`] where the scene cannot run.
pub fn sensitivities(
    scene: &Scene,
    look: impl Fn() -> bool + Sync,
) -> Result<Option<Sensitivities>, BuildError> {
    let gains = gains(scene);
    let mut cases: Vec<Option<(&Gain, f64)>> = vec![None];
    cases.extend(gains.iter().flat_map(|gain| [-SHARE, SHARE].map(|share| Some((gain, share)))));
    let runs = cases.par_iter().map(|case| {
        let mut scene = scene.clone();
        if let Some((gain, share)) = case {
            scene.for_every_robot(|robot| {
                if let Role::Follow(follow) = &mut robot.role {
                    gain.scale(follow, 1.0 + share);
                }
            });
        }
        settled(&scene, &look)
    });
    let errors: Option<Vec<_>> = runs.collect::<Result<Vec<_>, _>>()?.into_iter().collect();
    let Some([own, rest @ ..]) = errors.as_deref() else { return Ok(None) };
    let sensitivity = |(gain, pair): (&Gain, &[Vec<[f64; 2]>])| {
        let slope = |edge: usize, i: usize| {
            let [less, more] = [pair[0][edge][i], pair[1][edge][i]];
            let width = math::ln((1.0 + SHARE) / (1.0 - SHARE));
            (less > ZERO && more > ZERO).then(|| math::ln(more / less) / width)
        };
        Sensitivity {
            gain: gain.clone(),
            edges: (0..own.len()).map(|e| [slope(e, 0), slope(e, 1)]).collect(),
        }
    };
    let gains = gains.iter().zip(rest.chunks_exact(2)).map(sensitivity).collect();
    Ok(Some(Sensitivities { settled: own.clone(), gains }))
}

/// Settled errors of a run; `None` when it was not to go on.
fn settled(scene: &Scene, look: &(impl Fn() -> bool + Sync)) -> Result<Option<Vec<[f64; 2]>>, BuildError> {
    let mut simulation = Simulation::new(build(scene)?);
    let from = simulation.len() - (simulation.len() as f64 * LATE) as u64;
    let mut errors = vec![RootMeanSquare::<2>::EMPTY; simulation.fleet().edges.len()];
    while let Some(record) = simulation.next_record() {
        if (record.snapshot.time / scene.time.period).round() as u64 >= from {
            errors.iter_mut().zip(&record.edges).for_each(|(sum, edge)| sum.add(edge.error));
        }
    }
    Ok(look().then(|| errors.iter().map(|sum| sum.root().unwrap_or_default()).collect()))
}

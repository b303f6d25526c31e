//! What is asked: from where to where, at which levels, at what cost, with how much effort.

use crate::error::{InputError, checked};
use crate::formation_model::FormationModel;
use crate::limits::TravelLimits;
use crate::map::Map;
use vocabulary::{Pose, math};

/// Where a plan begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanStart {
    /// Of the lead.
    pub pose: Pose,
    /// Of the formation; between two levels where it is on its way from one to the other.
    pub level: f64,
    /// Curvature that the lead drives, 1/m: followers are taken to hold their places on that circle.
    pub curvature: f64,
    /// Speed of the lead, m/s.
    pub speed: f64,
}

/// Where a plan ends, at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanGoal {
    /// Of the lead, m.
    pub position: [f64; 2],
    /// Of the lead, rad; any without one.
    pub heading: Option<f64>,
    /// Of the formation; any without one.
    pub level: Option<usize>,
    /// How near is there, m.
    pub tolerance: f64,
    /// How near the heading has to be, rad.
    pub heading_tolerance: f64,
}

/// From where to where.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mission {
    /// Where it begins.
    pub start: PlanStart,
    /// Where it ends.
    pub goal: PlanGoal,
}

/// What a plan costs: its length in m, and more.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CostWeights {
    /// For every metre in the column; at levels before in proportion, 0 in the shape.
    pub level: f64,
    /// For every 1/m by which the curvature changes, m.
    pub turning: f64,
    /// For every level that the formation changes, m.
    pub change: f64,
    /// For every metre backwards.
    pub backwards: f64,
    /// For every change between forwards and backwards, m.
    pub cusp: f64,
}

/// How hard to search. The clock is not read: what is counted is the same on every machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchEffort {
    /// Steps that are swept at most until the first plan.
    pub expansions: usize,
    /// Steps that are swept at most after that, for better ones.
    pub improvement: usize,
    /// Weights of the estimate, the first for the first plan: one costs at most the weight times the best of the lattice.
    pub weights: [f64; 2],
    /// Length of a step, m.
    pub step: f64,
    /// Two nodes in one cell of this size, m, and with headings in one of this many parts of a turn, are one.
    pub cell: f64,
    /// Parts of a turn.
    pub headings: usize,
    /// Whether the way is smoothed.
    pub smooths: bool,
    /// Whether it is recorded what the search looked at.
    pub records: bool,
    /// Whether it is looked for a reason and an offer where there is no way.
    pub explains: bool,
}

/// Everything that a plan is asked of.
#[derive(Debug, Clone, Copy)]
pub struct PlanRequest<'a> {
    /// Where.
    pub map: &'a Map,
    /// Who.
    pub model: &'a FormationModel,
    /// How sharply and how fast.
    pub limits: TravelLimits,
    /// From where to where.
    pub mission: Mission,
    /// At what cost.
    pub costs: CostWeights,
    /// With how much effort.
    pub effort: SearchEffort,
    /// θ̄ in rad and κ̄ in 1/m of the headings that followers are held against at the start, for a formation that is on its
    /// way. Without them followers are taken to have driven the start's curvature for long.
    pub held: Option<&'a [[f64; 2]]>,
}

impl<'a> PlanRequest<'a> {
    /// With the usual costs and effort.
    pub fn new(map: &'a Map, model: &'a FormationModel, limits: TravelLimits, mission: Mission) -> Self {
        let (costs, effort) = (CostWeights::default(), SearchEffort::default());
        Self { map, model, limits, mission, costs, effort, held: None }
    }

    /// Holds the headings of followers against their number.
    pub(crate) fn check_held(&self) -> Result<(), InputError> {
        let expected = self.model.followers().len();
        match self.held {
            Some(held) if held.len() != expected => {
                Err(InputError::WrongCount { found: held.len(), expected })
            }
            Some(held) if held.iter().flatten().any(|value| !value.is_finite()) => {
                Err(InputError::NotFinite { what: "a held heading".into() })
            }
            _ => Ok(()),
        }
    }
}

impl PlanStart {
    /// At rest, at level 0.
    pub const fn at(pose: Pose) -> Self {
        Self { pose, level: 0.0, curvature: 0.0, speed: 0.0 }
    }
}

impl PlanGoal {
    /// To within 0.1 m and 0.1 rad of a pose, at any level.
    pub const fn at(pose: Pose) -> Self {
        Self { heading: Some(pose.heading), ..Self::to([pose.x, pose.y]) }
    }

    /// To within 0.1 m of a point, at any heading and level.
    pub const fn to(position: [f64; 2]) -> Self {
        Self { position, heading: None, level: None, tolerance: 0.1, heading_tolerance: 0.1 }
    }

    /// The same at one level.
    #[must_use]
    pub const fn at_level(self, level: usize) -> Self {
        Self { level: Some(level), ..self }
    }

    /// The goal's pose, with the heading of a start where it has none.
    pub(crate) fn pose(&self, otherwise: f64) -> Pose {
        Pose::new(self.position[0], self.position[1], self.heading.unwrap_or(otherwise))
    }
}

impl Default for CostWeights {
    fn default() -> Self {
        Self { level: 0.5, turning: 2.0, change: 0.5, backwards: 1.0, cusp: 3.0 }
    }
}

impl Default for SearchEffort {
    fn default() -> Self {
        Self {
            expansions: 60_000,
            improvement: 2_000,
            weights: [1.8, 1.5],
            step: 1.25,
            cell: 0.6,
            headings: 60,
            smooths: true,
            records: false,
            explains: true,
        }
    }
}

/// Farther goals are refused, m: a grid of that size is made for the search.
const FARTHEST: f64 = 2000.0;

impl Mission {
    /// Holds every number against a formation's levels and its limits.
    ///
    /// # Errors
    /// The first that makes no sense.
    pub fn check(&self, model: &FormationModel, limits: &TravelLimits) -> Result<(), InputError> {
        limits.check()?;
        if limits.reverses && model.robots() > 1 {
            return Err(InputError::ReversesTogether { robots: model.robots() });
        }
        let Self { start, goal } = self;
        let poses = [
            ("the start's x", start.pose.x),
            ("the start's y", start.pose.y),
            ("the start's heading", start.pose.heading),
            ("the goal's x", goal.position[0]),
            ("the goal's y", goal.position[1]),
            ("the goal's heading", goal.heading.unwrap_or(0.0)),
        ];
        for (what, value) in poses {
            checked(value, true, || what.into(), "finite")?;
        }
        let away = math::hypot(goal.position[0] - start.pose.x, goal.position[1] - start.pose.y);
        if away > FARTHEST {
            return Err(InputError::TooFar { away, most: FARTHEST });
        }
        let fits = start.curvature.abs() <= limits.curvature;
        checked(start.curvature, fits, || "the start's curvature".into(), "within the vehicle's, 1/m")?;
        let fits = (0.0..=limits.speed).contains(&start.speed);
        checked(start.speed, fits, || "the start's speed".into(), "from 0 to the largest, m/s")?;
        let both = [
            ("the goal's tolerance", goal.tolerance),
            ("the goal's tolerance of heading", goal.heading_tolerance),
        ];
        for (what, value) in both {
            checked(value, value > 0.0, || what.into(), "positive")?;
        }
        let last = model.levels() - 1;
        let fits = (0.0..=last as f64).contains(&start.level);
        checked(start.level, fits, || "the start's level".into(), "from 0 to the last level")?;
        match goal.level.filter(|level| *level > last) {
            Some(level) => Err(InputError::NoSuchLevel { level, last }),
            None => Ok(()),
        }
    }
}

impl SearchEffort {
    /// Checks every number.
    ///
    /// # Errors
    /// The first that makes no sense.
    pub fn check(&self) -> Result<(), InputError> {
        for weight in self.weights {
            checked(weight, weight >= 1.0, || "a weight of the estimate".into(), "1 or more")?;
        }
        let range = "from 0.01 to 100, m";
        for (what, value) in [("the length of a step", self.step), ("the size of a cell", self.cell)] {
            checked(value, (0.01..=100.0).contains(&value), || what.into(), range)?;
        }
        let headings = self.headings as f64;
        let fits = (4..=10_000).contains(&self.headings);
        checked(headings, fits, || "the number of headings".into(), "from 4 to 10000")?;
        Ok(())
    }
}

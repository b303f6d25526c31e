//! What moves the robots of a run.

use crate::continuous::Continuous;
use formation::Formation;
use vocabulary::TimeMode;
use world::{Handling, Physical, Unicycles, World, WorldSetup};

/// What moves the robots: a world that holds commands over a period, or plant, law and observers as one system.
pub(crate) enum Plant {
    Held(Box<dyn World>),
    Continuous(Box<Continuous>),
}

impl Clone for Plant {
    fn clone(&self) -> Self {
        match self {
            Self::Held(world) => Self::Held(world.save()),
            Self::Continuous(system) => Self::Continuous(system.clone()),
        }
    }
}

impl Plant {
    /// Unicycles on an empty plane are moved exactly; all else is moved by forces.
    pub(crate) fn new(stage: WorldSetup, mode: TimeMode, formation: &Formation) -> Self {
        let ideal = stage.props.is_empty()
            && stage.terrain.is_none()
            && stage.actors.iter().all(|a| a.wheels.is_none());
        if !ideal && mode != TimeMode::Continuous {
            return Self::Held(Box::new(Physical::new(stage)));
        }
        let world = Unicycles::new(stage.actors.into_iter().map(|actor| actor.robot).collect());
        match mode {
            TimeMode::Continuous => Self::Continuous(Box::new(Continuous::new(world, formation))),
            TimeMode::Sampled | TimeMode::Measured => Self::Held(Box::new(world)),
        }
    }

    /// Robots have these limits from now on, and laws are those of `formation`.
    pub(crate) fn apply_parameters(&mut self, handling: &[Handling], formation: &Formation) {
        self.world_mut().apply_parameters(handling);
        if let Self::Continuous(system) = self {
            system.keep_pace(formation);
        }
    }

    pub(crate) fn world(&self) -> &dyn World {
        match self {
            Self::Held(world) => world.as_ref(),
            Self::Continuous(system) => &system.world,
        }
    }

    pub(crate) fn world_mut(&mut self) -> &mut dyn World {
        match self {
            Self::Held(world) => world.as_mut(),
            Self::Continuous(system) => &mut system.world,
        }
    }
}

//! Barriers of safety filters as arcs on the ground: each faces what it keeps its robot from, and reddens as it tightens.

use super::DecalBuilder;
use crate::palette::{self, Rgb};
use crate::picture_context::PictureContext;
use glam::DVec2;
use vocabulary::{BarrierState, math};

/// Room at which an arc begins to redden, m for the default body.
const LOOSE: f64 = 0.8;
/// Half the angle of an arc, rad, and its points.
const HALF_ANGLE: f64 = 0.8;
const POINTS: u32 = 16;
/// From the circle around the body to the arc, m for the default body.
const OFF: f64 = 0.18;
/// Half the width of an arc, m for the default body; one that acts is twice as wide.
const HALF_WIDTH: f64 = 0.04;

impl DecalBuilder<'_> {
    /// The arcs of every robot that has a filter.
    pub(super) fn barriers(&mut self, context: &PictureContext<'_>) {
        for state in &context.record.safety {
            let robot = context.record.snapshot.robots.get(state.robot);
            let (Some(robot), Some(info)) = (robot, context.fleet.robots.get(state.robot)) else { continue };
            let middle = robot.motion.pose.world_from_body(0.5 * info.body.wheelbase, 0.0);
            // The tightest lies on top.
            let mut drawn: Vec<_> = state.barriers.iter().filter(|b| !b.constraint.is_view()).collect();
            drawn.sort_by(|a, b| b.value.total_cmp(&a.value));
            for barrier in drawn {
                let acts = state.moved > 0.0 && state.acting.contains(&barrier.constraint);
                let reach = info.body.radius() + OFF * context.size;
                self.arc(DVec2::from_array(middle), reach, barrier, acts, context);
            }
        }
    }

    fn arc(
        &mut self,
        middle: DVec2,
        reach: f64,
        barrier: &BarrierState,
        acts: bool,
        context: &PictureContext<'_>,
    ) {
        let tight = (1.0 - barrier.value / (LOOSE * context.size)).clamp(0.0, 1.0) as f32;
        let place = |k: u32| {
            let share = 2.0 * f64::from(k) / f64::from(POINTS) - 1.0;
            let (sin, cos) = math::sin_cos(barrier.direction + share * HALF_ANGLE);
            // Its ends fade, so that neighbouring arcs can be told apart.
            let alpha = (0.5 + 0.5 * tight) * (1.0 - share.abs() as f32).min(0.4) / 0.4;
            (middle + reach * DVec2::new(cos, sin), alpha)
        };
        let points: Vec<_> = (0..=POINTS).map(place).collect();
        let half = HALF_WIDTH * context.size * if acts { 2.0 } else { 1.0 };
        self.band(&points, half, if acts { 3.2 } else { 1.8 }, 0.0, colour(tight));
    }
}

/// From gold to red.
fn colour(tight: f32) -> Rgb {
    [0, 1, 2].map(|k| palette::GOLD[k] + tight * (palette::RED[k] - palette::GOLD[k]))
}

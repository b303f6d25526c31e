//! From the keys of props and patterns to props on the ground.

use crate::{
    Ground, PropMotion, PropSpec, Robot,
    outline::Outline,
    patterns::{Layout, PatternField, PatternKeys},
    prop_form::{MOST_PROPS, PropKeys},
    random::RandomStream,
    robots::start_pose,
    text::{Found, Node, Reporter, Span},
};
use std::f64::consts::PI;
use vocabulary::{Pose, Solid, counted};

/// Keeps the random numbers of fields apart from those of groups.
const FIRST_STREAM: u64 = 1 << 32;
/// Places that are tried for a prop of a field.
const TRIES: usize = 300;

/// A prop and where its name is written.
pub(crate) type Placed = Found<PropSpec>;

/// What props are put among.
pub(crate) struct PropStage<'a> {
    pub(crate) ground: Option<&'a Ground>,
    pub(crate) robots: &'a [&'a Robot],
    pub(crate) seed: u64,
}

impl PropStage<'_> {
    /// All props, those of patterns after the others.
    pub(crate) fn props(
        &self,
        props: &[PropKeys],
        patterns: &[PatternKeys],
        root: &Node,
        reporter: &mut Reporter,
    ) -> Vec<Placed> {
        let nodes = root.items("props").iter().map(|node| node.span);
        let written = props.iter().zip(nodes);
        let mut placed: Vec<_> = written.filter_map(|(keys, span)| self.prop(keys, span, reporter)).collect();
        for (index, keys) in patterns.iter().enumerate() {
            self.expand(keys, index as u64, &mut placed, reporter);
            if placed.len() > MOST_PROPS {
                reporter.report(keys.name.span, format!("this makes more than {MOST_PROPS} props"));
                break;
            }
        }
        placed
    }

    fn prop(&self, keys: &PropKeys, span: Span, reporter: &mut Reporter) -> Option<Placed> {
        let pose = match (keys.measured.pose, &keys.pose) {
            (Some(_), Some(pose)) => {
                reporter.report(pose.span, "a wall stands from its `from` to its `to` and has no `pose`");
                None
            }
            (Some(pose), None) => Some(pose),
            (None, pose) => start_pose(pose.as_ref(), keys.path.as_ref(), span, reporter),
        }?;
        let motion = match (&keys.mass, &keys.path) {
            (Some(mass), Some(_)) => {
                reporter.report(
                    mass.span,
                    "`mass` is for props that can be pushed; one with a `path` follows that",
                );
                return None;
            }
            (Some(mass), None) => PropMotion::Loose { mass: mass.value },
            (None, Some(path)) if path.is_planned() => {
                reporter.report(span, "goals are for robots that lead: a prop goes along a path as it is");
                return None;
            }
            (None, Some(path)) => PropMotion::Guided { path: path.clone() },
            (None, None) => PropMotion::Fixed,
        };
        let solid = keys.measured.solid;
        let foot = self.foot(solid, pose, &motion);
        let elevation = keys.elevation.unwrap_or(foot);
        if matches!(motion, PropMotion::Loose { .. }) && elevation < foot - 1e-6 {
            let message = format!(
                "`{}` starts in the ground: `elevation` of {elevation} m must be at least {foot:.3} m, or left out",
                keys.name.value
            );
            reporter.report(keys.name.span, message);
        }
        let (friction, restitution) = (keys.friction, keys.restitution);
        let name = keys.name.value.clone();
        let prop =
            PropSpec { name, solid, pose, elevation, friction, restitution, known: keys.known, motion };
        Some(Found { span: keys.name.span, value: prop })
    }

    /// Height on which a foot stands, m: that of the ground under its middle, and for what is loose the highest under
    /// its middle and corners, so that the ground does not throw it out.
    fn foot(&self, solid: Solid, pose: Pose, motion: &PropMotion) -> f64 {
        let Some(terrain) = self.ground.and_then(|ground| ground.terrain.as_ref()) else { return 0.0 };
        let middle = terrain.at(pose.x, pose.y).height;
        if !matches!(motion, PropMotion::Loose { .. }) {
            return middle;
        }
        let [length, width, _] = solid.extent();
        [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].into_iter().fold(middle, |most, (a, b)| {
            let [x, y] = pose.world_from_body(0.5 * a * length, 0.5 * b * width);
            most.max(terrain.at(x, y).height)
        })
    }

    /// Appends the props of a pattern.
    fn expand(&self, keys: &PatternKeys, index: u64, placed: &mut Vec<Placed>, reporter: &mut Reporter) {
        let spots = match &keys.layout {
            Layout::Placed(spots) => spots.clone(),
            Layout::Field(field) => self.strew(field, index, placed, reporter),
        };
        for (number, (solid, pose)) in spots.into_iter().enumerate() {
            let motion = keys.mass.map_or(PropMotion::Fixed, |mass| PropMotion::Loose { mass });
            let prop = PropSpec {
                name: format!("{}-{}", keys.name.value, number + 1),
                solid,
                pose,
                elevation: self.foot(solid, pose, &motion),
                motion,
                friction: keys.friction,
                restitution: keys.restitution,
                known: true,
            };
            placed.push(Found { span: keys.name.span, value: prop });
        }
    }

    /// Places of a field's props: drawn one by one, those too close to something drawn again.
    fn strew(
        &self,
        field: &PatternField,
        index: u64,
        placed: &[Placed],
        reporter: &mut Reporter,
    ) -> Vec<(Solid, Pose)> {
        let mut random = RandomStream::new(field.seed.unwrap_or(self.seed), FIRST_STREAM + index);
        let mut between = |low: f64, high: f64| low + (high - low) * random.share();
        let [x0, y0, x1, y1] = field.region;
        let mut taken: Vec<_> = self.robots.iter().map(|robot| Outline::of_robot(robot)).collect();
        taken.extend(placed.iter().map(|prop| Outline::of_solid(prop.value.solid, prop.value.pose)));
        let mut spots = vec![];
        for _ in 0..field.count.value {
            let spot = (0..TRIES).find_map(|_| {
                let pose = Pose::new(between(x0, x1), between(y0, y1), between(-PI, PI));
                let outline = Outline::of_solid(field.solid, pose);
                taken.iter().all(|other| outline.far_from(other, field.keep_clear)).then_some((pose, outline))
            });
            let Some((pose, outline)) = spot else {
                let message = format!(
                    "there is room for {} only, {} m clear of robots and of each other",
                    counted(spots.len(), "prop"),
                    field.keep_clear
                );
                reporter.report(field.count.span, message);
                break;
            };
            taken.push(outline);
            spots.push((field.solid, pose));
        }
        spots
    }
}

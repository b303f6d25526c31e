//! Props in well-known arrangements, as they are written.

use crate::{
    ground::RegionForm,
    names::{NameForm, POSE},
    prop_form::{FRICTION, MASS, MEASURE, Measured, RESTITUTION, SOLIDS},
    text::{
        Form, Found, Keys, Node, Reporter, integer, keys,
        kinds::{Kind, Kinds},
        number,
    },
};
use serde_json::Value as Json;
use vocabulary::{Pose, Solid};

/// Most props of a pattern.
pub(crate) const MOST_OF_A_PATTERN: u64 = 1000;

keys! {
    /// Cones in a line, left and right of it in turn, the first one left.
    struct SlalomKeys {
        /// Number of cones.
        count: usize = integer::<usize>(1, MOST_OF_A_PATTERN), required;
        /// From cone to cone along the line, m.
        spacing: f64 = MEASURE, or(2.0);
        /// From the line to either side, m.
        offset: f64 = number("m").from(0.0).up_to(1000.0), or(0.5);
        /// Of the cones' feet, m.
        radius: f64 = MEASURE, or(0.12);
        /// Of the cones, m.
        height: f64 = MEASURE, or(0.35);
        /// Start and direction of the line, [x in m, y in m, heading]; the first cone stands beside the start.
        pose: [f64; 3] = POSE, or([0.0; 3]);
    }
}

keys! {
    /// Two walls side by side, the left one first.
    struct CorridorKeys {
        /// Of the walls, m.
        length: f64 = MEASURE, required;
        /// Between the walls, m.
        width: f64 = MEASURE, required;
        /// Of the walls, m.
        height: f64 = MEASURE, or(0.5);
        /// Of the walls, m.
        thickness: f64 = MEASURE, or(0.1);
        /// Middle of the entrance and direction of the corridor, [x in m, y in m, heading].
        pose: [f64; 3] = POSE, or([0.0; 3]);
    }
}

keys! {
    /// Two pillars, the left one first.
    struct GateKeys {
        /// Between the pillars, m.
        width: f64 = MEASURE, required;
        /// Of the pillars, m.
        height: f64 = MEASURE, or(1.0);
        /// Of the pillars, m.
        radius: f64 = MEASURE, or(0.1);
        /// Middle of the gate and direction through it, [x in m, y in m, heading].
        pose: [f64; 3] = POSE, or([0.0; 3]);
    }
}

keys! {
    /// Props of one shape, strewn over a region by a seed.
    struct FieldKeys {
        /// Number of props.
        count: usize = integer::<usize>(1, MOST_OF_A_PATTERN), required;
        /// Same seed, same field; the scene's `seed` if left out.
        seed: u64 = integer::<u64>(0, i64::MAX as u64), optional;
        /// Where their middles are, [x from, y from, x to, y to] in m.
        region: [f64; 4] = RegionForm, required;
        /// Least distance from robots at the start and from other props, m.
        keep_clear: f64 = number("m").from(0.0).up_to(1000.0), or(0.5);
        /// `shape` and measures of each of them.
        prop: Measured = SOLIDS, required;
    }
}

/// Where the props of a pattern stand.
#[derive(Debug, Clone)]
pub(crate) enum Layout {
    /// Just there.
    Placed(Vec<(Solid, Pose)>),
    /// Strewn by a seed.
    Field(PatternField),
}

/// Props strewn by a seed.
#[derive(Debug, Clone)]
pub(crate) struct PatternField {
    pub(crate) count: Found<usize>,
    /// The scene's if `None`.
    pub(crate) seed: Option<u64>,
    /// m.
    pub(crate) region: [f64; 4],
    /// m.
    pub(crate) keep_clear: f64,
    pub(crate) solid: Solid,
}

/// The pose [forward, left] (m) of a pose, with its heading.
fn beside([x, y, heading]: [f64; 3], forward: f64, left: f64) -> Pose {
    let origin = Pose::new(x, y, heading);
    let [x, y] = origin.world_from_body(forward, left);
    Pose::new(x, y, heading)
}

fn slalom(keys: SlalomKeys, _: &Node, _: &mut Reporter) -> Option<Layout> {
    let (pose, spacing, offset) = (keys.pose?.value, keys.spacing?.value, keys.offset?.value);
    let solid = Solid::Cone { radius: keys.radius?.value, height: keys.height?.value };
    let cone = |index: usize| {
        let left = if index.is_multiple_of(2) { offset } else { -offset };
        (solid, beside(pose, index as f64 * spacing, left))
    };
    Some(Layout::Placed((0..keys.count?.value).map(cone).collect()))
}

fn corridor(keys: CorridorKeys, _: &Node, _: &mut Reporter) -> Option<Layout> {
    let (length, thickness) = (keys.length?.value, keys.thickness?.value);
    let (pose, left) = (keys.pose?.value, 0.5 * (keys.width?.value + thickness));
    let solid = Solid::Block { size: [length, thickness, keys.height?.value] };
    let wall = |left| (solid, beside(pose, 0.5 * length, left));
    Some(Layout::Placed([left, -left].map(wall).to_vec()))
}

fn gate(keys: GateKeys, _: &Node, _: &mut Reporter) -> Option<Layout> {
    let (pose, radius) = (keys.pose?.value, keys.radius?.value);
    let left = 0.5 * keys.width?.value + radius;
    let solid = Solid::Cylinder { radius, height: keys.height?.value };
    Some(Layout::Placed([left, -left].map(|left| (solid, beside(pose, 0.0, left))).to_vec()))
}

fn field(keys: FieldKeys, _: &Node, _: &mut Reporter) -> Option<Layout> {
    Some(Layout::Field(PatternField {
        count: keys.count?,
        seed: keys.seed.map(|seed| seed.value),
        region: keys.region?.value,
        keep_clear: keys.keep_clear?.value,
        solid: keys.prop?.value.solid,
    }))
}

/// Kinds of patterns.
const PATTERNS: Kinds<Layout> = Kinds {
    key: "kind",
    usual: None,
    all: &[
        &Kind { word: "slalom", make: slalom },
        &Kind { word: "corridor", make: corridor },
        &Kind { word: "gate", make: gate },
        &Kind { word: "field", make: field },
    ],
};

keys! {
    /// What all patterns have.
    struct SharedKeys {
        /// Start of the props' names: they are called `name-1`, `name-2` and so on.
        name: String = NameForm::START, required;
        /// Of each prop, kg; props with a mass are loose: they can be pushed, and fall.
        mass: f64 = MASS, optional;
        /// Coefficient of friction of the props' surfaces.
        friction: f64 = FRICTION, or(0.6);
        /// Share of the speed of an impact that the props are thrown back with.
        restitution: f64 = RESTITUTION, or(0.1);
    }
}

/// A pattern as it is written.
#[derive(Debug, Clone)]
pub(crate) struct PatternKeys {
    pub(crate) layout: Layout,
    pub(crate) name: Found<String>,
    pub(crate) mass: Option<f64>,
    pub(crate) friction: f64,
    pub(crate) restitution: f64,
}

/// A table that describes a pattern.
pub(crate) struct PatternForm;

impl Form for PatternForm {
    type Out = PatternKeys;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<PatternKeys> {
        let (layout, shared) = PATTERNS.read_with(node, reporter, SharedKeys::read)?;
        Some(PatternKeys {
            layout: layout?,
            name: shared.name?,
            mass: shared.mass.map(|found| found.value),
            friction: shared.friction?.value,
            restitution: shared.restitution?.value,
        })
    }

    fn schema(&self) -> Json {
        PATTERNS.schema_with(SharedKeys::fields)
    }
}

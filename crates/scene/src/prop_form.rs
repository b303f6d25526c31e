//! How props are written: shapes with their measures, and what all of them have.

use crate::{
    Path,
    names::{NameForm, POSE},
    path_form::PATH,
    text::{
        Couple, Flag, Form, Found, Keys, Node, Reporter, Triple,
        form::Number,
        keys,
        kinds::{Kind, KindOption, Kinds},
        number,
    },
};
use serde_json::Value as Json;
use vocabulary::{Pose, Solid, math};

/// Most props of a scene.
pub(crate) const MOST_PROPS: usize = 2000;
/// A measure of a prop.
pub(crate) const MEASURE: Number = number("m").above(0.0).up_to(1000.0);
/// [length, width, height].
const SIZE: Triple<Number, Number, Number> = Triple(MEASURE, MEASURE, MEASURE);
/// What makes a prop loose.
pub(crate) const MASS: Number = number("kg").above(0.0);
/// Of a prop's surface.
pub(crate) const FRICTION: Number = number("").from(0.0).up_to(5.0);
/// Of an impact.
pub(crate) const RESTITUTION: Number = number("").from(0.0).up_to(1.0);

keys! {
    /// A box.
    struct BlockKeys {
        /// [length, width, height], m.
        size: [f64; 3] = SIZE, required;
    }
}

keys! {
    /// From the ground at its rear end it rises evenly to its full height at its front end.
    struct RampKeys {
        /// [length, width, height], m.
        size: [f64; 3] = SIZE, required;
    }
}

keys! {
    /// Round and upright.
    struct CylinderKeys {
        /// Of its foot, m.
        radius: f64 = MEASURE, required;
        /// From foot to top, m.
        height: f64 = MEASURE, required;
    }
}

keys! {
    /// Round and upright, its tip on top.
    struct ConeKeys {
        /// Of its foot, m.
        radius: f64 = MEASURE, required;
        /// From foot to tip, m.
        height: f64 = MEASURE, required;
    }
}

keys! {
    /// A long block between two points; it has no `pose`.
    struct WallKeys {
        /// One end [x, y], m.
        from: [f64; 2] = Couple(number("m"), number("m")), required;
        /// The other end [x, y], m.
        to: [f64; 2] = Couple(number("m"), number("m")), required;
        /// From foot to top, m.
        height: f64 = MEASURE, or(0.5);
        /// From side to side, m.
        thickness: f64 = MEASURE, or(0.1);
    }
}

/// A solid, and its place where its measures say that.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measured {
    pub(crate) solid: Solid,
    pub(crate) pose: Option<Pose>,
}

fn anywhere(solid: Solid) -> Measured {
    Measured { solid, pose: None }
}

fn wall(keys: WallKeys, _: &Node, reporter: &mut Reporter) -> Option<Measured> {
    let (from, to) = (keys.from?.value, keys.to?);
    let [dx, dy] = [to.value[0] - from[0], to.value[1] - from[1]];
    let length = math::hypot(dx, dy);
    if length < 1e-3 {
        reporter.report(to.span, "a wall must be at least 0.001 m long: `to` is where `from` is");
        return None;
    }
    let pose = Pose::new(from[0] + 0.5 * dx, from[1] + 0.5 * dy, math::atan2(dy, dx));
    let size = [length, keys.thickness?.value, keys.height?.value];
    Some(Measured { solid: Solid::Block { size }, pose: Some(pose) })
}

const BLOCK: &dyn KindOption<Measured> = &Kind {
    word: "block",
    make: |keys: BlockKeys, _, _| Some(anywhere(Solid::Block { size: keys.size?.value })),
};
const CYLINDER: &dyn KindOption<Measured> = &Kind {
    word: "cylinder",
    make: |keys: CylinderKeys, _, _| {
        Some(anywhere(Solid::Cylinder { radius: keys.radius?.value, height: keys.height?.value }))
    },
};
const CONE: &dyn KindOption<Measured> = &Kind {
    word: "cone",
    make: |keys: ConeKeys, _, _| {
        Some(anywhere(Solid::Cone { radius: keys.radius?.value, height: keys.height?.value }))
    },
};
const RAMP: &dyn KindOption<Measured> = &Kind {
    word: "ramp",
    make: |keys: RampKeys, _, _| Some(anywhere(Solid::Wedge { size: keys.size?.value })),
};

/// Shapes of props.
const SHAPES: Kinds<Measured> = Kinds {
    key: "shape",
    usual: None,
    all: &[BLOCK, CYLINDER, CONE, &Kind { word: "wall", make: wall }, RAMP],
};

/// Shapes of props that can stand anywhere.
pub(crate) const SOLIDS: Kinds<Measured> =
    Kinds { key: "shape", usual: None, all: &[BLOCK, CYLINDER, CONE, RAMP] };

keys! {
    /// What all props have.
    struct SharedKeys {
        /// Unique name, among robots too.
        name: String = NameForm::WHOLE, required;
        /// Where the middle of its foot is: [x in m, y in m, heading]; a wall has none.
        pose: [f64; 3] = POSE, optional;
        /// Height of its foot over z = 0, m; on the ground if left out.
        elevation: f64 = number("m").from(-1000.0).up_to(1000.0), optional;
        /// kg; a prop with a mass is loose: it can be pushed, and falls.
        mass: f64 = MASS, optional;
        /// Its way, as that of a robot that leads; nothing stops it.
        path: Path = PATH, optional;
        /// Coefficient of friction of its surface.
        friction: f64 = FRICTION, or(0.6);
        /// Share of the speed of an impact that it is thrown back with.
        restitution: f64 = RESTITUTION, or(0.1);
        /// Whether plans to goals know of it from the start; otherwise robots have to sense it.
        known: bool = Flag, or(true);
    }
}

/// A prop as it is written.
#[derive(Debug, Clone)]
pub(crate) struct PropKeys {
    pub(crate) measured: Measured,
    pub(crate) name: Found<String>,
    pub(crate) pose: Option<Found<[f64; 3]>>,
    pub(crate) elevation: Option<f64>,
    pub(crate) mass: Option<Found<f64>>,
    pub(crate) path: Option<Path>,
    pub(crate) friction: f64,
    pub(crate) restitution: f64,
    pub(crate) known: bool,
}

/// A table that describes a prop.
pub(crate) struct PropForm;

impl Form for PropForm {
    type Out = PropKeys;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<PropKeys> {
        let (measured, shared) = SHAPES.read_with(node, reporter, SharedKeys::read)?;
        Some(PropKeys {
            measured: measured?,
            name: shared.name?,
            pose: shared.pose,
            elevation: shared.elevation.map(|found| found.value),
            mass: shared.mass,
            path: shared.path.map(|found| found.value),
            friction: shared.friction?.value,
            restitution: shared.restitution?.value,
            known: shared.known?.value,
        })
    }

    fn schema(&self) -> Json {
        SHAPES.schema_with(SharedKeys::fields)
    }
}

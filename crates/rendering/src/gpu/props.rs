//! Where the props of a moment stand, and what they are made of.

use crate::gpu::passes::instanced::Instance;
use crate::gpu::passes::prop::{PropAppearance, PropInstances};
use crate::palette::{Rgb, hex, linear, with_alpha};
use crate::picture_context::PictureContext;
use glam::{DQuat, DVec3, Mat4};
use vocabulary::{Mobility, Placement, Prop, Solid};

const CONCRETE: Rgb = hex(0x00c2_b8a8);
const PALE: Rgb = hex(0x00dc_d7cb);
const ORANGE: Rgb = hex(0x00f2_6418);
const PLYWOOD: Rgb = hex(0x00d3_b384);
const CRATE: Rgb = hex(0x00b9_8a55);
const BARREL: Rgb = hex(0x00a8_7a42);
/// What moves by itself is none of the robots' colours.
const GUIDED: Rgb = hex(0x00a5_434c);

/// Every prop of the fleet with its index and its pose: that of the moment, else its initial one.
pub(crate) fn placed<'a>(
    context: &PictureContext<'a>,
) -> impl Iterator<Item = (usize, &'a Prop, Placement)> + use<'a> {
    let now = &context.record.snapshot.props;
    let all = context.fleet.props.iter().enumerate();
    all.map(|(k, prop)| (k, prop, now.get(k).copied().unwrap_or(prop.placement))).filter(|(.., p)| sound(p))
}

fn sound(placement: &Placement) -> bool {
    let turns = placement.rotation.iter().map(|x| x * x).sum::<f64>() > 1e-12;
    turns && placement.position.iter().chain(&placement.rotation).all(|x| x.is_finite())
}

pub(crate) fn turn(placement: &Placement) -> DQuat {
    DQuat::from_array(placement.rotation).normalize()
}

/// The eight corners of the box around a prop, in the world.
pub(crate) fn corners(prop: &Prop, placement: &Placement) -> [DVec3; 8] {
    let [length, width, height] = prop.solid.extent();
    let (turn, foot) = (turn(placement), DVec3::from_array(placement.position));
    std::array::from_fn(|k| {
        let side = |bit: usize| if k & bit == 0 { -0.5 } else { 0.5 };
        let up = if k & 4 == 0 { 0.0 } else { height };
        foot + turn * DVec3::new(side(1) * length, side(2) * width, up)
    })
}

/// All copies of the solids in a picture.
pub(crate) fn props(context: &PictureContext<'_>) -> PropInstances {
    let mut copies = PropInstances::default();
    for (_, prop, placement) in placed(context).filter(|(k, ..)| !context.floor.is_drivable(*k)) {
        let ground = context.floor.height(DVec3::from_array(placement.position).truncate());
        let (look, colour) = appearance(prop);
        copies.others[look as usize].push(instance(context, prop, &placement, ground, colour));
    }
    for drivable in &context.floor.drivables {
        let prop = &context.fleet.props[drivable.prop];
        let ground = context.floor.ground(DVec3::from_array(prop.placement.position).truncate());
        let (look, colour) = appearance(prop);
        copies.drivables.push((look, instance(context, prop, &prop.placement, ground, colour)));
    }
    copies
}

/// How a prop is painted, and its colour.
fn appearance(prop: &Prop) -> (PropAppearance, Rgb) {
    match (prop.solid, prop.mobility) {
        (Solid::Block { .. }, Mobility::Fixed) => (PropAppearance::Concrete, CONCRETE),
        (Solid::Block { .. }, Mobility::Loose) => (PropAppearance::Timber, CRATE),
        (Solid::Block { .. }, Mobility::Guided) => (PropAppearance::Machine, GUIDED),
        (Solid::Cylinder { .. }, Mobility::Fixed) => (PropAppearance::Pillar, PALE),
        (Solid::Cylinder { .. }, Mobility::Loose) => (PropAppearance::Pillar, BARREL),
        (Solid::Cylinder { .. }, Mobility::Guided) => (PropAppearance::Pillar, GUIDED),
        (Solid::Cone { .. }, _) => (PropAppearance::Cone, ORANGE),
        (Solid::Wedge { .. }, Mobility::Guided) => (PropAppearance::Ramp, GUIDED),
        (Solid::Wedge { .. }, _) => (PropAppearance::Ramp, PLYWOOD),
    }
}

fn instance(
    context: &PictureContext<'_>,
    prop: &Prop,
    placement: &Placement,
    ground: f64,
    colour: Rgb,
) -> Instance {
    let scale = match prop.solid {
        Solid::Block { size } | Solid::Wedge { size } => DVec3::from_array(size),
        Solid::Cylinder { radius, height } | Solid::Cone { radius, height } => {
            DVec3::new(radius, radius, height)
        }
    };
    let place = DVec3::from_array(placement.position);
    let turn = turn(placement).as_quat();
    let model =
        Mat4::from_scale_rotation_translation(scale.as_vec3(), turn, (place - context.origin).as_vec3());
    let guided = f32::from(u8::from(prop.mobility == Mobility::Guided));
    let marks = [guided, 0.0, (ground - context.origin.z) as f32, 0.0];
    Instance::new(model, with_alpha(linear(colour), 1.0), marks)
}

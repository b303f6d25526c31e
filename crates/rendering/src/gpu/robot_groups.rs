//! Which robots of a view are drawn together: those that overlap in the picture.

use crate::annotation::labels::Window;
use crate::camera::viewpoint::Tile;
use crate::gpu::atlas::pack;
use crate::gpu::passes::robot::{RobotInstances, Squad};
use crate::picture_context::PictureContext;
use glam::{BVec3, Vec3};

/// Most robots that are sorted into groups: more overlap anyway.
const MOST: usize = 64;

/// The groups of a view, each with a place on a sheet.
#[derive(Debug, Default)]
pub(crate) struct Groups {
    pub(crate) all: Vec<Group>,
    /// Of the sheet, pixels.
    pub(crate) size: [u32; 2],
}

/// Robots that overlap; all of them where there are many, or where a sheet has no room for more groups than one.
#[derive(Debug)]
pub(crate) struct Group {
    /// What of the picture holds them.
    pub(crate) crop: Tile,
    /// Where that is on the sheet.
    pub(crate) slot: Tile,
    pub(crate) crowd: RobotInstances,
}

impl Group {
    /// From the sheet to the picture, pixels.
    pub(crate) fn shift(&self) -> [f32; 2] {
        [self.crop.x as f32 - self.slot.x as f32, self.crop.y as f32 - self.slot.y as f32]
    }
}

/// A robot of a crowd: its place among those of its kind, and among all of them.
#[derive(Debug, Clone, Copy)]
struct Member {
    kind: usize,
    place: usize,
    index: usize,
}

/// What of a picture holds some members.
type Held = (Tile, Vec<Member>);

impl Groups {
    /// Those of all robots within the bounds of their builds, as far as a camera sees them in its tile, on a sheet of at most
    /// `most` pixels across or down.
    pub(crate) fn of(
        crowd: &RobotInstances,
        context: &PictureContext<'_>,
        bounds: &[[Vec3; 2]],
        window: Window<'_>,
        most: u32,
    ) -> Self {
        let found: Vec<Held> = seen(crowd, context, bounds, window);
        let apart = (found.len() <= MOST).then(|| merged(&found));
        let packed = apart.and_then(|held| Some((pack(&sizes(&held), most)?, held)));
        let together = || {
            let held: Vec<_> = found.into_iter().reduce(join).into_iter().collect();
            Some((pack(&sizes(&held), most)?, held))
        };
        let Some(((slots, size), held)) = packed.or_else(together) else { return Self::default() };
        let group =
            |((crop, members), slot): (Held, Tile)| Group { crop, slot, crowd: chosen(crowd, &members) };
        Self { all: held.into_iter().zip(slots).map(group).collect(), size }
    }

    /// What a camera on a robot sees, all in one group.
    pub(crate) fn whole(crowd: RobotInstances, tile: &Tile) -> Self {
        let slot = Tile { x: 0, y: 0, ..*tile };
        Self { all: vec![Group { crop: *tile, slot, crowd }], size: [tile.width, tile.height] }
    }

    /// What has to be on the device.
    pub(crate) fn crowds(&mut self) -> impl Iterator<Item = &mut RobotInstances> {
        self.all.iter_mut().map(|group| &mut group.crowd)
    }
}

fn sizes(held: &[Held]) -> Vec<[u32; 2]> {
    held.iter().map(|(crop, _)| [crop.width, crop.height]).collect()
}

/// The robots that are in a picture, each with the part of it that holds it.
fn seen(
    crowd: &RobotInstances,
    context: &PictureContext<'_>,
    bounds: &[[Vec3; 2]],
    window: Window<'_>,
) -> Vec<Held> {
    let mut counts = vec![0; crowd.squads.len()];
    let mut seen = Vec::new();
    for (index, kind) in context.robot_models.of.iter().copied().enumerate() {
        let place = counts[kind];
        counts[kind] += 1;
        let Some(copy) = crowd.squads[kind].bodies.get(place) else { continue };
        let [low, high] = bounds[kind];
        let corner = |k: u8| Vec3::select(BVec3::new(k & 1 == 1, k & 2 == 2, k & 4 == 4), high, low);
        let corners = [0, 1, 2, 3, 4, 5, 6, 7].map(|k| context.origin + copy.place(corner(k)).as_dvec3());
        let part = window.camera.around(&corners);
        if let Some(crop) = part.and_then(|part| window.tile.part(part)) {
            seen.push((crop, vec![Member { kind, place, index }]));
        }
    }
    seen
}

/// The same with those together that overlap.
fn merged(found: &[Held]) -> Vec<Held> {
    let mut apart: Vec<Held> = Vec::new();
    for held in found {
        let mut held = held.clone();
        // One that has grown may meet those that it did not meet before.
        while let Some(k) = apart.iter().position(|other| meet(&held.0, &other.0)) {
            held = join(apart.swap_remove(k), held);
        }
        apart.push(held);
    }
    apart
}

fn meet(a: &Tile, b: &Tile) -> bool {
    a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height
}

fn join((a, mut members): Held, (b, more): Held) -> Held {
    let [x, y] = [a.x.min(b.x), a.y.min(b.y)];
    let [right, bottom] = [(a.x + a.width).max(b.x + b.width), (a.y + a.height).max(b.y + b.height)];
    members.extend(more);
    (Tile { x, y, width: right - x, height: bottom - y }, members)
}

/// Copies of some members alone.
fn chosen(crowd: &RobotInstances, members: &[Member]) -> RobotInstances {
    let squads = vec![Squad::default(); crowd.squads.len()];
    let mut part = RobotInstances { squads, ..RobotInstances::default() };
    for Member { kind, place, index } in members {
        let (squad, whole) = (&mut part.squads[*kind], &crowd.squads[*kind]);
        squad.bodies.push(whole.bodies[*place]);
        squad.wheels.extend_from_slice(&whole.wheels[4 * place..4 * place + 4]);
        part.cameras.push(crowd.cameras[*index]);
    }
    part
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_overlaps_is_in_one_group() {
        let tile = |x, y, width, height| Tile { x, y, width, height };
        let member = |index| vec![Member { kind: 0, place: 0, index }];
        // The third meets neither of the first two, but what they are together.
        let found = [tile(0, 0, 10, 10), tile(9, 9, 20, 20), tile(20, 2, 5, 3), tile(29, 0, 5, 5)];
        let found: Vec<Held> = (0..).zip(found).map(|(k, crop)| (crop, member(k))).collect();
        let places = |(crop, members): &Held| {
            let mut indices: Vec<_> = members.iter().map(|member| member.index).collect();
            indices.sort_unstable();
            (*crop, indices)
        };
        let groups: Vec<_> = merged(&found).iter().map(places).collect();
        assert_eq!(groups, [(tile(0, 0, 29, 29), vec![0, 1, 2]), (tile(29, 0, 5, 5), vec![3])]);
    }
}

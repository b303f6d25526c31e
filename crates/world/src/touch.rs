//! Contacts over time: which things touch, since when, and how hard.

use std::collections::BTreeMap;
use vocabulary::{Body, Contact, EntityId, Pose, Snapshot, math};

/// Things that have not touched for so long have parted, s: shorter gaps are one contact that rattles.
const PARTED: f64 = 0.1;

/// One touch of two things at an instant.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BodyContact {
    /// The two, in order.
    pub(crate) things: [EntityId; 2],
    /// Where, m.
    pub(crate) place: [f64; 3],
    /// From the first to the second.
    pub(crate) normal: [f64; 3],
    /// N s since the instant before.
    pub(crate) impulse: f64,
}

/// The contacts of a run under way.
#[derive(Debug, Clone, Default)]
pub(crate) struct Touches {
    count: u64,
    contacts: Vec<Contact>,
    /// Where in `contacts` the open contact of two things is.
    open: BTreeMap<[EntityId; 2], usize>,
    /// The smallest x that each robot may reach, in order.
    order: Vec<(f64, usize)>,
}

impl Touches {
    pub(crate) fn contacts(&self) -> &[Contact] {
        &self.contacts
    }

    /// Forgets the contacts that have ended: they have been told.
    pub(crate) fn forget_ended(&mut self) {
        if self.contacts.iter().all(|contact| contact.open) {
            return;
        }
        self.contacts.retain(|contact| contact.open);
        self.open =
            self.contacts.iter().enumerate().map(|(index, contact)| (contact.things, index)).collect();
    }

    /// Takes in a touch at `time`.
    pub(crate) fn touch(&mut self, time: f64, touch: &BodyContact) {
        let BodyContact { things, place, normal, impulse } = *touch;
        if let Some(contact) = self.open.get(&things).and_then(|index| self.contacts.get_mut(*index)) {
            contact.end = time;
            contact.impulse += impulse;
            return;
        }
        self.open.insert(things, self.contacts.len());
        let (begin, end) = (time, time);
        self.contacts.push(Contact {
            number: self.count,
            things,
            begin,
            end,
            open: true,
            place,
            normal,
            impulse,
        });
        self.count += 1;
    }

    /// Ends the contacts of things that have parted by `time`.
    pub(crate) fn part(&mut self, time: f64) {
        for contact in self.contacts.iter_mut().filter(|c| c.open && time - c.end > PARTED) {
            contact.open = false;
            self.open.remove(&contact.things);
        }
    }

    /// Finds the robots of a flat world whose outlines overlap.
    pub(crate) fn find<'b>(&mut self, snapshot: &Snapshot, body: impl Fn(usize) -> &'b Body) {
        self.forget_ended();
        let outline = |index: usize| BodyOutline::of(&snapshot.robots[index].motion.pose, body(index));
        // No point of a body is farther from its pose.
        let reach = |index: usize| {
            let Body { length, width, wheelbase, .. } = body(index);
            0.5 * (length + width + wheelbase)
        };
        let robots = snapshot.robots.iter().enumerate().filter(|(_, robot)| robot.is_present());
        self.order.clear();
        self.order.extend(robots.map(|(index, robot)| (robot.motion.pose.x - reach(index), index)));
        self.order.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let mut found = Vec::new();
        for (rank, &(left, i)) in self.order.iter().enumerate() {
            let (right, y) = (left + 2.0 * reach(i), snapshot.robots[i].motion.pose.y);
            for &(left, j) in &self.order[rank + 1..] {
                if left > right {
                    break;
                }
                // Outlines take a sine and a cosine: few are worth it.
                if (snapshot.robots[j].motion.pose.y - y).abs() > reach(i) + reach(j) {
                    continue;
                }
                if let Some((place, normal)) = outline(i.min(j)).overlap(&outline(i.max(j))) {
                    let things = [EntityId::Robot(i.min(j)), EntityId::Robot(i.max(j))];
                    found.push(BodyContact { things, place, normal, impulse: 0.0 });
                }
            }
        }
        found.sort_by_key(|touch| touch.things);
        for touch in &found {
            self.touch(snapshot.time, touch);
        }
        self.part(snapshot.time);
    }
}

/// A rectangle on the plane.
#[derive(Debug, Clone, Copy)]
struct BodyOutline {
    middle: [f64; 2],
    /// Unit vectors along and across.
    axes: [[f64; 2]; 2],
    /// Half of length and width, m.
    half: [f64; 2],
    height: f64,
    reach: f64,
}

impl BodyOutline {
    fn of(pose: &Pose, body: &Body) -> Self {
        let (sin, cos) = math::sin_cos(pose.heading);
        let ahead = body.wheelbase / 2.0;
        let half = [body.length / 2.0, body.width / 2.0];
        Self {
            middle: [pose.x + ahead * cos, pose.y + ahead * sin],
            axes: [[cos, sin], [-sin, cos]],
            half,
            height: body.height,
            reach: body.radius(),
        }
    }

    /// How far it reaches from its middle along a unit vector.
    fn reach_along(&self, axis: [f64; 2]) -> f64 {
        self.half[0] * dot(self.axes[0], axis).abs() + self.half[1] * dot(self.axes[1], axis).abs()
    }

    /// Middle and direction of the overlap along the axis on which the two overlap least, if they do on all.
    fn overlap(&self, other: &Self) -> Option<([f64; 3], [f64; 3])> {
        let apart = [other.middle[0] - self.middle[0], other.middle[1] - self.middle[1]];
        if dot(apart, apart) > math::powi(self.reach + other.reach, 2) {
            return None;
        }
        let mut least = (f64::INFINITY, [0.0; 2]);
        for axis in self.axes.into_iter().chain(other.axes) {
            let along = dot(apart, axis);
            let depth = self.reach_along(axis) + other.reach_along(axis) - along.abs();
            if depth < 0.0 {
                return None;
            }
            if depth < least.0 {
                least = (depth, if along < 0.0 { [-axis[0], -axis[1]] } else { axis });
            }
        }
        let (depth, normal) = least;
        let out = self.reach_along(normal) - 0.5 * depth;
        let across = dot(apart, [-normal[1], normal[0]]) / 2.0;
        let place = [0, 1].map(|k| self.middle[k] + out * normal[k] + across * [-normal[1], normal[0]][k]);
        Some(([place[0], place[1], 0.5 * self.height.min(other.height)], [normal[0], normal[1], 0.0]))
    }
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::RobotState;

    fn at(time: f64, gap: f64) -> Snapshot {
        let mut robots = vec![RobotState::default(); 2];
        robots[1].motion.pose.x = Body::default().length + gap;
        Snapshot { time, robots, props: vec![] }
    }

    #[test]
    fn a_rattling_contact_is_one_and_a_new_one_is_another() {
        let body = Body::default();
        let mut touches = Touches::default();
        let mut ended = Vec::new();
        for (k, gap) in [0.1, -0.01, 0.01, -0.02, 0.1, 0.1, 0.1, 0.1, -0.01].into_iter().enumerate() {
            touches.find(&at(k as f64 * 0.05, gap), |_| &body);
            ended.extend(touches.contacts().iter().filter(|c| !c.open).copied());
        }
        assert_eq!(ended.len(), 1);
        assert_eq!((ended[0].number, ended[0].begin, ended[0].end), (0, 0.05, 3.0 * 0.05));
        assert_eq!(ended[0].normal, [1.0, 0.0, 0.0]);
        let middle = Body::default().wheelbase / 2.0;
        assert!((ended[0].place[0] - (middle + Body::default().length / 2.0 - 0.005)).abs() < 1e-12);
        assert_eq!((touches.contacts().len(), touches.contacts()[0].number), (1, 1));
    }
}

//! What leads from one scene to another while a run goes, and what stands in the way.

use crate::text::{Keys, keys::Mark};
use crate::types::{
    LawPart, NarrowingPart, ObserverPart, ProximityPart, SafetyPart, SensingPart, VehiclePart,
};
use crate::vehicle::applies;
use crate::{Follow, Law, LawSource, Path, Robot, Role, Scene};
use serde::Serialize;
use std::collections::BTreeSet;
use vocabulary::ScalarTrajectory;

/// What differs between two scenes.
#[derive(Debug, Default)]
pub(crate) struct ParameterDifference {
    /// Overrides that lead from the one to the other.
    pub(crate) sets: Vec<String>,
    /// Paths of what cannot change while a run goes.
    pub(crate) obstacles: Vec<String>,
}

/// That what is at `path` cannot change while a run goes.
pub(crate) fn refusal(path: &str) -> String {
    format!(
        "`{path}` cannot change while a run goes; what can is `distance`, `bearing`, `law`, `observer` without its `start`, \
         `narrowing`, the limits of a `vehicle`, `safety` of a follower, and the goals of a lead robot"
    )
}

impl ParameterDifference {
    /// All but robots and changes.
    pub(crate) fn note_rest(&mut self, a: &Scene, b: &Scene) {
        // A part that is added to scenes has to be placed here: it does not compile without.
        let Scene {
            title,
            description,
            seed,
            time,
            physics,
            vision,
            ground,
            props,
            environment,
            views,
            film,
            expect,
            events,
            hand_over,
            robots: _,
            changes: _,
        } = a;
        for (key, same) in [
            ("title", *title == b.title),
            ("description", *description == b.description),
            ("seed", *seed == b.seed),
            ("time", *time == b.time),
            ("physics", *physics == b.physics),
            ("vision", *vision == b.vision),
            ("ground", *ground == b.ground),
            ("props", *props == b.props),
            ("environment", *environment == b.environment),
            ("views", *views == b.views),
            ("film", *film == b.film),
            ("expect", *expect == b.expect),
            // Events may come on top of those that are there.
            ("events", b.events.starts_with(events)),
            ("hand_over", *hand_over == b.hand_over),
        ] {
            self.refuse_unless(same, "", key);
        }
    }

    /// What differs between robots, one by one.
    pub(crate) fn note_robots(&mut self, before: &[Robot], after: &[Robot]) {
        if !before.iter().map(|robot| &robot.name).eq(after.iter().map(|robot| &robot.name)) {
            self.obstacles.push("robots".to_owned());
            return;
        }
        for (a, b) in before.iter().zip(after).filter(|(a, b)| a != b) {
            let at = format!("robots.{}.", a.name);
            self.refuse_unless(a.pose == b.pose, &at, "pose");
            self.refuse_unless(a.number == b.number, &at, "number");
            self.note_table([&a.vehicle, &b.vehicle], &format!("{at}vehicle."), |key| {
                is_live::<VehiclePart>(key) && applies(key, a.vehicle.kind)
            });
            // A robot that leads by its path is another body in the world than one that chases it.
            let leads = matches!(a.role, Role::Lead { .. }) && (a.safety.leads || b.safety.leads);
            self.note_table([&a.safety, &b.safety], &format!("{at}safety."), |key| {
                is_live::<SafetyPart>(key) && !(leads && key == "filter")
            });
            self.note_table(
                [&a.proximity, &b.proximity],
                &format!("{at}proximity."),
                is_live::<ProximityPart>,
            );
            match (&a.role, &b.role) {
                (Role::Lead { path: a }, Role::Lead { path: b }) => self.note_path([a, b], &at),
                (Role::Follow(a_role), Role::Follow(b_role)) => {
                    let slowest = a_role.speed == a.vehicle.speed_min && b_role.speed == b.vehicle.speed_min;
                    self.refuse_unless(a_role.speed == b_role.speed || slowest, &at, "speed");
                    self.note_follow(a_role, b_role, &at);
                }
                _ => self.obstacles.push(format!("{at}leader")),
            }
        }
    }

    fn note_follow(&mut self, a: &Follow, b: &Follow, at: &str) {
        let names =
            |follow: &Follow| follow.leaders.iter().map(|leader| leader.name.clone()).collect::<Vec<_>>();
        if names(a) == names(b) {
            for (before, after) in a.leaders.iter().zip(b.leaders.iter()) {
                let several = format!("{at}leaders.{}.", after.name);
                let at = if b.leaders.are_several() { &several } else { at };
                self.note_channel([&before.distance, &after.distance], at, "distance");
                self.note_channel([&before.bearing, &after.bearing], at, "bearing");
            }
        } else {
            self.obstacles.push(format!("{at}leader"));
        }
        self.note_law(&a.law, &b.law, &format!("{at}law."));
        self.note_table([&a.observer, &b.observer], &format!("{at}observer."), is_live::<ObserverPart>);
        self.note_table([&a.narrowing, &b.narrowing], &format!("{at}narrowing."), is_live::<NarrowingPart>);
        self.note_table([&a.sensing, &b.sensing], &format!("{at}sensing."), is_live::<SensingPart>);
    }

    /// Where a lead robot goes to may change, but not to a path that says how it goes, nor from one.
    fn note_path(&mut self, [a, b]: [&Path; 2], at: &str) {
        let kind = std::mem::discriminant(a) == std::mem::discriminant(b);
        if kind && a.is_planned() {
            self.note_table([a, b], &format!("{at}path."), |key| key != "priority");
        } else {
            self.refuse_unless(a == b, at, "path");
        }
    }

    /// One part of a set point; whether it is left free stays.
    fn note_channel(&mut self, [a, b]: [&Option<ScalarTrajectory>; 2], at: &str, key: &str) {
        match [a, b] {
            _ if a == b => {}
            [Some(_), Some(value)] => self.sets.push(format!("{at}{key}={}", written(value))),
            _ => self.obstacles.push(format!("{at}{key}")),
        }
    }

    /// Of the keys that choose a law the one that chooses the second.
    fn note_law(&mut self, a: &Law, b: &Law, at: &str) {
        if (a.custom(), a.built_in()) != (b.custom(), b.built_in()) {
            self.sets.push(match b.custom() {
                Some(law) => match law.source() {
                    LawSource::Shipped(name) => format!("{at}file={name}"),
                    LawSource::File(_) | LawSource::Scene => {
                        let (key, words) = law.in_words();
                        format!("{at}{key}={words}")
                    }
                },
                None => format!("{at}kind={}", written(&b.kind)),
            });
        }
        let (file, text, module) = (b.file.clone(), b.text.clone(), b.module.clone());
        let same = Law { kind: b.kind, file, text, module, ..a.clone() };
        self.note_table([&same, b], at, is_live::<LawPart>);
    }

    /// The keys in which two tables differ, those to be set of which `may` says so.
    fn note_table<T: Serialize + PartialEq>(&mut self, pair: [&T; 2], at: &str, may: impl Fn(&str) -> bool) {
        if pair[0] == pair[1] {
            return;
        }
        // What has been read from TOML can be written as TOML.
        let [a, b] = pair.map(|values| toml::Table::try_from(values).unwrap_or_default());
        let keys: BTreeSet<_> = a.keys().chain(b.keys()).collect();
        for key in keys.into_iter().filter(|key| a.get(*key) != b.get(*key)) {
            match b.get(key).filter(|_| may(key)) {
                Some(value) => self.sets.push(format!("{at}{key}={}", written(value))),
                None => self.obstacles.push(format!("{at}{key}")),
            }
        }
    }

    fn refuse_unless(&mut self, same: bool, at: &str, key: &str) {
        if !same {
            self.obstacles.push(format!("{at}{key}"));
        }
    }
}

/// Whether a run can go on with another value of `key` of the table whose keys are `K`.
fn is_live<K: Keys>(key: &str) -> bool {
    K::marks(key).is_some_and(|marks| marks.contains(&Mark::Live))
}

/// A value as it stands behind `=`; words stand alone.
fn written<T: Serialize>(value: &T) -> String {
    match toml::Value::try_from(value) {
        Ok(toml::Value::String(word)) => word,
        Ok(value) => value.to_string(),
        // What has been read from TOML can be written as TOML.
        Err(_) => String::new(),
    }
}

//! Actions on the scene and its run. The window handles files, pictures and itself.

use super::law_edit::remove_law;
use super::{AppState, Tool};
use crate::action::{Action, Happens};
use crate::numbers::{fixed, toml_number};
use crate::session::branches::BranchChange;
use crate::session::runner::RunRequest;
use crate::session::scene_draft::SceneDraft;
use scene::Role;
use vocabulary::math;
use vocabulary::{Relative, Word, wrap};

/// Candidate set points of a new follower: m, degrees.
const PLACES: [[f64; 2]; 8] = [
    [2.0, -135.0],
    [2.0, 135.0],
    [2.0, 180.0],
    [4.0, -135.0],
    [4.0, 135.0],
    [4.0, 180.0],
    [6.0, -135.0],
    [6.0, 135.0],
];
/// How far ahead of the shown time an event is set while the run plays, s of the clock on the wall.
const AHEAD: f64 = 0.3;
/// The law of a robot that gets a second leader by hand.
const TWO_LEADERS: &str = "two-distances";
/// Tolerance of a mirror image, m and rad.
const ALIKE: [f64; 2] = [0.05, 0.09];

/// Whether an action edits the scene.
fn changes_the_scene(action: &Action) -> bool {
    matches!(
        action,
        Action::Tune { .. }
            | Action::ChooseLaw(_)
            | Action::EditLaw(_)
            | Action::Set { .. }
            | Action::SetPoint { .. }
            | Action::Goal { .. }
            | Action::Shape { .. }
            | Action::Connect { .. }
            | Action::Happen { .. }
            | Action::AddRobot
            | Action::RemoveRobot(_)
            | Action::RenameRobot(..)
            | Action::AddProp(..)
            | Action::RemoveProp(_)
            | Action::Undo
            | Action::Redo
    )
}

impl AppState {
    /// Carries out an action that needs no files and no window; whether it was one.
    pub fn act(&mut self, action: &Action) -> bool {
        match action {
            Action::Toggle if self.playing => self.pause(),
            Action::Toggle => self.play(),
            Action::Step => self.step(),
            Action::Back(seconds) => self.seek(self.time() - seconds),
            Action::Pace(pace) => {
                self.pace = pace.clamp(0.1, 50.0);
                self.requests.push(RunRequest::Pace(self.pace));
            }
            Action::Seek(time) => self.seek(*time),
            Action::Present => self.cursor = None,
            Action::Branch(branch) => self.switch(*branch),
            Action::Fork => {
                self.leave_recording();
                self.rest();
                self.fork();
            }
            Action::NameBranch(branch, name) => {
                if let Some(face) = self.branches.get_mut(*branch) {
                    face.name.clone_from(name);
                }
            }
            Action::Select(selection) => self.selection = *selection,
            Action::ForAll(all) => self.for_all = *all,
            Action::Mirror(on) => self.mirror = *on,
            Action::FilmFrom(view) => self.film_from.clone_from(view),
            Action::UseTool(tool) => self.tool = if self.tool == *tool { Tool::Select } else { *tool },
            Action::Ahead(seconds) => {
                self.ahead = seconds.clamp(0.0, 60.0);
                self.requests.push(RunRequest::Ahead(self.ahead));
                if self.ahead == 0.0 {
                    self.prediction = None;
                }
            }
            Action::Restart => self.restart(0.0),
            Action::Share => self.share(),
            Action::PlanSweep(plan) => self.sweep.plan = Some(plan.clone()),
            Action::StartSweep(plan) => self.start_sweep(plan),
            Action::StopSweep => self.stop_sweep(),
            Action::Release => self.rest(),
            _ => return self.edit_scene(action),
        }
        true
    }

    /// Carries out an action that edits the scene; whether it was one.
    fn edit_scene(&mut self, action: &Action) -> bool {
        if changes_the_scene(action) {
            self.leave_recording();
        }
        match action {
            Action::Tune { what, key, value } => self.tune(what, key, value.as_deref()),
            Action::ChooseLaw(choice) => self.choose_law(choice),
            Action::EditLaw(text) => self.edit_law(text),
            Action::Set { what, values } => self.set(what, values),
            Action::SetPoint { edge, distance, bearing } => self.move_set_point(*edge, [*distance, *bearing]),
            Action::Goal { robot, number, place } => self.move_goal(*robot, *number, *place),
            Action::Shape { scale, turn } => self.reshape(*scale, *turn),
            Action::Connect { leader, follower, adds } => self.connect(*leader, *follower, *adds),
            Action::Happen { robot, what } => self.happen(*robot, *what),
            Action::AddRobot => self.add_robot(),
            Action::RemoveRobot(name) => self.remove_robot(name),
            Action::RenameRobot(old, new) => {
                let done = self.edit(&format!("{old} renamed to {new}"), |text| text.rename_robot(old, new));
                if done && self.chosen.as_ref() == Some(old) {
                    self.chosen = Some(new.clone());
                }
            }
            Action::AddProp(kind, place) => self.add_prop(kind, *place),
            Action::RemoveProp(name) => {
                self.edit(&format!("Removed {name}"), |text| text.remove_item("props", name));
            }
            Action::Undo => self.undo(),
            Action::Redo => self.redo(),
            _ => return false,
        }
        true
    }

    fn step(&mut self) {
        if self.recorded && self.cursor.is_none() {
            return;
        }
        if let Some(time) = self.cursor {
            self.seek(time + self.period());
        } else {
            self.playing = false;
            self.requests.push(RunRequest::Step);
        }
    }

    fn rest(&mut self) {
        if let Some(draft) = &mut self.draft {
            draft.rest();
        }
    }

    fn undo(&mut self) {
        if self.in_the_past() {
            return self.undo_past();
        }
        let step = self.draft.as_mut().and_then(SceneDraft::undo);
        if let Some((what, effect)) = step {
            self.take(&format!("Undo: {}", what.trim_end_matches('…')), &effect);
        }
    }

    fn redo(&mut self) {
        if self.in_the_past() {
            return self.note("Nothing was undone here: later changes stay on their branch");
        }
        let step = self.draft.as_mut().and_then(SceneDraft::redo);
        if let Some((what, effect)) = step {
            self.take(&format!("Redo: {}", what.trim_end_matches('…')), &effect);
        }
    }

    fn set(&mut self, what: &str, values: &[(String, String)]) {
        self.edit(what, |text| values.iter().try_for_each(|(path, value)| text.set(path, value)));
    }

    /// Sets a value of the selected follower or of all followers; `None` restores the default. Robots that lead have
    /// safety filters, too.
    fn tune(&mut self, what: &str, key: &str, value: Option<&str>) {
        let all = self.for_all;
        let safety = key.starts_with("safety.");
        let one = if safety {
            self.filtered_robot().map(|(_, robot)| robot.name.clone())
        } else {
            self.tuned_follower().map(|(_, _, name, _)| name.to_owned())
        };
        let (Some(name), Some(scene)) = (one, self.scene_now()) else { return };
        let tuned = scene.robots.iter().filter(|robot| safety || robot.role.follow().is_some());
        let tuned: Vec<String> = tuned.map(|robot| robot.name.clone()).collect();
        let shown = value.map_or_else(|| "its default".to_owned(), str::to_owned);
        let whose = if all { "all".to_owned() } else { name.clone() };
        let what = match what.strip_suffix('…') {
            Some(what) => format!("{what} of {whose}…"),
            None => format!("{what} of {whose}: {shown}"),
        };
        self.edit(&what, |text| {
            if all {
                // Values of single robots and groups would override the common value.
                for name in &tuned {
                    text.remove(&format!("robots.{name}.{key}"))?;
                }
                for group in 0..text.count("groups") {
                    text.remove(&format!("groups.{group}.{key}"))?;
                }
            }
            let path = if all { key.to_owned() } else { format!("robots.{name}.{key}") };
            match value {
                Some(value) => text.set(&path, value),
                None => text.remove(&path).map(drop),
            }
        });
    }

    /// Moves a set point, and its mirror image if that is enabled.
    fn move_set_point(&mut self, edge: usize, [distance, bearing]: [f64; 2]) {
        let Some([_, name_and]) = self.names_of(edge) else { return };
        let before = self.set_point(edge);
        let mut moves = vec![(edge, [distance, bearing])];
        if self.mirror
            && let Some(twin) = before.and_then(|before| self.twin(edge, before))
        {
            moves.push((twin, [distance, -bearing]));
        }
        self.put_set_points(&format!("Set point of {name_and}…"), &moves);
    }

    /// Puts a goal of a lead robot elsewhere; its heading stays.
    fn move_goal(&mut self, robot: usize, number: usize, [x, y]: [f64; 2]) {
        let Some(scene) = self.scene().cloned() else { return };
        let Some(member) = scene.robots.get(robot) else { return };
        let written = |goal: &scene::Goal, [x, y]: [f64; 2]| {
            let place = [x, y].map(toml_number).join(", ");
            goal.heading.map_or_else(
                || format!("[{place}]"),
                |heading| format!("[{place}, {}]", toml_number(heading)),
            )
        };
        let (key, value) = match &member.role {
            Role::Lead { path: scene::Path::Goal { pose, .. } } => ("pose", written(pose, [x, y])),
            Role::Lead { path: scene::Path::Tour { goals, .. } } => {
                let goals = goals.iter().enumerate();
                let all =
                    goals.map(|(k, goal)| written(goal, if k == number { [x, y] } else { goal.position }));
                ("goals", format!("[{}]", all.collect::<Vec<_>>().join(", ")))
            }
            _ => return,
        };
        self.set(
            &format!("Goal of {}…", member.name),
            &[(format!("robots.{}.path.{key}", member.name), value)],
        );
    }

    fn put_set_points(&mut self, what: &str, moves: &[(usize, [f64; 2])]) {
        let mut values = Vec::new();
        for (edge, [distance, bearing]) in moves {
            let Some([_, name]) = self.names_of(*edge) else { continue };
            let (Some((_, _, follow)), Some(leader)) = (self.follower(*edge), self.leader(*edge)) else {
                continue;
            };
            let several = follow.leaders.are_several();
            let of = if several { format!("leaders.{}.", leader.name) } else { String::new() };
            if leader.distance.is_some() {
                let value = toml_number(distance.clamp(follow.law.distance_min, 1000.0));
                values.push((format!("robots.{name}.{of}distance"), value));
            }
            if leader.bearing.is_some() {
                values.push((format!("robots.{name}.{of}bearing"), degrees(*bearing)));
            }
        }
        self.set(what, &values);
    }

    /// The edge on the other side of the same leader.
    pub(crate) fn twin(&self, edge: usize, [distance, bearing]: [f64; 2]) -> Option<usize> {
        let fleet = self.fleet()?;
        let record = self.record();
        let leader_of = |edge: usize| match &record {
            Some(record) => Some(record.edge(fleet, edge)?.leader),
            None => Some(fleet.edges.get(edge)?.leader),
        };
        let leader = leader_of(edge)?;
        (0..fleet.edges.len()).filter(|other| *other != edge && leader_of(*other) == Some(leader)).find(
            |other| {
                self.set_point(*other).is_some_and(|[d, b]| {
                    (d - distance).abs() < ALIKE[0] && wrap(b + bearing).abs() < ALIKE[1]
                })
            },
        )
    }

    fn reshape(&mut self, scale: f64, turn: f64) {
        let edges = self.fleet().map_or(0, |fleet| fleet.edges.len());
        let moved = |edge: usize| {
            let [distance, bearing] = self.set_point(edge)?;
            Some((edge, [distance * scale, wrap(bearing + turn)]))
        };
        let moves: Vec<_> = (0..edges).filter_map(moved).collect();
        self.put_set_points("Whole formation…", &moves);
    }

    /// Names of leader and follower of an edge.
    fn names_of(&self, edge: usize) -> Option<[String; 2]> {
        let fleet = self.fleet()?;
        let ends = fleet.edges.get(edge)?;
        Some([fleet.robots.get(ends.leader)?.name.clone(), fleet.robots.get(ends.follower)?.name.clone()])
    }

    /// Lets one robot follow another at its current distance and bearing; or, where it `adds` a leader to those that it has,
    /// at its current distances to all of them.
    fn connect(&mut self, leader: usize, follower: usize, adds: bool) {
        let Some(scene) = self.scene().cloned() else { return };
        let (Some(ahead), Some(behind)) = (scene.robots.get(leader), scene.robots.get(follower)) else {
            return;
        };
        if let Some(circle) = circle(&scene, leader, follower) {
            return self.fault(format!(
                "{} cannot follow {}: it would follow itself, {circle}",
                behind.name, ahead.name
            ));
        }
        let record = self.record();
        let pose = |robot: usize, start: vocabulary::Pose| {
            record.as_ref().and_then(|m| m.snapshot.robots.get(robot)).map_or(start, |r| r.motion.pose)
        };
        let now = Relative::between(pose(leader, ahead.pose), pose(follower, behind.pose));
        let looks_at = behind.role.follow().map_or(1, |follow| follow.law.leaders());
        let has = behind.role.follow().map(|follow| follow.leaders.clone()).filter(|_| adds);
        if let Some(has) = has.filter(|has| !has.include(&ahead.name)) {
            let away = |leader: &scene::Leader| {
                let robot = scene.index_of(&leader.name)?;
                let now =
                    Relative::between(pose(robot, scene.robots[robot].pose), pose(follower, behind.pose));
                Some((leader.name.clone(), now.distance))
            };
            let all = has.iter().filter_map(away).chain([(ahead.name.clone(), now.distance)]);
            let all: Vec<_> = all
                .map(|(name, distance)| {
                    let distance = toml_number((distance * 20.0).round() / 20.0);
                    format!("{{ name = {name:?}, distance = {distance} }}")
                })
                .collect();
            let (name, ahead) = (behind.name.clone(), ahead.name.clone());
            self.edit(&format!("{name} follows {ahead}, too"), |text| {
                for key in ["leader", "distance", "bearing", "leaders"] {
                    text.remove(&format!("robots.{name}.{key}"))?;
                }
                text.set(&format!("robots.{name}.leaders"), &format!("[{}]", all.join(", ")))?;
                // A law for two comes with the program.
                if all.len() == 2 && looks_at != 2 {
                    text.set(&format!("robots.{name}.law.file"), TWO_LEADERS)?;
                }
                Ok(())
            });
            return;
        }
        let (name, ahead) = (behind.name.clone(), ahead.name.clone());
        let leads = matches!(behind.role, Role::Lead { .. });
        self.edit(&format!("{name} follows {ahead}"), |text| {
            if leads {
                text.remove(&format!("robots.{name}.path"))?;
            }
            text.remove(&format!("robots.{name}.leaders"))?;
            if looks_at != 1 {
                remove_law(text, &format!("robots.{name}."))?;
            }
            for (key, value) in [
                ("leader", format!("{ahead:?}")),
                ("distance", toml_number((now.distance * 20.0).round() / 20.0)),
                ("bearing", degrees(now.bearing)),
            ] {
                text.set(&format!("robots.{name}.{key}"), &value)?;
            }
            Ok(())
        });
    }

    /// Lets something happen to a robot at the next sample, or, while the run plays, a moment later.
    fn happen(&mut self, robot: usize, what: Happens) {
        let Some(fleet) = self.fleet().cloned() else { return };
        let name = |robot: usize| fleet.robots.get(robot).map(|robot| robot.name.clone());
        let Some(own) = name(robot) else { return };
        let speed = self.record().and_then(|record| Some(record.snapshot.robots.get(robot)?.motion.speed));
        let lines = match what {
            Happens::Follows(leader) => {
                let Some(leader) = name(leader) else { return };
                format!("robot = {own:?}\nleader = {leader:?}\n")
            }
            Happens::Leads => {
                let speed = toml_number((speed.unwrap_or(0.0) * 1000.0).round() / 1000.0);
                format!("robot = {own:?}\npath = {{ kind = \"constant\", speed = {speed} }}\n")
            }
            Happens::Fails(failure) => format!("robot = {own:?}\nfails = {:?}\n", failure.word()),
            Happens::Assigns => format!("assign = {own:?}\n"),
        };
        // While it plays, the run is a little ahead of the window.
        let ahead = if self.playing && self.cursor.is_none() { AHEAD * self.pace } else { 0.0 };
        let period = self.period();
        let at = ((self.time() + ahead) / period).floor() + 1.0;
        let words = match what {
            Happens::Follows(leader) => format!("{own} shall follow {}", name(leader).unwrap_or_default()),
            Happens::Leads => format!("{own} shall drive on its own"),
            Happens::Fails(_) => format!("{own} shall fail"),
            Happens::Assigns => format!("Those behind {own} shall take their places anew"),
        };
        let lines = format!("at = {}\n{lines}", toml_number(at * period));
        self.edit(&words, |text| text.add_table("events", &lines));
    }

    fn add_robot(&mut self) {
        let Some(scene) = self.scene().cloned() else { return };
        let chosen = self.chosen_robot().filter(|robot| *robot < scene.robots.len()).unwrap_or(0);
        let Some(leader) = scene.robots.get(chosen) else { return };
        let name = (1..=scene.robots.len() + 1)
            .map(|n| format!("follower-{n}"))
            .find(|name| scene.index_of(name).is_none());
        let free = |place: &&[f64; 2]| {
            let [x, y] = seen_from(leader.pose, **place);
            let near = |robot: &scene::Robot| math::hypot(robot.pose.x - x, robot.pose.y - y) < 1.0;
            !scene.robots.iter().any(near)
        };
        let place = PLACES.iter().find(free).copied().unwrap_or([8.0, 180.0]);
        let [x, y] = seen_from(leader.pose, place);
        let speed = leader.vehicle.speed_max.min(0.5).max(leader.vehicle.speed_min);
        let Some(name) = name else { return };
        let lines = format!(
            "name = {name:?}\npose = [{}, {}, \"{} deg\"]\nspeed = {}\nleader = {:?}\ndistance = {}\nbearing = \"{} deg\"\n",
            toml_number(x),
            toml_number(y),
            toml_number(leader.pose.heading.to_degrees()),
            toml_number(speed),
            leader.name,
            toml_number(place[0]),
            toml_number(place[1]),
        );
        if self.edit(&format!("{name} follows {}", leader.name), |text| text.add_robot(&lines)) {
            self.chosen = Some(name);
        }
    }

    fn remove_robot(&mut self, name: &str) {
        let Some(scene) = self.scene().cloned() else { return };
        let follows =
            |robot: &&scene::Robot| matches!(&robot.role, Role::Follow(f) if f.leaders.include(name));
        let left: Vec<&str> = scene.robots.iter().filter(follows).map(|robot| &*robot.name).collect();
        if !left.is_empty() {
            let (them, verb) = (left.join(", "), if left.len() == 1 { "follows" } else { "follow" });
            return self
                .fault(format!("{name} stays: {them} {verb} it. Connect {them} to another robot first."));
        }
        self.edit(&format!("Removed {name}"), |text| text.remove_item("robots", name));
    }

    fn add_prop(&mut self, kind: &str, [x, y]: [f64; 2]) {
        let Some(scene) = self.scene().cloned() else { return };
        let taken = |name: &String| scene.props.iter().any(|prop| prop.name == *name);
        let name = (1..=scene.props.len() + 1).map(|n| format!("{kind}-{n}")).find(|name| !taken(name));
        let name = name.unwrap_or_default();
        let lines = format!(
            "name = {name:?}\nshape = \"cylinder\"\nradius = 0.15\nheight = 0.6\npose = [{}, {}, 0.0]\n",
            toml_number(x),
            toml_number(y)
        );
        let what = format!("{name} at {}, {} m", fixed(x, 1), fixed(y, 1));
        self.edit(&what, |text| text.add_table("props", &lines));
    }
}

/// A short description of a change: equal values of several robots are listed once.
pub fn words(change: &BranchChange) -> String {
    let mut said: Vec<(String, Vec<&str>)> = Vec::new();
    for set in &change.set {
        let (robot, what) =
            set.strip_prefix("robots.").and_then(|rest| rest.split_once('.')).unwrap_or(("", set));
        let what = what.split_once('=').map_or_else(|| what.to_owned(), |(key, value)| said_of(key, value));
        match said.iter_mut().find(|(known, _)| *known == what) {
            Some((_, robots)) => robots.push(robot),
            None => said.push((what, vec![robot])),
        }
    }
    let events = change.events.iter().map(scene::Event::words);
    let one = |(what, robots): (String, Vec<&str>)| match robots.as_slice() {
        [robot] => format!("{robot} {what}"),
        many => format!("{what} of {} robots", many.len()),
    };
    said.into_iter().map(one).chain(events).collect::<Vec<_>>().join(", ")
}

/// A value for people: angles in degrees, numbers short.
fn said_of(key: &str, value: &str) -> String {
    match value.parse::<f64>() {
        Ok(angle) if key == "bearing" => format!("bearing = {}°", fixed(angle.to_degrees(), 1)),
        Ok(number) => format!("{key} = {}", crate::numbers::plain(number)),
        Err(_) => format!("{key} = {value}"),
    }
}

/// An angle as scenes write it.
fn degrees(angle: f64) -> String {
    let degrees = (angle.to_degrees() * 1000.0).round() / 1000.0;
    // −180 is written 180.
    let degrees = if degrees <= -180.0 { degrees + 360.0 } else { degrees };
    format!("\"{} deg\"", crate::numbers::plain(degrees))
}

/// A place at a distance (m) and bearing (degrees) of a pose, m.
fn seen_from(pose: vocabulary::Pose, [distance, bearing]: [f64; 2]) -> [f64; 2] {
    pose.polar(distance, bearing.to_radians())
}

/// Names on the cycle that would arise if `follower` followed `leader`.
fn circle(scene: &scene::Scene, leader: usize, follower: usize) -> Option<String> {
    // From leader to leader; each robot with the one from which it was reached.
    let mut from: Vec<Option<usize>> = vec![None; scene.robots.len()];
    let mut open = vec![leader];
    while let Some(at) = open.pop() {
        if at == follower {
            let back = |robot: &usize| (*robot != leader).then(|| from[*robot]).flatten();
            let mut names: Vec<_> = std::iter::successors(Some(at), back).collect();
            names.push(follower);
            names.reverse();
            let name = |robot: usize| scene.robots.get(robot).map_or("", |robot| &robot.name);
            return Some(names.into_iter().map(name).collect::<Vec<_>>().join(" → "));
        }
        let follow = scene.robots.get(at)?.role.follow();
        for next in follow.into_iter().flat_map(|follow| follow.leaders.iter()) {
            let next = scene.index_of(&next.name)?;
            if next != leader && from[next].is_none() {
                from[next] = Some(at);
                open.push(next);
            }
        }
    }
    None
}

//! From the keys of a robot to a checked robot.

use crate::{
    Follow, Law, Narrowing, Observer, Path, Proximity, Robot, Role, Safety, Sensing, Vehicle, VehicleKind,
    document::RobotKeys,
    graph::Named,
    law_file::faults,
    leaders::{check_several, leaders, named},
    text::{Found, Keys, Node, Part, Reporter, Span},
    types::{
        LawPart, NarrowingPart, ObserverPart, ProximityPart, SafetyPart, SensingPart, VehiclePart, WrittenLaw,
    },
    vehicle::{WrittenVehicle, kind_is_lost, vehicle},
};
use vocabulary::{HeadingReference, Pose, math};

/// What holds for every robot that says nothing else.
pub(crate) struct Defaults {
    pub(crate) vehicle: VehiclePart,
    pub(crate) law: LawPart,
    pub(crate) observer: ObserverPart,
    pub(crate) sensing: SensingPart,
    pub(crate) narrowing: NarrowingPart,
    pub(crate) safety: SafetyPart,
    pub(crate) proximity: ProximityPart,
    /// Step of the physics, s.
    pub(crate) step: f64,
    /// Where that is said.
    pub(crate) step_span: Option<Span>,
}

impl Defaults {
    /// The vehicle of a robot or group that says `own` of it and stands at `span`.
    pub(crate) fn vehicle(
        &self,
        own: Option<&Found<VehiclePart>>,
        span: Span,
        reporter: &mut Reporter,
    ) -> Vehicle {
        let nothing = VehiclePart::default();
        let own = own.map_or(&nothing, |found| &found.value);
        let span = self.step_span.unwrap_or(span);
        vehicle(&WrittenVehicle { own, scene: &self.vehicle, step: self.step, span }, reporter)
    }

    /// The law of a robot or group on a vehicle of `kind` that says `own` of it and stands at `span`.
    pub(crate) fn law(&self, own: &LawPart, kind: VehicleKind, span: Span, reporter: &mut Reporter) -> Law {
        let law = self.chosen(own, own.complete_with(&self.law, Law::fitting(kind)));
        let mut report = |keys: &[&str], message: String| {
            let find = |key: &&str| own.span_of(key).or_else(|| self.law.span_of(key));
            reporter.report(keys.iter().find_map(find).unwrap_or(span), message);
        };
        for part in [own, &self.law] {
            let choices = [
                ("file", part.file.is_some()),
                ("text", part.text.is_some()),
                ("module", part.module.is_some()),
            ];
            let written: Vec<&str> = choices.iter().filter(|(_, is)| *is).map(|(key, _)| *key).collect();
            if written.len() > 1 {
                report(&written[1..], format!("give one of `{}`: each is a law", written.join("`, `")));
            }
        }
        match law.custom() {
            Some(custom) => faults(&law.parameters, custom).into_iter().for_each(|fault| report(&["parameters"], fault)),
            None if law.parameters.is_empty() => {}
            None => report(
                &["parameters"],
                "`parameters` are those of a custom law, which `file`, `text` or `module` names; the gains of a built-in law are \
                 keys of their own, such as `k`"
                    .to_owned(),
            ),
        }
        let Law { heading, heading_length, heading_lag, standing, .. } = law;
        if heading == HeadingReference::Path && heading_lag > 2.0 * heading_length {
            let message = format!(
                "`heading_lag` of {heading_lag} m must be at most twice `heading_length`, {} m",
                2.0 * heading_length
            );
            report(&["heading_lag", "heading_length"], message);
        }
        if standing && heading != HeadingReference::Path {
            let message = "`standing` needs `heading = \"path\"`: a bearing from the leader's own heading swings when it \
                           turns at a stop";
            report(&["standing", "heading"], message.to_owned());
        }
        law
    }

    /// A law as it was completed, where `own` and the scene choose different ones: what is said nearer to the robot counts,
    /// and so do parameters, which belong to a choice.
    fn chosen(&self, own: &LawPart, mut law: Law) -> Law {
        let said = |part: &LawPart| {
            part.kind.is_some() || part.file.is_some() || part.text.is_some() || part.module.is_some()
        };
        let nearest = if said(own) { own } else { &self.law };
        let custom =
            |found: &Option<Found<Option<WrittenLaw>>>| found.as_ref().and_then(|found| found.value.clone());
        law.module = custom(&nearest.module);
        law.text = custom(&nearest.text).filter(|_| law.module.is_none());
        law.file = custom(&nearest.file).filter(|_| law.module.is_none() && law.text.is_none());
        let values =
            |part: &LawPart| part.parameters.as_ref().map(|found| found.value.clone()).unwrap_or_default();
        law.parameters = if said(own) { values(own) } else { values(&self.law) };
        law.parameters.extend(values(own));
        law
    }

    /// The observer of a robot or group that says `own` of it.
    pub(crate) fn observer(&self, own: &ObserverPart, vehicle: &Vehicle) -> Observer {
        let observer = own.complete_with(&self.observer, Observer::fitting(vehicle.kind));
        let written = own.epsilon.is_some() || self.observer.epsilon.is_some();
        let said = own.adaptive.as_ref().or(self.observer.adaptive.as_ref());
        Observer { adaptive: said.map_or(!written, |found| found.value), ..observer }
    }

    /// The sensing of a robot or group that says `own` of it.
    pub(crate) fn sensing(&self, own: &SensingPart) -> Sensing {
        own.complete_with(&self.sensing, Sensing::default())
    }

    /// How a robot or group that says `own` of it files in.
    pub(crate) fn narrowing(&self, own: &NarrowingPart) -> Narrowing {
        own.complete_with(&self.narrowing, Narrowing::default())
    }

    /// The safety filter of a robot or group that says `own` of it.
    pub(crate) fn safety(&self, own: &SafetyPart) -> Safety {
        own.complete_with(&self.safety, Safety::default())
    }

    /// The proximity sensor of a robot or group that says `own` of it.
    pub(crate) fn proximity(&self, own: &ProximityPart) -> Proximity {
        own.complete_with(&self.proximity, Proximity::default())
    }
}

/// A robot as far as it could be made out, and where it came from.
pub(crate) struct RobotDraft {
    pub(crate) named: Named,
    /// Where its pose is written, or its name where it has none of its own.
    pub(crate) start: Option<Span>,
    /// The number it is given in the file.
    pub(crate) number: Option<Found<usize>>,
    /// `None` after reporting an error.
    pub(crate) robot: Option<Robot>,
}

/// The robot of one table.
pub(crate) fn draft(
    keys: &RobotKeys,
    node: &Node,
    defaults: &Defaults,
    reporter: &mut Reporter,
) -> RobotDraft {
    let named = Named { name: keys.name.clone(), leaders: named(keys) };
    let start = keys.pose.as_ref().map(|pose| pose.span).or(keys.name.as_ref().map(|name| name.span));
    RobotDraft { named, start, number: keys.number.clone(), robot: robot(keys, node, defaults, reporter) }
}

fn robot(keys: &RobotKeys, node: &Node, defaults: &Defaults, reporter: &mut Reporter) -> Option<Robot> {
    if kind_is_lost(node.get("vehicle"), keys.vehicle.as_ref()) {
        return None;
    }
    let vehicle = defaults.vehicle(keys.vehicle.as_ref(), node.span, reporter);
    let role = role(keys, node, &vehicle, defaults, reporter);
    let path = keys.path.as_ref().map(|path| &path.value);
    let pose = match (node.get("pose"), &keys.pose) {
        // The key is there; its error is reported already.
        (Some(_), None) => None,
        (_, pose) => start_pose(pose.as_ref(), path, node.span, reporter),
    };
    let safety = keys.safety.clone().map_or_else(SafetyPart::default, |found| found.value);
    let proximity = keys.proximity.clone().map_or_else(ProximityPart::default, |found| found.value);
    Some(Robot {
        name: keys.name.as_ref()?.value.clone(),
        pose: pose?,
        number: 0,
        vehicle,
        safety: defaults.safety(&safety),
        proximity: defaults.proximity(&proximity),
        role: role?,
    })
}

fn role(
    keys: &RobotKeys,
    node: &Node,
    vehicle: &Vehicle,
    defaults: &Defaults,
    reporter: &mut Reporter,
) -> Option<Role> {
    let name = keys.name.as_ref()?;
    match (node.get("path"), node.get("leader").or(node.get("leaders"))) {
        (Some(_), None) => lead(keys, node, vehicle, reporter),
        (None, Some(_)) => {
            follow(keys, node, vehicle, defaults, reporter).map(|follow| Role::Follow(Box::new(follow)))
        }
        (Some(_), Some(leader)) => {
            let message = format!("`{}` has a `path` and a `leader`; a robot leads or follows", name.value);
            reporter.report(leader.span, message);
            None
        }
        (None, None) => {
            let message = format!(
                "robot `{}` is not connected: it needs a `path` to lead, or a `leader` to follow",
                name.value
            );
            reporter.report(name.span, message);
            None
        }
    }
}

fn lead(keys: &RobotKeys, node: &Node, vehicle: &Vehicle, reporter: &mut Reporter) -> Option<Role> {
    let name = &keys.name.as_ref()?.value;
    for entry in ["distance", "bearing", "speed", "law", "observer", "sensing", "narrowing"]
        .into_iter()
        .filter_map(|key| node.entry(key))
    {
        reporter.report(entry.span, format!("`{}` is for robots that follow, but `{name}` leads", entry.key));
    }
    let path = keys.path.as_ref()?;
    check_path(path, vehicle, reporter);
    Some(Role::Lead { path: path.value.clone() })
}

fn follow(
    keys: &RobotKeys,
    node: &Node,
    vehicle: &Vehicle,
    defaults: &Defaults,
    reporter: &mut Reporter,
) -> Option<Follow> {
    let law = keys.law.clone().map_or_else(LawPart::default, |found| found.value);
    let law = defaults.law(&law, vehicle.kind, node.span, reporter);
    let observer = keys.observer.clone().map_or_else(ObserverPart::default, |found| found.value);
    let sensing = keys.sensing.clone().map_or_else(SensingPart::default, |found| found.value);
    let narrowing = keys.narrowing.clone().map_or_else(NarrowingPart::default, |found| found.value);
    let speed = start_speed(keys.speed.as_ref(), vehicle, law.standing, reporter);
    let follow = Follow {
        leaders: leaders(keys, node, &law, reporter)?,
        speed,
        law,
        observer: defaults.observer(&observer, vehicle),
        sensing: defaults.sensing(&sensing),
        narrowing: defaults.narrowing(&narrowing),
    };
    if let (Some(name), Some(list)) = (&keys.name, &keys.leaders) {
        let safety = keys.safety.clone().map_or_else(SafetyPart::default, |found| found.value);
        check_several(&name.value, &follow, &defaults.safety(&safety), list.span, reporter);
    }
    Some(follow)
}

/// A follower's speed at the start, m/s; one that `stands` with its leader may start at rest.
pub(crate) fn start_speed(
    speed: Option<&Found<f64>>,
    vehicle: &Vehicle,
    stands: bool,
    reporter: &mut Reporter,
) -> f64 {
    let Some(speed) = speed else { return vehicle.speed_min };
    let Vehicle { speed_min, speed_max, .. } = *vehicle;
    let speed_min = if stands { 0.0 } else { speed_min };
    if !(speed_min..=speed_max).contains(&speed.value) {
        let message = format!(
            "`speed` of {} m/s is outside the vehicle's limits, {speed_min} to {speed_max} m/s",
            speed.value
        );
        reporter.report(speed.span, message);
    }
    speed.value
}

/// Reports a wanted distance (m) that falls below the least one the law divides by.
pub(crate) fn check_distance(least: f64, distance_min: f64, span: Span, reporter: &mut Reporter) {
    if least < distance_min {
        let message =
            format!("`distance` falls to {least} m, below the law's `distance_min` of {distance_min} m");
        reporter.report(span, message);
    }
}

/// Reports a path that its robot cannot drive.
pub(crate) fn check_path(path: &Found<Path>, vehicle: &Vehicle, reporter: &mut Reporter) {
    let (speed, turn_rate) = path.value.peaks();
    if speed > vehicle.speed_max {
        let message = format!(
            "`path` reaches {speed} m/s, above the vehicle's `speed_max` of {} m/s",
            vehicle.speed_max
        );
        reporter.report(path.span, message);
    }
    if let Some(turn_rate) = turn_rate.filter(|rate| *rate > vehicle.turn_rate_max) {
        let most = vehicle.turn_rate_max;
        reporter.report(
            path.span,
            format!("`path` turns at {turn_rate} rad/s, above `turn_rate_max` of {most} rad/s"),
        );
    }
    if let Path::Constant { speed, turn_rate } | Path::Circle { speed, turn_rate } = path.value {
        let curvature = vehicle.limits().curvature_max;
        if speed > 0.0 && turn_rate.abs() > speed * curvature {
            let message = format!(
                "`path` turns tighter than the vehicle can: {turn_rate} rad/s at {speed} m/s is a circle of {:.3} m, and \
                 `steering_max` allows {:.3} m",
                speed / turn_rate.abs(),
                1.0 / curvature
            );
            reporter.report(path.span, message);
        }
    }
}

/// Where a robot starts: its `pose`, or the start of its path; reports an error if they contradict each other or are missing.
pub(crate) fn start_pose(
    pose: Option<&Found<[f64; 3]>>,
    path: Option<&Path>,
    span: Span,
    reporter: &mut Reporter,
) -> Option<Pose> {
    let start = path.and_then(Path::start);
    let Some(pose) = pose else {
        if start.is_none() {
            reporter.report(span, "`pose` is missing: write [x, y, heading]");
        }
        return start;
    };
    let [x, y, heading] = pose.value;
    if let Some(start) = start.filter(|start| math::hypot(x - start.x, y - start.y) > 1e-6) {
        let message =
            format!("`pose` must start at the first of the path's points, [{}, {}]", start.x, start.y);
        reporter.report(pose.span, message);
    }
    Some(Pose::new(x, y, heading))
}

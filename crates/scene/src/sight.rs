//! What followers can and cannot see: shells, cameras and the measurements that are possible.

use crate::{
    Follow, Robot, Role, Sensing, Vision,
    robots::RobotDraft,
    text::{Keys, Reporter, Span, words::quoted},
    types::{SensingKind as Kind, TimePart, VisionPart},
};
use std::collections::HashMap;
use std::f64::consts::PI;
use vocabulary::{
    CameraModel, CameraMount, FACES, Pose, ScalarTrajectory, Shell, TAGS, TimeMode, Word, math, wrap,
};

/// Robots whose shells the tag family can tell apart.
const MOST_SHELLS: usize = TAGS / FACES;
/// A tag is read up to this angle from its normal, rad.
const STEEPEST: f64 = 65.0 / 180.0 * PI;
/// Pixels that a cell needs at least.
const LEAST_CELL: f64 = 1.75;

impl Vision {
    /// The shell of a robot, its tags those of `number`; blank where the family has none.
    pub fn shell(&self, robot: &Robot) -> Shell {
        let fitting = Shell::fitting(&robot.vehicle.body());
        let shell = fitting.scaled(self.shell_scale).tagged(robot.number);
        Shell { cell: self.tag_cell.unwrap_or(shell.cell), ..shell }
    }

    /// Where the camera of a robot sits.
    pub fn camera_mount(&self, robot: &Robot) -> CameraMount {
        let (usual, shell) = (CameraMount::fitting(&robot.vehicle.body()), self.shell(robot));
        // As far above a shell of another size as above the usual one.
        let above = usual.height + (self.shell_scale - 1.0) * (usual.height - shell.height);
        CameraMount {
            forward: self.camera_forward.unwrap_or(usual.forward),
            height: self.camera_height.unwrap_or(above),
        }
    }

    /// What every camera sees.
    pub fn camera_model(&self) -> CameraModel {
        let [width, height] = self.resolution;
        let distortion = [self.k1, self.k2, self.p1, self.p2, self.k3];
        CameraModel { distortion, ..CameraModel::pinhole(width, height, self.field_of_view) }
    }
}

/// Numbers for the robots that name none: the lowest that are free.
pub(crate) fn number(drafts: &mut [RobotDraft], reporter: &mut Reporter) {
    let mut taken: HashMap<usize, String> = HashMap::new();
    for draft in drafts.iter() {
        let (Some(number), Some(name)) = (&draft.number, &draft.named.name) else { continue };
        if let Some(other) = taken.insert(number.value, name.value.clone()) {
            let first = FACES * number.value;
            let message = format!(
                "`number` {} is that of `{other}` already: tags {first} to {} would be on two shells",
                number.value,
                first + FACES - 1
            );
            reporter.report(number.span, message);
        }
    }
    let mut free = (0..).filter(|number| !taken.contains_key(number));
    for draft in drafts.iter_mut() {
        let number = draft.number.as_ref().map(|found| found.value).or_else(|| free.next());
        if let (Some(robot), Some(number)) = (&mut draft.robot, number) {
            robot.number = number;
        }
    }
}

/// Where things are said that sight depends on.
pub(crate) struct Said<'a> {
    pub(crate) time: &'a TimePart,
    pub(crate) part: &'a VisionPart,
    pub(crate) vision: &'a Vision,
}

/// Reports measurements that cannot be.
pub(crate) fn check_sight(said: &Said<'_>, drafts: &[RobotDraft], reporter: &mut Reporter) {
    let robots: HashMap<&str, &Robot> = drafts
        .iter()
        .filter_map(|draft| draft.robot.as_ref())
        .map(|robot| (robot.name.as_str(), robot))
        .collect();
    let mut inside = false;
    for draft in drafts {
        let (Some(robot), Some(name)) = (&draft.robot, &draft.named.name) else { continue };
        let Role::Follow(follow) = &robot.role else { continue };
        let kind = follow.sensing.kind;
        if kind == Kind::Truth {
            continue;
        }
        check_law(said, follow, robot, name.span, reporter);
        check_hold(follow, robot, name.span, reporter);
        let leader = robots.get(follow.leaders.first.name.as_str()).copied();
        if let Some(leader) = leader.filter(|_| kind.needs_tags()) {
            if !inside {
                inside = check_shell(said, robot, name.span, reporter);
            }
            check_visible(said, follow, [leader, robot], name.span, reporter);
        }
    }
}

fn check_law(said: &Said<'_>, follow: &Follow, robot: &Robot, span: Span, reporter: &mut Reporter) {
    let word = follow.sensing.kind.word();
    if !follow.law.observes() {
        let message = match follow.law.custom() {
            Some(law) => format!(
                "`{}` uses {}, which knows more than measurements tell; with sensing `{word}` its text must not say \
                 `knows`",
                robot.name,
                law.name()
            ),
            None => format!(
                "`{}` uses the `{}` law, which needs more than measurements tell; with sensing `{word}` its law must be \
                 `output-feedback`",
                robot.name,
                follow.law.kind.word()
            ),
        };
        reporter.report(span, message);
    }
    if let Some(mode) = said.time.mode.as_ref().filter(|mode| mode.value == TimeMode::Continuous) {
        let words = quoted([TimeMode::Sampled, TimeMode::Measured].into_iter().map(Word::word));
        let message = format!(
            "mode `continuous` has no measurements, but `{}` senses by `{word}`; use one of {words}",
            robot.name
        );
        reporter.report(mode.span, message);
    }
}

/// Reports measurements that come so late or so seldom that a leader is lost between any two of them.
fn check_hold(follow: &Follow, robot: &Robot, span: Span, reporter: &mut Reporter) {
    let Sensing { rate, latency, hold, .. } = follow.sensing;
    if latency + 1.0 / rate >= hold {
        let message = format!(
            "`{}` would lose its leader between any two measurements: they are up to {:.3} s old (`latency` and 1/`rate`), and `hold` is \
             {hold} s; it must be longer",
            robot.name,
            latency + 1.0 / rate
        );
        reporter.report(span, message);
    }
}

/// Reports cameras and tags that do not fit the robot's shell; whether it did.
fn check_shell(said: &Said<'_>, robot: &Robot, span: Span, reporter: &mut Reporter) -> bool {
    let (shell, camera_mount) = (said.vision.shell(robot), said.vision.camera_mount(robot));
    let span = |keys: &[&str]| keys.iter().find_map(|key| said.part.span_of(key)).unwrap_or(span);
    let up = camera_mount.height - shell.height;
    let half = 0.5 * shell.face_height;
    let within = shell.apothem - up * math::tan(shell.lean);
    if up.abs() < half && (camera_mount.forward - shell.forward).abs() < within {
        let message = format!(
            "the camera of `{}` is inside its own shell: at {:.3} m over the ground, and the shell reaches from {:.3} m to \
             {:.3} m; set `camera_height` above that, or `camera_forward` beyond {:.3} m",
            robot.name,
            camera_mount.height,
            shell.height - half,
            shell.height + half,
            shell.forward + within
        );
        reporter.report(span(&["camera_height", "camera_forward", "shell_scale"]), message);
        return true;
    }
    let slope = shell.face_height / math::cos(shell.lean);
    let side = 2.0 * shell.half_tag();
    if side > slope || shell.half_tag() > shell.half_width(shell.half_tag()) {
        let message = format!(
            "tags of `tag_cell` {} m are squares of {side:.3} m, too large for faces of {:.3} m by {slope:.3} m",
            shell.cell,
            2.0 * shell.half_width(0.0)
        );
        reporter.report(span(&["tag_cell", "shell_scale"]), message);
        return true;
    }
    false
}

/// Reports a leader that shows its follower no tag at its set point.
fn check_visible(
    said: &Said<'_>,
    follow: &Follow,
    [leader, robot]: [&Robot; 2],
    span: Span,
    reporter: &mut Reporter,
) {
    if leader.number >= MOST_SHELLS {
        let message = format!(
            "`{}` follows `{}` by its tags, but that is number {} and there are tags for {MOST_SHELLS} robots only",
            robot.name, leader.name, leader.number
        );
        reporter.report(span, message);
        return;
    }
    let (Some(ScalarTrajectory::Constant(distance)), Some(ScalarTrajectory::Constant(bearing))) =
        (&follow.leaders.first.distance, &follow.leaders.first.bearing)
    else {
        return;
    };
    let (shell, camera_mount, camera_model) =
        (said.vision.shell(leader), said.vision.camera_mount(robot), said.vision.camera_model());
    let (sin, cos) = math::sin_cos(*bearing);
    let [x, y] = Pose::new(distance * cos, distance * sin, 0.0).world_from_body(camera_mount.forward, 0.0);
    let eye = [x, y, camera_mount.height];
    let faces = (0..FACES).filter_map(|face| {
        let frame = shell.body_from_face(face);
        let [right, up, out] = frame.inverse().apply(eye);
        let away = (right * right + up * up + out * out).sqrt();
        let slant = out / away;
        (slant > math::cos(STEEPEST)).then_some(camera_model.focal * shell.cell * slant.sqrt() / away)
    });
    // Side by side and equally headed, as a formation is that has settled.
    let pan = wrap(bearing - PI).abs() - 0.5 * said.vision.field_of_view;
    if pan > said.vision.pan_max {
        let message = format!(
            "`{}` can never see its leader: at a bearing of {:.0} deg it is {:.0} deg off straight ahead, and the camera turns by \
             `pan_max` of {:.0} deg",
            robot.name,
            bearing.to_degrees(),
            wrap(bearing - PI).abs().to_degrees(),
            said.vision.pan_max.to_degrees()
        );
        reporter.report(span, message);
        return;
    }
    let largest = faces.fold(None, |most: Option<f64>, size| Some(most.map_or(size, |most| most.max(size))));
    let degrees = bearing.to_degrees();
    let message = match largest {
        None => format!(
            "`{}` can never see its leader: at a bearing of {degrees:.0} deg the shell of `{}` shows no tag within 65 deg of \
             its normal; keep |bearing| above 30 deg, and the camera away from the shell",
            robot.name, leader.name
        ),
        Some(pixels) if pixels < LEAST_CELL => format!(
            "`{}` can never see its leader: at {distance} m and {degrees:.0} deg a cell of a tag covers {pixels:.2} pixels, and \
             reading one takes {LEAST_CELL}; come nearer, or give more `resolution` or a larger `shell_scale`",
            robot.name
        ),
        Some(pixels) if 8.0 * pixels > f64::from(camera_model.width.min(camera_model.height)) => format!(
            "`{}` can never see its leader: at {distance} m a tag covers {:.0} pixels, more than the picture has; go farther away, or \
             give a wider `field_of_view`",
            robot.name,
            8.0 * pixels
        ),
        Some(_) => return,
    };
    reporter.report(span, message);
}

//! The keys of a scene that one may want to sweep, with what they are at present.

use crate::app_state::sweep_plan::SweepSide;
use crate::numbers::plain;
use crate::panels::controls::{Range, SliderRow};
use crate::panels::{law, safety, sensing, world};
use crate::symbols::{self, Symbol};
use scene::{Follow, Path, Robot, Role, Scene, SceneText, SensingKind, SwitchingKind};
use vocabulary::{HeadingReference, LawKind, ScalarTrajectory};

/// A key of the scene.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SweepKey {
    /// Its path.
    pub(crate) key: String,
    /// Its name and symbol.
    pub(crate) name: String,
    /// Its unit; empty for pure numbers.
    pub(crate) unit: String,
    /// The range that a sweep has at first.
    usual: [f64; 2],
    logarithmic: bool,
}

/// The keys of a scene, and all its values.
pub(crate) struct SweepKeys {
    /// What can be chosen.
    pub(crate) keys: Vec<SweepKey>,
    values: SceneText,
    written: SceneText,
    /// Those of followers stand for those of all robots.
    robots: Vec<String>,
}

/// Number of values of a key at first.
const COUNT: u32 = 9;
/// Keys that every follower has, and when they matter.
type Row = (SliderRow, fn(&Robot, &Follow) -> bool);
const ROWS: [Row; 21] = [
    (law::GAIN, |_, f| f.law.built_in().is_some()),
    (law::ROBUST, |_, f| robust(f)),
    (law::SLOPE, |_, f| robust(f) && f.law.switching == SwitchingKind::Tanh),
    // Whoever gives it ends its adaptation, in a sweep as in a scene.
    (law::EPSILON, |_, f| estimates(f)),
    (law::ALPHA_ONE, |_, f| estimates(f)),
    (law::ALPHA_TWO, |_, f| estimates(f)),
    (law::HEADING_LENGTH, |_, f| f.law.heading == HeadingReference::Path),
    (law::HEADING_LAG, |_, f| f.law.heading == HeadingReference::Path),
    (sensing::RATE, |_, f| measures(f)),
    (sensing::LATENCY, |_, f| measures(f)),
    (sensing::DROPS, |_, f| measures(f)),
    (sensing::DISTANCE_NOISE, |_, f| f.sensing.kind == SensingKind::Noise),
    (BEARING_NOISE, |_, f| f.sensing.kind == SensingKind::Noise),
    (sensing::PIXEL_NOISE, |_, f| f.sensing.kind == SensingKind::Geometric),
    (world::SPEED_MAX, |_, _| true),
    (world::TURN_MAX, |_, _| true),
    (world::ACCELERATION_MAX, |r, _| r.vehicle.acceleration_max.is_finite()),
    (safety::MARGIN, |r, _| r.safety.filter),
    (safety::POINT_AHEAD, |r, _| r.safety.filter),
    (safety::GAIN, |r, _| r.safety.filter),
    (safety::HORIZON, |r, _| r.safety.filter),
];
const BEARING_NOISE: SliderRow =
    SliderRow::new(symbols::BEARING_NOISE, "sensing.bearing_noise", Range::linear(0.0, 5.0), 2);
/// Tables of keys that robots have each, and a scene for all of them.
const SHARED: [&str; 7] = ["law", "observer", "sensing", "vehicle", "safety", "narrowing", "proximity"];

fn robust(follow: &Follow) -> bool {
    follow.law.built_in().is_some_and(|kind| kind != LawKind::FullState)
}

fn measures(follow: &Follow) -> bool {
    follow.sensing.kind != SensingKind::Truth
}

fn estimates(follow: &Follow) -> bool {
    follow.law.observes() || measures(follow)
}

impl SweepKeys {
    /// The keys of a scene, whose text this is.
    pub(crate) fn of(scene: &Scene, text: &str) -> Option<Self> {
        let (values, written) = (SceneText::parse(&scene.to_toml()).ok()?, SceneText::parse(text).ok()?);
        let (followers, leads): (Vec<&Robot>, Vec<&Robot>) =
            scene.robots.iter().partition(|robot| robot.role.follow().is_some());
        let robots = followers.iter().chain(&leads).map(|robot| robot.name.clone()).collect();
        let mut all = Self { keys: vec![], values, written, robots };
        if let Some((robot, follow)) = followers.first().and_then(|robot| Some((robot, robot.role.follow()?)))
        {
            all.list_shared(scene, robot, follow);
        }
        all.list_places(scene);
        all.add("time.period".to_owned(), "Control period".to_owned(), "s", None);
        Some(all)
    }

    /// Keys of laws, observers, sensing, vehicles and filters: for all robots, and for those that have values of their own.
    fn list_shared(&mut self, scene: &Scene, robot: &Robot, follow: &Follow) {
        for (row, _) in ROWS.iter().filter(|(_, when)| when(robot, follow)) {
            let Symbol { sign, name, unit, .. } = row.symbol;
            let name = format!("{name} {sign}");
            self.add(row.key.to_owned(), name.clone(), unit, Some(row.range));
            for robot in &scene.robots {
                let own = format!("robots.{}.{}", robot.name, row.key);
                if self.written.get(&own).is_some() {
                    self.add(own, format!("{name} of {}", robot.name), unit, Some(row.range));
                }
            }
        }
        let declared = follow.law.custom().map(|custom| &custom.declaration().parameters);
        for parameter in declared.into_iter().flatten() {
            let key = format!("law.parameters.{}", parameter.name);
            let logarithmic = parameter.scale == laws::Scale::Logarithmic;
            let range = Range { span: parameter.range, hard: parameter.range, logarithmic };
            let name = format!("{} {}", parameter.name, parameter.symbol);
            self.add(key, name.trim().to_owned(), &parameter.unit_name, Some(range));
        }
    }

    /// Places of followers, and motions of lead robots.
    fn list_places(&mut self, scene: &Scene) {
        let constant =
            |channel: &Option<ScalarTrajectory>| matches!(channel, Some(ScalarTrajectory::Constant(_)));
        for robot in &scene.robots {
            let own = &robot.name;
            match &robot.role {
                Role::Follow(follow) => {
                    for leader in follow.leaders.iter() {
                        let several = follow.leaders.are_several();
                        let [at, to] = if several {
                            [format!("robots.{own}.leaders.{}", leader.name), format!(" to {}", leader.name)]
                        } else {
                            [format!("robots.{own}"), String::new()]
                        };
                        if constant(&leader.distance) {
                            self.add(format!("{at}.distance"), format!("Distance ℓ of {own}{to}"), "m", None);
                        }
                        if constant(&leader.bearing) {
                            self.add(format!("{at}.bearing"), format!("Bearing ψ of {own}{to}"), "°", None);
                        }
                    }
                }
                Role::Lead { path: Path::Goal { .. } | Path::Tour { .. } } => {}
                Role::Lead { .. } => {
                    for (key, name, unit) in
                        [("speed", "Speed v", "m/s"), ("turn_rate", "Turn rate ω", "rad/s")]
                    {
                        self.add(format!("robots.{own}.path.{key}"), format!("{name} of {own}"), unit, None);
                    }
                }
            }
        }
    }

    /// Adds a key if it has a number at present.
    fn add(&mut self, key: String, name: String, unit: &str, range: Option<Range>) {
        if let Some(now) = self.number(&key) {
            let degrees = unit == "°";
            let now = if degrees { now.to_degrees() } else { now };
            let logarithmic = range.is_some_and(|range| range.logarithmic) && now > 0.0;
            let usual = usual(now, range, degrees);
            self.keys.push(SweepKey { key, name, unit: unit.to_owned(), usual, logarithmic });
        }
    }

    /// The number at a key, in rad for angles; of pairs that are equal the one.
    fn number(&self, key: &str) -> Option<f64> {
        let table = key.split('.').next()?;
        let text = if SHARED.contains(&table) {
            // Of a robot that has no value of its own.
            let own = |robot: &&String| self.written.get(&format!("robots.{robot}.{key}")).is_some();
            let robot = self.robots.iter().find(|robot| !own(robot)).or(self.robots.first())?;
            self.values.get(&format!("robots.{robot}.{key}"))?
        } else {
            self.values.get(key)?
        };
        let text = text.trim_matches(['[', ']']);
        let mut numbers = text.split(',').map(|part| part.trim().parse::<f64>().ok());
        let first = numbers.next()??;
        (first.is_finite() && numbers.all(|other| other == Some(first))).then_some(first)
    }

    /// What a swept key is at present, in degrees if its values are.
    pub(crate) fn present(&self, key: &str, degrees: bool) -> Option<f64> {
        self.number(key).map(|now| if degrees { now.to_degrees() } else { now })
    }

    /// The key of this path, if it is one of those that can be chosen.
    pub(crate) fn called(&self, key: &str) -> Option<&SweepKey> {
        self.keys.iter().find(|known| known.key == key)
    }

    /// The words for a key on an axis.
    pub(crate) fn label(&self, key: &str, degrees: bool) -> String {
        match self.called(key) {
            Some(known) => known.label(),
            None => sweeps::key_label(key, degrees),
        }
    }

    /// A side over a key, with the range that it has at first.
    pub(crate) fn side(&self, key: &str, count: Option<u32>) -> SweepSide {
        let count = count.unwrap_or(COUNT);
        if let Some(SweepKey { usual: [from, to], logarithmic, unit, .. }) = self.called(key) {
            let (key, degrees) = (key.to_owned(), unit == "°");
            return SweepSide { key, from: *from, to: *to, count, logarithmic: *logarithmic, degrees };
        }
        // The name of an angle's key says that it is one.
        let last = key.rsplit('.').next().unwrap_or_default();
        let degrees = ["bearing", "view_noise", "view_bias", "view_angle", "field_of_view"]
            .iter()
            .any(|angle| last.starts_with(angle));
        let [from, to] = self.present(key, degrees).map_or([0.0, 1.0], |now| usual(now, None, degrees));
        SweepSide { key: key.to_owned(), from, to, count, logarithmic: false, degrees }
    }

    /// The keys of a sweep at first: the two that matter most for the laws of the scene.
    pub(crate) fn first(&self) -> Vec<SweepSide> {
        let wanted = ["law.k", "observer.epsilon", "sensing.latency", "law.beta"];
        let mut keys: Vec<&str> = wanted.into_iter().filter(|key| self.called(key).is_some()).collect();
        keys.extend(self.keys.iter().map(|known| &*known.key).filter(|key| !wanted.contains(key)));
        keys.into_iter().take(2).map(|key| self.side(key, None)).collect()
    }
}

impl SweepKey {
    /// Its symbol, where there is little room: the last word of its name.
    pub(crate) fn short(&self) -> String {
        let (own, rest) = self.name.split_at(self.name.find(" of ").unwrap_or(self.name.len()));
        format!("{}{rest}", own.rsplit(' ').next().unwrap_or(own))
    }

    /// Its words on an axis and in a list.
    pub(crate) fn label(&self) -> String {
        let Self { name, unit, .. } = self;
        if unit.is_empty() { name.clone() } else { format!("{name} ({unit})") }
    }
}

/// The range of a sweep around what a key is at present.
fn usual(now: f64, range: Option<Range>, degrees: bool) -> [f64; 2] {
    let short = |value: f64| plain(value).parse().unwrap_or(value);
    match range {
        _ if degrees && range.is_none() => [now - 45.0, now + 45.0].map(|angle| short(angle.round())),
        Some(Range { span, hard, logarithmic: true }) if now > 0.0 => {
            // The middle one of its values is the present one.
            let factor = if span[1] / span[0] > 1000.0 { 10.0_f64 } else { 4.0 };
            let factor = factor.min(now / hard[0]).min(hard[1] / now).max(1.25);
            [now / factor, now * factor].map(short)
        }
        Some(Range { span: [low, high], .. }) => {
            let high = if 2.0 * now < 0.5 * high { high } else { 2.0 * now };
            [low, high].map(short)
        }
        None if now == 0.0 => [0.0, 1.0],
        None => {
            let ends = [0.5 * now, 1.5 * now].map(short);
            [ends[0].min(ends[1]), ends[0].max(ends[1])]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_at_first_have_what_is_there_in_their_middle() {
        let factors = Some(Range::factors(0.1, 20.0));
        assert_eq!(usual(5.0, factors, false), [1.25, 20.0]);
        assert_eq!(usual(3.0, factors, false), [0.75, 12.0]);
        assert_eq!(usual(0.001, Some(Range::factors(1e-4, 1.0)), false), [0.0001, 0.01]);
        assert_eq!(usual(0.01, Some(Range::linear(0.0, 0.3)), false), [0.0, 0.3]);
        assert_eq!(usual(0.0, Some(Range::linear(0.0, 0.9)), false), [0.0, 0.9]);
        assert_eq!(usual(5.0, Some(Range::linear(0.0, 20.0)), false), [0.0, 10.0]);
        assert_eq!(usual(-135.0, None, true), [-180.0, -90.0]);
        assert_eq!((usual(2.0, None, false), usual(-2.0, None, false)), ([1.0, 3.0], [-3.0, -1.0]));
        assert_eq!((usual(0.0, None, false)), [0.0, 1.0]);
    }
}

//! The checked scene: what every other crate may trust once a file has been loaded.
//!
//! Nothing here is partial: groups are robots, defaults are filled in, angles are radians in (−π, π], tables
//! are read. No number is NaN and every one lies in the range its description names.

mod change;
mod event;
mod expect;
mod film;
mod ground;
mod law;
mod leader;
mod narrowing;
mod path;
mod prop;
mod robot;
mod run;
mod safety;
mod sensing;
mod set_point;
mod stage;
mod vehicle;
mod written_law;

pub use change::Change;
pub use event::{Event, Failure, HandOver, Happening, Holds, Joining, Place, Recovery, Trigger, When};
pub use expect::Expect;
pub use film::{Film, Plot, Shot};
pub use ground::{Ground, Noise, Patch, Relief};
pub use law::{Law, Observer, SwitchingKind};
pub use leader::{Leader, Leaders};
pub use narrowing::Narrowing;
pub use path::{Goal, Path, SpeedProfile, Travel};
pub use prop::{PropMotion, PropSpec};
pub use robot::{Follow, Robot, Role};
pub use run::{OnContact, Physics, Time};
pub use safety::{Proximity, Safety};
pub use sensing::{Sensing, SensingKind, Vision};
pub use stage::{Environment, Views};
pub use vehicle::{Compensation, Vehicle, VehicleKind};
pub(crate) use written_law::Written;
pub use written_law::{LawSource, WrittenLaw};

pub(crate) use event::HandOverPart;
pub(crate) use expect::ExpectPart;
pub(crate) use film::FilmPart;
pub(crate) use law::{LawPart, ObserverPart};
pub(crate) use narrowing::NarrowingPart;
pub(crate) use run::{PhysicsPart, TimePart};
pub(crate) use safety::{ProximityPart, SafetyPart};
pub(crate) use sensing::{SensingForm, SensingPart, VisionPart};
pub(crate) use set_point::{BearingForm, DistanceForm};
pub(crate) use stage::{EnvironmentPart, ROBOT_VIEWS, ViewsPart};
pub(crate) use vehicle::VehiclePart;

use crate::document::SCHEMA_VERSION;
use crate::sets::{ParameterDifference, refusal};
use crate::{Diagnostics, Loaded, Override, load};
use serde::Serialize;
use vocabulary::{Judging, ScalarTrajectory};

/// One experiment, checked and complete.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Scene {
    /// Title shown in pictures and reports.
    pub title: String,
    /// What the experiment is about; may be empty.
    pub description: String,
    /// Seed of everything random.
    pub seed: u64,
    /// Length, control period and mode of the run.
    pub time: Time,
    /// How vehicles with wheels and props that move are carried through time.
    pub physics: Physics,
    /// Cameras and shells of all robots.
    pub vision: Vision,
    /// The lie of the land and its grip.
    pub ground: Ground,
    /// All robots in the order of the file, groups in place of their members, at least one. Names are unique.
    pub robots: Vec<Robot>,
    /// Solid things that are no robots, those of patterns after the others. Names are unique, among robots too.
    pub props: Vec<PropSpec>,
    /// What changes while the run goes, in the order of time.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub changes: Vec<Change>,
    /// What happens to the formation while the run goes, in the order of the file.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<Event>,
    /// How robots change their leader.
    #[serde(skip_serializing_if = "HandOver::is_usual")]
    pub hand_over: HandOver,
    /// Light and air.
    pub environment: Environment,
    /// How pictures look at the run.
    pub views: Views,
    /// How a film is made when the command line does not say.
    pub film: Film,
    /// What the run has to show.
    pub expect: Expect,
}

impl Scene {
    /// Reads and checks the scene file at `path`, or the shipped scene of that name where there is no such file, with
    /// `overrides` applied before checking.
    ///
    /// # Errors
    /// Everything that is wrong with the file, the overrides and the tables the file names.
    pub fn load(path: impl AsRef<std::path::Path>, overrides: &[Override]) -> Result<Loaded, Diagnostics> {
        load::load(path.as_ref(), overrides)
    }

    /// Checks scene `text`; `path` names it in messages, and tables are looked for beside it.
    ///
    /// # Errors
    /// Everything that is wrong with the text, the overrides and the tables the text names.
    pub fn parse(
        text: &str,
        path: impl AsRef<std::path::Path>,
        overrides: &[Override],
    ) -> Result<Loaded, Diagnostics> {
        load::parse(text, path.as_ref(), overrides)
    }

    /// The scene as TOML with every default written out, and with laws that have files of their own; it loads again to an
    /// equal scene.
    pub fn to_toml(&self) -> String {
        /// A scene as a file has it.
        #[derive(Serialize)]
        struct File<'a> {
            schema: u64,
            #[serde(flatten)]
            scene: &'a Scene,
        }
        let mut scene = self.clone();
        scene.for_every_robot(|robot| {
            if let Role::Follow(follow) = &mut robot.role {
                follow.law = follow.law.in_scene();
            }
        });
        for event in &mut scene.events {
            if let Happening::Follow { joins: Some(joins), .. } = &mut event.happening {
                joins.law = joins.law.in_scene();
            }
        }
        // A checked scene holds nothing that TOML cannot write, as the round trips of the tests show.
        toml::to_string(&File { schema: SCHEMA_VERSION, scene: &scene }).unwrap_or_default()
    }

    /// What has to be set to come from this scene to `other` while a run goes, robot by robot in the words of `--set`:
    /// `robots.follower-1.law.k=[3.0, 3.0]`. Changes that the scenes have themselves are left out of account.
    ///
    /// # Errors
    /// One message for everything that differs and cannot change while a run goes.
    pub fn sets_to(&self, other: &Self) -> Result<Vec<String>, Vec<String>> {
        let mut found = ParameterDifference::default();
        found.note_rest(self, other);
        found.note_robots(&self.robots, &other.robots);
        if found.obstacles.is_empty() {
            Ok(found.sets)
        } else {
            Err(found.obstacles.iter().map(|path| refusal(path)).collect())
        }
    }

    /// How the robots follow that lead at the start and have to follow later, by name: the first event of each says it.
    pub fn joining(&self) -> Vec<(&str, Follow)> {
        let mut joining: Vec<(&str, Follow)> = vec![];
        for event in &self.events {
            let Happening::Follow { robot, leader, place, joins: Some(joins) } = &event.happening else {
                continue;
            };
            if joining.iter().any(|(name, _)| name == robot) {
                continue;
            }
            let fixed = ScalarTrajectory::Constant;
            let [distance, bearing] = place.as_ref().map_or_else(
                || [fixed(joins.law.distance_min), fixed(std::f64::consts::PI)],
                |place| [place.distance.clone(), place.bearing.clone()],
            );
            let Joining { law, observer, sensing, narrowing } = (**joins).clone();
            let follow = Follow {
                leaders: Leaders::one(leader.clone(), distance, bearing),
                speed: 0.0,
                law,
                observer,
                sensing,
                narrowing,
            };
            joining.push((robot, follow));
        }
        joining
    }

    /// Index of the robot called `name`.
    pub fn index_of(&self, name: &str) -> Option<usize> {
        self.robots.iter().position(|robot| robot.name == name)
    }

    /// The robots that follow, by name, in their order.
    pub fn followers(&self) -> impl Iterator<Item = (&str, &Follow)> {
        self.robots.iter().filter_map(|robot| Some((&*robot.name, robot.role.follow()?)))
    }

    /// The edges of the formation at the start, in the order of their followers, those of one follower together: its name,
    /// how it follows, and whom by this edge.
    pub fn edges(&self) -> impl Iterator<Item = (&str, &Follow, &Leader)> {
        self.followers()
            .flat_map(|(name, follow)| follow.leaders.iter().map(move |leader| (name, follow, leader)))
    }

    /// What a run of this scene is judged by.
    pub fn judging(&self) -> Judging {
        self.expect.judging(self.time.duration)
    }

    /// What followers are given that their custom law does not use, in words: gains of the built-in laws, and set points
    /// that the law does not read.
    pub fn unused(&self) -> Vec<String> {
        crate::unused::unused(self)
    }

    /// What of the scene comes after the end of its run and so never takes effect, in words: changes, and expectations
    /// that are judged from a time on.
    pub fn late(&self) -> Vec<String> {
        let end = self.time.duration;
        let mut changes = self.changes.iter().filter(|change| change.at > end);
        let mut late = vec![];
        if let Some(first) = changes.next() {
            let more = match changes.count() {
                0 => "comes".to_owned(),
                more => format!("and {more} more come"),
            };
            late.push(format!("the change at {} s {more} after the end of the run at {end} s", first.at));
        }
        let at = |event: &Event| match event.trigger {
            Trigger::At { at } => Some(at).filter(|at| *at > end),
            Trigger::When { .. } => None,
        };
        for (index, time) in self.events.iter().enumerate().filter_map(|(k, event)| Some((k, at(event)?))) {
            late.push(format!("`events.{index}` at {time} s comes after the end of the run at {end} s"));
        }
        let Expect { settled_after, settling_time, wide_again_by, .. } = self.expect;
        let times = [
            ("settled_after", settled_after),
            ("settling_time", settling_time),
            ("wide_again_by", wide_again_by),
        ];
        for (key, time) in times {
            if let Some(time) = time.filter(|time| *time > end) {
                late.push(format!(
                    "`{key}` of {time} s is after the end of the run at {end} s: it is not judged"
                ));
            }
        }
        late
    }

    /// Does `work` to every robot as it is at the start and as it is after every change.
    pub fn for_every_robot(&mut self, mut work: impl FnMut(&mut Robot)) {
        let later = self.changes.iter_mut().flat_map(|change| &mut change.then.robots);
        self.robots.iter_mut().chain(later).for_each(&mut work);
    }
}

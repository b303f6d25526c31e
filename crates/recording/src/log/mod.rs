//! `log.mcap`: a whole run in one file that other tools open, and that comes back bit for bit.
//!
//! ```text
//! metadata    "echelon": version of this layout, program
//! metadata    "ros2": names of robots and props as ROS 2 takes them in topics
//! attachments scene.toml, manifest.json (as before the run; once more at its end, with digest and status)
//! chunk       schemas, channels, the cast, what stands still
//! chunks      about a simulated second each, compressed each by itself: moments, drawings, pictures
//! summary     indexes and statistics, where the run came to its end
//! ```
//!
//! A chunk reaches the file whole, so a run that is killed can be read up to its last one. Moments are written as
//! messages of our own (`messages`); drawings are Foxglove's schemas, made of the moments and never read back.
//!
//! What another program wrote anew is put together again (`import`).

mod compare;
mod drawing;
mod events;
mod fleet;
mod import;
mod law;
mod messages;
mod outline;
mod pictures;
mod pipe;
mod plans;
mod read;
mod record;
mod ros;
mod safety;
mod solids;
mod writer;

pub use compare::{Comparison, Difference, Peak, compare};
pub use pictures::{Photo, Roll};
pub(crate) use pipe::Pipe;
pub use read::{Log, Moments};

use vocabulary::{Edge, FleetInfo, Prop, RobotInfo};

/// Name of the file in a run folder.
pub const FILE: &str = "log.mcap";

/// The layout this program writes and reads.
const FORMAT: u32 = 2;

/// What to say of a log of another layout.
fn other_layout(format: &str) -> String {
    format!(
        "is a log of layout {format}; this program reads layout {FORMAT}: run its scene again (`echelon run \
         RUN/scene.toml`), or read it with the program that wrote it"
    )
}

/// Name of the metadata that makes an MCAP file a log of ours.
const NAME: &str = "echelon";

/// What our files name as the library that wrote them, before its version.
const OURS: &str = "echelon ";

/// Names of topics.
struct Topics;

impl Topics {
    const FLEET: &str = "/fleet";
    const CONTACTS: &str = "/contacts";
    const EVENTS: &str = "/events";
    const PLANS: &str = "/plans";
    const SAMPLES: &str = "/samples";

    fn robot(member: &RobotInfo) -> String {
        format!("/robot/{}/state", member.name)
    }

    fn edge(fleet: &FleetInfo, edge: Edge) -> String {
        format!("/edge/{}/state", fleet.pair(edge).join("/"))
    }

    fn measurements(fleet: &FleetInfo, edge: Edge) -> String {
        format!("/edge/{}/measurements", fleet.pair(edge).join("/"))
    }

    fn prop(prop: &Prop) -> String {
        format!("/prop/{}/state", prop.name)
    }

    fn law(member: &RobotInfo) -> String {
        format!("/robot/{}/law", member.name)
    }

    fn safety(member: &RobotInfo) -> String {
        format!("/robot/{}/safety", member.name)
    }
}

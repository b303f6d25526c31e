//! Links: the text that carries a scene, what is changed in it, what is looked at, and the proof that it is the same run.
//!
//! `#circle-three?law.k=3&@2.5:law.k=4&t=7.5&view=snake&selected=follower-1&v=0.1.0&d=1a2b3c4d`: the name of a shipped scene;
//! values as `--set` has them; values that are set at a time; time, view and robot; version and first digits of the digest.
//! A scene that does not come with the program stands in its name's place, packed: `#~…`.

mod difference;
mod error;
mod opened;
mod read;
mod shorten;
mod written;

pub use error::LinkError;
pub use opened::LinkedScene;

use crate::{Override, Shipped};

/// Version of the program, as links carry it.
pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");
/// Longest link that is read, bytes.
const MOST_BYTES: usize = 1_000_000;
/// Most values that a link sets, at the start and later.
const MOST_SETS: [usize; 2] = [300, 5000];
/// Latest time that a link names, s: runs are no longer.
const LATEST: f64 = 1e5;

/// A link.
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    /// Where the scene comes from.
    pub origin: LinkOrigin,
    /// What is set in it at the start.
    pub set: Vec<Override>,
    /// What is set later, in the order in which it applies.
    pub changes: Vec<TimedOverride>,
    /// The time to look at, s.
    pub time: Option<f64>,
    /// The view to look from, in the words of `--view`.
    pub view: Option<String>,
    /// Name of the selected robot.
    pub selected: Option<String>,
    /// Name of the branch.
    pub branch: Option<String>,
    /// What the run has to come to.
    pub proof: Option<LinkProof>,
}

/// Where the scene of a link comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LinkOrigin {
    /// It comes with the program.
    Shipped(&'static Shipped),
    /// The link carries its text.
    Text(String),
}

/// A value that is set while the run goes.
#[derive(Debug, Clone, PartialEq)]
pub struct TimedOverride {
    /// It holds from the first control sample at or after this on, s.
    pub at: f64,
    /// The value.
    pub set: Override,
}

/// What the run of a link has to come to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LinkProof {
    /// Version of the program that made the link.
    pub version: String,
    /// First 8 hexadecimal digits of the digest of the run up to the link's time.
    pub digits: String,
}

impl LinkProof {
    /// Number of digits.
    pub const DIGITS: usize = 8;

    /// That this program has come to `digest`.
    pub fn of(digest: &str) -> Self {
        Self { version: VERSION.to_owned(), digits: digest.chars().take(Self::DIGITS).collect() }
    }

    /// Whether a newer program made the link.
    pub fn newer(&self) -> bool {
        let parts = |version: &str| version.split('.').map(|part| part.parse().unwrap_or(0)).collect();
        let [theirs, ours]: [Vec<u64>; 2] = [&self.version, VERSION].map(parts);
        theirs > ours
    }

    /// Whether `digest` begins with the digits.
    pub fn fits(&self, digest: &str) -> bool {
        digest.starts_with(&self.digits)
    }
}

impl Link {
    /// Longest link that programs pass on without cutting it, characters.
    pub const SAFE_LENGTH: usize = 2000;

    /// The plain link to a scene.
    pub fn to(origin: LinkOrigin) -> Self {
        Self {
            origin,
            set: vec![],
            changes: vec![],
            time: None,
            view: None,
            selected: None,
            branch: None,
            proof: None,
        }
    }

    /// Whether a text is meant as a link: one line that begins with `#`, or is an address. Scenes, which may begin with a
    /// comment, have more lines.
    pub fn is_meant(text: &str) -> bool {
        let text = text.trim();
        !text.contains('\n') && (text.starts_with('#') || text.contains("://"))
    }

    /// Name of the scene: that of a shipped one, or `scene`.
    pub fn name(&self) -> &'static str {
        match &self.origin {
            LinkOrigin::Shipped(shipped) => shipped.name,
            LinkOrigin::Text(_) => "scene",
        }
    }
}

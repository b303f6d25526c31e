//! The run that a link leads to: is it the one that the link was made of?

use crate::{Error, STRIDE, SceneRun};
use metrics::Digest;
use scene::{Link, LinkProof};

/// Runs up to `time` s, or to where the run ends before: its digest. `go_on` gets the number of samples every [`STRIDE`]
/// samples and says whether the run goes on.
///
/// # Errors
/// [`Error`] where the run breaks off with a fault, [`Error::Interrupted`] where `go_on` says no.
pub fn digest_at(run: &mut SceneRun, time: f64, mut go_on: impl FnMut(u64) -> bool) -> Result<String, Error> {
    let most = run.simulation.sample_at(time) + 1;
    let (mut digest, mut samples) = (Digest::default(), 0);
    while samples < most {
        let Some(record) = run.simulation.next_record() else { break };
        digest.push(record);
        samples += 1;
        if samples % STRIDE == 0 && !go_on(samples) {
            return Err(Error::Interrupted { samples });
        }
    }
    run.simulation.fault().map_or_else(|| Ok(digest.text()), |fault| Err(fault.into()))
}

/// A run held against the link that leads to it.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkComparison {
    proof: Option<LinkProof>,
    /// s.
    time: f64,
    digest: String,
    sees: bool,
}

impl LinkComparison {
    /// Holds `digest`, to which a run has come at the time of `link`, against the link; `sees` says whether cameras on robots
    /// took pictures. `None` for a link without a time.
    pub fn new(link: &Link, digest: String, sees: bool) -> Option<Self> {
        link.time.map(|time| Self { proof: link.proof.clone(), time, digest, sees })
    }

    /// Whether it is the same run; `None` where the link proves nothing.
    pub fn same(&self) -> Option<bool> {
        self.proof.as_ref().map(|proof| proof.fits(&self.digest))
    }

    /// What came of it.
    pub fn words(&self) -> String {
        let Some(proof) = &self.proof else {
            return "nothing to compare: the link has no digest, since it was written by hand or cut off"
                .to_owned();
        };
        let version = env!("CARGO_PKG_VERSION");
        let other = (proof.version != version)
            .then(|| format!("made by echelon {}, this is {version}", proof.version));
        let time = self.time;
        if proof.fits(&self.digest) {
            let other = other.map_or_else(String::new, |other| format!(" ({other})"));
            return format!("the same run, bit for bit, up to t = {time} s{other}");
        }
        let why = match other {
            Some(other) => format!("{other}: another version need not come to the same bits"),
            None if self.sees => {
                "made by this version: what cameras see depends on adapter and processor too; or the link was edited by \
                 hand"
                    .to_owned()
            }
            None => "made by this version: the link was edited by hand, or another build of it computes differently".to_owned(),
        };
        let now = self.digest.get(..LinkProof::DIGITS).unwrap_or_default();
        format!("DIFFERENT at t = {time} s or before: digest {} in the link, {now} here; {why}", proof.digits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn comparison(link: &str, digest: &str, sees: bool) -> LinkComparison {
        let link: Link = link.parse().expect("a link");
        LinkComparison::new(&link, digest.to_owned(), sees).expect("a time")
    }

    #[test]
    fn what_came_of_it_is_said() {
        let own = format!("#line-three?t=0.5&v={}&d=1a2b3c4d", env!("CARGO_PKG_VERSION"));
        let same = comparison(&own, "1a2b3c4d5e", false);
        assert_eq!((same.same(), &*same.words()), (Some(true), "the same run, bit for bit, up to t = 0.5 s"));
        let apart = comparison(&own, "00000000ff", false);
        assert_eq!(apart.same(), Some(false));
        assert!(
            apart.words().contains("1a2b3c4d in the link, 00000000 here; made by this version"),
            "{}",
            apart.words()
        );
        assert!(comparison(&own, "00000000ff", true).words().contains("cameras"));
        let newer = comparison("#line-three?t=0.5&v=99.0.0&d=1a2b3c4d", "00000000ff", false);
        assert!(newer.words().contains("made by echelon 99.0.0, this is "), "{}", newer.words());
        let newer = comparison("#line-three?t=0.5&v=99.0.0&d=1a2b3c4d", "1a2b3c4d", false);
        assert!(newer.words().starts_with("the same run") && newer.words().contains("99.0.0"));
        let none = comparison("#line-three?t=0.5", "1a2b3c4d", false);
        assert!(none.same().is_none() && none.words().contains("no digest"));
    }

    #[test]
    fn the_digest_at_a_time_is_that_of_a_run_as_long() {
        let run = |set: &str| {
            let set: scene::Override = set.parse().expect("an override");
            let shipped = scene::shipped("line-three").expect("a scene");
            SceneRun::new(scene::Scene::parse(shipped.text, "", &[set]).expect("a scene").scene)
                .expect("a run")
        };
        let part = digest_at(&mut run("time.duration=2.0"), 0.5, |_| true).expect("a digest");
        let whole = digest_at(&mut run("time.duration=0.5"), 9.0, |_| true).expect("a digest");
        assert_eq!(part, whole);
        let other = digest_at(&mut run("time.duration=2.0"), 0.51, |_| true).expect("a digest");
        assert_ne!(part, other);
        let asked = digest_at(&mut run("time.duration=2.0"), 2.0, |_| false);
        assert!(matches!(asked, Err(Error::Interrupted { samples: STRIDE })));
    }
}

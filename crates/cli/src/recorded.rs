//! Opens what a run has left: its folder, or its log alone.

use crate::failure::Failure;
use crate::interrupt;
use crate::print::note;
use crate::progress::Progress;
use footage::times::shown;
use recording::Manifest;
use recording::log::{self, Log};
use scene::Scene;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};
use studies::replay::{RunDigest, digest_of};

/// A recorded run.
pub(crate) struct Recorded {
    /// As it was asked for.
    pub(crate) path: PathBuf,
    pub(crate) manifest: Manifest,
    /// The resolved scene, as text, and where it stands.
    pub(crate) scene: (PathBuf, String),
    log: Result<Log, Failure>,
}

impl Recorded {
    /// Opens a run folder or a log.
    pub(crate) fn open(path: &Path) -> Result<Self, Failure> {
        let opened = Self::read(path)?;
        if let Some(remark) = opened.records().and_then(Log::remark) {
            note(&format!("{} {remark}", path.display()));
        }
        interrupt::watch();
        Ok(opened)
    }

    fn read(path: &Path) -> Result<Self, Failure> {
        if !path.is_dir() {
            return match Log::open(path) {
                Ok(log) => Ok(Self::of_log(path, log)),
                Err(_) if !path.exists() => Err(Failure::Usage(format!(
                    "{} is neither a run folder nor a log: {}",
                    path.display(),
                    absent(path)
                ))),
                Err(error) => Err(match Failure::from(error) {
                    Failure::Usage(text) => Failure::Usage(text + &instead(path)),
                    other => other,
                }),
            };
        }
        let inside = path.join(log::FILE);
        let log = match Log::open(&inside) {
            Err(_) if !inside.exists() => Err(Failure::Usage(format!(
                "{} has no {}: what happened in it is not recorded moment by moment; `echelon run {}` makes it anew",
                path.display(),
                log::FILE,
                path.join("scene.toml").display()
            ))),
            opened => opened.map_err(Failure::from),
        };
        let (mut manifest, log) = match (read_manifest(path), log) {
            (Ok(manifest), log) => (manifest, log),
            (Err(failure), Ok(log)) => {
                if path.join("manifest.json").exists() {
                    note(&format!("{}; {} stands in for it", failure.text().unwrap_or_default(), log::FILE));
                }
                return Ok(Self::of_log(path, log));
            }
            (Err(failure), Err(_)) => return Err(failure),
        };
        if let (None, Ok(log)) = (&manifest.digest, &log) {
            manifest.samples = log.manifest().samples;
        }
        let place = path.join("scene.toml");
        let text = match (std::fs::read_to_string(&place), &log) {
            (Ok(text), _) => text,
            (Err(_), Ok(log)) => log.scene().to_owned(),
            (Err(error), Err(_)) => {
                return Err(Failure::Usage(format!("cannot read {}: {error}", place.display())));
            }
        };
        Ok(Self { path: path.to_owned(), manifest, scene: (place, text), log })
    }

    fn of_log(path: &Path, log: Log) -> Self {
        let scene = (path.to_owned(), log.scene().to_owned());
        Self { path: path.to_owned(), manifest: log.manifest().clone(), scene, log: Ok(log) }
    }

    /// Fails where the beginning was left out, which `work` needs.
    pub(crate) fn needs_the_start(&self, work: &str) -> Result<(), Failure> {
        let begins = self.records().map_or(0.0, Log::begins);
        if begins < 1e-9 {
            return Ok(());
        }
        Err(Failure::Usage(format!(
            "{} begins at {} s: {work} needs the run from its start; `echelon replay {} --capture {}` draws what is there",
            self.path.display(),
            shown(begins),
            self.path.display(),
            shown(begins)
        )))
    }

    /// Its moments; fails where they are not there.
    pub(crate) fn log(self) -> Result<Log, Failure> {
        self.log
    }

    /// Its moments, where they are there.
    pub(crate) fn records(&self) -> Option<&Log> {
        self.log.as_ref().ok()
    }

    /// Its scene, checked.
    pub(crate) fn scene(&self) -> Result<Scene, Failure> {
        let (place, text) = &self.scene;
        if text.is_empty() {
            let text =
                format!("{} holds no scene: it can be drawn and compared, not run again", place.display());
            return Err(Failure::Usage(text));
        }
        let loaded = Scene::parse(text, place, &[]).map_err(|errors| Failure::Usage(errors.to_string()))?;
        Ok(loaded.scene)
    }

    /// Samples and digest of the records in its log, where it has one.
    pub(crate) fn logged(&self, quiet: bool) -> Result<Option<RunDigest>, Failure> {
        let Some(log) = self.records() else { return Ok(None) };
        let steps = self.manifest.samples;
        let progress = Progress::begin(&format!("Reading {}", log.path().display()), steps, quiet);
        let read = digest_of(log, |samples| {
            progress.at(samples);
            !interrupt::asked()
        })?;
        if read.samples == 0 {
            let text = format!("{} holds no whole sample", log.path().display());
            return Err(Failure::Usage(text));
        }
        Ok(Some(read))
    }
}

/// What a recorded run is, for who named something else.
const WANTED: &str =
    "a run folder, such as runs/line-three-001, or its log.mcap is needed; `echelon run SCENE` leaves one";

/// What to say where there is nothing at `path`.
fn absent(path: &Path) -> String {
    match path.to_str().and_then(scene::shipped) {
        Some(_) => format!("it is a scene; `echelon run {}` records a run of it", path.display()),
        None => format!("there is no such file; {WANTED}"),
    }
}

/// What to name in place of a file that is no log.
fn instead(path: &Path) -> String {
    let ends = |ending: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending));
    let run = path.parent().filter(|folder| folder.join("manifest.json").is_file() && !ends("mcap"));
    match run {
        Some(folder) if folder.as_os_str().is_empty() => "; its run is this folder, `.`".to_owned(),
        Some(folder) => format!("; its run is the folder {}", folder.display()),
        None if ends("toml") => format!("; a scene is recorded by `echelon run {}`", path.display()),
        None => String::new(),
    }
}

/// Fails where a scene was to be named and a recorded run was.
pub(crate) fn refuse(path: &Path) -> Result<(), Failure> {
    let file = |name: &str| path.join(name).is_file();
    let log = || {
        let mut head = [0; 5];
        let read = std::fs::File::open(path).and_then(|mut file| file.read_exact(&mut head));
        read.is_ok() && &head == b"\x89MCAP"
    };
    let folder = path.is_dir() && (file("manifest.json") || file(log::FILE));
    let alone = path.is_file() && log();
    if !folder && !alone {
        return Ok(());
    }
    let shown = path.display();
    let scene = path.join("scene.toml");
    let scene = if scene.is_file() { format!("; its scene is {}", scene.display()) } else { String::new() };
    Err(Failure::Usage(format!(
        "{shown} is a recorded run, but a scene is needed here: `echelon replay {shown}` runs it again, with \
         `--capture 0,5` or `--film film.mp4` it draws it{scene}"
    )))
}

/// The manifest of the run in `folder`.
fn read_manifest(folder: &Path) -> Result<Manifest, Failure> {
    let path = folder.join("manifest.json");
    let text = std::fs::read_to_string(&path).map_err(|error| match error.kind() {
        ErrorKind::NotFound | ErrorKind::NotADirectory => Failure::Usage(format!(
            "{} is not a run folder: it has no manifest.json and no log.mcap; {WANTED}",
            folder.display()
        )),
        ErrorKind::InvalidData => {
            Failure::Usage(format!("{} is not a manifest: it is not text", path.display()))
        }
        _ => Failure::Machine(format!("cannot read {}: {error}", path.display())),
    })?;
    let manifest: Manifest = serde_json::from_str(&text).map_err(|error| {
        Failure::Usage(format!("{} is not the manifest of a run: {error}", path.display()))
    })?;
    match manifest.other_layout() {
        Some(fault) => Err(Failure::Usage(format!("{} {fault}", folder.display()))),
        None => Ok(manifest),
    }
}

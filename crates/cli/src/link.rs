//! `echelon link`: the text that leads others to a run; and what other subcommands do with one.

use crate::args::{SceneArgs, time};
use crate::failure::Failure;
use crate::load::{build, read_file, stem, with_seed};
use crate::print::{json, note, say};
use crate::progress::Progress;
use crate::{Outcome, cameras, interrupt};
use clap::Args;
use rendering::ViewLayout;
use scene::{Link, LinkProof, LinkedScene, Override, Scene};
use serde_json::json;
use std::path::{Path, PathBuf};
use studies::link::{LinkComparison, digest_at};

#[derive(Debug, Args)]
pub(crate) struct LinkArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// The time to look at in s, such as 7.5; by default the end of the run
    #[arg(long, value_name = "TIME", allow_negative_numbers = true, value_parser = time)]
    at: Option<f64>,
    /// The view to look from, in the words of `echelon capture`
    #[arg(long)]
    view: Option<String>,
    /// The robot that is selected in the lab
    #[arg(long, value_name = "ROBOT")]
    select: Option<String>,
    /// Address of a page with the lab, which the link is put behind
    #[arg(long, value_name = "URL")]
    page: Option<String>,
    /// Also write a scene file that leads to the same run
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Replace the file
    #[arg(long, requires = "out")]
    force: bool,
}

/// The link that `path` is; `None` where it is none.
pub(crate) fn meant(path: &Path) -> Result<Option<Link>, Failure> {
    let text = path.to_str().filter(|text| Link::is_meant(text) && !path.exists());
    text.map(|text| text.parse().map_err(|error: scene::LinkError| Failure::Usage(error.to_string())))
        .transpose()
}

/// The scene of a link with `overrides`, which looks at its run as the link does.
pub(crate) fn read(link: &Link, overrides: &[Override]) -> Result<Scene, Failure> {
    let LinkedScene { home, text, mut scene } = opened(link)?;
    if !overrides.is_empty() {
        scene =
            Scene::parse(&text, home, overrides).map_err(|faults| Failure::Usage(faults.to_string()))?.scene;
    }
    if let Some(view) = &link.view {
        scene.views.default.clone_from(view);
        scene.film.view = Some(view.clone());
    }
    Ok(scene)
}

fn opened(link: &Link) -> Result<LinkedScene, Failure> {
    let opened = link.open().map_err(|error| Failure::Usage(error.to_string()))?;
    if let Some(view) = &link.view {
        let names: Vec<String> = opened.scene.robots.iter().map(|robot| robot.name.clone()).collect();
        ViewLayout::parse(view, &names)
            .map_err(|error| Failure::Usage(format!("the view of the link: {error}")))?;
    }
    Ok(opened)
}

/// Holds `digest`, to which a run of `scene` has come, against the link that led to it, and says what came of it. Nothing else is
/// compared where the command line changes the scene.
pub(crate) fn compare(link: &Link, digest: String, scene: &SceneArgs, sees: bool) -> Option<LinkComparison> {
    let changed = !scene.set.is_empty() || scene.seed.is_some();
    LinkComparison::new(link, digest, sees).filter(|_| !changed)
}

pub(crate) fn link(args: &LinkArgs) -> Outcome {
    let SceneArgs { scene: path, set, seed, adapter, json: as_json, quiet } = &args.scene;
    let mut link = match meant(path)? {
        Some(link) => link,
        None => of_file(path)?,
    };
    link.set.extend(with_seed(set, *seed)?);
    link.view = args.view.clone().or(link.view);
    link.selected = args.select.clone().or(link.selected);
    (link.time, link.proof) = (args.at.or(link.time), None);
    // Checked before anything runs: what is printed can be read again.
    let end = opened(&link)?.scene.time.duration;
    link.time = link.time.or(Some(end));
    let link: Link = again(&link)?;
    interrupt::watch();
    let LinkedScene { home, text, scene } = opened(&link)?;
    let until = link.time.unwrap_or(end);
    let mut run = build(scene, &home.display())?;
    cameras::attach(&mut run, None, &adapter.name, None)?;
    let silent = *quiet || *as_json;
    let progress =
        Progress::begin(&format!("Simulating {}, {until} s", stem(path)), run.simulation.len(), silent);
    let digest = digest_at(&mut run, until, |samples| {
        progress.at(samples);
        !interrupt::asked()
    })?;
    drop(progress);
    let link = Link { proof: Some(LinkProof::of(&digest)), ..link };
    let shown =
        format!("{}{link}", args.page.as_deref().map_or("", |page| page.split('#').next().unwrap_or(page)));
    if let Some(file) = &args.out {
        let head = format!(
            "# Up to t = {until} s the digest of this run begins with {}.\n",
            LinkProof::of(&digest).digits
        );
        if file.exists() && !args.force {
            return Err(Failure::Usage(format!("{} exists already; --force replaces it", file.display())));
        }
        output::write_whole(file, (head + &text).as_bytes())?;
    }
    let length = shown.chars().count();
    if length > Link::SAFE_LENGTH && !*quiet {
        let instead = match &args.out {
            Some(file) => format!("{} leads to the same run", file.display()),
            None => "--out FILE writes a scene that leads to the same run".to_owned(),
        };
        note(&format!(
            "note: the link has {length} characters, and some programs cut links after {}: {instead}",
            Link::SAFE_LENGTH
        ));
    }
    if *as_json {
        json(&json!({ "link": shown, "time": until, "digest": digest, "length": length }));
    } else {
        say(&shown);
    }
    Ok(())
}

/// The link to a scene file or a shipped scene.
fn of_file(path: &Path) -> Result<Link, Failure> {
    Link::to_text(&read_file(path, &[])?.text, &stem(path)).map_err(|error| Failure::Usage(error.to_string()))
}

/// The link that comes of the text of `link`: so it is what its readers get.
fn again(link: &Link) -> Result<Link, Failure> {
    link.to_string().parse().map_err(|error: scene::LinkError| Failure::Usage(error.to_string()))
}

//! `echelon certify`: what the theorems say of a scene's run, edge by edge, and what lies beyond them.

mod beyond;
mod files;
mod pictures;
mod text;

pub(crate) use pictures::axis;

use crate::args::{SceneArgs, within};
use crate::failure::Failure;
use crate::load::{load, stem};
use crate::print::json;
use crate::progress::Progress;
use crate::{Outcome, cameras, interrupt};
use clap::Args;
use output::Place;
use scene::Scene;
use std::path::PathBuf;
use std::time::Instant;
use studies::certify::beyond::Beyond;
use studies::certify::{Certificate, certificates};
use vocabulary::FleetInfo;

#[derive(Debug, Args)]
pub(crate) struct CertifyArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Folder for certificate.json, certificate.csv and figures; it may hold other files
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Bound on the ultimate tracking error (m and rad together, as in the paper): report the largest ε for which the proof
    /// guarantees it
    #[arg(long, value_name = "BOUND", value_parser = within(1e-9..=1e3, "write a number from 1e-9 to 1000, such as 0.01"), allow_negative_numbers = true)]
    bound: Option<f64>,
    /// Skip what is beyond the paper: sensitivities, feasible set points, stability over ε and period, chains
    #[arg(long)]
    paper_only: bool,
    /// Compute sensitivities even if the runs are long: wheeled vehicles, many robots
    #[arg(long, conflicts_with = "paper_only")]
    sensitivity: bool,
    /// Exit with 1 if a statement is violated or a custom law breaks off
    #[arg(long)]
    strict: bool,
}

/// All that is known of a scene.
pub(crate) struct CertifyReport<'a> {
    scene: &'a Scene,
    fleet: FleetInfo,
    certificates: Vec<Certificate>,
    beyond: Option<Beyond>,
    bound: Option<f64>,
    wall: f64,
}

impl CertifyReport<'_> {
    /// "leader → follower" of a certificate, as they were then.
    fn pair(&self, certificate: &Certificate) -> String {
        self.fleet.pair(certificate.pair).join(" → ")
    }

    /// "leader → follower".
    fn edge(&self, index: usize) -> String {
        self.fleet.edges.get(index).map_or_else(String::new, |edge| self.fleet.pair(*edge).join(" → "))
    }

    /// Name of the robot that follows on an edge.
    fn follower(&self, index: usize) -> &str {
        self.fleet.edges.get(index).map_or("", |edge| self.fleet.pair(*edge)[1])
    }

    /// Whether no statement of any edge is violated, and every law gave its commands.
    fn holds(&self) -> bool {
        self.certificates.iter().all(Certificate::unbroken)
    }
}

pub(crate) fn certify(args: &CertifyArgs) -> Outcome {
    let began = Instant::now();
    let mut run = load(&args.scene)?;
    let _place = args.out.as_deref().map(Place::folder).transpose()?;
    cameras::attach(&mut run, None, &args.scene.adapter.name, None)?;
    let quiet = args.scene.quiet || args.scene.json;
    let (scene, fleet) = (run.scene.clone(), run.simulation.fleet().clone());
    if fleet.edges.is_empty() {
        let text = format!(
            "{}: no robot follows another, so there is nothing to certify",
            args.scene.scene.display()
        );
        return Err(Failure::Usage(text));
    }
    let what = format!("Certifying {}, {} s", stem(&args.scene.scene), scene.time.duration);
    let progress = Progress::begin(&what, run.simulation.len(), quiet);
    let certificates = certificates(run, |step| {
        progress.at(step);
        !interrupt::asked()
    })?
    .ok_or_else(nothing)?;
    drop(progress);
    let beyond = if args.paper_only {
        None
    } else {
        let sensitivities = beyond::every_gain(&scene, args.sensitivity, quiet)?;
        Some(Beyond::of(&scene, sensitivities).map_err(studies::Error::from)?)
    };
    let mut report =
        CertifyReport { scene: &scene, fleet, certificates, beyond, bound: args.bound, wall: 0.0 };
    report.wall = began.elapsed().as_secs_f64();
    let written =
        args.out.as_deref().map(|folder| files::write(folder, &report, args.scene.quiet)).transpose();
    if args.scene.json {
        json(&files::as_json(&report));
    } else if !args.scene.quiet {
        text::tell(&report, written.as_ref().map_or(&[], |files| files.as_deref().unwrap_or_default()));
    }
    // Results are printed even if a file cannot be written.
    written?;
    if args.strict && !report.holds() { Err(Failure::Expectation) } else { Ok(()) }
}

/// A certificate that was interrupted.
fn nothing() -> Failure {
    Failure::Interrupted("nothing was certified".into())
}

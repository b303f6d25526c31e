//! The simulation held against independent solutions of the same equations.
//!
//! Every case of a folder with `cases/*.json` and `golden/*.csv` is run: those of `tests/reference`, whose
//! `reference.py` made the golden files, and those of the folder named by `ECHELON_REFERENCE_DIR` if it is set.

use formation::lead::AnalyticTrajectory;
use formation::{Custom, EdgeLaw, Formation, Graph, Heading, Law, Observer, SetPointTrajectory, Switching};
use laws::{CustomLaw, LawFile};
use serde::Deserialize;
use simulation::{Setup, Simulation};
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use vocabulary::{
    Body, FleetInfo, LawKind, Limits, ObserverStart, Pose, RobotInfo, ScalarTrajectory, StepRecord, TimeMode,
    Trajectory, wrap,
};
use world::{RobotSetup, Unicycle, WorldSetup};

type Outcome<T> = Result<T, Box<dyn Error>>;

#[derive(Deserialize)]
struct Case {
    mode: String,
    period: f64,
    duration: f64,
    #[serde(default = "one")]
    record_every: usize,
    lead: Lead,
    controller: Controller,
    bounds: Bounds,
    robots: Vec<Robot>,
    edges: Vec<EdgeCase>,
    /// Whether the law is read from its law file; else it is the built-in one.
    #[serde(default)]
    from_file: bool,
}

#[derive(Deserialize)]
struct Lead {
    v: f64,
    omega: f64,
    v_wave: Option<Wave>,
    omega_wave: Option<Wave>,
}

#[derive(Deserialize, Clone, Copy)]
struct Wave {
    amplitude: f64,
    rate: f64,
}

#[derive(Deserialize)]
struct Controller {
    kind: String,
    k: [f64; 2],
    beta: f64,
    slope: f64,
    #[serde(default = "unit")]
    epsilon: f64,
    #[serde(default = "two")]
    alpha1: f64,
    #[serde(default = "unit")]
    alpha2: f64,
}

#[derive(Deserialize)]
struct Bounds {
    v_min: f64,
    v_max: f64,
    omega_max: f64,
}

#[derive(Deserialize)]
struct Robot {
    pose: [f64; 3],
    v: f64,
}

#[derive(Deserialize)]
struct EdgeCase {
    leader: usize,
    follower: usize,
    set_point: [f64; 2],
    #[serde(default)]
    modulation: Option<[Option<Wave>; 2]>,
}

fn one() -> usize {
    1
}

fn unit() -> f64 {
    1.0
}

fn two() -> f64 {
    2.0
}

fn course(mean: f64, wave: Option<Wave>) -> ScalarTrajectory {
    wave.map_or(ScalarTrajectory::Constant(mean), |w| ScalarTrajectory::Sinusoid {
        mean,
        amplitude: w.amplitude,
        rate: w.rate,
    })
}

impl Case {
    fn law(&self) -> Outcome<EdgeLaw> {
        let c = &self.controller;
        let kind = match &*c.kind {
            "FSFB" => LawKind::FullState,
            "RSFB" => LawKind::RobustState,
            "OFB" => LawKind::OutputFeedback,
            other => return Err(format!("unknown controller kind {other}").into()),
        };
        // The reference divides by the distance as it is; a millimetre never comes into play.
        let distance_min = 1e-3;
        let switching = Switching::Tanh([c.slope; 2]);
        Ok(EdgeLaw {
            law: Law {
                kind,
                gain: c.k,
                robust_gain: [c.beta; 2],
                switching,
                distance_min,
                heading: Heading::Leader,
            },
            custom: self.from_file.then(|| self.custom()).transpose()?,
            batch: None,
            observer: Observer {
                epsilon: [c.epsilon; 2],
                alpha1: [c.alpha1; 2],
                alpha2: [c.alpha2; 2],
                distance_min,
            },
            tracker: None,
            set_point: SetPointTrajectory::constant(0.0, 0.0),
            free: [false; 2],
            standing: false,
            narrowing: None,
        })
    }

    /// The same law, read from the law file that ships.
    fn custom(&self) -> Outcome<Custom> {
        let c = &self.controller;
        let name = match &*c.kind {
            "FSFB" => "full-state",
            "RSFB" => "robust-state",
            _ => "output-feedback",
        };
        let text = laws::shipped(name).ok_or("no such law")?.text;
        let law = LawFile::compile(text).map_err(|mistakes| format!("{name}: {mistakes:?}"))?;
        let value = |parameter: &laws::Parameter| match &*parameter.name {
            "k1" => Ok(c.k[0]),
            "k2" => Ok(c.k[1]),
            "beta1" | "beta2" => Ok(c.beta),
            "kappa1" | "kappa2" => Ok(c.slope),
            other => Err(format!("unknown parameter {other}")),
        };
        let values = law.declaration().parameters.iter().map(value).collect::<Result<_, _>>()?;
        Ok(Custom::new(Arc::new(law), values))
    }

    fn setup(&self) -> Outcome<Setup> {
        let names: Vec<String> = (0..self.robots.len()).map(|i| i.to_string()).collect();
        let pairs: Vec<(String, String)> =
            self.edges.iter().map(|e| (names[e.leader].clone(), names[e.follower].clone())).collect();
        let graph = Graph::new(&names, &pairs)?;
        let mut laws = Vec::new();
        for edge in &self.edges {
            let waves = edge.modulation.unwrap_or([None, None]);
            let [distance, bearing] = [0, 1].map(|i| course(edge.set_point[i], waves[i]));
            laws.push(EdgeLaw { set_point: SetPointTrajectory { distance, bearing }, ..self.law()? });
        }
        let b = &self.bounds;
        let limits =
            Limits { speed_min: b.v_min, speed_max: b.v_max, turn_rate_max: b.omega_max, ..Limits::PAPER };
        let lead: Arc<dyn Trajectory> = Arc::new(AnalyticTrajectory {
            speed: course(self.lead.v, self.lead.v_wave),
            turn_rate: course(self.lead.omega, self.lead.omega_wave),
        });
        let actor = |(index, r): (usize, &Robot)| RobotSetup {
            robot: Unicycle {
                pose: Pose::new(r.pose[0], r.pose[1], wrap(r.pose[2])),
                speed: r.v,
                limits,
                body: Body::default(),
                lead: (index == 0).then(|| lead.clone()),
            },
            wheels: None,
        };
        let actors = self.robots.iter().enumerate().map(actor).collect();
        let member =
            |(index, name): (usize, &String)| RobotInfo::new(name.clone(), index == 0, Body::default());
        Ok(Setup {
            events: Arc::default(),
            chased: vec![],
            goals: simulation::Goals::default(),
            safety_config: None,
            filters: vec![None; names.len()],
            changes: vec![],
            fleet: FleetInfo {
                duration: self.duration,
                robots: names.iter().enumerate().map(member).collect(),
                edges: graph.edges().to_vec(),
                ..FleetInfo::default()
            },
            sensor_config: None,
            observer_starts: vec![ObserverStart::Measured; self.edges.len()],
            stage: WorldSetup { actors, props: vec![], terrain: None, step: 0.005 },
            stop_at_contact: false,
            formation: Formation::new(
                graph,
                laws,
                vec![limits; names.len()],
                vec![(0, lead.clone())],
                self.period,
            )
            .in_continuous_time(self.mode == "continuous"),
            mode: match &*self.mode {
                "continuous" => TimeMode::Continuous,
                "sampled" => TimeMode::Sampled,
                "measured" => TimeMode::Measured,
                other => return Err(format!("unknown mode {other}").into()),
            },
            period: self.period,
            duration: self.duration,
        })
    }

    /// Largest deviation allowed of poses, speeds and errors.
    fn tolerance(&self) -> f64 {
        match (&*self.mode, &*self.controller.kind) {
            ("continuous", _) => 1e-4,
            (_, "OFB") => 1e-5,
            _ => 1e-6,
        }
    }

    /// Whether a bound of the follower or of a robot up its chain acts on it at this moment.
    fn bounded(&self, record: &StepRecord, follower: usize) -> Vec<bool> {
        let mut flags = vec![];
        let mut at = follower;
        while let Some(edge) = self.edges.iter().find(|e| e.follower == at) {
            let m = &record.snapshot.robots[at].motion;
            flags.push(m.speed <= self.bounds.v_min || m.speed >= self.bounds.v_max);
            flags.push(m.turn_rate.abs() >= self.bounds.omega_max);
            at = edge.leader;
        }
        flags
    }

    /// For every edge and sample: whether a bound became active within 30 ms of it.
    fn near_bounds(&self, records: &[StepRecord]) -> Vec<Vec<bool>> {
        let reach = (0.03 / self.period).round() as usize;
        let edges = self.edges.iter().map(|edge| {
            let flags: Vec<_> = records.iter().map(|m| self.bounded(m, edge.follower)).collect();
            let rises = |k: usize| (0..flags[k].len()).any(|i| flags[k][i] && (k == 0 || !flags[k - 1][i]));
            let rising: Vec<bool> = (0..records.len()).map(rises).collect();
            let near =
                |k: usize| rising[k.saturating_sub(reach)..(k + reach + 1).min(rising.len())].contains(&true);
            (0..records.len()).map(near).collect()
        });
        edges.collect()
    }
}

/// The largest deviation of a group of columns, and where it was.
#[derive(Clone)]
struct Worst {
    size: f64,
    at: String,
}

impl Worst {
    fn none() -> Self {
        Self { size: 0.0, at: "-".into() }
    }

    fn see(&mut self, size: f64, at: impl FnOnce() -> String) {
        if size > self.size || size.is_nan() {
            *self = Self { size, at: at() };
        }
    }
}

struct Deviation {
    states: Worst,
    rates: Worst,
    compared: usize,
}

fn golden(path: &Path) -> Outcome<Vec<Vec<f64>>> {
    let mut reader = csv::Reader::from_path(path)?;
    let rows =
        reader.records().map(|r| r?.iter().map(|x| Ok(x.parse::<f64>()?)).collect::<Outcome<Vec<f64>>>());
    rows.collect()
}

/// All moments of the case.
fn records(case: &Case) -> Outcome<Vec<StepRecord>> {
    let mut run = Simulation::new(case.setup()?);
    let mut records: Vec<StepRecord> = vec![];
    while let Some(record) = run.next_record() {
        records.push(record.clone());
    }
    Ok(records)
}

fn compare(case: &Case, golden: &[Vec<f64>], records: &[StepRecord]) -> Outcome<Deviation> {
    let near = case.near_bounds(records);
    let mut out = Deviation { states: Worst::none(), rates: Worst::none(), compared: 0 };
    for (row, k) in golden.iter().zip((0..).step_by(case.record_every)) {
        let record = records.get(k).ok_or("the run ended before the golden file")?;
        let time = record.snapshot.time;
        if (time - row[0]).abs() > 1e-9 {
            return Err(format!("row {k} is at {} s, expected {time} s", row[0]).into());
        }
        let mut columns = row[1..].iter();
        let mut next = || columns.next().copied().ok_or("the golden file has too few columns");
        for (i, robot) in record.snapshot.robots.iter().enumerate() {
            let m = &robot.motion;
            for (name, ours) in [("x", m.pose.x), ("y", m.pose.y), ("theta", m.pose.heading), ("v", m.speed)]
            {
                let apart = ours - next()?;
                let apart = if name == "theta" { wrap(apart) } else { apart };
                out.states.see(apart.abs(), || format!("{name}{i} at {time:.2} s"));
            }
        }
        // Columns come in the order of the followers' numbers, edges in the order of the case.
        for j in 1..case.robots.len() {
            let index = case.edges.iter().position(|e| e.follower == j).ok_or("a robot without a leader")?;
            let edge = &record.edges[index];
            let (a, w) = (edge.applied.acceleration - next()?, edge.applied.turn_rate - next()?);
            let e = [edge.error[0] - next()?, wrap(edge.error[1] - next()?)];
            let ds = [edge.rates[0] - next()?, edge.rates[1] - next()?];
            for (name, apart) in ["e_l", "e_psi"].into_iter().zip(e) {
                out.states.see(apart.abs(), || format!("{name}{j} at {time:.2} s"));
            }
            if !near[index][k] {
                let observed = case.controller.kind == "OFB";
                for (name, apart) in [("a", a), ("omega", w), ("ds_l", ds[0]), ("ds_psi", ds[1])] {
                    if observed || !name.starts_with("ds") {
                        out.rates.see(apart.abs(), || format!("{name}{j} at {time:.2} s"));
                    }
                }
            }
        }
        out.compared += 1;
    }
    Ok(out)
}

fn folders() -> Vec<PathBuf> {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference");
    std::iter::once(own).chain(std::env::var_os("ECHELON_REFERENCE_DIR").map(PathBuf::from)).collect()
}

fn cases(folder: &Path) -> Outcome<Vec<PathBuf>> {
    let cases = folder.join("cases");
    let entries = fs::read_dir(&cases).map_err(|e| format!("{}: {e}", cases.display()))?;
    let mut paths: Vec<PathBuf> = entries.map(|e| Ok(e?.path())).collect::<Outcome<_>>()?;
    paths.retain(|p| p.extension().is_some_and(|e| e == "json"));
    paths.sort();
    Ok(paths)
}

#[test]
fn every_reference_case_is_reproduced() {
    let mut failures = vec![];
    for folder in folders() {
        let paths = cases(&folder).expect("a folder of reference cases");
        assert!(!paths.is_empty(), "{} holds no cases", folder.display());
        println!("{}: {} cases", folder.display(), paths.len());
        for path in paths {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            for from_file in [false, true] {
                let name = if from_file { format!("{name}, law file") } else { name.clone() };
                if let Err(problem) = check(&folder, &path, &name, from_file) {
                    println!("{name:46} FAILED: {problem}");
                    failures.push(format!("{name}: {problem}"));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} cases failed:\n{}", failures.len(), failures.join("\n"));
}

fn check(folder: &Path, path: &Path, name: &str, from_file: bool) -> Outcome<()> {
    let case = Case { from_file, ..serde_json::from_str(&fs::read_to_string(path)?)? };
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let rows = golden(&folder.join("golden").join(format!("{stem}.csv")))?;
    let found = compare(&case, &rows, &records(&case)?)?;
    report(name, &found);
    if found.compared < 2 || found.compared != rows.len() {
        return Err(format!("only {} of {} rows compared", found.compared, rows.len()).into());
    }
    Ok(case.verdict(&found)?)
}

fn report(name: &str, found: &Deviation) {
    println!(
        "{name:46} {:4} rows   states {:9.2e} ({:20})   inputs and rates {:9.2e} ({})",
        found.compared, found.states.size, found.states.at, found.rates.size, found.rates.at
    );
}

impl Case {
    fn verdict(&self, found: &Deviation) -> Result<(), String> {
        for (worst, allowed) in [(&found.states, self.tolerance()), (&found.rates, 1e-3)] {
            // A deviation that is not a number must not pass.
            if worst.size.is_nan() || worst.size > allowed {
                return Err(format!("{} off by {:.3e}, allowed {allowed:.0e}", worst.at, worst.size));
            }
        }
        Ok(())
    }
}

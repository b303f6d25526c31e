//! A certificate as files: JSON, the quantities of the theorems over time as a table, and figures.

use super::CertifyReport;
use super::pictures;
use super::text::reason;
use crate::failure::Failure;
use crate::replaced::{quoted, write_all};
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use studies::certify::beyond::Beyond;
use studies::certify::chain::LENGTHS;
use studies::certify::{Certificate, Constants, LongestPeriod};
use vocabulary::Word;

/// Writes everything into `folder`; what was there under the same names is replaced.
pub(super) fn write(folder: &Path, report: &CertifyReport<'_>, quiet: bool) -> Result<Vec<PathBuf>, Failure> {
    let mut texts =
        vec![("certificate.json", format!("{:#}\n", as_json(report))), ("certificate.csv", table(report))];
    texts.extend(pictures::figures(report));
    // What an earlier certificate has left is not to be taken for this one's.
    for name in ["certificate.svg", "stability.svg", "reach.svg", "chain.svg"] {
        let path = folder.join(name);
        if path.is_file() && !texts.iter().any(|(other, _)| *other == name) {
            std::fs::remove_file(&path)
                .map_err(|e| Failure::Machine(format!("cannot remove {}: {e}", path.display())))?;
        }
    }
    let texts: Vec<_> = texts.into_iter().map(|(name, text)| (name.to_owned(), text)).collect();
    write_all(folder, &texts, quiet)
}

/// Every number, SI units.
pub(super) fn as_json(report: &CertifyReport<'_>) -> Value {
    let edges: Vec<Value> = report.certificates.iter().map(|c| edge(report, c)).collect();
    json!({
        "title": report.scene.title,
        "law": studies::caption(report.scene),
        "edges": edges,
        "beyond": report.beyond.as_ref().map(|beyond| beyond_json(report, beyond)),
        "wall_seconds": report.wall,
    })
}

fn edge(report: &CertifyReport<'_>, certificate: &Certificate) -> Value {
    let mut value = serde_json::to_value(certificate.metrics(&report.fleet)).unwrap_or_default();
    let witness = &certificate.witness;
    let measured = &certificate.measured;
    value["measured"] = json!({
        "samples": measured.samples, "first": measured.first, "last": measured.last, "largest": measured.largest,
        "falls": measured.falls, "limited": measured.limited, "effort": measured.effort,
    });
    value["law_fault"] = json!(certificate.fault);
    value["zeta_b"] = json!(witness.initial);
    value["final_error"] = json!(certificate.final_error);
    value["error_left_by_tanh"] = json!(certificate.smoothing);
    value["p0"] = json!(witness.layer.map(|l| rows(&l.matrix)));
    value["constants"] = json!(certificate.constants.map(|c| constants(&c, report.bound)));
    value
}

fn rows(matrix: &impl std::ops::Index<(usize, usize), Output = f64>) -> Vec<Vec<f64>> {
    (0..4).map(|i| (0..4).map(|j| matrix[(i, j)]).collect()).collect()
}

fn constants(c: &Constants, bound: Option<f64>) -> Value {
    json!({
        "lambda_min_p0": c.least, "norm_p0": c.norm, "sigma_s": c.sigma_s, "sigma_v": c.sigma_v,
        "sigma_1": c.sigma_1, "rho": c.rho, "l1": c.l1, "mu": c.mu, "epsilon": c.epsilon,
        "epsilon_1": c.epsilon_1, "c3": c.c3, "mu_1": c.mu_1, "mu_2": c.mu_2, "t_epsilon": c.t_epsilon,
        "trap": c.trap, "ultimate_filtered_error": c.filtered, "ultimate_error": c.error,
        "delta_0": c.delta_0,
        "wanted": bound.map(|b| json!({ "error": b, "epsilon_most": c.epsilon_for(b), "if": "the premises of eqs 51-53 are met" })),
    })
}

fn beyond_json(report: &CertifyReport<'_>, beyond: &Beyond) -> Value {
    let sensitivity = match &beyond.sensitivities {
        Err(why) => json!({ "left_out": why }),
        Ok(found) => {
            let gains = found.gains.iter().map(|g| json!({ "gain": g.gain.symbol(), "edges": g.edges }));
            json!({ "settled_error": found.settled, "gains": gains.collect::<Vec<_>>() })
        }
    };
    let reach = beyond.reach.iter().map(|reach| {
        let rays = reach.rays.iter().map(|ray| {
            json!({ "bearing": ray.bearing, "distance": ray.distance, "end": ray.end.map(reason) })
        });
        json!({
            "edge": report.edge(reach.edge), "set_point": reach.set_point, "refused": reach.refused.map(reason),
            "looked_to": reach.far, "rays": rays.collect::<Vec<_>>(),
        })
    });
    let chart = beyond.chart.as_ref().map(|chart| {
        let borders = chart.borders.iter().map(|(how, border)| {
            let longest = border.iter().map(|longest| match longest {
                LongestPeriod::Below => json!(0.0),
                LongestPeriod::At(period) => json!(period),
                LongestPeriod::Beyond => Value::Null,
            });
            json!({
                "discretisation": how.word(),
                "longest_period": longest.collect::<Vec<_>>(),
                "growth": chart.channel.growth(*how, chart.epsilon, chart.period),
                "reported_rate": chart.channel.reported_rate(*how, chart.epsilon, chart.period),
            })
        });
        json!({
            "follower": chart.follower, "epsilon": chart.epsilon, "period": chart.period,
            "epsilons": chart.epsilons, "borders": borders.collect::<Vec<_>>(),
        })
    });
    let chain = beyond.chain.iter().map(|gain| {
        let edge = report.edge(gain.edge);
        json!({ "edge": edge, "depth": gain.depth, "stable": gain.stable, "curve": gain.curve })
    });
    json!({
        "sensitivity": sensitivity,
        "reach": reach.collect::<Vec<_>>(),
        "stability": chart,
        "chain": { "lengths": LENGTHS, "edges": chain.collect::<Vec<_>>() },
    })
}

/// A row for every edge and sample.
fn table(report: &CertifyReport<'_>) -> String {
    let mut text = String::from(
        "leader,follower,time_s,error,error_rate,filtered_error,leader_effect,leader_effect_rate,beta_margin,p,v,\
         observer_error,w\n",
    );
    for certificate in &report.certificates {
        let edge = certificate.metrics(&report.fleet);
        let head = format!("{},{}", quoted(&edge.leader), quoted(&edge.follower));
        for r in certificate.witness.rows() {
            let own = [r.time, r.error, r.error_rate, r.filtered, r.effect, r.effect_rate];
            let proof = [r.margin, r.p, r.v, r.observer_error, r.w];
            let numbers = own.iter().chain(&proof).map(f64::to_string);
            // Writing to a text cannot fail.
            let _ = writeln!(text, "{head},{}", numbers.collect::<Vec<_>>().join(","));
        }
    }
    text
}

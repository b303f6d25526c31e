//! A custom law that broke off, in words.

use metrics::LawFaultMetrics;
use scene::Scene;

/// Whose law broke off, when, where in its text and why: "follower-2, t = 3.41 s (sample 341), mine.law:27:12: …".
pub fn law_fault_words(scene: &Scene, fault: &LawFaultMetrics) -> String {
    let LawFaultMetrics { robot, time, sample, fault } = fault;
    let last = scene.changes.iter().rfind(|change| change.at <= time + 1e-9);
    let then = last.map_or(scene, |change| &change.then);
    let follow = then.followers().find(|(name, _)| name == robot).map(|(_, follow)| follow);
    let law = follow.and_then(|follow| follow.law.custom()).map_or("its law", |law| law.name());
    let mark = if fault.starts_with(|c: char| c.is_ascii_digit()) { ":" } else { ": " };
    format!("{robot}, t = {time:.2} s (sample {sample}), {law}{mark}{fault}")
}

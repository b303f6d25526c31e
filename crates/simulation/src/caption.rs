//! A scene's laws in one line, for pictures and reports.

use scene::{Follow, Scene, SensingKind, SwitchingKind};
use vocabulary::{HeadingReference, LawKind, ObserverKind, TimeMode, counted};

/// Law, gains and timing of a scene in one line; ranges where gains of followers differ, "mixed" where their laws do.
pub fn caption(scene: &Scene) -> String {
    let all: Vec<&Follow> = scene.followers().map(|(_, follow)| follow).collect();
    if all.is_empty() {
        return "No followers".to_owned();
    }
    let mut parts = vec![common(&all, law).unwrap_or_else(|| "Mixed laws".to_owned())];
    // Where laws are mixed, their parameters would be anybody's.
    if let Some(Some(custom)) = common(&all, |follow| follow.law.custom().cloned()) {
        parts.extend(parameters(all[0], &all));
        if custom.declaration().parameters.len() > PARAMETERS {
            parts.push("…".to_owned());
        }
    }
    let built_in: Vec<_> = all.iter().copied().filter(|follow| follow.law.custom().is_none()).collect();
    if !built_in.is_empty() {
        parts.push(format!("K {}", range(&built_in, |follow| follow.law.k)));
    }
    let robust: Vec<_> =
        built_in.into_iter().filter(|follow| follow.law.kind != LawKind::FullState).collect();
    if !robust.is_empty() {
        parts.push(format!("β {}", range(&robust, |follow| follow.law.beta)));
        parts.push(match common(&robust, |follow| follow.law.switching) {
            Some(SwitchingKind::Tanh) => format!("tanh slope {}", range(&robust, |follow| follow.law.slope)),
            Some(SwitchingKind::Sign) => "sign".to_owned(),
            None => "tanh or sign".to_owned(),
        });
    }
    let path = |follow: &Follow| follow.law.heading == HeadingReference::Path;
    let filtered: Vec<_> = all.iter().copied().filter(|follow| path(follow)).collect();
    if !filtered.is_empty() {
        let [length, lag] = [
            range(&filtered, |follow| [follow.law.heading_length; 2]),
            range(&filtered, |follow| [follow.law.heading_lag; 2]),
        ];
        let some = if filtered.len() < all.len() { "some by " } else { "" };
        parts.push(format!("{some}path heading, λ {length} m, τ {lag} m"));
    }
    match all.iter().filter(|follow| follow.law.standing).count() {
        0 => {}
        count if count == all.len() => parts.push("standing".to_owned()),
        count => parts.push(format!("{count} of {} standing", all.len())),
    }
    let observed: Vec<_> = all.iter().copied().filter(|follow| observer(follow).is_some()).collect();
    match common(&observed, observer) {
        Some(Some(ObserverWords::Epsilon)) => {
            parts.push(format!("ε {} s", range(&observed, |follow| follow.observer.epsilon)));
        }
        Some(Some(ObserverWords::Noise)) => parts.push("ε from noise".to_owned()),
        Some(Some(ObserverWords::Unscented)) => parts.push("dual unscented filter".to_owned()),
        Some(None) => {}
        None if observed.is_empty() => {}
        None => parts.push("mixed observers".to_owned()),
    }
    let measuring: Vec<_> = all.iter().copied().filter(|follow| measures(follow)).collect();
    if !measuring.is_empty() {
        let rate = range(&measuring, |follow| [follow.sensing.rate; 2]);
        parts.push(match common(&all, |follow| follow.sensing.kind) {
            Some(SensingKind::Noise) => format!("{} a second", counted(rate, "noisy measurement")),
            Some(SensingKind::Geometric) => format!("{} of tags a second", counted(rate, "measurement")),
            Some(SensingKind::Camera) => format!("{} a second", counted(rate, "picture")),
            Some(SensingKind::Truth) | None => {
                format!("mixed sensing, {} a second", counted(rate, "measurement"))
            }
        });
    }
    let every = format!("every {} ms", short(scene.time.period * 1e3));
    parts.push(match scene.time.mode {
        _ if !measuring.is_empty() => every,
        TimeMode::Continuous => "continuous time".to_owned(),
        TimeMode::Sampled => every,
        TimeMode::Measured => format!("{every}, sampled measurement"),
    });
    if !scene.changes.is_empty() {
        parts.push(counted(scene.changes.len(), "change"));
    }
    parts.join(" · ")
}

fn law(follow: &Follow) -> String {
    match (follow.law.custom(), follow.law.kind) {
        (Some(law), _) if law.declaration().title.is_empty() => law.name().to_owned(),
        (Some(law), _) => law.declaration().title.clone(),
        (None, LawKind::FullState) => "Full state feedback".to_owned(),
        (None, LawKind::RobustState) => "Robust state feedback".to_owned(),
        (None, LawKind::OutputFeedback) => "Output feedback".to_owned(),
    }
}

/// Most parameters of a custom law that a caption has room for.
const PARAMETERS: usize = 4;

/// The first parameters of a law that all of these followers have.
fn parameters<'a>(law: &'a Follow, all: &'a [&Follow]) -> impl Iterator<Item = String> {
    let declared = law.law.custom().map_or(&[][..], |law| &law.declaration().parameters);
    declared.iter().take(PARAMETERS).enumerate().map(|(index, parameter)| {
        let value = range(all, |follow| [follow.law.values()[index]; 2]);
        format!("{} {value}{}", parameter.symbol, parameter.behind())
    })
}

fn measures(follow: &Follow) -> bool {
    follow.sensing.kind != SensingKind::Truth
}

/// How the caption describes an observer.
#[derive(Clone, Copy, PartialEq)]
enum ObserverWords {
    Epsilon,
    Noise,
    Unscented,
}

fn observer(follow: &Follow) -> Option<ObserverWords> {
    if measures(follow) && follow.observer.kind == ObserverKind::Unscented {
        Some(ObserverWords::Unscented)
    } else if measures(follow) && follow.observer.adaptive {
        Some(ObserverWords::Noise)
    } else {
        follow.law.observes().then_some(ObserverWords::Epsilon)
    }
}

/// The value that all followers have, if they have one.
fn common<T: PartialEq>(all: &[&Follow], value: impl Fn(&Follow) -> T) -> Option<T> {
    let mut values = all.iter().map(|follow| value(follow));
    let first = values.next()?;
    values.all(|other| other == first).then_some(first)
}

/// Two values of every follower: one where they are the same, from the smallest to the largest where followers differ.
fn range(all: &[&Follow], value: impl Fn(&Follow) -> [f64; 2]) -> String {
    let [first, second] = [0, 1].map(|k| {
        let values = || all.iter().map(|follow| value(follow)[k]);
        let (low, high) =
            (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        if low == high { short(low) } else { format!("{} to {}", short(low), short(high)) }
    });
    if first == second { first } else { format!("({first}, {second})") }
}

/// A number to six significant digits, without those that come from arithmetic only.
pub fn short(value: f64) -> String {
    format!("{value:.5e}").parse::<f64>().unwrap_or(value).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn told(sets: &[&str]) -> String {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/line-three.toml");
        let sets: Vec<_> = sets.iter().map(|set| set.parse().expect("an override")).collect();
        caption(&Scene::load(path, &sets).expect("a scene").scene)
    }

    #[test]
    fn gains_that_differ_are_told_as_ranges() {
        let plain = told(&[]);
        assert_eq!(plain, "Output feedback · K 5 · β 5 · tanh slope 24.53 · ε 0.001 s · every 10 ms");
        // The first follower alone does not stand for all.
        let one = told(&["robots.follower-2.law.k=3", "robots.follower-2.observer.epsilon=0.002"]);
        assert_eq!(
            one,
            "Output feedback · K 3 to 5 · β 5 · tanh slope 24.53 · ε 0.001 to 0.002 s · every 10 ms"
        );
        let both = told(&["robots.follower-2.law.k=[3, 4]"]);
        assert!(both.contains("K (3 to 5, 4 to 5)"), "{both}");
        let laws = told(&["robots.follower-2.law.kind=full-state"]);
        assert!(laws.starts_with("Mixed laws · K 5 · β 5 ·"), "{laws}");
        let custom = told(&["law.file=integral", "robots.follower-2.law.parameters.T=3"]);
        let title = "Output feedback with an integral of the error";
        assert!(custom.starts_with(&format!("{title} · k₁ 5 1/s · k₂ 5 1/s · T 1 to 3 s · ε")), "{custom}");
        let one = told(&["robots.follower-2.law.file=integral"]);
        assert!(one.starts_with("Mixed laws · K 5 · β 5 ·"), "{one}");
        let path = ["law.heading=path", "law.heading_lag=0.5", "robots.follower-2.law.heading_lag=1"];
        let behind = told(&path);
        assert!(behind.contains(" · path heading, λ 1 m, τ 0.5 to 1 m · ε"), "{behind}");
        let stands = told(&[path[0], path[1], path[2], "robots.follower-1.law.standing=true"]);
        assert!(stands.contains("τ 0.5 to 1 m · 1 of 2 standing · ε"), "{stands}");
        let sees = told(&["robots.follower-2.sensing.kind=geometric"]);
        assert!(sees.contains("mixed sensing"), "{sees}");
    }
}

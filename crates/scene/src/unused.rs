//! What a scene gives its followers that their custom law does not use.

use crate::types::{Follow, Law, Robot, Scene, VehicleKind, WrittenLaw};
use laws::InputKind;

/// What followers are given that their custom law does not use, in words.
pub(crate) fn unused(scene: &Scene) -> Vec<String> {
    let mut words: Vec<String> = vec![];
    for Robot { name, vehicle, role, .. } in &scene.robots {
        let Some((follow, law)) = role.follow().and_then(|follow| Some((follow, follow.law.custom()?)))
        else {
            continue;
        };
        let gains = unused_gains(&follow.law, vehicle.kind, law);
        for word in gains.into_iter().chain(unread_set_points(name, follow, law)) {
            // Followers of one kind are told once.
            if !words.contains(&word) {
                words.push(word);
            }
        }
    }
    words
}

/// Gains of the built-in laws that differ from those that fit the vehicle, so somebody has set them.
fn unused_gains(law: &Law, vehicle: VehicleKind, custom: &WrittenLaw) -> Option<String> {
    let usual = Law::fitting(vehicle);
    let gains = [
        ("k", law.k != usual.k),
        ("beta", law.beta != usual.beta),
        ("slope", law.slope != usual.slope),
        ("switching", law.switching != usual.switching),
    ];
    let set: Vec<&str> = gains.iter().filter(|(_, is_set)| *is_set).map(|(key, _)| *key).collect();
    let quoted: Vec<String> = set.iter().map(|key| format!("`law.{key}`")).collect();
    let is = match &quoted[..] {
        [] => return None,
        [_] => "is",
        _ => "are",
    };
    let declared = &custom.declaration().parameters;
    let own: Vec<String> = declared
        .iter()
        .filter(|parameter| set.contains(&parameter.name.as_str()))
        .map(|parameter| format!("`law.parameters.{}`", parameter.name))
        .collect();
    let hint = match (&own[..], declared.is_empty()) {
        ([], true) => "it has no parameters".to_owned(),
        ([], false) => "its own parameters are in `law.parameters`".to_owned(),
        (own, _) => format!("its own: {}", own.join(", ")),
    };
    let name = custom.name();
    Some(format!("{} {is} for the built-in laws; {name} does not use them: {hint}", quoted.join(", ")))
}

/// Distances and bearings that are given and that the law reads nothing of.
fn unread_set_points(name: &str, follow: &Follow, custom: &WrittenLaw) -> Vec<String> {
    let reads = &custom.declaration().reads;
    let is_read = |leader: usize, part: usize| {
        reads.iter().any(|(of, kind): &(usize, InputKind)| *of == leader && kind.wanted() == Some(part))
    };
    let mut words = vec![];
    for (index, leader) in follow.leaders.iter().enumerate() {
        for (part, what, is_given) in
            [(0, "distance", leader.distance.is_some()), (1, "bearing", leader.bearing.is_some())]
        {
            if is_given && !is_read(index, part) {
                words.push(format!(
                    "`{name}` is given a {what} to `{}`, which {} does not read",
                    leader.name,
                    custom.name()
                ));
            }
        }
    }
    words
}

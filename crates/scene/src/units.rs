//! Units of keys, as their forms have them.

use serde_json::Value as Json;
use std::sync::LazyLock;

static SCHEMA: LazyLock<Json> = LazyLock::new(crate::schema);

/// The unit of the number that a key such as `law.k` or `robots.follower-1.distance` takes; `None` for pure numbers, for what is
/// no number, and for keys that are not known.
pub fn unit(key: &str) -> Option<String> {
    let mut found = vec![&*SCHEMA];
    for part in key.split('.') {
        found = found.into_iter().flat_map(options).filter_map(|option| below(option, part)).collect();
    }
    let units = found.into_iter().flat_map(options).filter_map(|option| option["x-unit"].as_str());
    units.into_iter().next().map(str::to_owned)
}

/// A schema and all that it leaves the choice of.
fn options(schema: &Json) -> Vec<&Json> {
    let choices = ["anyOf", "oneOf"].into_iter().filter_map(|key| schema[key].as_array()).flatten();
    std::iter::once(schema).chain(choices.flat_map(options)).collect()
}

/// The schema of a key of a table, or of an entry of a list, whatever it is called.
fn below<'a>(schema: &'a Json, part: &str) -> Option<&'a Json> {
    schema["properties"].get(part).or_else(|| schema.get("items"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_those_of_the_forms() {
        for (key, wanted) in [
            ("time.period", Some("s")),
            ("law.k", Some("1/s")),
            ("observer.epsilon", Some("s")),
            ("robots.follower-1.distance", Some("m")),
            ("robots.follower-1.bearing", Some("rad")),
            ("robots.leader.path.speed", Some("m/s")),
            ("sensing.distance_noise", Some("m")),
            ("sensing.drop", None),
            ("vehicle.kind", None),
            ("nobody.knows", None),
        ] {
            assert_eq!(unit(key).as_deref(), wanted, "{key}");
        }
    }
}

//! How a vehicle is written, made complete, and held against itself and the step of the physics.

use crate::text::words::word;
use crate::{
    Vehicle, VehicleKind,
    text::{Form, Found, Keys, Node, Part, Reporter, Span, keys::Mark, table, words::quoted},
    types::VehiclePart,
};
use serde::{Serializer, ser};
use serde_json::{Value as Json, json};
use vocabulary::{GRAVITY, Word};

/// Whether `key` means something for vehicles of `kind`.
pub(crate) fn applies(key: &str, kind: VehicleKind) -> bool {
    VehiclePart::marks(key).is_some_and(|marks| {
        marks.iter().all(|mark| match mark {
            Mark::Wheels => kind.has_wheels(),
            Mark::Steered => kind.steers(),
            Mark::Live | Mark::Apart => true,
        })
    })
}

/// A vehicle: the word of a kind, or a table.
pub(crate) struct VehicleForm;

impl Form for VehicleForm {
    type Out = VehiclePart;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<VehiclePart> {
        if node.as_text().is_none() {
            let part = table::<VehiclePart>().read(node, reporter)?;
            // Of a kind that is none nothing can be said, as that a key has no effect on it.
            return (part.kind.is_some() || node.get("kind").is_none()).then_some(part);
        }
        let value = word::<VehicleKind>().read(node, reporter)?;
        Some(VehiclePart { kind: Some(Found { span: node.span, value }), ..VehiclePart::default() })
    }

    /// The defaults depend on the kind, so the description lists them.
    fn schema(&self) -> Json {
        let mut schema = table::<VehiclePart>().schema();
        let made = VehicleKind::ALL
            .map(|kind| (kind, serde_json::to_value(Vehicle::ready_made(kind)).unwrap_or_default()));
        for (key, property) in schema["properties"].as_object_mut().into_iter().flatten() {
            if key == "kind" {
                continue;
            }
            if let Some(property) = property.as_object_mut() {
                property.remove("default");
            }
            let values = made.iter().filter(|(kind, _)| applies(key, *kind)).map(|(kind, values)| {
                // JSON has no infinity.
                let value = if values[key].is_null() { "inf".to_owned() } else { values[key].to_string() };
                format!("{} {value}", kind.word())
            });
            let values = values.collect::<Vec<_>>().join(", ");
            let about = property["description"].as_str().unwrap_or_default();
            property["description"] = json!(format!("{about} Default: {values}."));
        }
        json!({ "anyOf": [word::<VehicleKind>().schema(), schema] })
    }
}

/// Writes the keys that mean something for the vehicle's kind, in their order.
pub(crate) fn written<S: Serializer>(vehicle: &Vehicle, serializer: S) -> Result<S::Ok, S::Error> {
    let values = toml::Table::try_from(vehicle).map_err(ser::Error::custom)?;
    let keys = VehiclePart::fields().into_iter().map(|field| field.key);
    serializer.collect_map(
        keys.filter(|key| applies(key, vehicle.kind)).filter_map(|key| Some((key, values.get(key)?))),
    )
}

/// Where a robot's vehicle is written, and what it is driven by.
pub(crate) struct WrittenVehicle<'a> {
    /// The robot's or group's own `vehicle`.
    pub(crate) own: &'a VehiclePart,
    /// The scene's `vehicle`, which holds for all robots.
    pub(crate) scene: &'a VehiclePart,
    /// Step of the physics, s.
    pub(crate) step: f64,
    /// Where that is said, or the robot where it is not.
    pub(crate) span: Span,
}

/// The vehicle that is written, after reporting values that contradict each other.
pub(crate) fn vehicle(written: &WrittenVehicle<'_>, reporter: &mut Reporter) -> Vehicle {
    let nothing = VehiclePart::default();
    let usual = usual_kind(written.scene);
    let kind = written.own.kind.as_ref().map_or(usual, |found| found.value);
    check_meaning(written.own, kind, reporter);
    let scene = if kind == usual { written.scene } else { &nothing };
    let vehicle = written.own.complete_with(scene, Vehicle::ready_made(kind));
    let check = Check { written: &WrittenVehicle { scene, ..*written }, vehicle };
    check.run(reporter);
    vehicle
}

/// The kind of robots that name none, where `scene` is the scene's `vehicle`.
pub(crate) fn usual_kind(scene: &VehiclePart) -> VehicleKind {
    scene.kind.as_ref().map_or(VehicleKind::Unicycle, |found| found.value)
}

/// Reports keys of `part` that mean nothing for vehicles of `kind`.
pub(crate) fn check_meaning(part: &VehiclePart, kind: VehicleKind, reporter: &mut Reporter) {
    for (key, span) in part.spans().into_iter().filter(|(key, _)| !applies(key, kind)) {
        let others = VehicleKind::ALL.into_iter().filter(|other| applies(key, *other));
        let others = quoted(others.map(Word::word));
        let kind = kind.word();
        reporter
            .report(span, format!("`{key}` has no effect on a vehicle of kind `{kind}`; it is for {others}"));
    }
}

/// Whether the vehicle at `node`, read as `part`, is of a kind that is none. That is reported already, and nothing that depends
/// on the kind can be said.
pub(crate) fn kind_is_lost(node: Option<&Node>, part: Option<&Found<VehiclePart>>) -> bool {
    let named = node.is_some_and(|node| node.as_text().is_some() || node.get("kind").is_some());
    named && part.is_none_or(|part| part.value.kind.is_none())
}

/// A vehicle under inspection.
struct Check<'a> {
    written: &'a WrittenVehicle<'a>,
    vehicle: Vehicle,
}

impl Check<'_> {
    fn run(&self, reporter: &mut Reporter) {
        let Vehicle { speed_min, speed_max, .. } = self.vehicle;
        if speed_min >= speed_max {
            let message =
                format!("`speed_min` of {speed_min} m/s must be below `speed_max` of {speed_max} m/s");
            self.report(&["speed_max", "speed_min"], message, reporter);
        }
        if self.vehicle.kind.has_wheels() {
            self.measures(reporter);
            self.springs(reporter);
            self.step(reporter);
        }
    }

    /// Reports `message` at the first of `keys` that is written.
    fn report(&self, keys: &[&str], message: String, reporter: &mut Reporter) {
        let WrittenVehicle { own, scene, span, .. } = *self.written;
        let find = |key: &&str| own.span_of(key).or_else(|| scene.span_of(key));
        reporter.report(keys.iter().find_map(find).unwrap_or(span), message);
    }

    fn measures(&self, reporter: &mut Reporter) {
        let Vehicle { length, width, height, wheelbase, track, wheel_radius, .. } = self.vehicle;
        let Vehicle { mass_height, clearance, .. } = self.vehicle;
        if wheel_radius >= height {
            let message = format!(
                "the middle of a wheel of `wheel_radius` {wheel_radius} m must lie below the roof, `height` of {height} m"
            );
            self.report(&["wheel_radius", "height"], message, reporter);
        } else if 2.0 * wheel_radius >= wheelbase {
            let message = format!(
                "front and rear wheels of `wheel_radius` {wheel_radius} m overlap: below half the `wheelbase` of {wheelbase} m"
            );
            self.report(&["wheel_radius", "wheelbase"], message, reporter);
        }
        if clearance >= height {
            let message = format!("`clearance` of {clearance} m must be below `height` of {height} m");
            self.report(&["clearance", "height"], message, reporter);
        }
        if mass_height > height {
            let message = format!("`mass_height` of {mass_height} m must be at most `height` of {height} m");
            self.report(&["mass_height", "height"], message, reporter);
        }
        if wheelbase > 1.2 * length {
            let message = format!(
                "`wheelbase` of {wheelbase} m is too large for a `length` of {length} m: at most 1.2 of it"
            );
            self.report(&["wheelbase", "length"], message, reporter);
        }
        if track > 1.5 * width {
            let message =
                format!("`track` of {track} m is too large for a `width` of {width} m: at most 1.5 of it");
            self.report(&["track", "width"], message, reporter);
        }
    }

    fn springs(&self, reporter: &mut Reporter) {
        let Vehicle { mass, spring, travel, .. } = self.vehicle;
        let sag = mass * GRAVITY / 4.0 / spring;
        if sag >= 5.0 * travel {
            let least = mass * GRAVITY / 4.0 / (5.0 * travel);
            let message = format!(
                "springs of {spring} N/m do not carry {mass} kg: they sag by {sag:.3} m, with a `travel` of {travel} m; \
                 stiffer than {least:.0} N/m"
            );
            self.report(&["spring", "mass", "travel"], message, reporter);
        }
    }

    fn step(&self, reporter: &mut Reporter) {
        let Vehicle { mass, spring, damping, speed_max, width, .. } = self.vehicle;
        let step = self.written.step;
        // Explicit integration of the springs: both products have to stay below 1.
        let frequency = (4.0 * spring / mass).sqrt();
        if frequency * step >= 1.0 {
            let message = format!(
                "the springs are too stiff for a physics step of {step} s: softer than {:.0} N/m, or a step below {:.2e} s",
                0.25 * mass / (step * step),
                1.0 / frequency
            );
            self.report(&["spring", "mass"], message, reporter);
        }
        let rate = 4.0 * damping / mass;
        if rate * step >= 1.0 {
            let message = format!(
                "the dampers are too stiff for a physics step of {step} s: softer than {:.1} N s/m, or a step below {:.2e} s",
                0.25 * mass / step,
                1.0 / rate
            );
            self.report(&["damping", "mass"], message, reporter);
        }
        if speed_max * step > 0.5 * width {
            let message = format!(
                "at `speed_max` of {speed_max} m/s the vehicle moves more than half its `width` of {width} m in a \
                 physics step of {step} s: slower than {:.1} m/s, or a step below {:.2e} s",
                0.5 * width / step,
                0.5 * width / speed_max
            );
            self.report(&["speed_max", "width"], message, reporter);
        }
    }
}

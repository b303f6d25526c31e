//! What pictures need beyond the robots.

use crate::text::{Form, Node, Reporter, angle, angle_within, number, settings, words::not_a_word};
use serde_json::{Value as Json, json};
use std::f64::consts::{FRAC_PI_2, PI};
use vocabulary::Light;

settings! {
    /// Light and air.
    #[derive(Copy)]
    pub struct Environment from EnvironmentPart {
        /// Height of the sun over the horizon, rad or "38 deg".
        pub sun_elevation: f64 = Light::default().sun_elevation, angle_within(PI / 180.0, FRAC_PI_2);
        /// Direction to the sun, rad or "60 deg", counter-clockwise from the world's x axis.
        pub sun_azimuth: f64 = Light::default().sun_azimuth, angle();
        /// Distance at which haze sets in, m.
        pub haze_from: f64 = Light::default().haze_from, number("m").above(0.0);
    }
}

settings! {
    /// How pictures look at the run.
    pub struct Views from ViewsPart {
        /// View used where the command line names none: `snake`, `snake-eye`, `top`, `orbit`, `fixed`,
        /// `follow:<robot>` or `camera:<robot>`.
        pub default: String = "snake".to_owned(), ViewForm;
    }
}

/// Views that need no robot's name.
const VIEWS: [&str; 5] = ["snake", "snake-eye", "top", "orbit", "fixed"];
/// What stands before the name of a robot in the views that go with one.
pub(crate) const ROBOT_VIEWS: [&str; 2] = ["follow:", "camera:"];

/// The name of a view.
pub(super) struct ViewForm;

impl Form for ViewForm {
    type Out = String;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<String> {
        let name = node
            .as_text()
            .filter(|name| VIEWS.contains(name) || ROBOT_VIEWS.iter().any(|v| name.starts_with(v)));
        if name.is_none() {
            not_a_word(node, VIEWS.into_iter().chain(["follow:<robot>", "camera:<robot>"]), reporter);
        }
        name.map(str::to_owned)
    }

    fn schema(&self) -> Json {
        json!({ "anyOf": [{ "enum": VIEWS }, { "type": "string", "pattern": format!("^({}).+$", ROBOT_VIEWS.join("|")) }] })
    }
}

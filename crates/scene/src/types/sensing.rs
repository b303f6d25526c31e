//! What robots know of their leaders, and the cameras and shells they know it by.

use crate::text::words::word;
use crate::text::{
    Couple, Flag, Form, Found, Node, Optional, Reporter, angle, angle_within, form::Number, integer, number,
    settings, table,
};
use serde_json::{Value as Json, json};
use std::f64::consts::PI;
use vocabulary::words;

/// rad.
const DEGREE: f64 = PI / 180.0;

settings! {
    /// How a follower senses its leader. The word of a kind alone stands for `{ kind = … }`. Every kind but `truth`
    /// measures `rate` times a second, and the follower's estimator carries on in between.
    #[derive(Copy)]
    pub struct Sensing from SensingPart {
        /// Where observations come from.
        pub kind: SensingKind = SensingKind::Truth, word::<SensingKind>();
        /// Measurements a second; need not fit the control period.
        pub rate: f64 = 30.0, number("1/s").from(0.1).up_to(1000.0);
        /// Time from a measurement until the follower has it, s.
        pub latency: f64 = 0.01, number("s").from(0.0).up_to(1.0);
        /// Share of the measurements that never arrive.
        pub drop: f64 = 0.0, number("").from(0.0).up_to(1.0);
        /// Time without a measurement after which the leader counts as lost, s: the follower slows down and searches.
        pub hold: f64 = 0.5, number("s").above(0.0).up_to(60.0);
        /// Kind `noise`: standard deviation of the distance, m.
        pub distance_noise: f64 = 0.002, number("m").from(0.0).up_to(10.0);
        /// Kind `noise`: standard deviation of the bearing.
        pub bearing_noise: f64 = 0.45 * DEGREE, angle_within(0.0, PI);
        /// Kind `noise`: standard deviation of the view angle.
        pub view_noise: f64 = 0.03 * DEGREE, angle_within(0.0, PI);
        /// Kind `noise`: constant error of the distance, m.
        pub distance_bias: f64 = 0.0, number("m").from(-10.0).up_to(10.0);
        /// Kind `noise`: constant error of the bearing.
        pub bearing_bias: f64 = 0.0, angle();
        /// Kind `noise`: constant error of the view angle.
        pub view_bias: f64 = 0.0, angle();
        /// Kind `noise`: time over which errors are alike, s; 0 makes those of every measurement its own.
        pub correlation: f64 = 0.0, number("s").from(0.0).up_to(1000.0);
        /// Kind `geometric`: standard deviation of each coordinate of a tag's corner, pixels.
        pub pixel_noise: f64 = 0.1, number("px").from(0.0).up_to(50.0);
        /// Kinds `geometric` and `camera`: how far bodies are expected to tilt against each other, standard deviation;
        /// if left out 0 for unicycles on level ground and 2 deg for all others.
        pub tilt: Option<f64> = None, Optional(angle_within(0.0, 0.5));
    }
}

words! {
    /// Where observations come from.
    pub enum SensingKind {
        /// The true relative position at every instant, without noise or delay.
        Truth = "truth",
        /// The truth with errors.
        Noise = "noise",
        /// Corners of the tags on the leader's shell as a camera would see them, with errors; the pose from those
        /// corners. Nothing is drawn.
        Geometric = "geometric",
        /// Pictures of the follower's own camera, drawn; tags found in them, and the pose from their corners.
        Camera = "camera",
    }
}

impl SensingKind {
    /// Whether it goes by the tags on the leader's shell.
    pub fn needs_tags(self) -> bool {
        matches!(self, Self::Geometric | Self::Camera)
    }
}

/// Sensing: the word of a kind, or a table.
pub(crate) struct SensingForm;

impl Form for SensingForm {
    type Out = SensingPart;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<SensingPart> {
        if node.as_text().is_none() {
            return table::<SensingPart>().read(node, reporter);
        }
        let value = word::<SensingKind>().read(node, reporter)?;
        Some(SensingPart { kind: Some(Found { span: node.span, value }), ..SensingPart::default() })
    }

    fn schema(&self) -> Json {
        json!({ "anyOf": [word::<SensingKind>().schema(), table::<SensingPart>().schema()] })
    }
}

/// A coefficient of distortion.
const COEFFICIENT: Number = number("").from(-10.0).up_to(10.0);

settings! {
    /// Cameras and shells of all robots.
    #[derive(Copy)]
    pub struct Vision from VisionPart {
        /// [width, height] of the pictures, pixels.
        pub resolution: [u32; 2] = [640, 480], Couple(integer::<u32>(32, 4096), integer::<u32>(32, 4096));
        /// Across the picture, from 5 deg to 150 deg.
        pub field_of_view: f64 = 50.0 * DEGREE, angle_within(5.0 * DEGREE, 150.0 * DEGREE);
        /// Radial distortion k1 of Brown and Conrady.
        pub k1: f64 = 0.0, COEFFICIENT;
        /// Radial distortion k2.
        pub k2: f64 = 0.0, COEFFICIENT;
        /// Radial distortion k3.
        pub k3: f64 = 0.0, COEFFICIENT;
        /// Tangential distortion p1.
        pub p1: f64 = 0.0, COEFFICIENT;
        /// Tangential distortion p2.
        pub p2: f64 = 0.0, COEFFICIENT;
        /// Standard deviation of the blur, pixels.
        pub blur: f64 = 0.7, number("px").from(0.0).up_to(20.0);
        /// Standard deviation of a pixel's noise, share of full scale.
        pub noise: f64 = 3.0 / 255.0, number("").from(0.0).up_to(1.0);
        /// Factor on the light; 1 shows white paper in the sun at about 0.85 of full scale.
        pub exposure: f64 = 1.0, number("").above(0.0).up_to(1000.0);
        /// Time over which a picture gathers light, s: what moves is smeared; 0 freezes it.
        pub shutter: f64 = 0.0, number("s").from(0.0).up_to(0.1);
        /// Fastest turn of a camera on its mast, rad/s.
        pub pan_rate: f64 = 2.0 * PI, number("rad/s").above(0.0).up_to(1000.0);
        /// Farthest a camera turns from straight ahead.
        pub pan_max: f64 = 170.0 * DEGREE, angle_within(0.0, PI);
        /// Camera ahead of the robot's reference point, m; over the front of its shell if left out.
        pub camera_forward: Option<f64> = None, Optional(number("m").from(-100.0).up_to(100.0));
        /// Camera over the ground, m; over its shell if left out.
        pub camera_height: Option<f64> = None, Optional(number("m").above(0.0).up_to(100.0));
        /// Shells are this many times as large as those that fit the vehicles.
        pub shell_scale: f64 = 1.0, number("").from(0.1).up_to(100.0);
        /// Side of a cell of the tags, m; what fits the shell if left out: 0.015 m on a shell of usual size.
        pub tag_cell: Option<f64> = None, Optional(number("m").above(0.0).up_to(10.0));
        /// Whether every measurement by camera takes in the whole picture, instead of where the leader is expected.
        pub whole_frames: bool = false, Flag;
    }
}

//! What is written about pictures: the forms that docs/dataset.md describes.

use crate::dataset::view::FaceView;
use perception::detect::Tag;
use serde_json::{Value, json};
use vocabulary::{CameraModel, FACES, FleetInfo, Rigid, RobotInfo, Shell};

/// Names of a tag's corners in their order.
const CORNERS: [&str; 4] = ["top-left", "top-right", "bottom-right", "bottom-left"];

/// Which robot carries a tag, and on which face.
pub(crate) fn carrier(fleet: &FleetInfo, id: u16) -> Option<(usize, usize)> {
    let face = |m: &RobotInfo| m.shell.as_ref().and_then(|shell| shell.face_of(id));
    fleet.robots.iter().enumerate().find_map(|(robot, member)| Some((robot, face(member)?)))
}

pub(crate) fn frame(frame: &Rigid) -> Value {
    json!({ "rotation": frame.rotation, "translation": frame.translation })
}

/// A robot, its shell and the tags on it.
pub(crate) fn robot(member: &RobotInfo) -> Value {
    let shell = member.shell.as_ref();
    let face = |shell: &Shell, face: usize| {
        json!({
            "face": face, "id": shell.first_tag.map(|first| usize::from(first) + face),
            "body_from_tag": frame(&shell.body_from_face(face)), "corners": shell.tag_corners(face),
        })
    };
    json!({
        "name": member.name, "leads": member.leads,
        "tag_size": shell.map(|s| 2.0 * s.half_tag()), "cell": shell.map(|s| s.cell),
        "faces": shell.map(|s| (0..FACES).map(|k| face(s, k)).collect::<Vec<_>>()).unwrap_or_default(),
    })
}

/// A camera: pinhole and distortion as OpenCV has them.
pub(crate) fn camera(robot: &str, leader: &str, camera_model: &CameraModel) -> Value {
    json!({
        "robot": robot, "leader": leader, "width": camera_model.width, "height": camera_model.height,
        "fx": camera_model.focal, "fy": camera_model.focal, "cx": camera_model.centre[0], "cy": camera_model.centre[1],
        "distortion": camera_model.distortion,
    })
}

/// A tag in a picture, and how much of it is hidden.
pub(crate) struct LabelledTag {
    pub(crate) id: u16,
    pub(crate) robot: usize,
    pub(crate) face: usize,
    pub(crate) view: FaceView,
    pub(crate) readable: bool,
    /// Of each corner.
    pub(crate) hidden: [bool; 4],
    /// Share of the tag.
    pub(crate) hidden_share: f64,
}

impl LabelledTag {
    fn any_hidden(&self) -> bool {
        self.hidden_share > 0.0 || self.hidden.iter().any(|h| *h)
    }

    pub(crate) fn as_json(&self, fleet: &FleetInfo) -> Value {
        json!({
            "id": self.id, "robot": fleet.robots[self.robot].name, "face": self.face,
            "camera_from_tag": frame(&self.view.camera_from_tag), "corners": self.view.corners,
            "incidence": self.view.incidence, "pixels_per_cell": self.view.cell,
            "readable": self.readable, "hidden": self.any_hidden(), "hidden_share": self.hidden_share,
        })
    }

    /// As an annotation of COCO's: boxes are measured from the outer corner of the picture, key points are pixels.
    pub(crate) fn as_coco(&self, number: usize, picture: usize) -> Value {
        let corners = &self.view.corners;
        let along = |k: usize| {
            let low = corners.iter().map(|c| c[k]).fold(f64::INFINITY, f64::min);
            (low, corners.iter().map(|c| c[k]).fold(f64::NEG_INFINITY, f64::max) - low)
        };
        let ((x, width), (y, height)) = (along(0), along(1));
        let points: Vec<f64> = corners
            .iter()
            .zip(self.hidden)
            .flat_map(|(c, hidden)| [c[0], c[1], if hidden { 1.0 } else { 2.0 }])
            .collect();
        json!({
            "id": number, "image_id": picture, "category_id": 1, "iscrowd": 0, "tag_id": self.id,
            "keypoints": points, "num_keypoints": 4,
            "bbox": [x + 0.5, y + 0.5, width, height], "area": area(corners),
            "segmentation": [corners.iter().flat_map(|c| [c[0] + 0.5, c[1] + 0.5]).collect::<Vec<_>>()],
        })
    }
}

/// A tag that was found; accepted if it stands as a face of its robot's shell would.
pub(crate) fn found(fleet: &FleetInfo, tag: &Tag, accepted: bool) -> Value {
    let carrier = carrier(fleet, tag.id);
    json!({
        "id": tag.id, "robot": carrier.map(|(robot, _)| fleet.robots[robot].name.as_str()),
        "face": carrier.map(|(_, face)| face), "corners": tag.corners, "deviation": tag.deviation,
        "accepted": accepted,
    })
}

/// The file for COCO's tools.
pub(crate) fn coco(title: &str, images: &[Value], annotations: &[Value]) -> Value {
    json!({
        "info": { "description": title, "version": "1" }, "licenses": [],
        "images": images, "annotations": annotations,
        "categories": [{
            "id": 1, "name": "tag36h11", "supercategory": "tag", "keypoints": CORNERS,
            "skeleton": [[1, 2], [2, 3], [3, 4], [4, 1]],
        }],
    })
}

/// Of a quadrilateral, square pixels.
fn area([a, b, c, d]: &[[f64; 2]; 4]) -> f64 {
    0.5 * ((c[0] - a[0]) * (d[1] - b[1]) - (d[0] - b[0]) * (c[1] - a[1])).abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::Body;

    #[test]
    fn a_tag_has_one_carrier() {
        let mut fleet = FleetInfo {
            robots: vec![RobotInfo::new("ann", true, Body::default()); 2],
            ..FleetInfo::default()
        };
        for (k, member) in fleet.robots.iter_mut().enumerate() {
            member.shell = member.shell.map(|shell| shell.tagged(3 * k));
        }
        assert_eq!(carrier(&fleet, 4), Some((0, 4)));
        assert_eq!(carrier(&fleet, 16), Some((1, 1)));
        assert_eq!(carrier(&fleet, 5), None);
    }

    #[test]
    fn annotations_are_what_coco_reads() {
        let view = FaceView {
            camera_from_tag: Rigid::IDENTITY,
            corners: [[10.0, 20.0], [30.0, 20.0], [30.0, 50.0], [10.0, 50.0]],
            incidence: 0.0,
            cell: 2.5,
        };
        let hidden = [false, true, false, false];
        let tag = LabelledTag { id: 7, robot: 0, face: 2, view, readable: true, hidden, hidden_share: 0.1 };
        let note = tag.as_coco(3, 4);
        assert_eq!(note["bbox"], json!([10.5, 20.5, 20.0, 30.0]));
        assert_eq!(note["area"], 600.0);
        assert_eq!(note["keypoints"][5], 1.0);
        assert_eq!(note["keypoints"].as_array().map(Vec::len), Some(12));
    }
}

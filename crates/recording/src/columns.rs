//! What the tables of a run have in their columns.

use crate::TableKind;

/// Names of the columns of a table, with units.
pub(crate) fn of(kind: TableKind) -> &'static [&'static str] {
    match kind {
        TableKind::Robots => &[
            "time_s",
            "robot",
            "x_m",
            "y_m",
            "heading_rad",
            "speed_m_s",
            "acceleration_m_s2",
            "turn_rate_rad_s",
            "height_m",
            "roll_rad",
            "pitch_rad",
            "steering_rad",
            "condition",
        ],
        TableKind::Edges => &[
            "time_s",
            "leader",
            "follower",
            "distance_m",
            "bearing_rad",
            "view_angle_rad",
            "set_distance_m",
            "set_bearing_rad",
            "error_distance_m",
            "error_bearing_rad",
            "asked_acceleration_m_s2",
            "asked_turn_rate_rad_s",
            "applied_acceleration_m_s2",
            "applied_turn_rate_rad_s",
            "rate_distance_m_s",
            "rate_bearing_rad_s",
            "seen_distance_m",
            "seen_bearing_rad",
            "seen_view_angle_rad",
            "age_s",
            "sight",
            "limited",
            "too_close",
        ],
        TableKind::Contacts => &[
            "first",
            "second",
            "begin_s",
            "end_s",
            "x_m",
            "y_m",
            "z_m",
            "normal_x",
            "normal_y",
            "normal_z",
            "impulse_n_s",
        ],
        TableKind::Props => &["time_s", "prop", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"],
        TableKind::Measurements => &[
            "leader",
            "follower",
            "outcome",
            "stamp_s",
            "arrival_s",
            "faces",
            "distance_m",
            "bearing_rad",
            "view_angle_rad",
            "true_distance_m",
            "true_bearing_rad",
            "true_view_angle_rad",
            "deviation_distance_m",
            "deviation_bearing_rad",
            "deviation_view_angle_rad",
            "pan_rad",
            "region_x_px",
            "region_y_px",
            "region_width_px",
            "region_height_px",
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `docs/formats.md` has the columns that there are, in their order.
    #[test]
    fn the_documentation_names_every_column() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/formats.md");
        let text = std::fs::read_to_string(path).expect("the page");
        for kind in [
            TableKind::Robots,
            TableKind::Edges,
            TableKind::Contacts,
            TableKind::Props,
            TableKind::Measurements,
        ] {
            let start = text.find(&format!("**`{}`**", kind.name())).expect("a paragraph");
            let paragraph = text[start..].split("\n\n").next().expect("an end");
            let named: Vec<&str> = paragraph.split('`').skip(3).step_by(2).collect();
            assert_eq!(named, of(kind), "{}", kind.name());
        }
    }
}

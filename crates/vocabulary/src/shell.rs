//! The shell that carries the identification tags: the geometry that pictures are drawn from and poses are found with.

use crate::codes::CODES;
use crate::math;
use crate::{Body, Rigid};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, FRAC_PI_8, PI};

/// Faces of a shell that carry a tag.
pub const FACES: usize = 5;

/// Codes of the tag family.
pub const TAGS: usize = CODES.len();

/// Cells along the side of a tag: its white margin, its black border and six cells of code.
pub const TAG_CELLS: usize = 10;

/// Outward directions of the faces from the heading, rad, counter-clockwise; the front three faces of the octagon are
/// cut away. Faces next to each other are neighbours.
pub const FACE_DIRECTIONS: [f64; FACES] =
    [FRAC_PI_2, FRAC_PI_2 + FRAC_PI_4, PI, -FRAC_PI_2 - FRAC_PI_4, -FRAC_PI_2];

/// A truncated octagon of leaning faces around the rear of a vehicle, a tag on each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shell {
    /// From its axis to the middle of a face, at mid-height, m.
    pub apothem: f64,
    /// Of its faces, measured along z, m.
    pub face_height: f64,
    /// By how much faces lean back from the vertical, rad.
    pub lean: f64,
    /// Side of a tag's cells, m: the black square is eight of them, its white margin one more around.
    pub cell: f64,
    /// Where its axis is ahead of the robot's reference point, m.
    pub forward: f64,
    /// Middle of its faces over the ground, m.
    pub height: f64,
    /// Id of the tag on face 0; the other faces have those that follow. `None` for blank faces.
    pub first_tag: Option<u16>,
}

impl Default for Shell {
    fn default() -> Self {
        Self::PAPER
    }
}

impl Shell {
    /// The shell of the paper's robots, its axis over the reference point, blank.
    pub const PAPER: Self = Self {
        apothem: 0.187,
        face_height: 0.16,
        lean: 10.0 * PI / 180.0,
        cell: 0.015,
        forward: 0.0,
        height: 0.20,
        first_tag: None,
    };

    /// The shell that fits a body: the paper's on bodies up to 1.2 m, above wheels that are taller; four times as large
    /// on the roof of a vehicle that carries people.
    pub fn fitting(body: &Body) -> Self {
        if body.length >= 1.2 {
            return Self::PAPER.scaled(4.0).at(0.12 * body.wheelbase, body.height + 0.40);
        }
        // Its lower rim is 0.092 m below its middle and clears the wheels by 2 cm.
        let over_wheels = 2.0 * body.wheel_radius + 0.022 + 0.092;
        Self::PAPER
            .at(0.0, if *body == Body::default() { 0.20 } else { (body.height - 0.017).max(over_wheels) })
    }

    /// `factor` times as large in every measure but its height over the ground.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            apothem: self.apothem * factor,
            face_height: self.face_height * factor,
            cell: self.cell * factor,
            ..self
        }
    }

    /// With its axis `forward` m ahead of the reference point and its middle `height` m over the ground.
    #[must_use]
    pub fn at(self, forward: f64, height: f64) -> Self {
        Self { forward, height, ..self }
    }

    /// With the tags of robot number `robot`: ids 5·robot to 5·robot + 4; blank beyond the family's last.
    #[must_use]
    pub fn tagged(self, robot: usize) -> Self {
        let first = FACES * robot;
        let fits = first + FACES <= TAGS;
        Self { first_tag: u16::try_from(first).ok().filter(|_| fits), ..self }
    }

    /// Distance of the tags' corners from the middle of their square, m: half the black square.
    pub fn half_tag(&self) -> f64 {
        4.0 * self.cell
    }

    /// The frame of a face in the body's: x to the right and y up as seen from outside, z outward; its origin in the
    /// middle of the tag.
    pub fn body_from_face(&self, face: usize) -> Rigid {
        let (sin, cos) = math::sin_cos(FACE_DIRECTIONS[face % FACES]);
        let (lean, upright) = math::sin_cos(self.lean);
        let columns =
            [[-sin, cos, 0.0], [-cos * lean, -sin * lean, upright], [cos * upright, sin * upright, lean]];
        Rigid {
            rotation: [0, 1, 2].map(|row| columns.map(|column| column[row])),
            translation: [self.forward + self.apothem * cos, self.apothem * sin, self.height],
        }
    }

    /// Corners of the black square of a face in the body's frame, m: top left, top right, bottom right, bottom left as
    /// seen from outside.
    pub fn tag_corners(&self, face: usize) -> [[f64; 3]; 4] {
        let (frame, h) = (self.body_from_face(face), self.half_tag());
        [[-h, h], [h, h], [h, -h], [-h, -h]].map(|[x, y]| frame.apply([x, y, 0.0]))
    }

    /// The face that carries the tag `id`.
    pub fn face_of(&self, id: u16) -> Option<usize> {
        let face = usize::from(id.checked_sub(self.first_tag?)?);
        (face < FACES).then_some(face)
    }

    /// The outline of a face in its own plane, half its width in m at a height of `y` m above the middle of the tag,
    /// measured along the face.
    pub fn half_width(&self, y: f64) -> f64 {
        (self.apothem - y * math::sin(self.lean)) * math::tan(FRAC_PI_8)
    }
}

/// Whether the cell in `column` (from the left) and `row` (from the top) of the tag `id` is white; margin and border
/// included, so both run from 0 to 9. `None` for an id the family does not have.
pub fn tag_cell(id: u16, column: usize, row: usize) -> Option<bool> {
    let code = tag_code(id)?;
    let rim = |k: usize| k.min(TAG_CELLS.saturating_sub(1 + k));
    Some(match rim(column).min(rim(row)) {
        0 => true,
        1 => false,
        _ => code >> (6 * (row - 2) + column - 2) & 1 == 1,
    })
}

/// The code of the tag `id`: bit 6·row + column is set where the cell is white.
pub fn tag_code(id: u16) -> Option<u64> {
    CODES.get(usize::from(id)).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_shell_has_the_measures_it_should() {
        let shell = Shell::PAPER;
        for (face, corners) in (0..FACES).map(|face| (face, shell.tag_corners(face))) {
            let side =
                |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| math::powi(a[k] - b[k], 2)).sum::<f64>().sqrt();
            for k in 0..4 {
                assert!((side(corners[k], corners[(k + 1) % 4]) - 0.12).abs() < 1e-12);
            }
            let z = corners.iter().map(|c| c[2]).sum::<f64>() / 4.0;
            assert!((z - 0.20).abs() < 1e-12);
            let outward = shell.body_from_face(face).turn([0.0, 0.0, 1.0]);
            assert!((outward[2] - math::sin(10_f64.to_radians())).abs() < 1e-12);
            let direction = math::atan2(outward[1], outward[0]);
            assert!(crate::wrap(direction - FACE_DIRECTIONS[face]).abs() < 1e-12);
        }
        // Bottom and top width of a face.
        let up = 0.08 / math::cos(10_f64.to_radians());
        assert!((2.0 * shell.half_width(-up) - 0.167).abs() < 1e-3);
        assert!((2.0 * shell.half_width(up) - 0.143).abs() < 1e-3);
    }

    /// From behind, left of the picture is left of the robot: +y.
    #[test]
    fn the_rear_face_is_seen_the_right_way_round() {
        let [top_left, top_right, bottom_right, _] = Shell::PAPER.tag_corners(2);
        assert!(top_left[1] > top_right[1] && top_right[2] > bottom_right[2]);
    }

    #[test]
    fn robots_have_five_tags_each_as_far_as_the_family_goes() {
        assert_eq!(Shell::PAPER.tagged(3).first_tag, Some(15));
        assert_eq!(Shell::PAPER.tagged(116).first_tag, Some(580));
        assert_eq!(Shell::PAPER.tagged(117).first_tag, None);
        let shell = Shell::PAPER.tagged(3);
        assert_eq!(
            (shell.face_of(14), shell.face_of(15), shell.face_of(19), shell.face_of(20)),
            (None, Some(0), Some(4), None)
        );
    }

    #[test]
    fn a_tag_has_a_white_margin_and_a_black_border() {
        let tag: Vec<String> = (0..10)
            .map(|row| (0..10).map(|c| if tag_cell(0, c, row) == Some(true) { '.' } else { '#' }).collect())
            .collect();
        assert!(tag[0] == ".........." && tag[1] == ".########." && tag[8] == ".########.", "{tag:#?}");
        assert!(tag[2..8].iter().all(|row| row.starts_with(".#") && row.ends_with("#.")), "{tag:#?}");
        assert_eq!(tag_cell(587, 0, 0), None);
    }

    /// The family's name: any two codes differ in 11 cells or more, however they are turned.
    #[test]
    fn codes_keep_their_distance() {
        let turned = |code: u64| {
            (0..36).fold(0_u64, |out, k| {
                let (row, column) = (k / 6, k % 6);
                out | (code >> (6 * row + column) & 1) << (6 * column + 5 - row)
            })
        };
        for (index, code) in CODES.iter().enumerate() {
            let mut other = *code;
            for turn in 0..4 {
                let least = CODES.iter().enumerate().filter(|(k, _)| turn > 0 || *k != index);
                let least = least.map(|(_, c)| (c ^ other).count_ones()).min().unwrap_or(36);
                assert!(least >= 11, "tag {index} turned {turn} times is {least} cells from another");
                other = turned(other);
            }
        }
    }
}

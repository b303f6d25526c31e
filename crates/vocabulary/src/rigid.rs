//! Where frames are in one another.

use crate::math;

/// A turn and a shift: takes points of one frame to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rigid {
    /// Rows of the matrix that turns.
    pub rotation: [[f64; 3]; 3],
    /// Added after the turn, m.
    pub translation: [f64; 3],
}

impl Rigid {
    /// Leaves points where they are.
    pub const IDENTITY: Self =
        Self { rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], translation: [0.0; 3] };

    /// Turned by `roll` about x, then `pitch` about y, then `heading` about z, rad; its origin at `at`, m.
    pub fn turned(at: [f64; 3], heading: f64, pitch: f64, roll: f64) -> Self {
        let ((sh, ch), (sp, cp), (sr, cr)) =
            (math::sin_cos(heading), math::sin_cos(pitch), math::sin_cos(roll));
        Self {
            rotation: [
                [ch * cp, ch * sp * sr - sh * cr, ch * sp * cr + sh * sr],
                [sh * cp, sh * sp * sr + ch * cr, sh * sp * cr - ch * sr],
                [-sp, cp * sr, cp * cr],
            ],
            translation: at,
        }
    }

    /// A direction, turned.
    pub fn turn(&self, v: [f64; 3]) -> [f64; 3] {
        self.rotation.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
    }

    /// A point, turned and shifted; m.
    pub fn apply(&self, point: [f64; 3]) -> [f64; 3] {
        let turned = self.turn(point);
        [0, 1, 2].map(|k| turned[k] + self.translation[k])
    }

    /// First `inner`, then this one.
    #[must_use]
    pub fn after(&self, inner: &Self) -> Self {
        let column = |k: usize| self.turn(inner.rotation.map(|row| row[k]));
        let columns = [column(0), column(1), column(2)];
        Self {
            rotation: [0, 1, 2].map(|row| columns.map(|c| c[row])),
            translation: self.apply(inner.translation),
        }
    }

    /// The way back.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let r = &self.rotation;
        let back = Self { rotation: [0, 1, 2].map(|k| [r[0][k], r[1][k], r[2][k]]), translation: [0.0; 3] };
        Self { translation: back.turn(self.translation).map(|x| -x), ..back }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: [f64; 3], b: [f64; 3]) {
        assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-12), "{a:?} {b:?}");
    }

    #[test]
    fn there_and_back() {
        let frame = Rigid::turned([1.0, -2.0, 0.5], 0.7, -0.2, 0.1);
        near(frame.inverse().apply(frame.apply([0.3, 0.2, -0.1])), [0.3, 0.2, -0.1]);
        near(frame.after(&frame.inverse()).apply([3.0, 2.0, 1.0]), [3.0, 2.0, 1.0]);
    }

    #[test]
    fn a_positive_pitch_is_nose_down_and_a_positive_roll_right_side_down() {
        let at = |pitch, roll, p| Rigid::turned([0.0; 3], 0.0, pitch, roll).apply(p);
        assert!(at(0.1, 0.0, [1.0, 0.0, 0.0])[2] < 0.0);
        assert!(at(0.0, 0.1, [0.0, -1.0, 0.0])[2] < 0.0);
        near(
            Rigid::turned([0.0; 3], std::f64::consts::FRAC_PI_2, 0.0, 0.0).apply([1.0, 0.0, 0.0]),
            [0.0, 1.0, 0.0],
        );
    }
}

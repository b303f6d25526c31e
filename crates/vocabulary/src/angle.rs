//! Angles on the circle.

use std::f64::consts::{PI, TAU};

/// `angle` in radians wrapped to (−π, π]. A value that is not finite stays as it is.
pub fn wrap(angle: f64) -> f64 {
    if angle > -PI && angle <= PI {
        return angle;
    }
    let wrapped = PI - (PI - angle).rem_euclid(TAU);
    // rem_euclid may round up to TAU itself; −π belongs to the other end.
    if wrapped <= -PI { PI } else { wrapped }
}

/// The angle equal to `angle` on the circle that lies within half a turn of `near`; both in radians.
pub fn nearest_turn(angle: f64, near: f64) -> f64 {
    near + wrap(angle - near)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wraps_into_the_half_open_interval() {
        for (angle, wrapped) in [(0.0, 0.0), (PI, PI), (-PI, PI), (3.0 * PI, PI), (-3.0 * PI, PI), (TAU, 0.0)]
        {
            assert_eq!(wrap(angle), wrapped, "wrap({angle})");
        }
        assert!((wrap(4.0) - (4.0 - TAU)).abs() < 1e-15);
        assert!((wrap(-4.0) - (TAU - 4.0)).abs() < 1e-15);
        assert!(wrap(f64::NAN).is_nan());
    }

    #[test]
    fn nearest_turn_is_continuous_over_the_seam() {
        assert!((nearest_turn(-3.1, 3.1) - (TAU - 3.1)).abs() < 1e-15);
        assert!((nearest_turn(0.1, 40.0 * PI) - (40.0 * PI + 0.1)).abs() < 1e-12);
    }
}

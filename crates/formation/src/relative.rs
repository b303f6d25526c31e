//! How the relative position of a follower changes (eqs 6-12); the position itself, eqs 2-4, is [`Relative::between`].
//!
//! Indices of the paper: i is the leader, j the follower.

use nalgebra::{Matrix2, SMatrix, SVector, Vector2};
use vocabulary::{MotionInput, Relative, math};

/// The line between a leader and its follower as the follower sees it, ready for the equations: the effect of the follower's own
/// motion does not depend on the leader's heading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineOfSight {
    /// ℓ, m, at least the minimum it was made with.
    pub distance: f64,
    /// sin γ.
    pub sin_view: f64,
    /// cos γ.
    pub cos_view: f64,
}

/// A relative position ready for the equations: sines and cosines taken, distance kept off zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geometry {
    /// The line between the two.
    pub line: LineOfSight,
    /// sin ψ.
    pub sin_bearing: f64,
    /// cos ψ.
    pub cos_bearing: f64,
}

impl LineOfSight {
    /// That of `relative`, its distance at least `distance_min` m (ℓ_min) wherever it divides.
    pub fn new(relative: &Relative, distance_min: f64) -> Self {
        let (sin_view, cos_view) = math::sin_cos(relative.view_angle);
        Self { distance: relative.distance.max(distance_min), sin_view, cos_view }
    }

    /// g, the 2×2 input matrix (eq 9); det g = v_j/ℓ.
    pub fn input_matrix(&self, follower_speed: f64) -> Matrix2<f64> {
        let (v, l) = (follower_speed, self.distance);
        Matrix2::new(-self.cos_view, -v * self.sin_view, self.sin_view / l, -v * self.cos_view / l)
    }

    /// −g⁻¹ b in [m/s², rad/s], in closed form; `follower_speed` must not be zero.
    pub fn minus_inverse_input(&self, follower_speed: f64, b: &Vector2<f64>) -> Vector2<f64> {
        let across = self.distance * b.y;
        Vector2::new(
            self.cos_view * b.x - self.sin_view * across,
            (self.sin_view * b.x + self.cos_view * across) / follower_speed,
        )
    }

    /// g0, [m/s², rad/s²] (eq 10, printed there as 2×2; it is 2×1).
    pub fn drift(&self, follower_speed: f64) -> Vector2<f64> {
        Vector2::new(-follower_speed * follower_speed / self.distance, 0.0)
    }

    /// First column of g_s (eq 11); its second column is zero.
    pub fn rate_column(&self, follower_speed: f64) -> Vector2<f64> {
        let turn = follower_speed / self.distance;
        Vector2::new(turn * self.cos_view, -2.0 * turn * self.sin_view / self.distance)
    }
}

impl Geometry {
    /// The geometry of `relative`, its distance at least `distance_min` m (ℓ_min) wherever it divides.
    pub fn new(relative: &Relative, distance_min: f64) -> Self {
        let (sin_bearing, cos_bearing) = math::sin_cos(relative.bearing);
        Self { line: LineOfSight::new(relative, distance_min), sin_bearing, cos_bearing }
    }

    /// d[ℓ, ψ]/dt in [m/s, rad/s] from the speeds of follower and leader and the leader's turn rate (eqs 6-7).
    pub fn rates(&self, follower_speed: f64, leader_speed: f64, leader_turn_rate: f64) -> Vector2<f64> {
        let LineOfSight { distance, sin_view, cos_view } = self.line;
        Vector2::new(
            follower_speed * cos_view - leader_speed * self.cos_bearing,
            (leader_speed * self.sin_bearing - follower_speed * sin_view) / distance - leader_turn_rate,
        )
    }

    /// g_v, the 2×5 matrix that multiplies the leader's motion (eq 12).
    ///
    /// 2 cos θ_ij − cos γ cos ψ is written without headings, since θ_ij = θ_i − θ_j = γ − ψ.
    pub fn leader_matrix(&self, follower_speed: f64) -> SMatrix<f64, 2, 5> {
        let LineOfSight { distance: l, sin_view: sg, cos_view: cg } = self.line;
        let (v, sp, cp) = (follower_speed, self.sin_bearing, self.cos_bearing);
        SMatrix::<f64, 2, 5>::new(
            v * (cg * cp + 2.0 * sg * sp) / l,
            cp,
            -sp * sp / l,
            0.0,
            sp,
            2.0 * v * cg * sp / (l * l),
            -sp / l,
            -2.0 * sp * cp / (l * l),
            1.0,
            cp / l,
        )
    }

    /// g_v V_i, [m/s², rad/s²]: what the leader's motion does to d²s/dt².
    pub fn leader_effect(&self, follower_speed: f64, leader: &MotionInput) -> Vector2<f64> {
        self.leader_matrix(follower_speed) * leader_vector(leader)
    }
}

/// V_i = [v, dv/dt, v², dω/dt, vω] of the leader, SI units.
pub fn leader_vector(leader: &MotionInput) -> SVector<f64, 5> {
    let v = leader.speed;
    SVector::<f64, 5>::new(v, leader.acceleration, v * v, leader.turn_acceleration, v * leader.turn_rate)
}

#[cfg(test)]
pub(crate) use tests::second_rates;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::PI;
    use vocabulary::{Pose, nearest_turn};

    /// g_s, the 2×2 matrix that multiplies ds/dt (eq 11).
    fn rate_matrix(geometry: &Geometry, follower_speed: f64) -> Matrix2<f64> {
        let column = geometry.line.rate_column(follower_speed);
        Matrix2::new(column.x, 0.0, column.y, 0.0)
    }

    /// d²s/dt² in [m/s², rad/s²] from the follower's command, ds/dt and the leader's motion (eq 8).
    pub(crate) fn second_rates(
        geometry: &Geometry,
        follower_speed: f64,
        command: &Vector2<f64>,
        rates: &Vector2<f64>,
        leader: &MotionInput,
    ) -> Vector2<f64> {
        -(geometry.line.input_matrix(follower_speed) * command
            + geometry.line.drift(follower_speed)
            + rate_matrix(geometry, follower_speed) * rates
            + geometry.leader_effect(follower_speed, leader))
    }

    /// A robot with constant dv/dt and dω/dt, on its way from a pose.
    #[derive(Debug, Clone, Copy)]
    struct Rover {
        pose: Pose,
        drive: MotionInput,
    }

    impl Rover {
        /// Where it is `t` s later, by a Taylor expansion exact to fourth order: |t| is small in these tests.
        fn at(&self, t: f64) -> Self {
            let d = &self.drive;
            let steps = 16;
            let mut now = *self;
            let h = t / f64::from(steps);
            for _ in 0..steps {
                let heading =
                    |s: f64| now.pose.heading + now.drive.turn_rate * s + d.turn_acceleration * s * s / 2.0;
                let speed = |s: f64| now.drive.speed + d.acceleration * s;
                let slope = |s: f64| (speed(s) * math::cos(heading(s)), speed(s) * math::sin(heading(s)));
                let (a, b, c) = (slope(0.0), slope(h / 2.0), slope(h));
                let pose = Pose::new(
                    now.pose.x + h / 6.0 * (a.0 + 4.0 * b.0 + c.0),
                    now.pose.y + h / 6.0 * (a.1 + 4.0 * b.1 + c.1),
                    heading(h),
                );
                let drive = MotionInput {
                    speed: speed(h),
                    turn_rate: now.drive.turn_rate + d.turn_acceleration * h,
                    ..*d
                };
                now = Self { pose, drive };
            }
            now
        }
    }

    fn rover() -> impl Strategy<Value = Rover> {
        (-5.0..5.0, -5.0..5.0, -PI..PI, 0.05..2.0, -2.0..2.0, -1.0..1.0, -1.0..1.0).prop_map(
            |(x, y, heading, speed, acceleration, turn_rate, turn_acceleration)| Rover {
                pose: Pose::new(x, y, heading),
                drive: MotionInput { speed, acceleration, turn_rate, turn_acceleration },
            },
        )
    }

    fn output(leader: &Rover, follower: &Rover, t: f64) -> Vector2<f64> {
        let r = Relative::between(leader.at(t).pose, follower.at(t).pose);
        Vector2::new(r.distance, r.bearing)
    }

    /// First and second time derivative of [ℓ, ψ] at 0 by central differences, Richardson-extrapolated.
    fn differences(leader: &Rover, follower: &Rover) -> (Vector2<f64>, Vector2<f64>) {
        let centre = output(leader, follower, 0.0);
        let sample = |t: f64| {
            let mut s = output(leader, follower, t);
            s.y = nearest_turn(s.y, centre.y);
            s
        };
        let first = |h: f64| (sample(h) - sample(-h)) / (2.0 * h);
        let second = |h: f64| (sample(h) - 2.0 * centre + sample(-h)) / (h * h);
        let h = 2e-3;
        ((4.0 * first(h / 2.0) - first(h)) / 3.0, (4.0 * second(h / 2.0) - second(h)) / 3.0)
    }

    fn command(rover: &Rover) -> Vector2<f64> {
        Vector2::new(rover.drive.acceleration, rover.drive.turn_rate)
    }

    proptest! {
        #[test]
        fn rates_match_finite_differences(leader in rover(), follower in rover()) {
            let r = Relative::between(leader.pose, follower.pose);
            prop_assume!(r.distance > 0.5);
            let geometry = Geometry::new(&r, 0.1);
            let rates = geometry.rates(follower.drive.speed, leader.drive.speed, leader.drive.turn_rate);
            let (first, _) = differences(&leader, &follower);
            prop_assert!((rates - first).norm() < 1e-7, "{rates} against {first}");
        }

        #[test]
        fn second_rates_match_finite_differences(leader in rover(), follower in rover()) {
            let r = Relative::between(leader.pose, follower.pose);
            prop_assume!(r.distance > 0.5);
            let geometry = Geometry::new(&r, 0.1);
            let rates = geometry.rates(follower.drive.speed, leader.drive.speed, leader.drive.turn_rate);
            let model = second_rates(&geometry, follower.drive.speed, &command(&follower), &rates, &leader.drive);
            let (_, second) = differences(&leader, &follower);
            prop_assert!((model - second).norm() < 2e-5 * (1.0 + second.norm()), "{model} against {second}");
        }

        /// With the direction of the line in place of the bearing: the leader's turn rate drops out of the rate, and its
        /// change out of g_v V_i.
        #[test]
        fn rates_of_the_lines_direction_match_finite_differences(leader in rover(), follower in rover()) {
            let r = Relative::between(leader.pose, follower.pose);
            prop_assume!(r.distance > 0.5);
            let (geometry, v, law) = (Geometry::new(&r, 0.1), follower.drive.speed, crate::law::test_law());
            let direction = |t: f64| {
                let (l, f) = (leader.at(t).pose, follower.at(t).pose);
                law.heading.output(&Relative::between(l, f), f.heading)
            };
            let centre = direction(0.0);
            let at = |t: f64| {
                let s = direction(t);
                Vector2::new(s.distance, nearest_turn(s.bearing, centre.bearing))
            };
            let first = |h: f64| (at(h) - at(-h)) / (2.0 * h);
            let second = |h: f64| (at(h) - 2.0 * at(0.0) + at(-h)) / (h * h);
            let h = 2e-3;
            let (first, second) =
                ((4.0 * first(h / 2.0) - first(h)) / 3.0, (4.0 * second(h / 2.0) - second(h)) / 3.0);
            let rates = law.rates(&geometry, v, &leader.drive);
            prop_assert!((rates - first).norm() < 1e-7, "{rates} against {first}");
            let model = -(geometry.line.input_matrix(v) * command(&follower)
                + geometry.line.drift(v)
                + rate_matrix(&geometry, v) * rates
                + law.leader_effect(&geometry, v, &leader.drive));
            prop_assert!((model - second).norm() < 2e-5 * (1.0 + second.norm()), "{model} against {second}");
        }

        /// g alone: how d²s/dt² answers to a change of the follower's command.
        #[test]
        fn input_matrix_is_the_answer_to_the_command(leader in rover(), follower in rover(), a in -1.0..1.0, w in -1.0..1.0) {
            let r = Relative::between(leader.pose, follower.pose);
            prop_assume!(r.distance > 0.5);
            let mut other = follower;
            other.drive.acceleration += a;
            other.drive.turn_rate += w;
            let change = differences(&leader, &other).1 - differences(&leader, &follower).1;
            let g = LineOfSight::new(&r, 0.1).input_matrix(follower.drive.speed);
            prop_assert!((change + g * Vector2::new(a, w)).norm() < 1e-4, "{change}");
        }

        /// g0, g_s: what is left of d²s/dt² with a leader at rest and no command.
        #[test]
        fn drift_and_rate_matrix_stand_alone(mut leader in rover(), mut follower in rover()) {
            leader.drive = MotionInput::default();
            follower.drive = MotionInput { speed: follower.drive.speed, ..MotionInput::default() };
            let r = Relative::between(leader.pose, follower.pose);
            prop_assume!(r.distance > 0.5);
            let v = follower.drive.speed;
            let geometry = Geometry::new(&r, 0.1);
            let (first, second) = differences(&leader, &follower);
            let model = -geometry.line.drift(v) - rate_matrix(&geometry, v) * first;
            prop_assert!((model - second).norm() < 2e-5 * (1.0 + second.norm()));
        }

        /// g_v: every one of its five columns, by changing one entry of V_i at a time.
        #[test]
        fn leader_matrix_matches_the_leader(leader in rover(), follower in rover()) {
            let r = Relative::between(leader.pose, follower.pose);
            prop_assume!(r.distance > 0.5);
            let geometry = Geometry::new(&r, 0.1);
            let v = follower.drive.speed;
            let base = Rover { drive: MotionInput { speed: leader.drive.speed, ..MotionInput::default() }, ..leader };
            let still = Rover { drive: MotionInput::default(), ..leader };
            for (one, other) in [
                (leader, base),
                (Rover { drive: MotionInput { acceleration: 1.0, ..base.drive }, ..leader }, base),
                (Rover { drive: MotionInput { turn_acceleration: 1.0, ..base.drive }, ..leader }, base),
                (base, still),
            ] {
                let change = differences(&one, &follower).1 - differences(&other, &follower).1;
                let rate_change = geometry.rates(0.0, one.drive.speed, one.drive.turn_rate)
                    - geometry.rates(0.0, other.drive.speed, other.drive.turn_rate);
                let model = geometry.leader_effect(v, &one.drive) - geometry.leader_effect(v, &other.drive)
                    + rate_matrix(&geometry, v) * rate_change;
                prop_assert!((change + model).norm() < 1e-4 * (1.0 + model.norm()), "{change} against {}", -model);
            }
        }

        #[test]
        fn determinant_is_speed_over_distance(leader in rover(), follower in rover()) {
            let r = Relative::between(leader.pose, follower.pose);
            prop_assume!(r.distance > 0.2);
            let v = follower.drive.speed;
            let g = LineOfSight::new(&r, 0.1).input_matrix(v);
            prop_assert!((g.determinant() - v / r.distance).abs() < 1e-12);
        }

        #[test]
        fn closed_form_inverse_inverts(leader in rover(), follower in rover(), a in -9.0..9.0, b in -9.0..9.0) {
            let r = Relative::between(leader.pose, follower.pose);
            prop_assume!(r.distance > 0.2);
            let geometry = Geometry::new(&r, 0.1);
            let v = follower.drive.speed;
            let rhs = Vector2::new(a, b);
            let back = geometry.line.input_matrix(v) * geometry.line.minus_inverse_input(v, &rhs);
            prop_assert!((back + rhs).norm() < 1e-9);
        }
    }
}

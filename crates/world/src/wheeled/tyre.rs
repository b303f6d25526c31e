//! A tyre as a brush that bends: force from deflection, deflection from slip over a relaxation length.
//!
//! With load N, sideways speed u and rolling speed v the brush's deflection d follows d' = −u − |v|/σ d, and the side
//! force is C N/σ d: at a steady slip angle α = atan(u/|v|) that is −C N tan α, at rest a spring that holds the vehicle
//! where it stands. Along its rolling direction the brush bends as far as brakes and rolling resistance hold it. Both
//! together never exceed the friction circle μN. (Pacejka, Tyre and Vehicle Dynamics, ch. 5: single contact point model.)

use vocabulary::math;

/// Parameters of a tyre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tyre {
    /// Coefficient of friction.
    pub friction: f64,
    /// Cornering stiffness over load, 1/rad.
    pub cornering: f64,
    /// m.
    pub relaxation: f64,
    /// Rolling resistance over load.
    pub rolling: f64,
}

/// How far a tyre's brush is bent, [forward, left], m.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Brush(pub [f64; 2]);

/// What a tyre is told at an instant.
#[derive(Debug, Clone, Copy)]
pub struct Rolling {
    /// Of the contact patch over the ground, forward and left, m/s.
    pub velocity: [f64; 2],
    /// Of the wheel on the ground, N.
    pub load: f64,
    /// Multiplies the friction.
    pub grip: f64,
    /// Of the motor, forward, N.
    pub drive: f64,
    /// Largest force of the brake, N.
    pub brake: f64,
    /// Mass that the wheel carries at rest, kg: for the damping of a tyre that stands.
    pub mass: f64,
}

/// Share of critical damping of the brush of a tyre that stands.
const STANDING_DAMPING: f64 = 0.5;
/// Rolling speed at which that damping has gone, m/s: the relaxation damps then.
const STANDING: f64 = 0.2;

impl Tyre {
    /// Force [forward, left] on the vehicle, N, and the brush after `step` s.
    pub fn force(&self, rolling: &Rolling, brush: Brush, step: f64) -> ([f64; 2], Brush) {
        let Rolling { velocity: [along, aside], load, .. } = *rolling;
        let stiffness = self.cornering * load / self.relaxation;
        if stiffness <= 0.0 {
            return ([0.0; 2], Brush::default());
        }
        let fading = 1.0 + math::powi(along / STANDING, 2);
        let damping = STANDING_DAMPING * (stiffness * rolling.mass).sqrt() / fading;
        // Backward Euler: stable however fast it rolls.
        let left = (brush.0[1] - step * aside) / (1.0 + step * along.abs() / self.relaxation);
        let held = rolling.brake + self.rolling * load;
        let forward = brush.0[0] - step * along;
        let resistance = (stiffness * forward - damping * along).clamp(-held, held);
        let side = stiffness * left - damping * aside;
        let wanted = rolling.drive + resistance;
        let (most, asked) = (self.friction * rolling.grip * load, math::hypot(wanted, side));
        let cut = if asked > most { most / asked } else { 1.0 };
        // What slides does not bend further.
        let bent = (stiffness * forward).clamp(-held, held) / stiffness;
        ([wanted * cut, side * cut], Brush([bent, left * cut]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TYRE: Tyre = Tyre { friction: 0.9, cornering: 12.0, relaxation: 0.06, rolling: 0.03 };

    fn rolling(along: f64, aside: f64) -> Rolling {
        Rolling { velocity: [along, aside], load: 12.0, grip: 1.0, drive: 0.0, brake: 0.0, mass: 1.2 }
    }

    fn settled(rolling: &Rolling) -> [f64; 2] {
        let mut brush = Brush::default();
        let mut force = [0.0; 2];
        for _ in 0..2000 {
            (force, brush) = TYRE.force(rolling, brush, 0.005);
        }
        force
    }

    #[test]
    fn a_steady_slip_angle_gives_the_cornering_stiffness() {
        for speed in [0.5, 1.0, 10.0] {
            let [along, aside] = settled(&rolling(speed, 0.02 * speed));
            assert!((aside + 12.0 * 12.0 * 0.02).abs() < 0.05 * 2.88, "{aside} at {speed} m/s");
            assert!((along + 0.03 * 12.0).abs() < 1e-9);
        }
    }

    #[test]
    fn friction_bounds_everything() {
        let slide = Rolling { brake: 100.0, ..rolling(1.0, 1.0) };
        let [along, aside] = settled(&slide);
        assert!((math::hypot(along, aside) - 0.9 * 12.0).abs() < 1e-9 && along < 0.0 && aside < 0.0);
    }

    proptest! {
        #[test]
        fn any_motion_gives_a_finite_force_within_the_circle(
            along in -50.0..50.0, aside in -50.0..50.0, load in 0.0..1e4, drive in -1e3..1e3, brake in 0.0..1e3,
        ) {
            let told = Rolling { load, drive, brake, ..rolling(along, aside) };
            let (force, brush) = TYRE.force(&told, Brush([0.01, -0.02]), 0.005);
            prop_assert!(math::hypot(force[0], force[1]) <= 0.9 * load * (1.0 + 1e-12) + 1e-12);
            prop_assert!(brush.0.iter().all(|d| d.is_finite()));
        }
    }
}

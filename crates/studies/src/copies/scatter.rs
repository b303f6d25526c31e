//! Starts that differ from episode to episode.

use crate::Error;
use laws::Noise;
use scene::{Robot, Scene};
use std::f64::consts::TAU;
use vocabulary::{Pose, math};

/// How far robots start from where their scene puts them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StartScatter {
    /// Numbers of the robots; the others start where the scene puts them.
    pub robots: Vec<usize>,
    /// Radius of the disc in which the start is, uniformly distributed, m.
    pub position: f64,
    /// Largest turn of the heading to either side, uniformly distributed, rad.
    pub heading: f64,
}

/// Which start of a copy: its random numbers depend on nothing else.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Episode {
    /// Seed of the copy. The first episode has it as the seed of its scene.
    pub seed: u64,
    /// Number of the episode since the copy got that seed, from 0.
    pub number: u64,
}

/// Draws of one start before it is given up.
const ATTEMPTS: u64 = 100;
/// Random numbers of one draw.
const DRAWN: u64 = 3;
/// What one episode adds to the seed of a scene, so that seeds side by side have no episode in common (2⁶⁴ divided by the golden
/// ratio).
const STRIDE: u64 = 0x9e37_79b9_7f4a_7c15;

impl StartScatter {
    /// Gives `scene` the starts and the seed of an episode. Starts whose bodies could touch are drawn again.
    ///
    /// # Errors
    /// [`Error::Usage`] where there is no room, naming the robot.
    pub fn scatter(&self, scene: &mut Scene, episode: Episode) -> Result<(), Error> {
        scene.seed = episode.seed.wrapping_add(episode.number.wrapping_mul(STRIDE));
        if self.position == 0.0 && self.heading == 0.0 {
            return Ok(());
        }
        let waits = |robot: &usize| self.robots.contains(robot);
        let mut placed: Vec<usize> = (0..scene.robots.len()).filter(|robot| !waits(robot)).collect();
        for &robot in &self.robots {
            let Some(own) = scene.robots.get(robot).map(|robot| robot.pose) else { continue };
            let noise = Noise { seed: episode.seed, robot: robot as u64, sample: episode.number };
            let free = (0..ATTEMPTS).any(|attempt| {
                scene.robots[robot].pose = self.drawn(own, &noise, attempt);
                placed.iter().all(|other| apart(&scene.robots[robot], &scene.robots[*other]))
            });
            if !free {
                return Err(Error::Usage(format!(
                    "`{}` has no room to start within {} m of where the scene puts it, in {ATTEMPTS} attempts: scatter the \
                     robots less, or put them farther apart",
                    scene.robots[robot].name, self.position
                )));
            }
            placed.push(robot);
        }
        Ok(())
    }

    fn drawn(&self, own: Pose, noise: &Noise, attempt: u64) -> Pose {
        let [far, around, turn] = [0, 1, 2].map(|which| noise.uniform(attempt * DRAWN + which));
        let (distance, (sin, cos)) = (self.position * far.sqrt(), math::sin_cos(TAU * around));
        Pose::new(
            own.x + distance * cos,
            own.y + distance * sin,
            own.heading + self.heading * (2.0 * turn - 1.0),
        )
    }
}

/// Whether the circles around two bodies are apart.
fn apart(a: &Robot, b: &Robot) -> bool {
    let [(p, r), (q, s)] = [a, b].map(|robot| {
        let body = robot.vehicle.body();
        let (sin, cos) = math::sin_cos(robot.pose.heading);
        let ahead = 0.5 * body.wheelbase;
        ([robot.pose.x + ahead * cos, robot.pose.y + ahead * sin], body.radius())
    });
    math::hypot(p[0] - q[0], p[1] - q[1]) > r + s
}

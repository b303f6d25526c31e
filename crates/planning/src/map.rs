//! A map: convex ground with convex obstacles on it, and how far everything has to stay off them.

use crate::convex::{Convex, Nearest, box_of};
use crate::error::{InputError, checked};
use crate::field::{Buckets, NearestGrid};
use std::fmt;

/// Ground, obstacles and clearance. Distances are exact: a grid only says which obstacles to ask.
#[derive(Debug, Clone)]
pub struct Map {
    ground: Convex,
    obstacles: Vec<Convex>,
    clearance: f64,
    nearest: NearestGrid,
    buckets: Buckets,
}

/// What a robot would touch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Boundary {
    /// An obstacle, by its number.
    Obstacle(usize),
    /// A side of the ground, by its number.
    Ground(usize),
}

impl fmt::Display for Boundary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Obstacle(index) => write!(f, "obstacle {index}"),
            Self::Ground(side) => write!(f, "side {side} of the ground"),
        }
    }
}

impl Map {
    /// `ground` is a convex polygon, `obstacles` may overlap it and each other, robots stay `clearance` m off both.
    ///
    /// # Errors
    /// The ground is a disc, or the clearance is negative or not finite.
    pub fn new(ground: Convex, obstacles: Vec<Convex>, clearance: f64) -> Result<Self, InputError> {
        let corners: Vec<_> = ground.corners().collect();
        if corners.len() < 3 {
            return Err(InputError::NoArea { what: "the ground".into(), corners: corners.len() });
        }
        checked(clearance, clearance >= 0.0, || "the clearance".into(), "0 or more, m")?;
        let [low, high] = box_of(&corners);
        let nearest = NearestGrid::new(low, high, &obstacles);
        let buckets = Buckets::new(low, high, &obstacles);
        Ok(Self { ground, obstacles, clearance, nearest, buckets })
    }

    /// The polygon on which robots drive.
    pub fn ground(&self) -> &Convex {
        &self.ground
    }

    /// What stands on it.
    pub fn obstacles(&self) -> &[Convex] {
        &self.obstacles
    }

    /// How far robots stay off everything, m.
    pub fn clearance(&self) -> f64 {
        self.clearance
    }

    /// Distance of a point to the nearest obstacle or to the edge of the ground, m; negative where it may not be.
    pub fn distance(&self, point: [f64; 2]) -> f64 {
        let among = self.nearest.candidates(point);
        let obstacles = among.iter().map(|index| self.obstacles[*index as usize].distance(point));
        obstacles.fold(-self.ground.distance(point), f64::min)
    }

    /// The same with the direction in which the distance grows, and whose it is.
    pub fn nearest(&self, point: [f64; 2]) -> (Nearest, Boundary) {
        let edge = self.ground.nearest(point);
        let inwards = Nearest { distance: -edge.distance, direction: edge.direction.map(|x| -x) };
        let mut found = (inwards, Boundary::Ground(self.ground.side_towards(point)));
        for index in self.nearest.candidates(point) {
            let nearest = self.obstacles[*index as usize].nearest(point);
            if nearest.distance < found.0.distance {
                found = (nearest, Boundary::Obstacle(*index as usize));
            }
        }
        found
    }

    /// Distance of a body to what is nearest, m; exact up to `far` m, at least that beyond.
    pub fn distance_of(&self, body: &Convex, far: f64) -> f64 {
        let edge = body.corners().map(|corner| -self.ground.distance(corner)).fold(f64::INFINITY, f64::min);
        let near = self.buckets.near(body.centre(), body.reach() + far);
        near.map(|index| self.obstacles[index].distance_to(body))
            .fold((edge - body.radius()).min(far), f64::min)
    }

    /// Numbers of the obstacles that are within `reach` m of a point, each once, in rising order.
    pub fn within(&self, point: [f64; 2], reach: f64) -> Vec<usize> {
        let mut near: Vec<usize> = self.buckets.near(point, reach).collect();
        near.sort_unstable();
        near.dedup();
        near.retain(|index| self.obstacles[*index].distance(point) <= reach);
        near
    }

    /// The map with another clearance: for a formation that starts nearer to something than it should be.
    ///
    /// # Errors
    /// The clearance is negative or not finite.
    pub fn with_clearance(&self, clearance: f64) -> Result<Self, InputError> {
        checked(clearance, clearance >= 0.0, || "the clearance".into(), "0 or more, m")?;
        Ok(Self { clearance, ..self.clone() })
    }

    /// The map with one more obstacle.
    #[must_use]
    pub fn with(&self, obstacle: Convex) -> Self {
        let mut obstacles = self.obstacles.clone();
        obstacles.push(obstacle);
        self.with_obstacles(obstacles)
    }

    /// The map without one of its obstacles.
    #[must_use]
    pub fn without(&self, obstacle: usize) -> Self {
        let mut obstacles = self.obstacles.clone();
        if obstacle < obstacles.len() {
            obstacles.remove(obstacle);
        }
        self.with_obstacles(obstacles)
    }

    fn with_obstacles(&self, obstacles: Vec<Convex>) -> Self {
        let corners: Vec<_> = self.ground.corners().collect();
        let [low, high] = box_of(&corners);
        let nearest = NearestGrid::new(low, high, &obstacles);
        let buckets = Buckets::new(low, high, &obstacles);
        Self { ground: self.ground.clone(), obstacles, clearance: self.clearance, nearest, buckets }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trial;
    use vocabulary::Pose;

    fn by_all(map: &Map, point: [f64; 2]) -> f64 {
        let obstacles = map.obstacles().iter().map(|obstacle| obstacle.distance(point));
        obstacles.fold(-map.ground().distance(point), f64::min)
    }

    #[test]
    fn the_grid_gives_the_distances_of_all_obstacles() {
        for (seed, count) in [(1, 1), (2, 20), (3, 300)] {
            let map = trial::map(seed, count);
            for k in 0..4000 {
                let [x, y] = [f64::from(k % 63), f64::from(k / 63)].map(|cell| -0.5 + 0.654_321 * cell);
                if map.ground().distance([x, y]) <= 0.0 {
                    assert_eq!(map.distance([x, y]), by_all(&map, [x, y]), "{x} {y}");
                }
                assert_eq!(map.nearest([x, y]).0.distance, map.distance([x, y]));
            }
        }
    }

    #[test]
    fn bodies_are_as_far_as_from_all_obstacles() {
        let map = trial::map(5, 100);
        for k in 0..400 {
            let at = Pose::new(2.0 + f64::from(k % 20) * 1.8, 2.0 + f64::from(k / 20) * 1.8, f64::from(k));
            let body = Convex::rectangle(at, [0.6, 0.3]).expect("a box");
            let all = map.obstacles().iter().map(|obstacle| obstacle.distance_to(&body));
            let edge = body.corners().map(|c| -map.ground().distance(c)).fold(f64::INFINITY, f64::min);
            assert_eq!(map.distance_of(&body, 1.0), all.fold(edge, f64::min).min(1.0));
        }
    }

    #[test]
    fn a_map_without_obstacles_is_bounded_by_its_ground() {
        let ground = Convex::rectangle(Pose::new(0.0, 0.0, 0.3), [5.0, 3.0]).expect("a box");
        let map = Map::new(ground, vec![], 0.1).expect("a map");
        assert!((map.distance([0.0, 0.0]) - 3.0).abs() < 1e-12);
        assert!(map.distance([9.0, 0.0]) < 0.0);
        assert!(matches!(map.nearest([0.0, 0.0]).1, Boundary::Ground(_)));
        let disc = Convex::disc([0.0, 0.0], 1.0).expect("a disc");
        assert!(Map::new(disc, vec![], 0.1).is_err());
    }
}

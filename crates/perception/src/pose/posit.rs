//! Pose of a solid from points that are not in one plane: POSIT (DeMenthon and Davis, "Model-based object pose in 25
//! lines of code", IJCV 15, 1995).
//!
//! A point M of the object is seen at (x, y) with x (1 + ε) = sR₁·M + sTx and likewise for y, where s = 1/Tz and
//! ε = R₃·M/Tz. Were ε known this would be linear in the first two rows of the rotation; POSIT starts from ε = 0 (a
//! scaled orthographic picture) and repeats.

use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};
use vocabulary::Rigid;

/// Rounds after which POSIT is told to have failed; it gains a digit or more per round unless the object is as deep as
/// it is far.
const ROUNDS: usize = 500;

/// Depths that change by less than this share have settled.
const SETTLED: f64 = 1e-14;

/// A point of an object (m, its own frame) and the direction (x/z, y/z) it is seen in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Match {
    /// m, object frame.
    pub point: [f64; 3],
    /// x/z and y/z in the camera's frame (x right, y down, z ahead).
    pub seen: [f64; 2],
}

/// The object's frame in the camera's by POSIT in its homogeneous form (DeMenthon's later one, also in `SoftPOSIT`, 2004):
/// the translation is solved for with the rotation, so no point is favoured.
///
/// `None` for fewer than four points, points in one plane, or if nothing in front of the camera came out of it.
pub fn posit(matches: &[Match]) -> Option<Rigid> {
    let middle = centroid(matches)?;
    let rows = |m: &Match| (Vector3::from(m.point) - middle).push(1.0);
    let squares: Matrix4<f64> = matches.iter().map(|m| rows(m) * rows(m).transpose()).sum();
    let inverse = spread_is_solid(matches, &middle).then(|| squares.try_inverse())??;
    settle(matches, &middle, |stretched| {
        let mut sums = [Vector4::zeros(); 2];
        for (m, [x, y]) in matches.iter().zip(stretched) {
            sums[0] += rows(m) * *x;
            sums[1] += rows(m) * *y;
        }
        let [i, j] = sums.map(|sum| inverse * sum);
        Some((i.xyz(), j.xyz(), [i.w, j.w]))
    })
}

/// Repeats `solve`, which gives I = sR₁, J = sR₂ and (sTx, sTy) for directions stretched by 1 + ε, until depths settle;
/// `origin` is the point they are given for.
fn settle(
    matches: &[Match],
    origin: &Vector3<f64>,
    mut solve: impl FnMut(&[[f64; 2]]) -> Option<(Vector3<f64>, Vector3<f64>, [f64; 2])>,
) -> Option<Rigid> {
    let mut stretched: Vec<[f64; 2]> = matches.iter().map(|m| m.seen).collect();
    let mut round = 0;
    loop {
        let (i, j, shift) = solve(&stretched)?;
        let (rotation, translation) = scaled_pose(&i, &j, shift)?;
        let points = matches.iter().map(|m| Vector3::from(m.point) - origin);
        let change = stretch(matches, points, &rotation, &translation, &mut stretched);
        // Rounding may keep the last digit moving: the caller judges the pose by its residual.
        if change < SETTLED || round == ROUNDS {
            return rigid(&rotation, &translation, origin);
        }
        if !change.is_finite() {
            return None;
        }
        round += 1;
    }
}

/// Stretches the directions of `matches` by 1 + ε for an object at this rotation and translation, its points relative to
/// the point that is translated; returns the largest change.
pub(super) fn stretch(
    matches: &[Match],
    points: impl Iterator<Item = Vector3<f64>>,
    rotation: &Matrix3<f64>,
    translation: &Vector3<f64>,
    stretched: &mut [[f64; 2]],
) -> f64 {
    let mut change = 0.0_f64;
    for ((m, point), stretched) in matches.iter().zip(points).zip(stretched) {
        let depth = rotation.row(2).transpose().dot(&point) / translation.z;
        let next = m.seen.map(|x| x * (1.0 + depth));
        change = change.max((next[0] - stretched[0]).abs()).max((next[1] - stretched[1]).abs());
        *stretched = next;
    }
    change
}

/// Rotation and translation from I = sR₁, J = sR₂ and (sTx, sTy).
pub(super) fn scaled_pose(
    i: &Vector3<f64>,
    j: &Vector3<f64>,
    shift: [f64; 2],
) -> Option<(Matrix3<f64>, Vector3<f64>)> {
    let scale = (i.norm() * j.norm()).sqrt();
    if !(scale.is_finite() && scale > 1e-9) {
        return None;
    }
    // I and J are at right angles only without noise: each gives up half of what they lack.
    let (a, b) = (i.normalize(), j.normalize());
    let (sum, difference) = ((a + b).try_normalize(1e-9)?, (a - b).try_normalize(1e-9)?);
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let (first, second) = ((sum + difference) * half, (sum - difference) * half);
    let rotation =
        Matrix3::from_rows(&[first.transpose(), second.transpose(), first.cross(&second).transpose()]);
    Some((rotation, Vector3::new(shift[0] / scale, shift[1] / scale, 1.0 / scale)))
}

/// The frame in the camera's whose point `origin` is seen at `translation`; `None` if that is no number.
pub(super) fn rigid(
    rotation: &Matrix3<f64>,
    translation: &Vector3<f64>,
    origin: &Vector3<f64>,
) -> Option<Rigid> {
    let t = translation - rotation * origin;
    let finite = rotation.iter().chain(t.iter()).all(|x| x.is_finite());
    finite.then(|| Rigid {
        rotation: [0, 1, 2].map(|r| [0, 1, 2].map(|c| rotation[(r, c)])),
        translation: [t.x, t.y, t.z],
    })
}

/// Middle of the points, m; `None` for fewer than four or for numbers that are none.
pub(super) fn centroid(matches: &[Match]) -> Option<Vector3<f64>> {
    let finite = matches.iter().all(|m| m.point.iter().chain(&m.seen).all(|x| x.is_finite()));
    (finite && matches.len() >= 4)
        .then(|| matches.iter().map(|m| Vector3::from(m.point)).sum::<Vector3<f64>>() / matches.len() as f64)
}

/// Whether points extend in all three directions: in the narrowest by 1% of the widest.
fn spread_is_solid(matches: &[Match], middle: &Vector3<f64>) -> bool {
    let spread: Matrix3<f64> = matches
        .iter()
        .map(|m| (Vector3::from(m.point) - middle) * (Vector3::from(m.point) - middle).transpose())
        .sum();
    let spreads = spread.symmetric_eigenvalues();
    spreads.min() > 1e-4 * spreads.max()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::tests::{Views, frames_apart, matches_of};
    use vocabulary::math;

    /// The object's frame in the camera's by POSIT as first published: everything is measured from the first point, whose
    /// error so enters every other.
    fn classic_posit(matches: &[Match]) -> Option<Rigid> {
        let origin = Vector3::from(matches.first()?.point);
        let middle = centroid(matches)?;
        let rows = |m: &Match| Vector3::from(m.point) - origin;
        let squares: Matrix3<f64> = matches.iter().map(|m| rows(m) * rows(m).transpose()).sum();
        let inverse = spread_is_solid(matches, &middle).then(|| squares.try_inverse())??;
        let [x0, y0] = matches.first()?.seen;
        settle(matches, &origin, |stretched| {
            let mut sums = [Vector3::zeros(); 2];
            for (m, [x, y]) in matches.iter().zip(stretched) {
                sums[0] += rows(m) * (x - x0);
                sums[1] += rows(m) * (y - y0);
            }
            let [i, j] = sums.map(|sum| inverse * sum);
            Some((i, j, [x0, y0]))
        })
    }

    #[test]
    fn exact_points_give_the_pose() {
        let mut views = Views::seeded(1);
        let (mut tried, mut worst) = (0, 0.0_f64);
        for _ in 0..400 {
            let view = views.next(0.5..6.0);
            // Nearer than this the corners' depths differ by more than their mean, and the iteration may not converge.
            if view.faces.len() < 2 || view.camera_from_body.translation[2] < 0.55 {
                continue;
            }
            tried += 1;
            for found in [posit(&matches_of(&view)), classic_posit(&matches_of(&view))] {
                let found = found.expect("a pose");
                let off = frames_apart(&found, &view.camera_from_body);
                if off > 1e-9 {
                    println!(
                        "OFF {off:e} {:.3} faces {}",
                        view.camera_from_body.translation[2],
                        view.faces.len()
                    );
                }
                worst = worst.max(off);
            }
        }
        assert!(tried > 200 && worst < 1e-9, "{worst:e} in {tried}");
    }

    /// Half a metre from camera to shell, with corners off by a fifth of a pixel.
    #[test]
    fn the_classic_form_is_worse_close_up() {
        let mut views = Views::seeded(2);
        let (mut classic, mut homogeneous, mut n) = (0.0, 0.0, 0.0);
        for _ in 0..600 {
            let view = views.next(0.65..0.66).noisy(0.2, &mut views);
            if view.faces.len() < 2 {
                continue;
            }
            let matches = matches_of(&view);
            let off = |found: Option<Rigid>| {
                found.map_or(1.0, |f| math::powi(frames_apart(&f, &view.camera_from_body), 2))
            };
            classic += off(classic_posit(&matches));
            homogeneous += off(posit(&matches));
            n += 1.0;
        }
        let (classic, homogeneous) = ((classic / n).sqrt(), (homogeneous / n).sqrt());
        assert!(n > 200.0 && homogeneous < 0.8 * classic, "{homogeneous:.2e} against {classic:.2e}");
    }

    #[test]
    fn points_in_a_plane_are_refused() {
        let flat = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.2]]
            .map(|[x, y]| Match { point: [x, y, 0.0], seen: [x / 4.0, y / 4.0] });
        assert_eq!(posit(&flat), None);
        assert_eq!(classic_posit(&flat), None);
        assert_eq!(posit(&flat[..3]), None);
    }
}

//! The boundary layer of the observer: A₀ and P₀ (eqs 37-41).

use crate::observer::Observer;
use nalgebra::{Matrix4, SMatrix, SVector};

/// P₀ with P₀A₀ + A₀ᵀP₀ = −I and what the bounds take from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundaryLayer {
    /// P₀, symmetric; rows and columns are [η₁ distance, η₁ bearing, η₂ distance, η₂ bearing].
    pub matrix: Matrix4<f64>,
    /// Its smallest eigenvalue.
    pub least: f64,
    /// Its largest eigenvalue, which is ‖P₀‖.
    pub norm: f64,
}

/// A₀ = [[−α1, I], [−α2, 0]] (eq 37).
pub fn system(observer: &Observer) -> Matrix4<f64> {
    let (a, b) = (observer.alpha1, observer.alpha2);
    Matrix4::new(
        -a[0], 0.0, 1.0, 0.0, //
        0.0, -a[1], 0.0, 1.0, //
        -b[0], 0.0, 0.0, 0.0, //
        0.0, -b[1], 0.0, 0.0,
    )
}

/// P with PA + AᵀP = −I; `None` where there is none, which means that A is not Hurwitz.
pub fn lyapunov(a: &Matrix4<f64>) -> Option<Matrix4<f64>> {
    let eye = Matrix4::<f64>::identity();
    // vec(PA + AᵀP) = (Aᵀ ⊗ I + I ⊗ Aᵀ) vec P, columns of P one below the other.
    let both: SMatrix<f64, 16, 16> = a.transpose().kronecker(&eye) + eye.kronecker(&a.transpose());
    let right = SVector::<f64, 16>::from_column_slice((-eye).as_slice());
    let solved = both.lu().solve(&right)?;
    let p = Matrix4::from_column_slice(solved.as_slice());
    let p = (p + p.transpose()) / 2.0;
    // Only a Hurwitz matrix has a positive definite solution.
    p.cholesky().map(|_| p)
}

impl BoundaryLayer {
    /// That of an observer; `None` where s² + α1 s + α2 has a root that is not stable.
    pub fn of(observer: &Observer) -> Option<Self> {
        let matrix = lyapunov(&system(observer))?;
        let eigenvalues = matrix.symmetric_eigenvalues();
        Some(Self { matrix, least: eigenvalues.min(), norm: eigenvalues.max() })
    }

    /// W = ηᵀP₀η (eq 39).
    pub fn energy(&self, eta: &[f64; 4]) -> f64 {
        let eta = SVector::<f64, 4>::from(*eta);
        (eta.transpose() * self.matrix * eta)[0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::boundary_layer;

    fn observer(alpha1: [f64; 2], alpha2: [f64; 2]) -> Observer {
        Observer { epsilon: [0.01; 2], alpha1, alpha2, distance_min: 0.1 }
    }

    #[test]
    fn it_is_the_closed_form_of_every_channel() {
        let layer = BoundaryLayer::of(&observer([2.0, 0.7], [1.0, 3.0])).expect("stable");
        for (k, (a, b)) in [(2.0, 1.0), (0.7, 3.0)].into_iter().enumerate() {
            let [p11, p12, p22] = boundary_layer(a, b);
            let m = &layer.matrix;
            for (found, wanted) in [(m[(k, k)], p11), (m[(k, k + 2)], p12), (m[(k + 2, k + 2)], p22)] {
                assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
            }
        }
        assert!(layer.matrix[(0, 1)].abs() < 1e-12 && layer.matrix[(0, 3)].abs() < 1e-12);
    }

    #[test]
    fn the_papers_choice_in_closed_form() {
        let layer = BoundaryLayer::of(&observer([2.0; 2], [1.0; 2])).expect("stable");
        let root = 0.5_f64.sqrt();
        assert!((layer.norm - (1.0 + root)).abs() < 1e-12 && (layer.least - (1.0 - root)).abs() < 1e-12);
        assert!((layer.energy(&[1.0, 0.0, 1.0, 0.0]) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn what_is_not_stable_has_none() {
        assert_eq!(BoundaryLayer::of(&observer([-1.0, 2.0], [1.0; 2])), None);
        assert_eq!(BoundaryLayer::of(&observer([2.0; 2], [1.0, -1.0])), None);
        assert_eq!(BoundaryLayer::of(&observer([0.0; 2], [1.0; 2])), None);
    }
}

//! Moments of a density by sampling.

use super::estimate::{Estimate, Moments, body, checked};
use super::random::Random;
use pendulum_core::body::BodyError;

/// A region of the plane, defined by a bounding box and a test for points inside.
pub trait Region {
    /// Returns the lower left and upper right corners of a bounding box, in metres from the pivot.
    fn bounds(&self) -> ([f64; 2], [f64; 2]);

    /// Returns `true` if the point is inside the region.
    fn contains(&self, point: [f64; 2]) -> bool;

    /// Estimates the body with the given `density` in kg/m² inside the region from `samples` random
    /// points in the bounding box.
    ///
    /// Each error is one standard error, for the centre to first order (a ratio of two means).
    /// Errors decrease with the square root of the number of samples. Equal seeds give the same
    /// bits on every machine.
    fn monte_carlo(
        &self,
        mut density: impl FnMut([f64; 2]) -> f64,
        samples: usize,
        seed: u64,
    ) -> Result<Estimate, BodyError>
    where
        Self: Sized,
    {
        let (low, high) = self.bounds();
        let size = [high[0] - low[0], high[1] - low[1]];
        let origin = [low[0] + 0.5 * size[0], low[1] + 0.5 * size[1]];
        let mut random = Random::new(seed);
        let mut sums = Sums::default();
        let mut evaluations = 0;
        for _ in 0..samples {
            let point = [low[0] + size[0] * random.unit(), low[1] + size[1] * random.unit()];
            if self.contains(point) {
                evaluations += 1;
                let value = checked(&mut density, point)?;
                sums.add(value, [point[0] - origin[0], point[1] - origin[1]], point);
            }
        }
        sums.estimate(size[0] * size[1], origin, samples, evaluations)
    }
}

/// Sums over samples of weight w at local points p, and the sums of squares for the errors.
#[derive(Default)]
struct Sums {
    moments: Moments,
    /// Σw², Σw²x, Σw²y, Σw²x², Σw²y².
    squares: [f64; 5],
    /// Σ(w r²)² with r from the pivot.
    inertia: f64,
    inertia_square: f64,
}

impl Sums {
    fn add(&mut self, w: f64, [x, y]: [f64; 2], point: [f64; 2]) {
        for (sum, factor) in self.moments.iter_mut().zip([1.0, x, y, x * x, x * y, y * y]) {
            *sum += w * factor;
        }
        for (sum, factor) in self.squares.iter_mut().zip([1.0, x, y, x * x, y * y]) {
            *sum += w * w * factor;
        }
        let inertia = w * (point[0] * point[0] + point[1] * point[1]);
        self.inertia += inertia;
        self.inertia_square += inertia * inertia;
    }

    fn estimate(
        self,
        area: f64,
        origin: [f64; 2],
        samples: usize,
        evaluations: usize,
    ) -> Result<Estimate, BodyError> {
        let count = samples as f64;
        if samples < 2 {
            let required = "two or more, for a standard error";
            return Err(BodyError::Argument { name: "number of samples", value: count, required });
        }
        let share = area / count;
        let body = body(&self.moments.map(|sum| share * sum), origin)?;
        // The variance of a sum of n independent terms with the sum s and the sum of squares q:
        // n/(n − 1) (q − s²/n).
        let sum_error =
            |sum: f64, square: f64| root(count / (count - 1.0) * (square - sum * sum / count));
        let [w, x, y, xx, yy] = self.squares;
        let center = |axis: usize, first: f64, second: f64| {
            let c = body.center[axis] - origin[axis];
            root(count / (count - 1.0) * (second - 2.0 * c * first + c * c * w)) / self.moments[0]
        };
        Ok(Estimate {
            body,
            mass_error: share * sum_error(self.moments[0], w),
            center_error: [center(0, x, xx), center(1, y, yy)],
            inertia_error: share * sum_error(self.inertia, self.inertia_square),
            evaluations,
        })
    }
}

/// Returns the square root of a value that is negative only by rounding errors.
fn root(value: f64) -> f64 {
    if 0.0 < value { value.sqrt() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::super::{Body, BodyError, Ellipse, Estimate, Polygon};
    use super::Region;

    fn corner() -> Polygon {
        let corner =
            Polygon::new(&[[0.0, 0.0], [3.0, 0.5], [3.0, 1.0], [1.0, 1.0], [1.5, 2.0], [0.5, 2.5]])
                .unwrap();
        corner.hole(&[[0.5, 0.5], [1.0, 0.75], [0.75, 1.5]]).unwrap()
    }

    /// Returns the deviations from the exact body in standard errors.
    fn deviations(found: &Estimate, exact: &Body) -> [f64; 4] {
        [
            (found.body.mass - exact.mass) / found.mass_error,
            (found.body.center[0] - exact.center[0]) / found.center_error[0],
            (found.body.center[1] - exact.center[1]) / found.center_error[1],
            (found.body.inertia() - exact.inertia()) / found.inertia_error,
        ]
    }

    #[test]
    fn exact_values_lie_within_four_standard_errors() {
        let (polygon, ellipse) = (corner(), Ellipse::new([0.5, -2.0], 1.5, 0.25, 0.6).unwrap());
        for seed in 100..120 {
            for (found, exact) in [
                (polygon.monte_carlo(|_| 2.0, 10_000, seed), polygon.body(2.0)),
                (ellipse.monte_carlo(|_| 2.0, 10_000, seed), ellipse.body(2.0)),
            ] {
                let deviations = deviations(&found.unwrap(), &exact.unwrap());
                assert!(deviations.iter().all(|deviation| deviation.abs() < 4.0), "{deviations:?}");
            }
        }
    }

    #[test]
    fn standard_errors_are_neither_too_small_nor_too_large() {
        // The mean of 400 squared deviations is 1, with a standard error of √(2/400). The mass is
        // concentrated at one end, far from the middle of the box.
        let density = |[x, _]: [f64; 2]| x * x * x;
        let exact = corner().quadrature(density, 1e-9).unwrap().body;
        let mut squares = [0.0; 4];
        for seed in 0..400 {
            let found = corner().monte_carlo(density, 2000, seed).unwrap();
            for (sum, deviation) in squares.iter_mut().zip(deviations(&found, &exact)) {
                *sum += deviation * deviation / 400.0;
            }
        }
        assert!(squares.iter().all(|mean| (mean - 1.0).abs() < 4.0 * 0.0707), "{squares:?}");
    }

    #[test]
    fn errors_fall_with_the_root_of_the_samples() {
        let exact = corner().body(1.0).unwrap();
        let root_mean_square = |samples| {
            let mut sum = 0.0;
            for seed in 0..100 {
                let apart =
                    corner().monte_carlo(|_| 1.0, samples, seed).unwrap().body.mass - exact.mass;
                sum += apart * apart;
            }
            f64::sqrt(sum / 100.0)
        };
        // Sixteen times as many samples have a quarter of the error; the ratio of two such means
        // scatters by a tenth.
        let ratio = root_mean_square(500) / root_mean_square(8000);
        assert!((ratio / 4.0 - 1.0).abs() < 0.4, "{ratio}");
    }

    #[test]
    fn varying_density_agrees_with_quadrature() {
        let density = |[x, y]: [f64; 2]| 1.0 + x * y * y;
        let exact = corner().quadrature(density, 1e-12).unwrap().body;
        let deviations = deviations(&corner().monte_carlo(density, 100_000, 9).unwrap(), &exact);
        assert!(deviations.iter().all(|deviation| deviation.abs() < 4.0), "{deviations:?}");
    }

    #[test]
    fn same_seed_same_bits() {
        let found = |seed| corner().monte_carlo(|_| 1.0, 1000, seed).unwrap();
        assert_eq!(found(1), found(1));
        assert_ne!(found(1), found(2));
    }

    #[test]
    fn regions_of_ones_own_can_be_sampled() {
        /// The upper half of the unit disc: c = 4/(3π), I = π/4.
        struct Half;
        impl Region for Half {
            fn bounds(&self) -> ([f64; 2], [f64; 2]) {
                ([-1.0, 0.0], [1.0, 1.0])
            }
            fn contains(&self, [x, y]: [f64; 2]) -> bool {
                x * x + y * y <= 1.0
            }
        }
        let found = Half.monte_carlo(|_| 1.0, 100_000, 3).unwrap();
        let pi = core::f64::consts::PI;
        assert!((found.body.center[1] - 4.0 / (3.0 * pi)).abs() < 4.0 * found.center_error[1]);
        assert!((found.body.inertia() - pi / 4.0).abs() < 4.0 * found.inertia_error);
        assert!((found.mass_error / 0.0026 - 1.0).abs() < 0.02);
    }

    #[test]
    fn samples_without_mass_are_refused() {
        assert_eq!(corner().monte_carlo(|_| 0.0, 100, 1), Err(BodyError::NoMass));
        assert_eq!(
            corner().monte_carlo(|_| 1.0, 1, 1),
            Err(BodyError::Argument {
                name: "number of samples",
                value: 1.0,
                required: "two or more, for a standard error"
            })
        );
        assert!(matches!(
            corner().monte_carlo(|_| -1.0, 100, 1),
            Err(BodyError::Density { value: -1.0, .. })
        ));
    }
}

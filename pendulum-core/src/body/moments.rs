//! Bodies as their moments: mass, first and second moments about the pivot.

use crate::body::error::BodyError;
use crate::scalar::Real;
use core::ops::Add;

/// The moments of a rigid planar body in the equations of motion: ∫ρ dp, ∫ρ p dp and ∫ρ p pᵀ dp.
///
/// The second moments are stored about the centre of mass, where they do not depend on the pivot
/// and are free of cancellation. The fields are independent of each other; what follows from them
/// is a method: `B.inertia` of a block is [`inertia()`](Self::inertia) in Rust.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Body<T = f64> {
    /// The mass m, in kg.
    pub mass: T,
    /// The centre of mass c relative to the pivot, in m.
    pub center: [T; 2],
    /// ∫ρ x² dp, ∫ρ x y dp and ∫ρ y² dp about the centre of mass, in kg m².
    pub central: [T; 3],
}

impl<T: Real> Body<T> {
    /// Returns the moment of inertia about the pivot, I = ∫ρ |p|² dp, in kg m².
    pub fn inertia(&self) -> T {
        let [x, y] = self.center;
        self.inertia_about_center() + self.mass * (x * x + y * y)
    }

    /// Returns the moment of inertia about the centre of mass, I − m|c|², in kg m².
    pub fn inertia_about_center(&self) -> T {
        self.central[0] + self.central[2]
    }

    /// Returns ∫ρ x² dp, ∫ρ x y dp and ∫ρ y² dp about the pivot, in kg m².
    pub fn moments(&self) -> [T; 3] {
        let [x, y] = self.center;
        let [xx, xy, yy] = self.central;
        [xx + self.mass * x * x, xy + self.mass * x * y, yy + self.mass * y * y]
    }

    /// Moves the body by `offset` relative to its pivot.
    pub fn translated(self, offset: [T; 2]) -> Self {
        let [x, y] = self.center;
        Self { center: [x + offset[0], y + offset[1]], ..self }
    }

    /// Changes the pivot to a point given relative to the current one.
    pub fn with_pivot(self, pivot: [T; 2]) -> Self {
        self.translated([-pivot[0], -pivot[1]])
    }

    /// Rotates the body counter-clockwise about its pivot by `angle` in radians.
    pub fn rotated(self, angle: T) -> Self {
        let (sin, cos) = angle.sin_cos();
        let [x, y] = self.center;
        let [xx, xy, yy] = self.central;
        let cross = cos * sin * xy;
        Self {
            center: [cos * x - sin * y, sin * x + cos * y],
            central: [
                cos * cos * xx - (cross + cross) + sin * sin * yy,
                cos * sin * (xx - yy) + (cos * cos - sin * sin) * xy,
                sin * sin * xx + (cross + cross) + cos * cos * yy,
            ],
            ..self
        }
    }

    /// Multiplies the density by `factor`.
    pub fn scaled(self, factor: T) -> Self {
        Self {
            mass: self.mass * factor,
            central: self.central.map(|moment| moment * factor),
            ..self
        }
    }

    /// Maps every number: mass, centre and moments, in the order of the fields.
    pub fn map<U>(self, mut map: impl FnMut(T) -> U) -> Body<U> {
        Body {
            mass: map(self.mass),
            center: self.center.map(&mut map),
            central: self.central.map(&mut map),
        }
    }
}

impl<T: Real> Add for Body<T> {
    type Output = Self;

    /// Combines two bodies on a common pivot, by the parallel-axis theorem. The sum of their masses
    /// must not be zero.
    fn add(self, other: Self) -> Self {
        let mass = self.mass + other.mass;
        let part = other.mass / mass;
        let [x, y] = [other.center[0] - self.center[0], other.center[1] - self.center[1]];
        let reduced = self.mass * part;
        Self {
            mass,
            center: [self.center[0] + part * x, self.center[1] + part * y],
            central: [
                self.central[0] + other.central[0] + reduced * x * x,
                self.central[1] + other.central[1] + reduced * x * y,
                self.central[2] + other.central[2] + reduced * y * y,
            ],
        }
    }
}

/// Sums and differences of distributions of mass, in a plane and in space.
macro_rules! sums {
    ($body:ident) => {
        impl $body {
            /// Adds `bodies`; overlaps count several times.
            pub fn compound(bodies: impl IntoIterator<Item = Self>) -> Result<Self, BodyError> {
                let mut sum: Option<Self> = None;
                for body in bodies {
                    let body = body.checked()?;
                    sum = Some(sum.map_or(body, |sum| sum + body));
                }
                sum.ok_or(BodyError::NoMass)?.checked()
            }

            /// Removes `hole`, which must lie inside the body.
            pub fn without(self, hole: Self) -> Result<Self, BodyError> {
                let (body, hole) = (self.checked()?, hole.checked()?);
                if body.mass <= hole.mass {
                    return Err(BodyError::NoMass);
                }
                (body + hole.scaled(-1.0)).checked()
            }

            /// Returns the same distribution with another total mass.
            pub fn with_mass(self, mass: f64) -> Result<Self, BodyError> {
                let body = self.checked()?;
                Ok(Self { mass, ..body.scaled(mass / body.mass) }).and_then(Self::checked)
            }
        }
    };
}

pub(super) use sums;

sums!(Body);

impl Body {
    /// Creates a body from its mass, centre, and moment of inertia about the pivot.
    ///
    /// Returns an error if the inertia is less than m|c|². The second moments are those of an
    /// isotropic body, which makes no difference in equations of motion that depend only on the
    /// moment of inertia.
    pub fn from_inertia(mass: f64, center: [f64; 2], inertia: f64) -> Result<Self, BodyError> {
        let least = mass * (center[0] * center[0] + center[1] * center[1]);
        if inertia < least {
            return Err(BodyError::LittleInertia { inertia, least });
        }
        let half = 0.5 * (inertia - least);
        Self { mass, center, central: [half, 0.0, half] }.checked()
    }

    /// Returns the body if a distribution of mass with these moments exists: all numbers are
    /// finite, the mass is positive, and the tensor of second moments is positive semidefinite up
    /// to rounding.
    pub fn checked(self) -> Result<Self, BodyError> {
        positive("mass", self.mass)?;
        let [xx, xy, yy] = self.central;
        if self.center.iter().chain(&self.central).any(|number| !number.is_finite()) {
            return Err(BodyError::OutOfRange);
        }
        let trace = xx + yy;
        let slack = 1e-12 * trace;
        if 0.0 <= trace && -slack <= xx && -slack <= yy && xy * xy <= xx * yy + slack * trace {
            Ok(self)
        } else {
            Err(BodyError::Moments { central: self.central })
        }
    }
}

/// Returns `value` if it is positive and finite.
pub(super) fn positive(name: &'static str, value: f64) -> Result<f64, BodyError> {
    if 0.0 < value && value < f64::INFINITY {
        Ok(value)
    } else {
        Err(BodyError::Argument { name, value, required: "positive and finite" })
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::{Body, BodyError};
    use crate::scalar::{Dual, Real};

    pub(in crate::body) fn close(a: f64, b: f64, relative: f64) {
        assert!((a - b).abs() <= relative * b.abs(), "{a} is not {b}");
    }

    /// Checks that mass, centre and second moments agree, in units of the size of the body.
    pub(in crate::body) fn same(a: Body, b: Body, relative: f64) {
        let size = (b.inertia() / b.mass).sqrt();
        close(a.mass, b.mass, relative);
        for index in 0..2 {
            let apart = (a.center[index] - b.center[index]).abs();
            assert!(apart <= relative * size, "{a:?} is not {b:?}");
        }
        for index in 0..3 {
            let apart = (a.central[index] - b.central[index]).abs();
            assert!(apart <= relative * b.inertia(), "{a:?} is not {b:?}");
        }
    }

    fn plank() -> Body {
        Body::rectangle(2.0, 3.0, 0.5).unwrap().rotated(0.3).translated([0.7, -1.1])
    }

    #[test]
    fn moving_changes_nothing_about_the_centre() {
        let body = plank();
        let moved = body.translated([1e6, -2e6]);
        assert_eq!((moved.central, moved.mass), (body.central, body.mass));
        assert_eq!(moved.with_pivot([1e6, -2e6]).central, body.central);
        let at_center = body.with_pivot(body.center);
        assert_eq!(
            (at_center.center, at_center.inertia()),
            ([0.0, 0.0], body.inertia_about_center())
        );
    }

    #[test]
    fn parallel_axes_add_mass_times_distance_squared() {
        let body = plank();
        close(body.inertia(), body.inertia_about_center() + 2.0 * (0.49 + 1.21), 1e-15);
        close(body.inertia_about_center(), 2.0 * (9.0 + 0.25) / 12.0, 1e-15);
        let [xx, xy, yy] = body.moments();
        close(xx + yy, body.inertia(), 1e-15);
        close(xy, body.central[1] - 2.0 * 0.7 * 1.1, 1e-15);
    }

    #[test]
    fn turning_keeps_the_inertia_and_comes_back() {
        let body = plank();
        for angle in [0.1, 1.0, 2.5, -7.0] {
            let turned = body.rotated(angle);
            close(turned.inertia(), body.inertia(), 1e-15);
            close(turned.inertia_about_center(), body.inertia_about_center(), 1e-15);
            same(turned.rotated(-angle), body, 1e-15);
        }
        // A quarter turn exchanges the axes.
        let upright = Body::rectangle(1.0, 3.0, 1.0).unwrap().rotated(core::f64::consts::FRAC_PI_2);
        same(upright, Body::rectangle(1.0, 1.0, 3.0).unwrap(), 1e-15);
    }

    #[test]
    fn two_halves_are_the_whole() {
        let half = Body::rectangle(1.0, 1.0, 2.0).unwrap();
        let whole = half.translated([-0.5, 0.0]) + half.translated([0.5, 0.0]);
        same(whole, Body::rectangle(2.0, 2.0, 2.0).unwrap(), 1e-15);
    }

    #[test]
    fn three_squares_in_a_row_are_a_bar() {
        let square = Body::rectangle(1.0, 1.0, 1.0).unwrap();
        let bar = Body::compound([0.5, 1.5, 2.5].map(|y| square.translated([0.0, -y]))).unwrap();
        same(bar, Body::rectangle(3.0, 1.0, 3.0).unwrap().translated([0.0, -1.5]), 1e-15);
        close(bar.inertia(), 3.0 * (10.0 / 12.0 + 2.25), 1e-15);
    }

    #[test]
    fn the_order_of_a_compound_does_not_matter() {
        let parts = [
            plank(),
            Body::disc(0.3, 0.2).unwrap().translated([2.0, 1.0]),
            Body::point(1.5, [-1.0, 0.5]).unwrap(),
        ];
        let [a, b, c] = parts;
        same((a + b) + c, c + (b + a), 1e-15);
    }

    #[test]
    fn what_is_cut_out_can_be_put_back() {
        let hole = Body::disc(0.25, 0.1).unwrap().translated([0.6, -1.0]);
        let rest = plank().without(hole).unwrap();
        same(rest + hole, plank(), 1e-15);
        assert_eq!(hole.without(plank()), Err(BodyError::NoMass));
        assert_eq!(hole.without(hole), Err(BodyError::NoMass));
        // Lighter than the body, but outside of it.
        let outside = Body::disc(0.25, 0.1).unwrap().translated([30.0, 0.0]);
        assert!(matches!(plank().without(outside), Err(BodyError::Moments { .. })));
    }

    #[test]
    fn density_scales_mass_and_moments_alone() {
        let heavy = plank().scaled(3.0);
        assert_eq!((heavy.mass, heavy.center), (6.0, plank().center));
        close(heavy.inertia(), 3.0 * plank().inertia(), 1e-15);
        same(heavy.with_mass(2.0).unwrap(), plank(), 1e-15);
        let massless = plank().with_mass(0.0);
        assert!(matches!(massless, Err(BodyError::Argument { name: "mass", value: 0.0, .. })));
    }

    #[test]
    fn inertia_alone_makes_a_body() {
        let body = Body::from_inertia(2.0, [3.0, 4.0], 60.0).unwrap();
        assert_eq!((body.inertia(), body.inertia_about_center()), (60.0, 10.0));
        assert_eq!(
            Body::from_inertia(2.0, [3.0, 4.0], 49.0),
            Err(BodyError::LittleInertia { inertia: 49.0, least: 50.0 })
        );
        assert_eq!(Body::from_inertia(1.0, [f64::NAN, 0.0], 1.0), Err(BodyError::OutOfRange));
    }

    #[test]
    fn impossible_bodies_are_refused() {
        assert_eq!(Body::compound([]), Err(BodyError::NoMass));
        let body = plank();
        assert!(matches!(
            Body { mass: -1.0, ..body }.checked(),
            Err(BodyError::Argument { name: "mass", value: -1.0, .. })
        ));
        assert!(matches!(
            Body { mass: f64::NAN, ..body }.checked(),
            Err(BodyError::Argument { name: "mass", .. })
        ));
        for central in [[1.0, 2.0, 1.0], [-1.0, 0.0, 2.0], [2.0, 0.0, -1.0]] {
            assert_eq!(Body { central, ..body }.checked(), Err(BodyError::Moments { central }));
            assert_eq!(
                Body::compound([body, Body { central, ..body }]),
                Err(BodyError::Moments { central })
            );
        }
        let far = body.translated([1e200, 0.0]);
        assert_eq!(Body::compound([far, body]), Err(BodyError::OutOfRange));
    }

    #[test]
    fn properties_differentiate() {
        // dI/dy of a body that moves down: 2 m y.
        let body =
            plank().map(Dual::from_f64).translated([Dual::constant(0.0), Dual::variable(0.0)]);
        close(body.inertia().derivative, -2.0 * 2.0 * 1.1, 1e-15);
        assert_eq!(body.map(|number| number.value), plank());
    }
}

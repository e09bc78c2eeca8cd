//! Solids in space as their moments: mass, first and second moments about the origin.

use crate::attitude::Attitude;
use crate::body::error::BodyError;
use crate::body::moments::{positive, sums};
use crate::scalar::Real;
use core::ops::Add;
use nalgebra::{Matrix3, SMatrix};

/// The ten moments of a solid in space: ∫ρ dp, ∫ρ p dp and ∫ρ p pᵀ dp.
///
/// Points p are given along axes fixed in the solid, from an origin fixed in it. The second moments
/// are stored about the centre of mass, where they do not depend on the origin and are free of
/// cancellation. What follows from the moments is a method: `B.inertia` of a block is
/// [`inertia()`](Self::inertia) in Rust.
///
/// Lengths are in metres, masses in kilograms.
///
/// ```
/// use pendulum_runtime::body::{BodyError, Solid};
/// # fn main() -> Result<(), BodyError> {
/// // A hammer, with its origin at the end of the handle: a handle of wood and a head of steel.
/// let handle = Solid::cylinder(0.3, 0.015, 0.35)?.translated([0.0, 0.0, 0.175]);
/// let head = Solid::cuboid(0.8, [0.12, 0.03, 0.03])?.translated([0.0, 0.0, 0.35]);
/// let hammer = handle + head;
/// let (moments, axes) = hammer.principal();
/// assert!(moments[0] < moments[1] && moments[1] < moments[2]);
/// # let _ = axes;
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Solid<T = f64> {
    /// The mass m, in kg.
    pub mass: T,
    /// The centre of mass c, in m.
    pub center: [T; 3],
    /// The integrals of ρ times x², y², z², x y, x z and y z about the centre of mass, in kg m².
    pub central: [T; 6],
}

/// The components of the second moments, in the order of [`Solid::central`].
const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];

impl<T: Real> Solid<T> {
    /// Returns the inertia matrix about the origin, ∫ρ (|p|² 1 − p pᵀ) dp, in kg m².
    pub fn inertia(&self) -> SMatrix<T, 3, 3> {
        inertia_of(self.moments())
    }

    /// Returns the inertia matrix about the centre of mass, in kg m².
    pub fn inertia_about_center(&self) -> SMatrix<T, 3, 3> {
        inertia_of(self.central)
    }

    /// Returns the integrals of ρ times x², y², z², x y, x z and y z about the origin, in kg m².
    pub fn moments(&self) -> [T; 6] {
        with_point(self.central, self.mass, self.center)
    }

    /// Moves the solid by `offset` relative to its origin.
    #[must_use]
    pub fn translated(self, offset: [T; 3]) -> Self {
        Self { center: core::array::from_fn(|k| self.center[k] + offset[k]), ..self }
    }

    /// Turns the solid about its origin.
    #[must_use]
    pub fn rotated(self, turn: Attitude<T>) -> Self {
        let matrix: [[T; 3]; 3] = turn.to_matrix().into();
        let [xx, yy, zz, xy, xz, yz] = self.central;
        let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        // The columns of the matrix are the turned axes: half of M S Mᵀ, then the other half.
        let half = rows.map(|[x, y, z]| {
            core::array::from_fn(|k| x * matrix[0][k] + y * matrix[1][k] + z * matrix[2][k])
        });
        let [x, y, z]: [[T; 3]; 3] = half;
        let central =
            PAIRS.map(|[i, k]| matrix[0][i] * x[k] + matrix[1][i] * y[k] + matrix[2][i] * z[k]);
        Self { center: turn * self.center, central, ..self }
    }

    /// Multiplies the density by `factor`.
    #[must_use]
    pub fn scaled(self, factor: T) -> Self {
        let central = self.central.map(|moment| moment * factor);
        Self { mass: self.mass * factor, central, ..self }
    }

    /// Maps every number: mass, centre and moments, in the order of the fields.
    pub fn map<U>(self, mut map: impl FnMut(T) -> U) -> Solid<U> {
        Solid {
            mass: map(self.mass),
            center: self.center.map(&mut map),
            central: self.central.map(&mut map),
        }
    }
}

impl<T: Real> Add for Solid<T> {
    type Output = Self;

    /// Combines two solids with a common origin, by the parallel-axis theorem. The sum of their
    /// masses must not be zero.
    fn add(self, other: Self) -> Self {
        let mass = self.mass + other.mass;
        let part = other.mass / mass;
        let apart = core::array::from_fn(|k| other.center[k] - self.center[k]);
        let central = core::array::from_fn(|k| self.central[k] + other.central[k]);
        Self {
            mass,
            center: core::array::from_fn(|k| self.center[k] + part * apart[k]),
            central: with_point(central, self.mass * part, apart),
        }
    }
}

/// Returns second moments with those of a point mass added.
fn with_point<T: Real>(moments: [T; 6], mass: T, at: [T; 3]) -> [T; 6] {
    core::array::from_fn(|k| moments[k] + mass * at[PAIRS[k][0]] * at[PAIRS[k][1]])
}

/// Returns the inertia matrix of second moments.
fn inertia_of<T: Real>([xx, yy, zz, xy, xz, yz]: [T; 6]) -> SMatrix<T, 3, 3> {
    SMatrix::from([[yy + zz, -xy, -xz], [-xy, xx + zz, -yz], [-xz, -yz, xx + yy]])
}

sums!(Solid);

impl Solid {
    /// Creates a solid from its mass, its centre of mass and its inertia matrix about the origin:
    /// the entries xx, yy, zz, xy, xz and yz, where xy is −∫ρ x y dp.
    ///
    /// For an inertia about the centre of mass, the centre is zero here, and
    /// [`translated`](Self::translated) moves the solid to its place.
    ///
    /// # Errors
    /// If no distribution of mass has these moments: each principal moment of inertia about the
    /// centre of mass is at most the sum of the other two.
    pub fn from_inertia(mass: f64, center: [f64; 3], inertia: [f64; 6]) -> Result<Self, BodyError> {
        let [xx, yy, zz, xy, xz, yz] = inertia;
        let half = 0.5 * (xx + yy + zz);
        let about_origin = [half - xx, half - yy, half - zz, -xy, -xz, -yz];
        Self { mass, center, central: with_point(about_origin, -mass, center) }.checked()
    }

    /// Returns the principal moments of inertia about the centre of mass in ascending order, in
    /// kg m², and the attitude of their axes x, y and z; NaN if a number is not finite.
    ///
    /// The solid turned back by this attitude has no products of inertia.
    pub fn principal(&self) -> ([f64; 3], Attitude) {
        let Some(eigen) = eigen(self.central) else {
            return ([f64::NAN; 3], Attitude::from_quaternion([f64::NAN; 4]));
        };
        let mut order = [0, 1, 2];
        // The greatest second moment belongs to the least moment of inertia.
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let [x, y, _] = order.map(|k| {
            let axis = eigen.eigenvectors.column(k).into_owned();
            // An axis has no sign: its greatest component is positive.
            if axis[axis.iamax()] < 0.0 { -axis } else { axis }
        });
        let [a, b, c] = order.map(|k| eigen.eigenvalues[k]);
        let axes = Matrix3::from_columns(&[x, y, x.cross(&y)]);
        let nan = Attitude::from_quaternion([f64::NAN; 4]);
        ([b + c, a + c, a + b], Attitude::from_matrix(axes).unwrap_or(nan))
    }

    /// Returns the solid if a distribution of mass with these moments exists: all numbers are
    /// finite, the mass is positive, and the matrix of second moments is positive semidefinite up
    /// to rounding. Then no principal moment of inertia exceeds the sum of the others.
    pub fn checked(self) -> Result<Self, BodyError> {
        positive("mass", self.mass)?;
        let Some(eigen) = eigen(self.central) else { return Err(BodyError::OutOfRange) };
        if self.moments().iter().chain(&self.center).any(|number| !number.is_finite()) {
            return Err(BodyError::OutOfRange);
        }
        let trace: f64 = self.central[..3].iter().sum();
        if -1e-12 * trace <= eigen.eigenvalues.min() {
            Ok(self)
        } else {
            Err(BodyError::Inertia { principal: self.principal().0 })
        }
    }
}

/// Returns the principal second moments and their axes, `None` if a number is not finite.
fn eigen(
    [xx, yy, zz, xy, xz, yz]: [f64; 6],
) -> Option<nalgebra::SymmetricEigen<f64, nalgebra::Const<3>>> {
    let matrix = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let finite = matrix.iter().all(|part| part.is_finite()) && matrix.trace().is_finite();
    finite.then(|| matrix.symmetric_eigen())
}

#[cfg(test)]
pub(super) mod tests {
    use super::{PAIRS, Solid};
    use crate::attitude::Attitude;
    use crate::body::error::BodyError;
    use crate::body::moments::tests::close;
    use crate::scalar::Dual;
    use nalgebra::{Matrix3, Vector3};

    /// Checks that mass, centre and second moments agree, in units of the size of the solid.
    pub(in crate::body) fn same(a: Solid, b: Solid, relative: f64) {
        let trace: f64 = b.moments()[..3].iter().sum();
        let size = (trace / b.mass).sqrt();
        close(a.mass, b.mass, relative);
        for k in 0..3 {
            assert!((a.center[k] - b.center[k]).abs() <= relative * size, "{a:?} is not {b:?}");
        }
        for k in 0..6 {
            assert!((a.central[k] - b.central[k]).abs() <= relative * trace, "{a:?} is not {b:?}");
        }
    }

    fn brick() -> Solid {
        let turn = Attitude::from_euler("zyx", [0.3, -1.0, 2.0]).unwrap();
        Solid::cuboid(2.0, [3.0, 0.5, 1.0]).unwrap().rotated(turn).translated([0.7, -1.1, 0.2])
    }

    #[test]
    fn inertia_is_that_of_parallel_axes() {
        let solid = brick();
        let c = Vector3::from(solid.center);
        let steiner = (Matrix3::identity() * c.norm_squared() - c * c.transpose()) * solid.mass;
        assert!((solid.inertia() - solid.inertia_about_center() - steiner).amax() < 1e-14);
        close(solid.inertia_about_center().trace(), 2.0 * 2.0 * (9.0 + 0.25 + 1.0) / 12.0, 1e-15);
    }

    #[test]
    fn moving_changes_nothing_about_the_centre() {
        let moved = brick().translated([1e6, -2e6, 3e6]);
        assert_eq!((moved.central, moved.mass), (brick().central, brick().mass));
    }

    #[test]
    fn turning_turns_the_inertia_matrix_and_comes_back() {
        for order in ["xyz", "zxz"] {
            let turn = Attitude::from_euler(order, [0.4, 2.0, -1.3]).unwrap();
            let matrix = turn.to_matrix();
            let turned = brick().rotated(turn);
            let exact = matrix * brick().inertia() * matrix.transpose();
            assert!((turned.inertia() - exact).amax() < 1e-14);
            same(turned.rotated(turn.inverse()), brick(), 1e-15);
        }
        let quarter = Attitude::from_axis_angle([0.0, 0.0, 1.0], core::f64::consts::FRAC_PI_2);
        let turned = Solid::cuboid(1.0, [1.0, 2.0, 3.0]).unwrap().rotated(quarter);
        same(turned, Solid::cuboid(1.0, [2.0, 1.0, 3.0]).unwrap(), 1e-15);
    }

    #[test]
    fn eight_parts_are_the_whole() {
        let part = Solid::cuboid(0.5, [1.0, 2.0, 0.5]).unwrap();
        let parts = (0..8).map(|k| {
            let side = |bit| if k >> bit & 1 == 0 { -0.5 } else { 0.5 };
            part.translated([side(0), 2.0 * side(1), 0.5 * side(2)])
        });
        let whole = Solid::cuboid(4.0, [2.0, 4.0, 1.0]).unwrap();
        same(Solid::compound(parts).unwrap(), whole, 1e-15);
    }

    #[test]
    fn the_order_of_a_compound_does_not_matter() {
        let [a, b, c] = [
            brick(),
            Solid::ball(0.3, 0.2).unwrap().translated([2.0, 1.0, -4.0]),
            Solid::point(1.5, [-1.0, 0.5, 2.0]).unwrap(),
        ];
        same((a + b) + c, c + (b + a), 2e-15);
    }

    #[test]
    fn what_is_cut_out_can_be_put_back() {
        let hole = Solid::ball(0.25, 0.1).unwrap().translated([0.6, -1.0, 0.2]);
        let rest = brick().without(hole).unwrap();
        same(rest + hole, brick(), 1e-15);
        assert_eq!(hole.without(brick()), Err(BodyError::NoMass));
        assert_eq!(hole.without(hole), Err(BodyError::NoMass));
        let outside = hole.translated([0.0, 30.0, 0.0]);
        assert!(matches!(brick().without(outside), Err(BodyError::Inertia { .. })));
    }

    #[test]
    fn a_hollow_ball_is_a_ball_without_a_ball() {
        // Densities are equal: masses as cubes of radii. 2/5 m (R⁵ − r⁵)/(R³ − r³).
        let shell = Solid::ball(8.0, 2.0).unwrap().without(Solid::ball(1.0, 1.0).unwrap()).unwrap();
        close(shell.inertia()[(2, 2)], 0.4 * 31.0, 1e-15);
    }

    #[test]
    fn density_scales_mass_and_moments_alone() {
        let heavy = brick().scaled(3.0);
        assert_eq!((heavy.mass, heavy.center), (6.0, brick().center));
        same(heavy.with_mass(2.0).unwrap(), brick(), 1e-15);
        let massless = brick().with_mass(0.0);
        assert!(matches!(massless, Err(BodyError::Argument { name: "mass", value: 0.0, .. })));
    }

    #[test]
    fn numbers_of_a_data_sheet_make_a_solid() {
        let inertia = brick().inertia();
        let entries = PAIRS.map(|[i, k]| inertia[(i, k)]);
        same(Solid::from_inertia(2.0, brick().center, entries).unwrap(), brick(), 1e-15);
        let top = Solid::from_inertia(1.0, [0.0; 3], [2.0, 2.0, 1.0, 0.0, 0.0, 0.0]).unwrap();
        assert_eq!(top.inertia(), Matrix3::from_diagonal(&Vector3::new(2.0, 2.0, 1.0)));
    }

    #[test]
    fn principal_moments_may_not_exceed_the_sum_of_the_others() {
        let of = |moments: [f64; 3]| {
            let [x, y, z] = moments;
            Solid::from_inertia(1.0, [0.0; 3], [x, y, z, 0.0, 0.0, 0.0])
        };
        assert!(of([1.0, 2.0, 3.0]).is_ok() && of([0.0, 1.0, 1.0]).is_ok());
        for order in [[1.0, 1.0, 2.1], [1.0, 2.1, 1.0], [2.1, 1.0, 1.0]] {
            let Err(error) = of(order) else { panic!("{order:?}") };
            let BodyError::Inertia { principal } = error else { panic!("{error:?}") };
            for (found, exact) in principal.iter().zip([1.0, 1.0, 2.1]) {
                close(*found, exact, 1e-15);
            }
        }
        assert!(of([-1.0, 1.0, 1.0]).is_err() && of([-1.0, -1.0, -1.0]).is_err());
        // Large products beside moments that are possible alone.
        let products = Solid::from_inertia(1.0, [0.0; 3], [1.0, 1.0, 1.0, 0.9, 0.9, 0.9]);
        assert!(matches!(products, Err(BodyError::Inertia { .. })), "{products:?}");
        // The inertia about the origin is less than that of a point at the centre.
        let little = Solid::from_inertia(2.0, [3.0, 4.0, 0.0], [32.0, 18.0, 49.0, -24.0, 0.0, 0.0]);
        assert!(matches!(little, Err(BodyError::Inertia { .. })), "{little:?}");
    }

    #[test]
    fn numbers_that_are_none_are_refused() {
        let fine = brick();
        for bad in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
            let solid = Solid { mass: bad, ..fine };
            let error = solid.checked();
            assert!(matches!(error, Err(BodyError::Argument { name: "mass", .. })), "{bad}");
        }
        for bad in [f64::NAN, f64::INFINITY] {
            let solid = Solid { center: [0.0, bad, 0.0], ..fine };
            assert_eq!(solid.checked(), Err(BodyError::OutOfRange));
            for k in 0..6 {
                let mut solid = fine;
                solid.central[k] = bad;
                assert_eq!(solid.checked(), Err(BodyError::OutOfRange));
                assert!(solid.principal().0[0].is_nan());
            }
        }
        assert_eq!(Solid::compound([]), Err(BodyError::NoMass));
        assert_eq!(fine.translated([1e200; 3]).checked(), Err(BodyError::OutOfRange));
    }

    #[test]
    fn principal_axes_leave_no_products() {
        for solid in [brick(), Solid::rod(1.0, [1.0; 3], [2.0, 3.0, -1.0]).unwrap()] {
            let (moments, axes) = solid.principal();
            let turned = solid.rotated(axes.inverse()).inertia_about_center();
            let scale = moments[2];
            assert!((turned - Matrix3::from_diagonal(&moments.into())).amax() < 2e-15 * scale);
            assert!(moments.is_sorted());
        }
        let (moments, axes) = Solid::cuboid(12.0, [3.0, 2.0, 1.0]).unwrap().principal();
        assert_eq!((moments, axes), ([5.0, 10.0, 13.0], Attitude::identity()));
    }

    #[test]
    fn properties_differentiate() {
        // dIxx/dy of a solid that moves up: 2 m y.
        let up = [0.0, 1.0, 0.0].map(|derivative| Dual { value: 0.0, derivative });
        let solid = brick().map(Dual::constant).translated(up);
        close(solid.inertia()[(0, 0)].derivative, -2.0 * 2.0 * 1.1, 1e-14);
        assert_eq!(solid.map(|number| number.value), brick());
    }
}

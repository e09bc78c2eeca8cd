//! Solids of uniform density with closed-form moments.

use crate::body::error::BodyError;
use crate::body::moments::positive;
use crate::body::solid::Solid;

impl Solid {
    /// Creates a point mass at `at`.
    pub fn point(mass: f64, at: [f64; 3]) -> Result<Self, BodyError> {
        Self { mass, center: at, central: [0.0; 6] }.checked()
    }

    /// Creates a thin straight rod between two points: mL²/12 about its centre, and nothing about
    /// itself.
    pub fn rod(mass: f64, from: [f64; 3], to: [f64; 3]) -> Result<Self, BodyError> {
        let [x, y, z] = core::array::from_fn(|k| 0.5 * (to[k] - from[k]));
        let center = [from[0] + x, from[1] + y, from[2] + z];
        let third = mass / 3.0;
        let central = [x * x, y * y, z * z, x * y, x * z, y * z].map(|part| third * part);
        Self { mass, center, central }.checked()
    }

    /// Creates a box centred on the origin, from its lengths along x, y and z: m(y² + z²)/12 about
    /// x.
    pub fn cuboid(mass: f64, size: [f64; 3]) -> Result<Self, BodyError> {
        for length in size {
            positive("side", length)?;
        }
        Self::along_axes(mass, size.map(|length| mass * length * length / 12.0))
    }

    /// Creates a ball centred on the origin: 2mr²/5.
    pub fn ball(mass: f64, radius: f64) -> Result<Self, BodyError> {
        let radius = positive("radius", radius)?;
        Self::ellipsoid(mass, [radius; 3])
    }

    /// Creates an ellipsoid centred on the origin, from its semi-axes along x, y and z:
    /// m(b² + c²)/5 about x.
    pub fn ellipsoid(mass: f64, semi_axes: [f64; 3]) -> Result<Self, BodyError> {
        for length in semi_axes {
            positive("semi-axis", length)?;
        }
        Self::along_axes(mass, semi_axes.map(|length| mass * length * length / 5.0))
    }

    /// Creates a cylinder about the axis z, centred on the origin: mr²/2 about z, and
    /// m(3r² + L²)/12 about x and y.
    pub fn cylinder(mass: f64, radius: f64, length: f64) -> Result<Self, BodyError> {
        let (radius, length) = (positive("radius", radius)?, positive("length", length)?);
        let across = 0.25 * mass * radius * radius;
        Self::along_axes(mass, [across, across, mass * length * length / 12.0])
    }

    /// Creates a cone about the axis z that opens upwards from its tip at the origin, as a top
    /// stands: 3mr²/10 about z, and 3m(r² + 4h²)/20 about x and y.
    pub fn cone(mass: f64, radius: f64, height: f64) -> Result<Self, BodyError> {
        let (radius, height) = (positive("radius", radius)?, positive("height", height)?);
        let across = 0.15 * mass * radius * radius;
        let cone = Self::along_axes(mass, [across, across, 0.0375 * mass * height * height])?;
        cone.translated([0.0, 0.0, 0.75 * height]).checked()
    }

    /// Creates a capsule about the axis z, centred on the origin: a cylinder of this length with
    /// half a ball at each end.
    pub fn capsule(mass: f64, radius: f64, length: f64) -> Result<Self, BodyError> {
        let (radius, length) = (positive("radius", radius)?, positive("length", length)?);
        // Volumes over πr².
        let caps = mass / (1.0 + 0.75 * length / radius);
        let middle = mass - caps;
        let across = radius * radius * (0.25 * middle + 0.2 * caps);
        // A half ball has its centre of mass at 3r/8 from its flat side, about which z² has the
        // mean r²/5.
        let caps =
            caps * (0.25 * length * length + 0.375 * length * radius + 0.2 * radius * radius);
        Self::along_axes(mass, [across, across, middle * length * length / 12.0 + caps])
    }

    /// Creates a solid from its second moments along the axes, about the origin.
    fn along_axes(mass: f64, [xx, yy, zz]: [f64; 3]) -> Result<Self, BodyError> {
        Self { mass, center: [0.0; 3], central: [xx, yy, zz, 0.0, 0.0, 0.0] }.checked()
    }
}

#[cfg(test)]
mod tests {
    use super::{BodyError, Solid};
    use crate::attitude::Attitude;
    use crate::body::moments::tests::close;
    use crate::body::solid::tests::same;

    fn diagonal(solid: Solid) -> [f64; 3] {
        let inertia = solid.inertia();
        [0, 1, 2].map(|k| inertia[(k, k)])
    }

    #[test]
    fn box_ball_ellipsoid_and_cylinder_have_the_moments_of_textbooks() {
        let cases = [
            (Solid::cuboid(12.0, [1.0, 2.0, 3.0]), [13.0, 10.0, 5.0]),
            (Solid::ball(5.0, 3.0), [18.0; 3]),
            (Solid::ellipsoid(5.0, [1.0, 2.0, 3.0]), [13.0, 10.0, 5.0]),
            (Solid::cylinder(12.0, 2.0, 3.0), [21.0, 21.0, 24.0]),
            (Solid::cone(20.0, 2.0, 3.0), [120.0, 120.0, 24.0]),
        ];
        for (solid, exact) in cases {
            for (found, exact) in diagonal(solid.unwrap()).into_iter().zip(exact) {
                close(found, exact, 1e-15);
            }
        }
    }

    #[test]
    fn a_cone_stands_on_its_tip() {
        let cone = Solid::cone(1.0, 0.3, 2.0).unwrap();
        assert_eq!(cone.center, [0.0, 0.0, 1.5]);
        // About the centre: 3m(4r² + h²)/80.
        close(cone.inertia_about_center()[(0, 0)], 3.0 * (4.0 * 0.09 + 4.0) / 80.0, 1e-15);
    }

    #[test]
    fn a_capsule_is_a_cylinder_between_two_half_balls() {
        // Limits: without length a ball, without caps a cylinder.
        same(Solid::capsule(2.0, 1.5, 1e-9).unwrap(), Solid::ball(2.0, 1.5).unwrap(), 1e-8);
        same(
            Solid::capsule(2.0, 1e-9, 1.5).unwrap(),
            Solid::cylinder(2.0, 1e-9, 1.5).unwrap(),
            1e-8,
        );
        // Density 1/π, r = 1, L = 2: masses 2 and 4/3. About x: cylinder 2(3 + 4)/12; half balls
        // with 83/320 m r² about their centres of mass, which are at 1 + 3/8.
        let capsule = Solid::capsule(10.0 / 3.0, 1.0, 2.0).unwrap();
        let caps = 4.0 / 3.0 * (83.0 / 320.0 + 1.375 * 1.375);
        close(diagonal(capsule)[0], 7.0 / 6.0 + caps, 1e-15);
        close(diagonal(capsule)[2], 1.0 + 0.4 * 4.0 / 3.0, 1e-15);
    }

    #[test]
    fn a_rod_has_no_inertia_about_itself() {
        let rod = Solid::rod(3.0, [0.0; 3], [0.0, 0.0, 2.0]).unwrap();
        assert_eq!((diagonal(rod), rod.center), ([4.0, 4.0, 0.0], [0.0, 0.0, 1.0]));
        let turn = Attitude::from_directions([0.0, 0.0, 1.0], [1.0, -2.0, 2.0]);
        let to = [2.0 / 3.0, -4.0 / 3.0, 4.0 / 3.0];
        same(rod.rotated(turn), Solid::rod(3.0, [0.0; 3], to).unwrap(), 1e-15);
    }

    #[test]
    fn sizes_and_masses_must_be_positive() {
        for bad in [0.0, -1.0, f64::INFINITY, f64::NAN] {
            for (solid, name) in [
                (Solid::cuboid(1.0, [1.0, bad, 1.0]), "side"),
                (Solid::ellipsoid(1.0, [1.0, 1.0, bad]), "semi-axis"),
                (Solid::ball(1.0, bad), "radius"),
                (Solid::cylinder(1.0, bad, 1.0), "radius"),
                (Solid::cylinder(1.0, 1.0, bad), "length"),
                (Solid::cone(1.0, bad, 1.0), "radius"),
                (Solid::cone(1.0, 1.0, bad), "height"),
                (Solid::capsule(1.0, bad, 1.0), "radius"),
                (Solid::capsule(1.0, 1.0, bad), "length"),
                (Solid::point(bad, [0.0; 3]), "mass"),
                (Solid::rod(bad, [0.0; 3], [1.0, 0.0, 0.0]), "mass"),
                (Solid::cuboid(bad, [1.0; 3]), "mass"),
                (Solid::capsule(bad, 1.0, 1.0), "mass"),
            ] {
                assert!(
                    matches!(solid, Err(BodyError::Argument { name: found, .. }) if found == name),
                    "{solid:?}"
                );
            }
        }
        assert_eq!(Solid::ball(1.0, 1e200), Err(BodyError::OutOfRange));
        assert_eq!(Solid::capsule(1.0, 1e-300, 1e300), Err(BodyError::OutOfRange));
    }
}

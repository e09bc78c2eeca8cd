//! Roots and dips of a function of one variable.

use crate::scalar::Float;

/// A point of a function: the argument and the value.
pub(crate) type Point<T> = (T, T);

/// Returns the root between two points whose values differ in sign, to the last digits.
///
/// The method is inverse quadratic interpolation where it converges, otherwise bisection:
/// Chandrupatla (1997), A new hybrid quadratic/bisection algorithm for finding the zero of a
/// nonlinear function without using derivatives, Adv. Eng. Softw. 28, 145.
pub(crate) fn root<T: Float, E>(
    f: &mut impl FnMut(T) -> Result<T, E>,
    a: Point<T>,
    b: Point<T>,
) -> Result<T, E> {
    let number = T::from_f64;
    let (zero, half, one) = (number(0.0), number(0.5), number(1.0));
    let (mut near, mut far) = (b, a);
    let mut t = half;
    // Bisection needs as many steps as there are binary digits between the ends.
    for _ in 0..300 {
        let x = near.0 + t * (far.0 - near.0);
        let new = (x, f(x)?);
        let third = if (new.1 < zero) == (near.1 < zero) {
            near
        } else {
            let third = far;
            far = near;
            third
        };
        near = new;
        let best = if near.1.abs() < far.1.abs() { near } else { far };
        let width = (far.0 - near.0).abs();
        let least = T::EPSILON * (best.0.abs() + T::EPSILON);
        if best.1 == zero || width <= least + least {
            return Ok(best.0);
        }
        let xi = (near.0 - far.0) / (third.0 - far.0);
        let phi = (near.1 - far.1) / (third.1 - far.1);
        let smooth = phi * phi < xi && (one - phi) * (one - phi) < one - xi;
        t = if smooth {
            near.1 / (far.1 - near.1) * (third.1 / (far.1 - third.1))
                + (third.0 - near.0) / (far.0 - near.0)
                    * (near.1 / (third.1 - near.1))
                    * (far.1 / (third.1 - far.1))
        } else {
            half
        };
        let margin = least / width;
        t = if t < margin {
            margin
        } else if one - margin < t {
            one - margin
        } else {
            t
        };
    }
    Ok(near.0)
}

/// The minimum of a function in a dip, for a function that is positive around the dip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Dip<T> {
    /// The function stays away from zero.
    Away,
    /// The function comes as near to zero as the tolerance allows, on either side, at this point.
    Touches(T),
    /// The function is negative at this point, beyond the tolerance.
    Crosses(T),
}

/// Returns `true` if a positive function with a lower point between two others stays above zero,
/// unless it oscillates between the points. A convex function lies above the lines through two of
/// the points, continued beyond these points; the test allows the function to fall twice as far.
pub(crate) fn stays_away<T: Float>([a, b, c]: &[Point<T>; 3], tolerance: T) -> bool {
    let (before, after) = (b.0 - a.0, c.0 - b.0);
    let falls = [(a.1 - b.1) * (after / before), (c.1 - b.1) * (before / after)];
    let fall = if falls[0] < falls[1] { falls[1] } else { falls[0] };
    tolerance < b.1 - (fall + fall)
}

/// Searches a positive function with a lower point `b` between `a` and `c` for a minimum near zero.
///
/// The golden section search (Kiefer 1953) narrows the interval of the minimum, and stops as soon
/// as the minimum is clearly too high. The zero of the slope, computed from differences over four
/// points, then has twice as many correct digits.
pub(crate) fn dip<T: Float, E>(
    f: &mut impl FnMut(T) -> Result<T, E>,
    [mut a, mut b, mut c]: [Point<T>; 3],
    tolerance: T,
) -> Result<Dip<T>, E> {
    let number = T::from_f64;
    let zero = number(0.0);
    let enough = number(1e-3) * (c.0 - a.0);
    let mut count = 0;
    while enough < c.0 - a.0 {
        let right = b.0 - a.0 < c.0 - b.0;
        let x = b.0 + number(0.381966) * (if right { c.0 } else { a.0 } - b.0);
        let new = (x, f(x)?);
        if new.1 < -tolerance {
            return Ok(Dip::Crosses(x));
        }
        (a, b, c) = match (new.1 < b.1, right) {
            (true, true) => (b, new, c),
            (true, false) => (a, new, b),
            (false, true) => (a, b, new),
            (false, false) => (new, b, c),
        };
        count += 1;
        let rise = a.1.max(c.1) - b.1;
        // If `b` lies close to an end, the values contain little information about the minimum on
        // the other side.
        let balanced = number(0.3) * (c.0 - a.0) < (b.0 - a.0).min(c.0 - b.0);
        if 4 < count && balanced && tolerance < b.1 - (rise + rise) {
            return Ok(Dip::Away);
        }
    }
    if b.1 < -tolerance {
        return Ok(Dip::Crosses(b.0));
    }
    let eta = number(1e-3);
    let mut slope = |x: T| {
        let near = f(x + eta)? - f(x - eta)?;
        let far = f(x + eta + eta)? - f(x - eta - eta)?;
        Ok(number(8.0) * near - far)
    };
    let ends = [(a.0, slope(a.0)?), (c.0, slope(c.0)?)];
    let mut lowest = b;
    if ends[0].1 < zero && zero < ends[1].1 {
        let x = root(&mut slope, ends[0], ends[1])?;
        lowest = (x, f(x)?.min(b.1));
    }
    Ok(if lowest.1 < -tolerance {
        Dip::Crosses(lowest.0)
    } else if lowest.1 <= tolerance {
        Dip::Touches(lowest.0)
    } else {
        Dip::Away
    })
}

/// Returns a place between three points at which a function is negative although it is not at the
/// points, if there is one in a dip.
///
/// A dip shows as a middle point below both others. If the first or the last point is one of the
/// `edges`, beyond which no points are known, the least value may also lie between it and the middle
/// one: a further point, close to the edge, tells.
pub(crate) fn hidden_dip<T: Float, E>(
    f: &mut impl FnMut(T) -> Result<T, E>,
    points: [Point<T>; 3],
    edges: [bool; 2],
) -> Result<Option<T>, E> {
    let (number, [a, b, c]) = (T::from_f64, points);
    let zero = number(0.0);
    // A parabola falls by an eighth of the second difference beside an edge.
    let second = (a.1 - b.1 - b.1 + c.1).abs();
    let mut beside = |edge: Point<T>, next: Point<T>| {
        if next.1 < edge.1 || second < edge.1 {
            return Ok(None);
        }
        let x = edge.0 + number(1e-3) * (next.0 - edge.0);
        let near = (x, f(x)?);
        Ok((near.1 < edge.1).then_some(near))
    };
    let first = if edges[0] { beside(a, b)?.map(|near| [a, near, b]) } else { None };
    let middle = (b.1 < a.1 && b.1 <= c.1).then_some(points);
    let last = if edges[1] { beside(c, b)?.map(|near| [b, near, c]) } else { None };
    for points in [first, middle, last].into_iter().flatten() {
        if points[1].1 < zero {
            return Ok(Some(points[1].0));
        }
        if !stays_away(&points, zero)
            && let Dip::Crosses(low) = dip(f, points, zero)?
        {
            return Ok(Some(low));
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::{Dip, dip, hidden_dip, root};
    use crate::scalar::{DoubleDouble, Float, Real};

    fn root_of(f: impl Fn(f64) -> f64, a: f64, b: f64) -> (f64, u32) {
        let mut count = 0;
        let mut counted = |x| {
            count += 1;
            Ok::<f64, ()>(f(x))
        };
        let found = root(&mut counted, (a, f(a)), (b, f(b))).unwrap();
        (found, count)
    }

    #[test]
    fn roots_to_the_last_digit() {
        let (x, count) = root_of(|x| x * x - 0.5, 0.0, 1.0);
        assert!(
            (x - core::f64::consts::FRAC_1_SQRT_2).abs() <= 2.3e-16 && count < 12,
            "{x} {count}"
        );
        let (x, count) = root_of(|x| (x - 0.3).powi(3), 0.0, 1.0);
        assert!((x - 0.3).abs() < 1e-5 && count < 100, "{x} {count}");
        let (x, count) = root_of(|x| if x < 0.7 { -1.0 } else { 1.0 }, 0.0, 1.0);
        assert!((x - 0.7).abs() <= 2.3e-16 && count < 70, "{x} {count}");
        let (x, _) = root_of(|x| 1.0 / (x - 0.25), 0.0, 1.0);
        assert!((x - 0.25).abs() <= 2.3e-16, "{x}");
        let (x, _) = root_of(|x| x.powi(3) - 1e-60, 0.0, 1.0);
        assert!((x - 1e-20).abs() < 1e-31, "{x}");
    }

    #[test]
    fn roots_in_two_words() {
        let two = DoubleDouble::from(0.5);
        let mut f = |x: DoubleDouble| Ok::<_, ()>(x * x - two);
        let x = root(&mut f, (0.0.into(), (-0.5).into()), (1.0.into(), two)).unwrap();
        assert!((x - two.sqrt()).abs().to_f64() < 1e-31);
    }

    fn dip_of(f: impl Fn(f64) -> f64, tolerance: f64) -> Dip<f64> {
        let mut plain = |x| Ok::<f64, ()>(f(x));
        dip(&mut plain, [0.0, 0.5, 1.0].map(|x| (x, f(x))), tolerance).unwrap()
    }

    /// A parabola that is below zero by d at x, from three points around it or beside it.
    #[test]
    fn dips_beside_an_edge() {
        for k in 1..100 {
            let x = 0.02 * f64::from(k);
            for d in [1e-9, 1e-6, 1e-3] {
                let mut f = |y: f64| Ok::<_, ()>((y - x) * (y - x) - d);
                let points = [0.0, 1.0, 2.0].map(|y| (y, f(y).unwrap()));
                let seen = points.iter().any(|point| point.1 < 0.0);
                for (edges, hidden) in [([true; 2], true), ([false; 2], 0.5 < x && x <= 1.5)] {
                    let low = hidden_dip(&mut f, points, edges).unwrap();
                    assert!(low.is_some() == hidden || seen, "{x} {d} {edges:?}");
                    assert!(low.is_none_or(|low| f(low).unwrap() < 0.0), "{x} {d} {low:?}");
                }
                let mut above = |y: f64| Ok::<_, ()>((y - x) * (y - x) + d);
                let points = [0.0, 1.0, 2.0].map(|y| (y, above(y).unwrap()));
                assert_eq!(hidden_dip(&mut above, points, [true; 2]), Ok(None));
            }
        }
    }

    #[test]
    fn dips() {
        let Dip::Touches(x) = dip_of(|x| (x - 0.4) * (x - 0.4) * (1.0 + x), 1e-12) else {
            panic!("it touches")
        };
        assert!((x - 0.4).abs() < 1e-11, "{x}");
        assert_eq!(dip_of(|x| (x - 0.4) * (x - 0.4) + 1e-6, 1e-12), Dip::Away);
        assert_eq!(dip_of(|x| (x - 0.4) * (x - 0.4) + 1.0, 1e-12), Dip::Away);
        assert!(
            matches!(dip_of(|x| (x - 0.4) * (x - 0.4) - 1e-10, 0.0), Dip::Crosses(x) if (x - 0.4).abs() <= 1e-5)
        );
        assert!(
            matches!(dip_of(|x| (x - 0.4) * (x - 0.4) - 1e-13, 1e-12), Dip::Touches(x) if (x - 0.4).abs() <= 1e-6)
        );
        assert!(
            matches!(dip_of(|x| (x - 0.4).abs(), 1e-12), Dip::Touches(x) if (x - 0.4).abs() < 1e-12)
        );
        // The points at the end of a step are not in the middle.
        let f = |x: f64| Ok::<f64, ()>((x - 0.9994) * (x - 0.9994));
        for points in [[0.875, 0.9999, 1.0], [0.9988, 0.9989, 1.125]] {
            let found = dip(&mut { f }, points.map(|x| (x, f(x).unwrap())), 1e-12).unwrap();
            assert!(matches!(found, Dip::Touches(x) if (x - 0.9994).abs() < 1e-9), "{found:?}");
        }
    }
}

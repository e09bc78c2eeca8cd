//! The method of Tsitouras of order 5.

use crate::integrate::field::Field;
use crate::integrate::interpolant::Interpolant;
use crate::integrate::method::{Adaptive, ErrorEstimate, Method, Response, Weights};
use crate::integrate::schemes::runge_kutta::{Row, Slopes};
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::integrate::step::gap::widest;
use crate::scalar::Float;
use crate::system::Dynamics;

/// The explicit Runge–Kutta pair of orders 5 and 4 of Tsitouras: six evaluations a step, adaptive.
///
/// It suits every system and is the choice for errors from 1e-2 to 1e-6; below that
/// [`Dop853`](crate::integrate::Dop853) takes fewer evaluations. It is not symplectic, and its
/// energy drifts with the tolerance: errors of its steps have the same sign in every period and add
/// up, on a pivot shaken a thousand times to about a hundred tolerances whatever the tolerance is.
/// It is explicit: a stiff spring or damper forces h·ω below about 3.5.
///
/// The last stage is the first of the next step. Dense output is the quartic of the same paper and
/// costs nothing.
///
/// Source: Tsitouras (2011), Runge–Kutta pairs of order 5(4) satisfying only the first column
/// simplifying assumption, Comput. Math. Appl. 62, 770.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tsit5;

impl Tsit5 {
    /// The method.
    pub const fn new() -> Self {
        Self
    }
}

impl<D: Dynamics<N, Scalar: Float>, const N: usize> Method<D, N> for Tsit5 {
    const NAME: &'static str = "Tsit5";
    type Workspace = Slopes<D::Scalar, N, 7>;

    fn workspace(&self, _: &D) -> Self::Workspace {
        Slopes::zero()
    }

    fn keeps_contacts(&self) -> bool {
        true
    }

    #[inline]
    fn attempt<const W: bool>(
        &self,
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        k: &mut Slopes<D::Scalar, N, 7>,
    ) -> Endpoint<D::Scalar, N> {
        k.first(field, from);
        k.stage(field, interval, from, 1, C[1], A1);
        k.stage(field, interval, from, 2, C[2], A2);
        k.stage(field, interval, from, 3, C[3], A3);
        k.stage(field, interval, from, 4, C[4], A4);
        k.stage(field, interval, from, 5, C[5], A5);
        let (dq, dv) = k.weighted(B);
        let mut to = from.advanced(interval, &dq, &dv);
        k.v[6] = to.v.high;
        k.a[6] = to.end_acceleration(field);
        to
    }

    fn interpolant(
        &self,
        _: &mut Field<'_, D, N>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        to: &mut Endpoint<D::Scalar, N>,
        k: &mut Slopes<D::Scalar, N, 7>,
    ) -> Interpolant<D::Scalar, N> {
        let h = interval.length::<D::Scalar>();
        let mut interpolant = Interpolant::hermite(interval, from, to, &k.a[0], &k.a[6]);
        let (q, v) = k.weighted(D);
        interpolant.q[3] = q.map(|sum| h * sum);
        interpolant.v[3] = v.map(|sum| h * sum);
        interpolant.terms = 4;
        interpolant
    }
}

impl<D: Dynamics<N, Scalar: Float>, const N: usize> ErrorEstimate<D, N> for Tsit5 {
    #[inline]
    fn error(&self, k: &Slopes<D::Scalar, N, 7>, h: f64, weights: &Weights<N>) -> f64 {
        ErrorEstimate::<D, N>::error_along(self, k, h, weights, |_| ())
    }

    #[inline]
    fn error_along(
        &self,
        k: &Slopes<D::Scalar, N, 7>,
        h: f64,
        weights: &Weights<N>,
        along: impl Fn(&mut [D::Scalar; N]),
    ) -> f64 {
        let (mut q, mut v) = k.weighted(E);
        along(&mut q);
        along(&mut v);
        h * (weights.square_sum(&q, &v) / (2 * N) as f64).sqrt()
    }
}

impl Adaptive for Tsit5 {
    const ORDER: u32 = 5;
    const RESPONSE: Response =
        Response { alpha: 0.17, beta: 0.04, safety: 0.8, least: 0.2, greatest: 10.0 };
    const GAP: f64 = widest(&C, &E);
}

const C: [f64; 7] = [0.0, 0.161, 0.327, 0.9, 0.9800255409045097, 1.0, 1.0];

const A1: Row<1> = [(0, 0.161)];
const A2: Row<2> = [(0, -0.008480655492356989), (1, 0.335480655492357)];
const A3: Row<3> = [(0, 2.8971530571054935), (1, -6.359448489975075), (2, 4.3622954328695815)];
const A4: Row<4> = [
    (0, 5.325864828439257),
    (1, -11.748883564062828),
    (2, 7.4955393428898365),
    (3, -0.09249506636175525),
];
const A5: Row<5> = [
    (0, 5.86145544294642),
    (1, -12.92096931784711),
    (2, 8.159367898576159),
    (3, -0.071584973281401),
    (4, -0.028269050394068383),
];
const B: Row<6> = [
    (0, 0.09646076681806523),
    (1, 0.01),
    (2, 0.4798896504144996),
    (3, 1.379008574103742),
    (4, -3.290069515436081),
    (5, 2.324710524099774),
];

/// The difference of the weights of both orders.
const E: Row<7> = [
    (0, -0.00178001105222577714),
    (1, -0.0008164344596567469),
    (2, 0.007880878010261995),
    (3, -0.1447110071732629),
    (4, 0.5823571654525552),
    (5, -0.45808210592918697),
    (6, 0.015151515151515152),
];

/// The coefficients of θ⁴ in the weights of the quartic; the lower ones follow from the states and
/// slopes at both ends.
const D: Row<7> = [
    (0, -1.0530884977290216),
    (1, 0.1017),
    (2, 2.490627285651252793),
    (3, -16.54810288924490272),
    (4, 47.37952196281928122),
    (5, -34.87065786149660974),
    (6, 2.5),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::schemes::runge_kutta::conditions::{moment, sum};

    #[test]
    fn rows_add_up_to_their_nodes() {
        for (i, sum) in
            [sum(A1), sum(A2), sum(A3), sum(A4), sum(A5), sum(B)].into_iter().enumerate()
        {
            assert!((sum - C[i + 1]).abs() < 1e-14, "row {} adds up to {sum}", i + 1);
        }
    }

    #[test]
    fn weights_integrate_powers() {
        for power in 0..5 {
            assert!(
                (moment(&C, B, power) - 1.0 / f64::from(power + 1)).abs() < 1e-14,
                "power {power}"
            );
        }
        for power in 0..4 {
            assert!(moment(&C, E, power).abs() < 1e-14, "power {power}");
        }
        assert!(moment(&C, E, 4).abs() > 1e-4);
    }

    #[test]
    fn the_quartic_integrates_powers() {
        // ∫₀^θ cᵖ = θᵖ⁺¹/(p+1): the coefficient of θ⁴ is a quarter for p = 3 and zero for the
        // powers below.
        for power in 0..3 {
            assert!(moment(&C, D, power).abs() < 1e-12, "power {power}");
        }
        assert!((moment(&C, D, 3) - 0.25).abs() < 1e-13);
    }
}

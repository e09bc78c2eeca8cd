//! The Nyström pair of Dormand, El-Mikkawy and Prince of order 8.

use crate::integrate::field::Field;
use crate::integrate::interpolant::Interpolant;
use crate::integrate::method::{Adaptive, ErrorEstimate, Method, Response, Weights};
use crate::integrate::schemes::nystrom::Kicks;
use crate::integrate::schemes::runge_kutta::Row;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::integrate::step::gap::widest;
use crate::scalar::Float;
use crate::system::{Dynamics, VelocityFree};

/// The Runge–Kutta–Nyström pair of orders 8 and 6 of Dormand, El-Mikkawy and Prince: eight
/// evaluations a step, adaptive.
///
/// The fastest method here for errors from 1e-2 to 1e-5 over tens of periods: 0.7 of the time of
/// [`Dop853`](crate::integrate::Dop853) for the same error of a Kepler orbit of eccentricity 0.5,
/// half of it for pendulums on a driven pivot. Below 1e-5 [`Dprkn12`](crate::integrate::Dprkn12) is
/// faster; over hundreds of periods of a pendulum
/// [`QuinlanTremaine`](crate::integrate::QuinlanTremaine) takes half its time, with a step to be
/// chosen. It is not symplectic: over very many periods the energy drifts with the tolerance.
///
/// It is for systems with a constant mass matrix and accelerations without velocities, and compiles
/// for no others. The last stage is the first of the next step. Dense output is made of the same
/// accelerations and costs nothing; its error falls with the seventh power of the step in the
/// coordinates and the sixth in the velocities, slower than that of the steps: where few times have
/// to be as exact as the steps, end steps there by `t_stops`.
///
/// Source: Dormand, El-Mikkawy and Prince (1987), High-order embedded Runge–Kutta–Nyström formulae,
/// IMA J. Numer. Anal. 7, 423.
///
/// ```compile_fail,E0277
/// # use pendulum_runtime::{integrate::*, system::*};
/// fn swing<S: System<1, Scalar = f64, Inputs = ()>>(system: &S) -> Result<f64, Failure<f64, 1>> {
///     Ok(solve(system, (0.0, 10.0), [1.3], [0.0]).method(Dprkn8).rtol(1e-9).run()?.end.q[0])
/// }
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dprkn8;

impl Dprkn8 {
    /// The method.
    pub const fn new() -> Self {
        Self
    }
}

impl<D: Dynamics<N, Scalar: Float, System: VelocityFree<N>>, const N: usize> Method<D, N>
    for Dprkn8
{
    const NAME: &'static str = "Dprkn8";
    type Workspace = Kicks<D::Scalar, N, 9>;

    fn workspace(&self, _: &D) -> Self::Workspace {
        Kicks::zero()
    }

    #[inline]
    fn attempt<const W: bool>(
        &self,
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        k: &mut Kicks<D::Scalar, N, 9>,
    ) -> Endpoint<D::Scalar, N> {
        k.first(field, from);
        k.stage(field, interval, from, 1, C[1], A1);
        k.stage(field, interval, from, 2, C[2], A2);
        k.stage(field, interval, from, 3, C[3], A3);
        k.stage(field, interval, from, 4, C[4], A4);
        k.stage(field, interval, from, 5, C[5], A5);
        k.stage(field, interval, from, 6, C[6], A6);
        k.stage(field, interval, from, 7, C[7], A7);
        let mut to = k.end(interval, from, Q, V);
        k.a[8] = to.end_acceleration(field);
        to
    }

    fn interpolant(
        &self,
        _: &mut Field<'_, D, N>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        to: &mut Endpoint<D::Scalar, N>,
        k: &mut Kicks<D::Scalar, N, 9>,
    ) -> Interpolant<D::Scalar, N> {
        k.dense(interval, from, to, &k.a[8], DQ, DV)
    }
}

impl<D: Dynamics<N, Scalar: Float, System: VelocityFree<N>>, const N: usize> ErrorEstimate<D, N>
    for Dprkn8
{
    #[inline]
    fn error(&self, k: &Kicks<D::Scalar, N, 9>, h: f64, weights: &Weights<N>) -> f64 {
        k.error(h, weights, EQ, EV)
    }
}

impl Adaptive for Dprkn8 {
    const ORDER: u32 = 8;
    const RESPONSE: Response =
        Response { alpha: 0.125, beta: 0.025, safety: 0.8, least: 0.2, greatest: 6.0 };
    const GAP: f64 = widest(&C, &EV);
}

// Printed by tests/data/nystrom.py.

const C: [f64; 9] = [0.0, 0.05, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0, 1.0];

const A1: Row<1> = [(0, 0.00125)];

const A2: Row<2> = [(0, 0.0016666666666666668), (1, 0.0033333333333333335)];

const A3: Row<3> = [(0, 0.045), (1, -0.09), (2, 0.09)];

const A4: Row<4> = [
    (0, -0.3379798532571243),
    (1, 0.8611516478170984),
    (2, -0.48613644655235316),
    (3, 0.0879646519923791),
];

const A5: Row<5> = [
    (0, 0.7461462641043086),
    (1, -1.804347430246737),
    (2, 1.2761518285888953),
    (3, -0.031220932716737166),
    (4, 0.05827027027027027),
];

const A6: Row<6> = [
    (0, -1.2551623461807584),
    (1, 3.257463187064823),
    (2, -2.068866619575089),
    (3, 0.4206478455603251),
    (4, -0.018382978723404254),
    (5, 0.06930091185410335),
];

const A7: Row<7> = [
    (0, 3.772901830095941),
    (1, -9.669613121677195),
    (2, 6.7991544547851674),
    (3, -0.8490343907823893),
    (4, 0.4671734865470852),
    (5, -0.04939742152466368),
    (6, 0.028815162556053812),
];

/// The weights for the coordinates.
const Q: Row<6> = [
    (0, 0.028092718568909044),
    (2, 0.1457093253968254),
    (3, 0.1529431216931217),
    (4, 0.09151785714285714),
    (5, 0.06554705215419501),
    (6, 0.01618992504409171),
];

/// The weights for the velocities.
const V: Row<7> = [
    (0, 0.028092718568909044),
    (2, 0.1618992504409171),
    (3, 0.2184901738473167),
    (4, 0.18303571428571427),
    (5, 0.2184901738473167),
    (6, 0.1618992504409171),
    (7, 0.028092718568909044),
];

/// The differences of the weights of both orders, for the coordinates.
const EQ: Row<6> = [
    (0, -0.044557986852984274),
    (2, 0.10965442077101599),
    (3, -0.14620589436135464),
    (4, 0.1315853049252192),
    (5, -0.06265966901200913),
    (6, 0.012183824530112887),
];

/// The same for the velocities.
const EV: Row<8> = [
    (0, -0.044557986852984274),
    (2, 0.12183824530112887),
    (3, -0.2088655633733638),
    (4, 0.2631706098504384),
    (5, -0.2088655633733638),
    (6, 0.12183824530112887),
    (7, 0.10544201314701572),
    (8, -0.15),
];

/// The terms of the dense output of the coordinates from the sixth on.
const DQ: [Row<8>; 2] = [
    [
        (0, -1.3214627924725144),
        (2, 2.4231265419345864),
        (3, -1.0651434568686846),
        (4, -0.8831251526029542),
        (5, 1.1441780906299877),
        (6, -0.1544152634805315),
        (7, -0.27788199385200496),
        (8, 0.13472402671211586),
    ],
    [
        (0, 1.2652526498962144),
        (2, -2.8126815029222065),
        (3, 2.6034755651086248),
        (4, -0.48536637776176833),
        (5, -1.8330527432645483),
        (6, 2.3632681901798285),
        (7, 0.9650918104189548),
        (8, -2.0659875916550994),
    ],
];

/// The terms of the dense output of the velocities from the fourth on.
const DV: [Row<8>; 3] = [
    [
        (0, -6.0429975988839075),
        (2, 9.212170631094764),
        (3, -1.8844893275221537),
        (4, -2.649375457808863),
        (5, 2.121593228806063),
        (6, -2.4060367957325997),
        (7, -1.2550367600896506),
        (8, 2.9041720801363478),
    ],
    [
        (0, 4.133018805146444),
        (2, -6.100714742840897),
        (3, -1.4195659541137668),
        (4, 6.75485004890303),
        (5, -1.3659103139862814),
        (6, -6.163312989656297),
        (7, -1.2279834681448343),
        (8, 5.389618614692603),
    ],
    [
        (0, 8.8567685492735),
        (2, -19.688770520455446),
        (3, 18.224328955760374),
        (4, -3.397564644332378),
        (5, -12.831369202851837),
        (6, 16.5428773312588),
        (7, 6.755642672932683),
        (8, -14.461913141585695),
    ],
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::schemes::runge_kutta::conditions::{moment, sum};

    #[test]
    fn rows_add_up_to_half_the_squares_of_their_nodes() {
        for (i, sum) in
            [sum(A1), sum(A2), sum(A3), sum(A4), sum(A5), sum(A6), sum(A7)].into_iter().enumerate()
        {
            assert!(
                (sum - C[i + 1] * C[i + 1] / 2.0).abs() < 1e-13,
                "row {} adds up to {sum}",
                i + 1
            );
        }
    }

    #[test]
    fn weights_integrate_powers() {
        for power in 0..8 {
            let n = f64::from(power);
            // Twice for the coordinates: ∫∫ cⁿ = 1/((n + 1)(n + 2)).
            assert!(
                power == 7 || (moment(&C, Q, power) - 1.0 / ((n + 1.0) * (n + 2.0))).abs() < 1e-15,
                "power {power}"
            );
            assert!((moment(&C, V, power) - 1.0 / (n + 1.0)).abs() < 1e-15, "power {power}");
        }
        for power in 0..6 {
            assert!(power == 5 || moment(&C, EQ, power).abs() < 1e-15, "power {power}");
            assert!(moment(&C, EV, power).abs() < 1e-15, "power {power}");
        }
        assert!(1e-7 < moment(&C, EV, 6).abs());
    }
}

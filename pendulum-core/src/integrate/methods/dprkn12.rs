//! The Nyström pair of Dormand, El-Mikkawy and Prince of order 12.

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

/// The Runge–Kutta–Nyström pair of orders 12 and 10 of Dormand, El-Mikkawy and Prince: seventeen
/// evaluations per step, adaptive.
///
/// The method is the choice for equations written by hand. For the same error it takes 0.3 to 0.75
/// of the time of [`Dop853`](crate::integrate::Dop853), and the fraction falls with the error. On a
/// Kepler orbit of eccentricity 0.5, for errors above 1e-5, it takes 0.75 to 1 of that time. On
/// such an orbit it is also faster than [`Taylor`](crate::integrate::Taylor), with three quarters
/// of the time of `Taylor` at 1e-10. For pendulums on a driven pivot `Taylor` takes two thirds to
/// four fifths of the time of `Dprkn12`, for undriven pendulums about half. `Dprkn12` is not
/// symplectic: over very many periods the energy drifts, at tight tolerances by rounding only.
///
/// The method requires a constant mass matrix and accelerations without velocities, and does not
/// compile for other systems. Dense output uses the accelerations of the step and takes no further
/// evaluations. Its error falls with the tenth power of the step in the coordinates and the ninth
/// in the velocities, slower than that of the steps: if the state at a few times has to be as
/// accurate as the steps, end steps there by `t_stops`.
///
/// Source: Dormand, El-Mikkawy and Prince (1987), High-order embedded Runge–Kutta–Nyström formulae,
/// IMA J. Numer. Anal. 7, 423.
///
/// ```compile_fail,E0277
/// # use pendulum_runtime::{integrate::*, system::*};
/// fn swing<S: System<1, Scalar = f64, Inputs = ()>>(system: &S) -> Result<f64, Failure<f64, 1>> {
///     Ok(solve(system, (0.0, 10.0), [1.3], [0.0]).method(Dprkn12).rtol(1e-9).run()?.end.q[0])
/// }
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dprkn12;

impl<D: Dynamics<N, Scalar: Float, System: VelocityFree<N>>, const N: usize> Method<D, N>
    for Dprkn12
{
    const NAME: &'static str = "Dprkn12";
    type Workspace = Kicks<D::Scalar, N, 18>;

    fn workspace(&self, _: &D) -> Self::Workspace {
        Kicks::zero()
    }

    #[inline]
    fn attempt<const W: bool>(
        &self,
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        k: &mut Kicks<D::Scalar, N, 18>,
    ) -> Endpoint<D::Scalar, N> {
        k.first(field, from);
        k.stage(field, interval, from, 1, C[1], A1);
        k.stage(field, interval, from, 2, C[2], A2);
        k.stage(field, interval, from, 3, C[3], A3);
        k.stage(field, interval, from, 4, C[4], A4);
        k.stage(field, interval, from, 5, C[5], A5);
        k.stage(field, interval, from, 6, C[6], A6);
        k.stage(field, interval, from, 7, C[7], A7);
        k.stage(field, interval, from, 8, C[8], A8);
        k.stage(field, interval, from, 9, C[9], A9);
        k.stage(field, interval, from, 10, C[10], A10);
        k.stage(field, interval, from, 11, C[11], A11);
        k.stage(field, interval, from, 12, C[12], A12);
        k.stage(field, interval, from, 13, C[13], A13);
        k.stage(field, interval, from, 14, C[14], A14);
        k.stage(field, interval, from, 15, C[15], A15);
        k.stage(field, interval, from, 16, C[16], A16);
        k.end(interval, from, Q, V)
    }

    fn interpolant(
        &self,
        field: &mut Field<'_, D, N>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        to: &mut Endpoint<D::Scalar, N>,
        k: &mut Kicks<D::Scalar, N, 18>,
    ) -> Interpolant<D::Scalar, N> {
        k.a[17] = to.end_acceleration(field);
        k.dense(interval, from, to, &k.a[17], DQ, DV)
    }
}

impl<D: Dynamics<N, Scalar: Float, System: VelocityFree<N>>, const N: usize> ErrorEstimate<D, N>
    for Dprkn12
{
    #[inline]
    fn error(&self, k: &Kicks<D::Scalar, N, 18>, h: f64, weights: &Weights<N>) -> f64 {
        k.error(h, weights, EQ, EV)
    }
}

impl Adaptive for Dprkn12 {
    const ORDER: u32 = 12;
    const RESPONSE: Response =
        Response { alpha: 0.08, beta: 0.015, safety: 0.8, least: 0.2, greatest: 6.0 };
    const GAP: f64 = widest(&C, &EV);
}

// Printed by tests/data/nystrom.py.

const C: [f64; 18] = [
    0.0,
    0.02,
    0.04,
    0.1,
    0.13333333333333333,
    0.16,
    0.05,
    0.2,
    0.25,
    0.3333333333333333,
    0.5,
    0.5555555555555556,
    0.75,
    0.8571428571428571,
    0.9452162222720143,
    1.0,
    1.0,
    1.0,
];

const A1: Row<1> = [(0, 0.0002)];

const A2: Row<2> = [(0, 0.0002666666666666667), (1, 0.0005333333333333334)];

const A3: Row<3> = [(0, 0.002916666666666667), (1, -0.004166666666666667), (2, 0.00625)];

const A4: Row<3> =
    [(0, 0.0016460905349794238), (2, 0.0054869684499314125), (3, 0.0017558299039780521)];

const A5: Row<4> = [
    (0, 0.0019456),
    (2, 0.007151746031746032),
    (3, 0.0029127111111111113),
    (4, 0.0007899428571428571),
];

const A6: Row<5> = [
    (0, 0.00056640625),
    (2, 0.0008809730489417989),
    (3, -0.0004369212962962963),
    (4, 0.00033900669642857143),
    (5, -9.946469907407407e-05),
];

const A7: Row<5> = [
    (0, 0.0030833333333333333),
    (3, 0.0017777777777777779),
    (4, 0.0027),
    (5, 0.0015782828282828283),
    (6, 0.01086060606060606),
];

const A8: Row<7> = [
    (0, 0.00365183937480113),
    (2, 0.003965171714072343),
    (3, 0.0031972582629306284),
    (4, 0.008221467306855435),
    (5, -0.0013130926959572379),
    (6, 0.009771586968064868),
    (7, 0.003755769069232834),
];

const A9: Row<8> = [
    (0, 0.003707241068718501),
    (2, 0.005082045854555286),
    (3, 0.001174708002175412),
    (4, -0.021147629915126993),
    (5, 0.06010463698107881),
    (6, 0.02010573476850619),
    (7, -0.02835075012293358),
    (8, 0.014879568918581932),
];

const A10: Row<9> = [
    (0, 0.03512537656073344),
    (2, -0.008615749195138479),
    (3, -0.005791448051007917),
    (4, 1.945554823782616),
    (5, -3.4351238674565137),
    (6, -0.10930701107475221),
    (7, 2.3496383118995166),
    (8, -0.7560094086870229),
    (9, 0.10952897222156927),
];

const A11: Row<10> = [
    (0, 0.020527792537482496),
    (2, -0.00728644676448018),
    (3, -0.0021153556079618403),
    (4, 0.9275807968723522),
    (5, -1.6522824844257367),
    (6, -0.02107956300568657),
    (7, 1.2065364326207872),
    (8, -0.4137144770010661),
    (9, 0.09079873982809654),
    (10, 0.005355552600533985),
];

const A12: Row<11> = [
    (0, -0.14324078875545515),
    (2, 0.012528703773091817),
    (3, 0.006826019163969827),
    (4, -4.799555395574387),
    (5, 5.6986250439519415),
    (6, 0.7553430369523645),
    (7, -0.12755487858281084),
    (8, -1.9605926051117384),
    (9, 0.9185609056635262),
    (10, -0.23880085505284432),
    (11, 0.15911081357234216),
];

const A13: Row<12> = [
    (0, 0.8045019205520489),
    (2, -0.016658527067011247),
    (3, -0.021415834042629735),
    (4, 16.827235928962466),
    (5, -11.172835357176098),
    (6, -3.377159297226324),
    (7, -15.243326655360846),
    (8, 17.179835738215417),
    (9, -5.437719239823995),
    (10, 1.3878671618364655),
    (11, -0.5925827732652812),
    (12, 0.029603873171297354),
];

const A14: Row<13> = [
    (0, -0.913296766697358),
    (2, 0.0024112725757805178),
    (3, 0.01765812269386174),
    (4, -14.851649779720384),
    (5, 2.1589708670045757),
    (6, 3.99791558311788),
    (7, 28.434151800232232),
    (8, -25.2593643549416),
    (9, 7.733878542362238),
    (10, -1.8913028948478674),
    (11, 1.0014845070224718),
    (12, 0.004641199599109052),
    (13, 0.011218755022148957),
];

const A15: Row<14> = [
    (0, -0.27519629720559396),
    (2, 0.03661188877915492),
    (3, 0.009789519688231562),
    (4, -12.293062345886211),
    (5, 14.207226453937903),
    (6, 1.5866476906789537),
    (7, 2.4577735327595946),
    (8, -8.935193694403273),
    (9, 4.373672731613407),
    (10, -1.8347181765449492),
    (11, 1.1592085289061491),
    (12, -0.017290253165383924),
    (13, 0.019325977904460768),
    (14, 0.005204442937554993),
];

const A16: Row<14> = [
    (0, 1.3076391847404059),
    (2, 0.017364109189745843),
    (3, -0.018544456454265796),
    (4, 14.811522032867726),
    (5, 9.38317630848247),
    (6, -5.2284261999445425),
    (7, -48.95128052584765),
    (8, 38.297096034337926),
    (9, -10.58738133697598),
    (10, 2.4332304376226275),
    (11, -1.0453406042575444),
    (12, 0.0717732095086726),
    (13, 0.0021622109708082783),
    (14, 0.007009595759602514),
];

/// The weights for the coordinates.
const Q: Row<10> = [
    (0, 0.012127868517185414),
    (6, 0.08629746251568875),
    (7, 0.2525469581187147),
    (8, -0.1974186799326823),
    (9, 0.2031869190789726),
    (10, -0.020775808077714918),
    (11, 0.10967804874502014),
    (12, 0.038065132526466504),
    (13, 0.01163406880432423),
    (14, 0.0046580297040248785),
];

/// The weights for the velocities.
const V: Row<12> = [
    (0, 0.012127868517185414),
    (6, 0.09083943422704079),
    (7, 0.3156836976483934),
    (8, -0.2632249065769097),
    (9, 0.3047803786184589),
    (10, -0.041551616155429835),
    (11, 0.2467756096762953),
    (12, 0.15226053010586602),
    (13, 0.08143848163026961),
    (14, 0.08502571193890811),
    (15, -0.009155189630077963),
    (16, 0.025),
];

/// The differences of the weights of both orders, for the coordinates.
const EQ: Row<10> = [
    (0, -0.004880833389821577),
    (6, 0.014038126584857338),
    (7, -0.11947921920803832),
    (8, 0.20440246507662121),
    (9, -0.1322681492223791),
    (10, 0.11053069299761689),
    (11, -0.07975385787102851),
    (12, 0.011224330486437457),
    (13, -0.004671596801593694),
    (14, 0.0008580413473282841),
];

/// The differences of the weights of both orders, for the velocities.
const EV: Row<12> = [
    (0, -0.004880833389821577),
    (6, 0.014776975352481408),
    (7, -0.1493490240100479),
    (8, 0.2725366201021616),
    (9, -0.19840222383356862),
    (10, 0.22106138599523378),
    (11, -0.17944618020981415),
    (12, 0.04489732194574983),
    (13, -0.03270117761115586),
    (14, 0.015662325288859434),
    (15, -0.029155189630077964),
    (16, 0.025),
];

/// The weights of the dense output of the coordinates, from the sixth term on.
const DQ: [Row<14>; 4] = [
    [
        (0, -4.508370512180587),
        (5, -4.800619136782281),
        (6, 7.563397157606861),
        (7, 1.4458896144114073),
        (8, 0.6983293008693411),
        (9, -0.5317188300123262),
        (10, 0.21204527590983047),
        (11, -0.46437234203486816),
        (12, 0.328820287890371),
        (13, 0.2706705476017337),
        (14, 0.1675060960822474),
        (15, 0.8539536611767642),
        (16, -0.30138548105486956),
        (17, -0.9341456394836254),
    ],
    [
        (0, 5.0913683539788614),
        (5, 9.601238273564562),
        (6, -9.838993694061978),
        (7, -3.616452544301951),
        (8, -0.6961555719281131),
        (9, -1.3049256059435221),
        (10, 1.2870763223414847),
        (11, 0.9120648784427123),
        (12, -3.8020541162741663),
        (13, 1.1756943335403895),
        (14, 3.8245170187829824),
        (15, -0.04622943915622556),
        (16, 1.5445605120477137),
        (17, -4.13170872103275),
    ],
    [
        (0, 12.16083981024705),
        (5, 26.40340525230254),
        (6, -25.8145694715974),
        (7, -5.158774813587603),
        (8, -3.1253156562289854),
        (9, -6.012631183917805),
        (10, -2.115518401939527),
        (11, 3.4658189625429623),
        (12, 1.7335853199631743),
        (13, -0.9373466570523499),
        (14, -2.163528946690586),
        (15, -4.477149285336189),
        (16, 0.9033840541347793),
        (17, 5.13780101715994),
    ],
    [
        (0, -16.02286005120759),
        (5, -52.80681050460508),
        (6, 37.63839418370555),
        (7, 14.351218732972338),
        (8, 11.736524098935783),
        (9, 13.642046576872406),
        (10, -4.065764255642508),
        (11, -10.531501781012912),
        (12, 9.046600562226264),
        (13, 1.0222094697449549),
        (14, -8.17924347825295),
        (15, 3.9466600633950017),
        (16, -6.001871582811375),
        (17, 6.224397965680121),
    ],
];

/// The weights of the dense output of the velocities, from the fourth term on.
const DV: [Row<14>; 5] = [
    [
        (0, -15.843193508783978),
        (5, -14.40185741034684),
        (6, 23.916523834885634),
        (7, 7.178822122069763),
        (8, 0.12080110328120029),
        (9, -0.07125459694468413),
        (10, 0.6361358277294914),
        (11, -1.8044097088984299),
        (12, -0.1554931121228822),
        (13, -0.06054351751911614),
        (14, -0.6331264997161331),
        (15, 2.699188827981462),
        (16, -1.2791564431646087),
        (17, -0.302436918450876),
    ],
    [
        (0, 11.776118011146934),
        (5, 2.2798091958758004e-46),
        (6, -15.863401863455234),
        (7, 2.1740199464374097),
        (8, -2.1015090894317074),
        (9, 7.105089797904523),
        (10, -5.133500622483437),
        (11, 0.05003941688107172),
        (12, 9.433240621480273),
        (13, -5.151106286231571),
        (14, -12.478587632842432),
        (15, -4.985033649591909),
        (16, -2.825368649813924),
        (17, 18.0),
    ],
    [
        (0, 84.28293771884023),
        (5, 172.8222889241621),
        (6, -172.13123374482345),
        (7, -45.95026706446407),
        (8, -17.374351628412732),
        (9, -33.185003977275876),
        (10, 0.5474606486322864),
        (11, 20.247729999270835),
        (12, -19.680037534066468),
        (13, 4.480473706573328),
        (14, 18.117503344718532),
        (15, -18.232203215438336),
        (16, 14.425459800873114),
        (17, -8.370756978589489),
    ],
    [
        (0, -33.19527827714602),
        (5, -2.8419950080745434e-46),
        (6, 55.96297903795701),
        (7, -16.134676423188527),
        (8, -21.943571145911246),
        (9, -6.467136836147183),
        (10, 33.187204238086245),
        (11, 14.399455423707948),
        (12, -50.05508480861045),
        (13, 3.409935377438979),
        (14, 50.025205486536485),
        (15, 20.030554029109506),
        (16, 16.780413898167264),
        (17, -66.0),
    ],
    [
        (0, -144.20574046086833),
        (5, -475.26129454144575),
        (6, 338.74554765334994),
        (7, 129.16096859675105),
        (8, 105.62871689042204),
        (9, 122.77841919185165),
        (10, -36.59187830078257),
        (11, -94.78351602911621),
        (12, 81.41940506003638),
        (13, 9.199885227704595),
        (14, -73.61319130427654),
        (15, 35.519940570555015),
        (16, -54.01684424530237),
        (17, 56.01958169112109),
    ],
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::schemes::runge_kutta::conditions::{moment, sum};

    #[test]
    fn rows_add_up_to_half_the_squares_of_their_nodes() {
        for (i, sum) in [
            sum(A1),
            sum(A2),
            sum(A3),
            sum(A4),
            sum(A5),
            sum(A6),
            sum(A7),
            sum(A8),
            sum(A9),
            sum(A10),
            sum(A11),
            sum(A12),
            sum(A13),
            sum(A14),
            sum(A15),
            sum(A16),
        ]
        .into_iter()
        .enumerate()
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
        for power in 0..12 {
            let n = f64::from(power);
            // The weights of the coordinates integrate twice: ∫∫ cⁿ = 1/((n + 1)(n + 2)).
            assert!(
                power == 11 || (moment(&C, Q, power) - 1.0 / ((n + 1.0) * (n + 2.0))).abs() < 1e-15,
                "power {power}"
            );
            assert!((moment(&C, V, power) - 1.0 / (n + 1.0)).abs() < 1e-15, "power {power}");
        }
        for power in 0..10 {
            assert!(power == 9 || moment(&C, EQ, power).abs() < 1e-15, "power {power}");
            assert!(moment(&C, EV, power).abs() < 1e-15, "power {power}");
        }
        assert!(1e-7 < moment(&C, EV, 10).abs());
    }
}

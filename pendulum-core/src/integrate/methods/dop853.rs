//! The method of Dormand and Prince of order 8, in the form of Hairer.

use crate::integrate::field::Field;
use crate::integrate::interpolant::Interpolant;
use crate::integrate::method::{Adaptive, ErrorEstimate, Method, Response, Weights};
use crate::integrate::schemes::runge_kutta::{Row, Slopes, weighted};
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::integrate::step::gap::widest;
use crate::scalar::Float;
use crate::system::Dynamics;

/// The explicit Runge–Kutta method of order 8 of Dormand and Prince with error estimates of orders
/// 5 and 3: twelve evaluations per step, adaptive.
///
/// The method supports every system and is the choice for equations written by hand, for errors
/// from 1e-2 to 1e-13. It is not symplectic: over very many periods the energy drifts, at tight
/// tolerances by rounding only; the errors of a thousand periods of a shaken pivot add up to a few
/// tolerances. It is explicit: a stiff spring or damper limits h·ω to about 6, for any tolerance.
///
/// The method does not miss short pulses of a motion with a known time scale: a
/// [`Function`](crate::motion::Function) provides the scale by
/// [`resolution`](crate::motion::Function::resolution), a user-defined motion by
/// [`longest_step`](crate::motion::Motion::longest_step). If the scale is unknown, a step is at
/// most a fiftieth of the interval, or one second in an
/// [`Integrator`](crate::integrate::Integrator), which may be too long at loose tolerances.
///
/// A rejected step takes eleven evaluations. Dense output is of order 7 and takes three more
/// evaluations, but only in steps for which it is requested.
///
/// Source: Dormand and Prince (1981) for the method; Hairer, Nørsett and Wanner (1993), Solving
/// Ordinary Differential Equations I, II.5 and II.6, and their code DOP853 for the estimates, the
/// dense output and the digits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dop853;

impl<D: Dynamics<N, Scalar: Float>, const N: usize> Method<D, N> for Dop853 {
    const NAME: &'static str = "Dop853";
    type Workspace = Stages<D::Scalar, N>;

    fn workspace(&self, _: &D) -> Self::Workspace {
        Stages::zero()
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
        stages: &mut Stages<D::Scalar, N>,
    ) -> Endpoint<D::Scalar, N> {
        let k = &mut stages.k;
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
        stages.increment = k.weighted(B);
        from.advanced(interval, &stages.increment.0, &stages.increment.1)
    }

    fn interpolant(
        &self,
        field: &mut Field<'_, D, N>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        to: &mut Endpoint<D::Scalar, N>,
        stages: &mut Stages<D::Scalar, N>,
    ) -> Interpolant<D::Scalar, N> {
        let k = &mut stages.k;
        k.v[12] = to.v.high;
        k.a[12] = to.end_acceleration(field);
        k.stage(field, interval, from, 13, C[13], A13);
        k.stage(field, interval, from, 14, C[14], A14);
        k.stage(field, interval, from, 15, C[15], A15);
        let mut interpolant = Interpolant::hermite(interval, from, to, &k.a[0], &k.a[12]);
        let h = interval.length::<D::Scalar>();
        for (term, (q, v)) in
            [k.weighted(D3), k.weighted(D4), k.weighted(D5), k.weighted(D6)].into_iter().enumerate()
        {
            interpolant.q[3 + term] = q.map(|sum| h * sum);
            interpolant.v[3 + term] = v.map(|sum| h * sum);
        }
        interpolant.terms = 7;
        interpolant
    }

    fn stage(
        &self,
        index: usize,
        interval: &StepInterval,
        from: &Endpoint<D::Scalar, N>,
        Stages { k, .. }: &Stages<D::Scalar, N>,
    ) -> Option<(f64, Endpoint<D::Scalar, N>)> {
        let dq = match index {
            0 => weighted(&k.v, A1),
            1 => weighted(&k.v, A2),
            2 => weighted(&k.v, A3),
            3 => weighted(&k.v, A4),
            4 => weighted(&k.v, A5),
            5 => weighted(&k.v, A6),
            6 => weighted(&k.v, A7),
            7 => weighted(&k.v, A8),
            8 => weighted(&k.v, A9),
            9 => weighted(&k.v, A10),
            10 => weighted(&k.v, A11),
            _ => return None,
        };
        let (h, c) = (interval.length::<D::Scalar>(), C[index + 1]);
        let q = core::array::from_fn(|i| from.q.high[i] + h * dq[i]);
        Some((c, Endpoint::new(interval.at(c).0, q, k.v[index + 1])))
    }
}

impl<D: Dynamics<N, Scalar: Float>, const N: usize> ErrorEstimate<D, N> for Dop853 {
    #[inline]
    fn error(&self, stages: &Stages<D::Scalar, N>, h: f64, weights: &Weights<N>) -> f64 {
        ErrorEstimate::<D, N>::error_along(self, stages, h, weights, |_| ())
    }

    #[inline]
    fn error_along(
        &self,
        stages: &Stages<D::Scalar, N>,
        h: f64,
        weights: &Weights<N>,
        along: impl Fn(&mut [D::Scalar; N]),
    ) -> f64 {
        let (dq, dv) = &stages.increment;
        let (mut q5, mut v5) = stages.k.weighted(E5);
        let (q3, v3) = stages.k.weighted(B3);
        let mut q3 = core::array::from_fn(|i| dq[i] - q3[i]);
        let mut v3 = core::array::from_fn(|i| dv[i] - v3[i]);
        for estimate in [&mut q5, &mut v5, &mut q3, &mut v3] {
            along(estimate);
        }
        let fifth = weights.square_sum(&q5, &v5);
        let third = weights.square_sum::<D::Scalar>(&q3, &v3);
        // Where squares underflow, the third of them may be all that is left, and a hundredth of it
        // zero.
        if fifth == 0.0 {
            return 0.0;
        }
        // Both estimates are divided by h; the combined estimate behaves like one of order 7.
        STRICTNESS * h * fifth / ((fifth + 0.01 * third) * (2 * N) as f64).sqrt()
    }
}

impl Adaptive for Dop853 {
    const ORDER: u32 = 8;
    // With this β and a safety factor below the usual 0.9, one step in twenty is rejected instead
    // of one in five, and pendulums and orbits take a tenth fewer evaluations for the same error.
    const RESPONSE: Response =
        Response { alpha: 0.11, beta: 0.02, safety: 0.8, least: 1.0 / 3.0, greatest: 6.0 };
    const GAP: f64 = widest(&C, &E5);
}

/// The factor by which the error estimate exceeds that of Hairer's program. With Hairer's estimate
/// three orbits of eccentricity 0.3 end 240 tolerances off.
const STRICTNESS: f64 = 2.0;

/// The slopes of a step, and its increments divided by h.
#[derive(Clone, Copy, Debug)]
pub struct Stages<T, const N: usize> {
    k: Slopes<T, N, 16>,
    increment: ([T; N], [T; N]),
}

impl<T: Float, const N: usize> Stages<T, N> {
    pub(crate) fn zero() -> Self {
        let zero = [T::from_f64(0.0); N];
        Self { k: Slopes::zero(), increment: (zero, zero) }
    }
}

// Stages 0 to 11 belong to the step, stage 12 is the slope at its end, and stages 13 to 15 belong
// to the dense output.

const C: [f64; 16] = [
    0.0,
    0.0526001519587677318785587544488,
    0.0789002279381515978178381316732,
    0.11835034190722739672675719751,
    0.28164965809277260327324280249,
    0.333333333333333333333333333333,
    0.25,
    0.307692307692307692307692307692,
    0.651282051282051282051282051282,
    0.6,
    0.857142857142857142857142857142,
    1.0,
    1.0,
    0.1,
    0.2,
    0.777777777777777777777777777778,
];

const A1: Row<1> = [(0, 0.0526001519587677318785587544488)];

const A2: Row<2> = [(0, 0.0197250569845378994544595329183), (1, 0.0591751709536136983633785987549)];

const A3: Row<2> = [(0, 0.0295875854768068491816892993775), (2, 0.0887627564304205475450678981324)];

const A4: Row<3> = [
    (0, 0.241365134159266685502369798665),
    (2, -0.884549479328286085344864962717),
    (3, 0.924834003261792003115737966543),
];

const A5: Row<3> = [
    (0, 0.037037037037037037037037037037),
    (3, 0.170828608729473871279604482173),
    (4, 0.125467687566822425016691814123),
];

const A6: Row<4> = [
    (0, 0.037109375),
    (3, 0.170252211019544039314978060272),
    (4, 0.0602165389804559606850219397283),
    (5, -0.017578125),
];

const A7: Row<5> = [
    (0, 0.0370920001185047927108779319836),
    (3, 0.170383925712239993810214054705),
    (4, 0.107262030446373284651809199168),
    (5, -0.0153194377486244017527936158236),
    (6, 0.00827378916381402288758473766002),
];

const A8: Row<6> = [
    (0, 0.624110958716075717114429577812),
    (3, -3.36089262944694129406857109825),
    (4, -0.868219346841726006818189891453),
    (5, 27.5920996994467083049415600797),
    (6, 20.1540675504778934086186788979),
    (7, -43.4898841810699588477366255144),
];

const A9: Row<7> = [
    (0, 0.477662536438264365890433908527),
    (3, -2.48811461997166764192642586468),
    (4, -0.590290826836842996371446475743),
    (5, 21.2300514481811942347288949897),
    (6, 15.2792336328824235832596922938),
    (7, -33.2882109689848629194453265587),
    (8, -0.0203312017085086261358222928593),
];

const A10: Row<8> = [
    (0, -0.93714243008598732571704021658),
    (3, 5.18637242884406370830023853209),
    (4, 1.09143734899672957818500254654),
    (5, -8.14978701074692612513997267357),
    (6, -18.5200656599969598641566180701),
    (7, 22.7394870993505042818970056734),
    (8, 2.49360555267965238987089396762),
    (9, -3.0467644718982195003823669022),
];

const A11: Row<9> = [
    (0, 2.27331014751653820792359768449),
    (3, -10.5344954667372501984066689879),
    (4, -2.00087205822486249909675718444),
    (5, -17.9589318631187989172765950534),
    (6, 27.9488845294199600508499808837),
    (7, -2.85899827713502369474065508674),
    (8, -8.87285693353062954433549289258),
    (9, 12.3605671757943030647266201528),
    (10, 0.643392746015763530355970484046),
];

// The weights of the step of order 8, and of the estimates of orders 5 (`E5`, weights of a
// difference) and 3 (`B3`, weights of a result).

const B: Row<8> = [
    (0, 0.0542937341165687622380535766363),
    (5, 4.45031289275240888144113950566),
    (6, 1.89151789931450038304281599044),
    (7, -5.8012039600105847814672114227),
    (8, 0.31116436695781989440891606237),
    (9, -0.152160949662516078556178806805),
    (10, 0.201365400804030348374776537501),
    (11, 0.0447106157277725905176885569043),
];

const B3: Row<3> = [
    (0, 0.244094488188976377952755905512),
    (8, 0.733846688281611857341361741547),
    (11, 0.0220588235294117647058823529412),
];

const E5: Row<8> = [
    (0, 0.01312004499419488073250102996),
    (5, -1.225156446376204440720569753),
    (6, -0.4957589496572501915214079952),
    (7, 1.664377182454986536961530415),
    (8, -0.350328848749973681688648729),
    (9, 0.3341791187130174790297318841),
    (10, 0.08192320648511571246570742613),
    (11, -0.02235530786388629525884427845),
];

// Dense output.

const A13: Row<8> = [
    (0, 0.0561675022830479523392909219681),
    (6, 0.253500210216624811088794765333),
    (7, -0.246239037470802489917441475441),
    (8, -0.124191423263816360469010140626),
    (9, 0.15329179827876569731206322685),
    (10, 0.00820105229563468988491666602057),
    (11, 0.00756789766054569976138603589584),
    (12, -0.008298),
];

const A14: Row<8> = [
    (0, 0.0318346481635021405060768473261),
    (5, 0.0283009096723667755288322961402),
    (6, 0.0535419883074385676223797384372),
    (7, -0.0549237485713909884646569340306),
    (10, -0.000108347328697249322858509316994),
    (11, 0.000382571090835658412954920192323),
    (12, -0.000340465008687404560802977114492),
    (13, 0.141312443674632500278074618366),
];

const A15: Row<8> = [
    (0, -0.428896301583791923408573538692),
    (5, -4.69762141536116384314449447206),
    (6, 7.68342119606259904184240953878),
    (7, 4.06898981839711007970213554331),
    (8, 0.356727187455281109270669543021),
    (12, -0.00139902416515901462129418009734),
    (13, 2.9475147891527723389556272149),
    (14, -9.15095847217987001081870187138),
];

const D3: Row<12> = [
    (0, -8.4289382761090128651353491142),
    (5, 0.5667149535193777696253178359),
    (6, -3.0689499459498916912797304727),
    (7, 2.384667656512069828772814968),
    (8, 2.1170345824450282767155149946),
    (9, -0.8713915837779729920678990749),
    (10, 2.240437430260788275854177165),
    (11, 0.6315787787694688181557024929),
    (12, -0.0889903364513333108206981174),
    (13, 18.148505520854727256656404962),
    (14, -9.1946323924783554000451984436),
    (15, -4.4360363875948939664310572),
];

const D4: Row<12> = [
    (0, 10.427508642579134603413151009),
    (5, 242.28349177525818288430175319),
    (6, 165.20045171727028198505394887),
    (7, -374.54675472269020279518312152),
    (8, -22.113666853125306036270938578),
    (9, 7.7334326684722638389603898808),
    (10, -30.674084731089398182061213626),
    (11, -9.3321305264302278729567221706),
    (12, 15.697238121770843886131091075),
    (13, -31.139403219565177677282850411),
    (14, -9.3529243588444783865713862664),
    (15, 35.81684148639408375246589854),
];

const D5: Row<12> = [
    (0, 19.985053242002433820987653617),
    (5, -387.03730874935176555105901742),
    (6, -189.17813819516756882830838328),
    (7, 527.80815920542364900561016686),
    (8, -11.573902539959630126141871134),
    (9, 6.8812326946963000169666922661),
    (10, -1.000605096691083840318386098),
    (11, 0.7777137798053443209286926574),
    (12, -2.7782057523535084065932004339),
    (13, -60.196695231264120758267380846),
    (14, 84.320405506677161018159903784),
    (15, 11.99229113618278932803513003),
];

const D6: Row<12> = [
    (0, -25.693933462703749003312586129),
    (5, -154.18974869023643374053993627),
    (6, -231.52937917604549567536039109),
    (7, 357.6391179106141237828534991),
    (8, 93.405324183624310003907691704),
    (9, -37.458323136451633156875139351),
    (10, 104.09964950896230045147246184),
    (11, 29.840293426660503123344363579),
    (12, -43.533456590011143754432175058),
    (13, 96.3245539591882829483949506),
    (14, -39.177261675615439165231486172),
    (15, -149.72683625798562581422125276),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::schemes::runge_kutta::conditions::{moment, sum};

    #[test]
    fn rows_add_up_to_their_nodes() {
        let sums = [
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
            sum(B),
        ];
        for (i, sum) in sums.into_iter().enumerate() {
            assert!((sum - C[i + 1]).abs() < 1e-13, "row {} adds up to {sum}", i + 1);
        }
        for (i, sum) in [sum(A13), sum(A14), sum(A15)].into_iter().enumerate() {
            assert!((sum - C[i + 13]).abs() < 1e-14, "row {} adds up to {sum}", i + 13);
        }
    }

    #[test]
    fn weights_integrate_powers() {
        for power in 0..8 {
            assert!(
                (moment(&C, B, power) - 1.0 / f64::from(power + 1)).abs() < 1e-14,
                "power {power}"
            );
        }
        // `B3` integrates the powers 0 to 2 exactly; `E5` integrates the powers 0 to 4 to zero.
        for power in 0..3 {
            assert!(
                (moment(&C, B3, power) - 1.0 / f64::from(power + 1)).abs() < 1e-14,
                "power {power}"
            );
        }
        for power in 0..5 {
            assert!(moment(&C, E5, power).abs() < 1e-14, "power {power}");
        }
        assert!(moment(&C, E5, 6).abs() > 1e-5);
    }

    #[test]
    fn dense_weights_vanish_on_constants() {
        for row in [sum(D3), sum(D4), sum(D5), sum(D6)] {
            assert!(row.abs() < 1e-12, "{row}");
        }
    }
}

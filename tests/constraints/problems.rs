//! Problems with known digits and closed forms.

use crate::systems::{
    ANDREWS_START, Bob, CAR_AXIS_START, Disc, Loops2, Simple, Sleigh, andrews, car_axis,
};
use pendulum_runtime::prelude::*;
use pendulum_runtime::system::System;

/// Andrews' mechanism at t = 0.03, recomputed to 28 digits: the published ones are off from the
/// tenth on.
const ANDREWS_END: [[f64; 7]; 2] = [
    [
        15.810771195153707097119387,
        -15.756371058411839469727753,
        0.040822240119645804854828,
        -0.53473011634207957937702,
        0.52440996587995406937167,
        0.53473011634207957937702,
        1.0480807410419378730685,
    ],
    [
        1139.9203022591060641980968,
        -1424.3792951775400731960264,
        11.032911910618593745327,
        19.293374105032040831628,
        0.57356991482950245381769,
        -19.293374105032040831628,
        0.32317914924913087499075,
    ],
];

/// The multipliers there, with our sign.
const ANDREWS_REACTIONS: [f64; 6] = [
    -199.17534810453862818624,
    29.755309974971763324416,
    -23.066543611622151128617,
    -31.452725275771137075385,
    -22.642494786394378577713,
    -11.617392352611255906901,
];

#[test]
fn show() {
    let system = andrews();
    for rtol in [1e-6, 1e-8, 1e-10, 1e-12] {
        macro_rules! with {
            ($method:expr) => {{
                let clock = std::time::Instant::now();
                let end = solve(&system, (0.0, 0.03), ANDREWS_START, [0.0; 7]).method($method).rtol(rtol).atol(rtol).run();
                match end {
                    Ok(end) => {
                        let last = end.end;
                        let error = (0..7).map(|k| (last.q[k] - ANDREWS_END[0][k]).abs() / ANDREWS_END[0][k].abs()).fold(0.0, f64::max);
                        let λ = system.reactions(0.03, &last.q, &last.v, &());
                        let λ = (0..6).map(|k| (λ[k] - ANDREWS_REACTIONS[k]).abs()).fold(0.0, f64::max);
                        println!("{} {rtol:e}: {error:e} {λ:e} {} {} {:?}", stringify!($method), end.stats.accepted, end.stats.evaluations, clock.elapsed());
                    }
                    Err(error) => println!("{error}"),
                }
            }};
        }
        with!(Picard);
        with!(Dop853);
        with!(Taylor::new());
    }
}

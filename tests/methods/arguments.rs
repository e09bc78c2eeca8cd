//! Functions whose arguments change sign, or pass a narrow range, within a long step.

use core::f64::consts::{PI, TAU};
use pendulum_runtime::error::Error;
use pendulum_runtime::motion::{Curve, Sinusoid};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::Float;
use pendulum_runtime::system::System;
use systems::random::{Random, some};

lagrangian! {
    /// A block on a table that shakes, with friction over the width w.
    #[derive(Clone, Copy, Debug)]
    pub struct Shaken { A, ω, F, w }
    coordinate x;
    kinetic = ẋ^2/2;
    force x = A*ω^2*sin(ω*t) - F*tanh(ẋ/w);
}

lagrangian! {
    /// The same block with its friction as a logistic function.
    #[derive(Clone, Copy, Debug)]
    pub struct Logistic { A, ω, F, w }
    coordinate x;
    kinetic = ẋ^2/2;
    force x = A*ω^2*sin(ω*t) + F - 2*F/(1 + exp(-2*ẋ/w));
}

lagrangian! {
    /// The same block with its friction as a function of Gompertz.
    #[derive(Clone, Copy, Debug)]
    pub struct Gompertz { A, ω, F, w }
    coordinate x;
    kinetic = ẋ^2/2;
    force x = A*ω^2*sin(ω*t) + F*(2*exp(-ln(2)*exp(ẋ/w)) - 1);
}

lagrangian! {
    /// The same block with its friction as a function of Gudermann.
    #[derive(Clone, Copy, Debug)]
    pub struct Gudermann { A, ω, F, w }
    coordinate x;
    kinetic = ẋ^2/2;
    force x = A*ω^2*sin(ω*t) + F*(1 - 4/π*atan(exp(ẋ/w)));
}

lagrangian! {
    /// The same block with its friction as an angle, whose other side is the width.
    #[derive(Clone, Copy, Debug)]
    pub struct Angle { A, ω, F, w }
    coordinate x;
    kinetic = ẋ^2/2;
    force x = A*ω^2*sin(ω*t) - F*(1 - 2/π*atan2(w, ẋ));
}

lagrangian! {
    /// The same block with dry friction.
    #[derive(Clone, Copy, Debug)]
    pub struct Dry { A, ω, F }
    coordinate x;
    kinetic = ẋ^2/2;
    force x = A*ω^2*sin(ω*t) - F*sign(ẋ);
}

lagrangian! {
    /// A block on a spring and on a belt, with dry friction.
    #[derive(Clone, Copy, Debug)]
    pub struct Belt { k, F }
    coordinate q;
    driven x;
    kinetic = q̇^2/2;
    potential = k*q^2/2;
    force q = -F*sign(q̇ - dot(x));
}

lagrangian! {
    /// The same block on a belt whose speed is a function of time.
    #[derive(Clone, Copy, Debug)]
    pub struct Timed { k, F, b, ω }
    coordinate q;
    kinetic = q̇^2/2;
    potential = k*q^2/2;
    force q = -F*sign(q̇ - b*sin(ω*t));
}

lagrangian! {
    /// A point between two springs, of which the nearer one pulls.
    #[derive(Clone, Copy, Debug)]
    pub struct Wells { k }
    coordinate x;
    coordinate y;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = k/2*min((x - 1)^2, (x + 1)^2) + y^2/2 + x*y/5;
}

lagrangian! {
    /// A free mass under pulses of different shapes.
    #[derive(Clone, Copy, Debug)]
    pub struct Pushed { a, b, d, c, w }
    coordinate q;
    kinetic = q̇^2/2;
    force q = a*exp(-((t^2 - c^2)/w)^2) + b*exp(-(abs(t - c)/w)^(3/2)) + d/cosh((t^3 - c^3)/w);
}

lagrangian! {
    /// A free mass that is pushed when a motion passes a place.
    #[derive(Clone, Copy, Debug)]
    pub struct Passed { a, c, w }
    coordinate q;
    driven x;
    kinetic = q̇^2/2;
    force q = a*exp(-((x - c)/w)^2);
}

lagrangian! {
    /// A mass that crosses a brake.
    #[derive(Clone, Copy, Debug)]
    pub struct Braked { c, p, w }
    coordinate x;
    kinetic = ẋ^2/2;
    force x = -c*ẋ*exp(-((x - p)/w)^2);
}

lagrangian! {
    /// A mass that is drawn to a plane by a constant force.
    #[derive(Clone, Copy, Debug)]
    pub struct Drawn { a, p }
    coordinate x;
    kinetic = ẋ^2/2;
    potential = a*abs(x - p);
}

lagrangian! {
    /// A ball above a spring.
    #[derive(Clone, Copy, Debug)]
    pub struct Above { g, k }
    coordinate y;
    kinetic = ẏ^2/2;
    potential = g*y + k/2*max(0, -y)^2;
}

lagrangian! {
    /// Masses that are pushed one after another, while s grows as time does and r rests.
    #[derive(Clone, Copy, Debug)]
    pub struct Varied { a, c, w }
    coordinate q[6];
    coordinate s;
    coordinate r;
    kinetic = sum(k in 0..6, q̇[k]^2)/2 + (ṡ^2 + ṙ^2)/2;
    force q[0] = a*exp(-((t - c)/w)^2/(1 + r^2));
    force q[1] = a*exp(-((s - c - 1.1)/w)^2*(2 + r));
    force q[2] = a*exp(-((s - c - 2.2)/w)^2 - r);
    force q[3] = a/(1 + ((s - c - 3.3)/w)^2*(2 + sin(r)));
    force q[4] = a*exp(2*(cos(s - c - 4.4) - 1)/w^2);
    force q[5] = a*cos(s - c - 5.5)^4000;
}

lagrangian! {
    /// Masses that are pushed again and again.
    #[derive(Clone, Copy, Debug)]
    pub struct Again { a, c }
    coordinate x;
    coordinate y;
    kinetic = (ẋ^2 + ẏ^2)/2;
    force x = a*cos(t - c)^4000;
    force y = a*(1/2 + cos(t - c)/2)^2000;
}

/// Runs the default method and others, and compares a number of the end.
macro_rules! ends {
    ($dynamics:expr, $time:expr, $q:expr, $v:expr, $value:expr, $expected:expr, $most:expr) => {
        ends!($dynamics, $time, $q, $v, $value, $expected, $most, [Auto, Picard, Dop853])
    };
    ($dynamics:expr, $time:expr, $q:expr, $v:expr, $value:expr, $expected:expr, $most:expr, [$($method:expr),*]) => {
        for tolerance in [1e-5, 1e-7, 1e-9] {
            $(
                let solution =
                    solve($dynamics, $time, $q, $v).method($method).rtol(tolerance).run().unwrap();
                let found: f64 = $value(&solution.end);
                let (error, method) = ((found - $expected).abs() / tolerance, solution.stats.method);
                assert!(error <= $most, "{method} at {tolerance:e}: {error} tolerances, {found}");
            )*
        }
    };
}

/// The value follows from short steps of `Rodas4` and `Dop853`, which agree to eleven digits.
#[test]
fn a_block_that_sticks_for_eight_milliseconds() {
    let block = Shaken::new(1.0, TAU, 2.0, 1e-3);
    let speed = |end: &State<f64, 1>| end.v[0];
    ends!(&block, (0.0, 5.2), [0.0], [10.0], speed, 3.951_269_891_7, 100.0);
    let logistic = Logistic::new(1.0, TAU, 2.0, 1e-3);
    ends!(&logistic, (0.0, 5.2), [0.0], [10.0], speed, 3.951_269_891_7, 100.0);
    let run = solve(&block, (0.0, 5.2), [0.0], [10.0]).method(Rodas4).rtol(1e-7).run().unwrap();
    assert!((run.end.v[0] - 3.951_269_891_7).abs() < 1e-5);
}

/// The values follow from short steps.
#[test]
fn blocks_that_stick_by_functions_of_exponentials() {
    macro_rules! check {
        ($block:ident, $start:expr) => {{
            let block = $block::new(1.0, TAU, 2.0, 1e-3);
            let exact = |time, q, v, step| {
                let run = solve(&block, time, q, v).method(Dop853).rtol(1e-12).atol(1e-12);
                run.max_step(step).run().unwrap().end
            };
            let middle = exact((0.0, 4.9), [0.0], [$start], 0.05);
            let right = exact((4.9, 5.2), middle.q, middle.v, 5e-4).v[0];
            let speed = |end: &State<f64, 1>| end.v[0];
            ends!(&block, (0.0, 5.2), [0.0], [$start], speed, right, 100.0);
        }};
    }
    for start in [10.0, 9.98, 9.95] {
        check!(Gompertz, start);
        check!(Gudermann, start);
        check!(Angle, start);
    }
}

/// While the table moves with less than the friction, the block has to stay at rest.
#[test]
fn dry_friction_that_sticks_is_an_error() {
    let block = Dry::new(1.0, TAU, 2.0);
    // v = v₀ − 2 t + ω (1 − cos ωt) is zero at 5, and at t₁; from there on it grows by 4 (t − t₁).
    let (first, second) = (4.978_533_294_245_55, 5.005_314_966_679_28);
    for (start, sticks) in [(10.0, 5.0), (9.9, second)] {
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
            let run = solve(&block, (0.0, 10.0), [0.0], [start]).rtol(tolerance);
            let failure = run.run().unwrap_err();
            let message = failure.error.to_string();
            let Error::Sliding { t, argument: "ẋ" } = failure.error else { panic!("{message}") };
            // Near the end of the motion, time is the root of a velocity.
            assert!((t - sticks).abs() < 30.0 * tolerance, "{t} at {tolerance:e}");
            assert!(message.contains("as a `friction` in place of"), "{message}");
        }
    }
    let expected = TAU * ((TAU * first).cos() - 1.0) + 2.0 * (5.0 - first);
    let speed = |end: &State<f64, 1>| end.v[0];
    ends!(&block, (0.0, 5.0), [0.0], [9.9], speed, expected, 100.0);
}

/// Checks that a block sticks at the time `$stop`, known to `$width`.
macro_rules! sticks {
    ($block:expr, $time:expr, $start:expr, $stop:expr, $width:expr, [$($method:expr),*]) => {
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10, 1e-12] {
            $(
                let run = solve(&$block, $time, [0.0], [$start]).method($method).rtol(tolerance);
                let failure = run.max_steps(10_000).run().unwrap_err();
                let message = failure.error.to_string();
                let Error::Sliding { t, .. } = failure.error else { panic!("{message}") };
                assert!((t - $stop).abs() < $width + 100.0 * tolerance, "{t} for {}", $stop);
            )*
        }
    };
}

/// Stages on both sides of a jump may cancel, and errors far below the tolerance hide them.
#[test]
fn stages_on_both_sides_of_a_switch_stick_in_time() {
    let mut random = Random::new(15);
    for _ in some(0..40) {
        let (ω, friction, start) =
            (random.uniform(1.0, 8.0), random.uniform(0.3, 1.4), random.uniform(0.5, 3.0));
        let block = Dry::new(1.0 / (ω * ω), ω, friction);
        // From the first zero of v = v₀ + (1 − cos ωt)/ω − F t the drive has to be below F.
        let speed = |t: f64| start / ω + (1.0 - (ω * t).cos()) / ω - friction * t;
        let Some(stop) = (1..30_000).map(|k| 1e-3 * f64::from(k) / ω).find(|&t| speed(t) <= 0.0)
        else {
            continue;
        };
        if friction < (ω * stop).sin().abs() + 0.05 {
            continue;
        }
        sticks!(
            block,
            (0.0, 40.0 / ω),
            start / ω,
            stop,
            2e-3 / ω,
            [Auto, Dop853, Rodas4, Taylor::new()]
        );
    }
}

/// Returns when a block that starts at rest on its spring has the speed `belt` of a belt, unless
/// it does not clearly stick there; `belt` also returns the acceleration.
fn stuck(k: f64, friction: f64, start: f64, belt: impl Fn(f64) -> [f64; 2]) -> Option<f64> {
    let (side, ω) = ((start - belt(0.0)[0]).signum(), k.sqrt());
    // With a steady friction, the block swings about another place.
    let place = -side * friction / k;
    let ahead = |t: f64| side * (ω * place * (ω * t).sin() + start * (ω * t).cos() - belt(t)[0]);
    let after = (1..3000).map(|step| 1e-3 * f64::from(step)).find(|&t| ahead(t) < 0.0)?;
    let (mut low, mut high) = (after - 1e-3, after);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *if ahead(middle) < 0.0 { &mut high } else { &mut low } = middle;
    }
    let q = place - place * (ω * high).cos() + start / ω * (ω * high).sin();
    ((k * q + belt(high)[1]).abs() < 0.7 * friction).then_some(high)
}

/// The velocity of what sticks to a belt hardly changes within the short steps that land there.
#[test]
fn dry_friction_that_sticks_to_a_belt_is_an_error() {
    let mut random = Random::new(36);
    let mut found = [0; 4];
    for member in 0..40 {
        let (k, friction) = (random.uniform(1.0, 30.0), random.uniform(1.0, 10.0));
        let (start, b, c) =
            (random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0), random.of(&[0.5, 2.0, -1.0]));
        let block = Belt { k, F: friction };
        macro_rules! check {
            ($block:expr, $belt:expr) => {
                if let Some(stop) = stuck(k, friction, start, $belt) {
                    let block = $block;
                    sticks!(block, (0.0, 3.0), start, stop, 1e-10, [Auto, Dop853]);
                    found[member % 4] += 1;
                }
            };
        }
        let ω = 5.0 * c;
        match member % 4 {
            0 => check!(block.driven_by(Sinusoid::new([b / ω], ω, [0.0])), |t: f64| {
                [b * (ω * t).cos(), -b * ω * (ω * t).sin()]
            }),
            1 => {
                let line = Curve::linear(&[0.0, 4.0], &[[0.0], [4.0 * b]]).unwrap();
                check!(block.driven_by(line), |_| [b, 0.0]);
            }
            2 => {
                let times = [0.0, 0.7, 1.1, 2.3, 4.0];
                let places = times.map(|t| [b * t + 0.5 * c * t * t]);
                let parabola = Curve::catmull_rom(&times, &places).unwrap();
                check!(block.driven_by(parabola), |t| [b + c * t, c]);
            }
            _ => check!(Timed { k, F: friction, b, ω }, |t: f64| {
                [b * (ω * t).sin(), b * ω * (ω * t).cos()]
            }),
        }
    }
    assert!(found.iter().all(|count| 0 < *count), "{found:?}");
}

/// The value follows from runs that end at each change of sign.
#[test]
fn the_nearer_of_two_springs() {
    let wells = Wells::new(23.565_285_164_495_222);
    let (q, v) =
        ([0.017_318_669_149_460_675, -0.665_075_209_903_939_9], [0.757_886_059_945_867, 0.0]);
    // Passing the ridge at a speed of 0.15 multiplies errors by hundreds.
    ends!(
        &wells,
        (0.0, 6.0),
        q,
        v,
        |end: &State<f64, 2>| end.q[0],
        1.371_322_664_50,
        3e3,
        [Auto, Picard, Dop853, Rodas4]
    );
}

/// Returns the integral of a pulse over its width.
fn area(pulse: impl Fn(f64) -> f64, (begin, end): (f64, f64)) -> f64 {
    let h = (end - begin) / 4000.0;
    (0..=4000).map(|k| h * pulse(begin + h * f64::from(k))).sum()
}

#[test]
fn kicks_at_powers_of_time() {
    let mut random = Random::new(11);
    let speed = |end: &State<f64, 1>| end.v[0];
    for _ in some(0..40) {
        let (c, w) = (random.uniform(2.0, 10.0), random.uniform(0.005, 0.05));
        let near = |width: f64| (c - 30.0 * width, c + 30.0 * width);
        let square = area(|t| (-((t * t - c * c) / w).powi(2)).exp(), near(w / c));
        let cube = area(|t| 1.0 / ((t.powi(3) - c.powi(3)) / w).cosh(), near(w / (c * c)));
        // ∫ exp(−|u|^(3/2)) du is 2 Γ(5/3).
        let cusp = 1.805_490_585_901_867 * w;
        for (pushed, expected) in [
            (Pushed::new(3.0, 0.0, 0.0, c, w), 3.0 * square),
            (Pushed::new(0.0, 3.0, 0.0, c, w), 3.0 * cusp),
            (Pushed::new(0.0, 0.0, 3.0, c, w), 3.0 * cube),
        ] {
            ends!(&pushed, (0.0, 12.0), [0.0], [0.0], speed, expected, 100.0);
        }
    }
}

/// Kicks with a width or a height that depends on the state, and peaks of sines.
#[test]
fn kicks_that_vary_with_the_state() {
    let mut random = Random::new(16);
    for _ in some(0..14) {
        // No peak lies at the start or at the end.
        let (c, w) = (random.uniform(4.3, 5.0), random.uniform(0.005, 0.03));
        let (a, r) = (3.0, random.uniform(-0.9, 2.0));
        let start = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, r];
        let rates = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let end = c + 5.5 + 1.2;
        let bell = |k: f64| a * w * (PI / k).sqrt();
        // ∫ dx/(1 + k (x/w)²) from 0 to the end.
        let tail = (2.0 + r.sin()).sqrt() / w;
        let fraction = ((end - c - 3.3) * tail).atan() + ((c + 3.3) * tail).atan();
        let peaks = |own: &dyn Fn(f64) -> f64| area(|t| a * own(t), (0.0, end));
        let expected = [
            bell((1.0 + r * r).recip()),
            bell(2.0 + r),
            bell(1.0) * (-r).exp(),
            a * fraction / tail,
            peaks(&|t| (2.0 * ((t - c - 4.4).cos() - 1.0) / (w * w)).exp()),
            peaks(&|t| (t - c - 5.5).cos().powi(4000)),
        ];
        for (k, expected) in expected.into_iter().enumerate() {
            let speed = |end: &State<f64, 8>| end.v[k];
            ends!(&Varied::new(a, c, w), (0.0, end), start, rates, speed, expected, 100.0);
        }
        let expected = [
            peaks(&|t| (t - c).cos().powi(4000)),
            peaks(&|t| (0.5 + 0.5 * (t - c).cos()).powi(2000)),
        ];
        for (k, expected) in expected.into_iter().enumerate() {
            let speed = |end: &State<f64, 2>| end.v[k];
            ends!(&Again::new(a, c), (0.0, end), [0.0; 2], [0.0; 2], speed, expected, 100.0);
        }
    }
}

#[test]
fn kicks_at_places_of_a_motion() {
    let mut random = Random::new(12);
    let speed = |end: &State<f64, 1>| end.v[0];
    for _ in some(0..30) {
        let (ω, φ) = (random.uniform(0.2, 0.6), random.uniform(0.0, 1.0));
        let (c, w) = (random.uniform(0.2, 0.8), random.uniform(2e-3, 0.02));
        let passed = Passed::new(3.0, c, w).driven_by(Sinusoid::new([1.0], ω, [φ]));
        // The motion passes c on the way down.
        let at = (PI - c.asin() - φ) / ω;
        let pulse = |t: f64| 3.0 * (-(((ω * t + φ).sin() - c) / w).powi(2)).exp();
        let begin = (PI / 2.0 - φ) / ω;
        let near = (begin.max(at - 30.0 * w / ω), at + 30.0 * w / ω);
        let expected = area(pulse, near);
        ends!(&passed, (begin, at + 1.0), [0.0], [0.0], speed, expected, 100.0);
    }
}

/// dv/dx = −c exp(−((x − p)/w)²): the speed falls by √π c w.
#[test]
fn a_brake_that_is_crossed_within_a_step() {
    let mut random = Random::new(13);
    for _ in some(0..40) {
        let (w, p) = (random.uniform(1e-3, 1e-2), random.uniform(2.0, 8.0));
        let c = random.uniform(10.0, 40.0);
        let expected = 2.0 - PI.sqrt() * c * w;
        let speed = |end: &State<f64, 1>| end.v[0];
        let braked = Braked::new(c, p, w);
        ends!(&braked, (0.0, 8.0), [0.0], [2.0], speed, expected, 100.0);
        let single = Braked { c: c as f32, p: p as f32, w: w as f32 };
        let end = solve(&single, (0.0, 8.0), [0.0], [2.0]).run().unwrap().end;
        assert!((f64::from(end.v[0]) - expected).abs() < 1e-3, "{} for {expected}", end.v[0]);
    }
}

/// Parabolas between the changes of sign: the period is 4 v/a.
#[test]
fn parabolas_between_changes_of_sign() {
    let mut random = Random::new(14);
    for _ in some(0..20) {
        let (a, v) = (random.uniform(0.5, 5.0), random.uniform(0.5, 3.0));
        let drawn = Drawn::new(a, 0.5);
        let period = 4.0 * v / a;
        let place = |end: &State<f64, 1>| end.q[0];
        ends!(&drawn, (0.0, 7.25 * period), [0.5], [v], place, 0.5 + 0.5 * v * v / a, 300.0);
        let solution = solve(&drawn, (0.0, 7.25 * period), [0.5], [v]).run().unwrap();
        assert!(solution.stats.accepted < 400, "{}", solution.stats);
        let back = solve(&drawn, (7.25 * period, 0.0), solution.end.q, solution.end.v);
        assert!((back.run().unwrap().end.v[0] - v).abs() < 1e-3);
    }
}

/// In contact, y = g/k (cos ωt − 1) − (v/ω) sin ωt until it is zero again.
#[test]
fn a_ball_on_a_spring() {
    let (g, k, h) = (9.81, 1e4, 1.3);
    let (fall, speed) = ((2.0 * h / g).sqrt(), (2.0 * g * h).sqrt());
    let ω = k.sqrt();
    let contact = 2.0 * (PI - (speed * ω / g).atan()) / ω;
    let period = 2.0 * fall + contact;
    let height = |end: &State<f64, 1>| end.q[0];
    ends!(
        &Above::new(g, k),
        (0.0, 5.0 * period),
        [h],
        [0.0],
        height,
        h,
        1e3,
        [Auto, Picard, Dop853, Rodas4]
    );
}

#[test]
fn arguments_are_listed() {
    fn lists<T: Float, S: System<N, Scalar = T>, const N: usize>() -> [&'static [&'static str]; 2] {
        [S::FACTS.switches, S::FACTS.layers]
    }
    assert_eq!(lists::<f64, Dry, 1>(), [&["ẋ"][..], &[]]);
    assert_eq!(lists::<f64, Shaken, 1>(), [&[][..], &["ẋ/w"]]);
    assert_eq!(lists::<f64, Drawn, 1>(), [&["p − x"][..], &[]]);
}

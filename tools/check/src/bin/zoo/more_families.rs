//! The families that are measured only with `--features all`.

use crate::case::{Guide, Scalar};
use crate::families::{
    Family, Problem, closure, contact, double, friction, kick, moving, pendulum, shorter, single,
    square_wave,
};
use crate::more_blocks::{
    Atoms, Charged, Eight, Elastic, Five, Hoop, Kinked, Lifted, Oscillator, Restricted, SoftStop,
    Stars, Steep, Toda, Valley, Wilberforce,
};
use crate::motions::{Drive, Shape};
use crate::random::Random;
use crate::trial::Trial;
use systems::problems::{Double, HenonHeiles, Kepler, Simple};

const fn wide(name: &'static str, make: fn(&mut Random, Scalar) -> Problem) -> Family {
    Family { name, scalar: Scalar::Wide, make }
}

pub(crate) const MORE: &[Family] = &[
    double("simple", simple),
    // Controls.
    double("double", coupled),
    double("kepler", |r, s| {
        let e = r.within(0.0, 0.7);
        orbit(s, 1.0 - e, e, 10.0)
    }),
    double("hoop", hoop),
    double("wilberforce", wilberforce),
    double("five links", five),
    double("eight links", eight),
    double("henon-heiles", henon_heiles),
    // Contacts.
    double("soft stop", soft_stop),
    double("max stop", |r, s| {
        let kinked = Kinked { g: 9.81, a: 0.0, k: 1e3, m: r.within(-0.3, 0.5), c: 0.0 };
        pendulum(r, |q, v| Trial::new(s, &kinked, [q - 1.5], v, 5.0, Guide::FREE))
    }),
    double("two walls", |r, s| {
        steep(r, s, &Steep { e: (-200.0f64).exp(), k: 200.0, ..FLAT }, 0.05)
    }),
    double("x^12", |r, s| steep(r, s, &Steep { a: 1.0, ..FLAT }, 1e300)),
    double("exp(20 x)", |r, s| steep(r, s, &Steep { e: 1e-6, k: 20.0, ..FLAT }, 0.1)),
    double("needle", |r, s| steep(r, s, &Steep { a: 1.0, h: 0.1, p: 0.02, ..FLAT }, 0.02)),
    double("double well", double_well),
    double("lennard-jones", lennard_jones),
    // Friction and corners.
    double("smoothed abs", smoothed_abs),
    double("abs", |r, s| {
        let kinked = Kinked { g: 2.0, a: r.within(0.5, 2.0), k: 0.0, m: 0.0, c: 0.0 };
        pendulum(r, |q, v| Trial::new(s, &kinked, [q], v, 8.0, Guide::FREE))
    }),
    double("drag abs(v) v", |r, s| {
        let kinked = Kinked { g: 9.81, a: 0.0, k: 0.0, m: 0.0, c: r.within(0.1, 2.0) };
        pendulum(r, |q, v| Trial::new(s, &kinked, [q], v, 8.0, Guide::FREE))
    }),
    // Forces.
    double("chirp", |r, s| {
        let chirp =
            Oscillator {
                k: 20.0, f: r.within(5.0, 20.0), ω: 1.0, χ: r.within(1.0, 5.0), ..PLAIN
            };
        oscillator(r, s, &chirp, 8.0)
    }),
    double("fast force", |r, s| {
        let fast = Oscillator {
            k: 1.0,
            c: 1.0,
            f: r.within(100.0, 500.0),
            ω: r.within(150.0, 300.0),
            ..PLAIN
        };
        oscillator(r, s, &fast, 3.0)
    }),
    double("duffing", |r, s| {
        let duffing = Oscillator { k: -1.0, c: 1.0, f: r.within(0.2, 0.5), ω: 1.2, ..PLAIN };
        oscillator(r, s, &duffing, 10.0)
    }),
    double("van der pol", |r, s| {
        let relaxed = Oscillator { k: 1.0, μ: r.within(0.5, 3.0), ..PLAIN };
        oscillator(r, s, &relaxed, 10.0)
    }),
    double("van der pol 20", |r, s| {
        let relaxed = Oscillator { k: 1.0, μ: r.within(10.0, 20.0), ..PLAIN };
        oscillator(r, s, &relaxed, 30.0)
    }),
    double("morse", |r, s| {
        let morse = Oscillator { D: 2.0, s: r.within(2.0, 6.0), ..PLAIN };
        let (q, v) = ([r.within(-0.1, 0.3)], [r.within(-1.0, 1.0)]);
        Box::new(Trial::new(s, &morse, q, v, 5.0, Guide::FREE))
    }),
    double("unstable", |r, s| {
        let (q, v) = ([core::f64::consts::PI - r.log_within(1e-6, 1e-2)], [0.0]);
        Box::new(Trial::new(s, &Simple { g: 1.0 }, q, v, 8.0, Guide::FREE))
    }),
    // Orbits and lattices.
    double("kepler 0.99", |r, s| {
        let e = r.within(0.97, 0.995);
        orbit(s, 1.0 + e, -e, r.within(3.5, 5.0))
    }),
    double("restricted", restricted),
    double("three stars", stars),
    double("toda", toda),
    double("magnetic", magnetic),
    double("stiff spring", elastic),
    // Motions from rest.
    double("rest, ramp", |r, s| {
        let shape = Shape::Ramp {
            a: r.within(0.2, 0.6),
            from: r.within(3.0, 8.0),
            long: r.within(0.2, 0.5),
        };
        lifted(r, s, shape)
    }),
    double("rest, rise", |r, s| {
        let shape =
            Shape::Rise { a: r.within(0.2, 0.6), c: r.within(4.0, 8.0), s: r.within(0.1, 0.2) };
        lifted(r, s, shape)
    }),
    // Single precision.
    single("simple f32", simple),
    single("double f32", coupled),
    single("moving f32", moving),
    single("contact 1e-2 f32", |r, s| contact(r, s, 1e-2)),
    single("friction f32", |r, s| friction(r, s, 0.03, 0.0)),
    single("square wave f32", |r, s| square_wave(r, s, 1e-2)),
    single("kick f32", kick),
    single("closure step f32", |r, s| {
        closure(r, s, |r| Shape::Jump { a: r.within(1.0, 5.0), at: r.within(1.0, 6.0) })
    }),
    single("lennard-jones f32", lennard_jones),
    // Double-double.
    wide("simple dd", simple),
    wide("double dd", coupled),
    wide("kepler dd", |r, s| {
        let e = r.within(0.0, 0.5);
        orbit(s, 1.0 - e, e, 3.0)
    }),
    wide("contact 1e-2 dd", |r, s| contact(r, s, 1e-2)),
    wide("square wave dd", |r, s| square_wave(r, s, 0.1)),
];

fn soft_stop(r: &mut Random, scalar: Scalar) -> Problem {
    let stop = SoftStop { g: 9.81, k: 1e4, m: r.within(-0.3, 0.5), w: 3e-3 };
    let (q, v) = ([r.within(-1.5, -0.5)], [r.within(-2.0, 2.0)]);
    Box::new(Trial::new(scalar, &stop, q, v, 5.0, Guide::max_step(0.015)))
}

const FLAT: Steep = Steep { a: 0.0, e: 0.0, k: 1.0, d: 0.0, h: 0.0, p: 1.0 };

fn steep(r: &mut Random, scalar: Scalar, steep: &Steep, max_step: f64) -> Problem {
    let (q, v) = ([r.within(-0.5, 0.5)], [r.within(0.7, 2.0)]);
    Box::new(Trial::new(scalar, steep, q, v, 8.0, Guide::max_step(max_step)))
}

fn double_well(r: &mut Random, scalar: Scalar) -> Problem {
    let well = Steep { d: r.within(1.0, 3.0), ..FLAT };
    let (q, v) = ([r.log_within(1e-4, 1e-1)], [0.0]);
    Box::new(Trial::new(scalar, &well, q, v, 6.0, Guide::FREE))
}

fn smoothed_abs(r: &mut Random, scalar: Scalar) -> Problem {
    let valley = Valley { k: r.within(0.5, 2.0), d: 1e-8 };
    let (q, v) = ([r.within(-1.0, 1.0)], [r.within(-1.0, 1.0)]);
    Box::new(Trial::new(scalar, &valley, q, v, 10.0, Guide::max_step(0.02)))
}

const PLAIN: Oscillator =
    Oscillator { D: 0.0, s: 1.0, k: 0.0, c: 0.0, μ: 0.0, f: 0.0, ω: 0.0, χ: 0.0 };

fn oscillator(r: &mut Random, scalar: Scalar, system: &Oscillator, end: f64) -> Problem {
    let (q, v) = ([r.within(-1.5, 1.5)], [r.within(-1.0, 1.0)]);
    Box::new(Trial::new(scalar, system, q, v, end, Guide::max_step(0.5)))
}

/// Creates a ball that rests until the ground moves.
fn lifted(r: &mut Random, scalar: Scalar, shape: Shape) -> Problem {
    let (g, k, w) = (9.81, 1e4, 1e-2);
    let ball = Lifted { g, k, w, c: r.within(0.0, 1.0) };
    // The equilibrium of spring and weight, by bisection.
    let (mut low, mut high) = (-0.1f64, 0.1f64);
    for _ in 0..60 {
        let y = 0.5 * (low + high);
        let push = k * w * (1.0 + (-y / w).exp()).ln() / (1.0 + (y / w).exp());
        if push < g { high = y } else { low = y }
    }
    let drive = Drive::Closure(shape, [0.0, 1.0]);
    Box::new(Trial::new(scalar, &ball, [low], [0.0], 10.0, Guide::max_step(0.02)).driven(drive))
}

fn lennard_jones(r: &mut Random, scalar: Scalar) -> Problem {
    let (q, v) = ([r.within(1.05, 2.5), 0.0], [r.within(-2.0, 2.0), r.within(-0.5, 0.5)]);
    Box::new(Trial::new(scalar, &Atoms { ε: 1.0 }, q, v, 5.0, Guide::FREE))
}

fn coupled(r: &mut Random, scalar: Scalar) -> Problem {
    let double = Double { m: [1.0, r.within(0.5, 1.5)], l: [1.0, r.within(0.5, 1.5)], g: 9.81 };
    let q = [r.within(-1.2, 1.2), r.within(-1.2, 1.2)];
    let v = [r.within(-1.0, 1.0), r.within(-1.0, 1.0)];
    Box::new(Trial::new(scalar, &double, q, v, shorter(scalar, 5.0), Guide::FREE))
}

fn five(r: &mut Random, scalar: Scalar) -> Problem {
    let q = core::array::from_fn(|_| r.within(-0.8, 0.8));
    Box::new(Trial::new(scalar, &Five { l: 0.3, g: 9.81 }, q, [0.0; 5], 2.0, Guide::FREE))
}

fn eight(r: &mut Random, scalar: Scalar) -> Problem {
    let q = core::array::from_fn(|_| r.within(-0.6, 0.6));
    Box::new(Trial::new(scalar, &Eight { l: 0.3, g: 9.81 }, q, [0.0; 8], 1.0, Guide::FREE))
}

fn elastic(r: &mut Random, scalar: Scalar) -> Problem {
    let elastic = Elastic { k: r.log_within(1e3, 1e5), g: 9.81 };
    let (q, v) = (
        [1.0 + r.within(-0.02, 0.02), r.within(-1.5, 1.5)],
        [r.within(-0.5, 0.5), r.within(-1.0, 1.0)],
    );
    Box::new(Trial::new(scalar, &elastic, q, v, 3.0, Guide::FREE))
}

fn hoop(r: &mut Random, scalar: Scalar) -> Problem {
    let hoop = Hoop { g: r.within(1.0, 5.0), ω: r.within(1.0, 3.0) };
    pendulum(r, |q, v| Trial::new(scalar, &hoop, [q], v, 8.0, Guide::FREE))
}

fn magnetic(r: &mut Random, scalar: Scalar) -> Problem {
    let charged = Charged { B: r.within(1.0, 10.0), E: r.within(0.0, 1.0) };
    let v = [r.within(-1.0, 1.0), r.within(-1.0, 1.0)];
    Box::new(Trial::new(scalar, &charged, [r.within(0.0, 1.0), 0.0], v, 8.0, Guide::FREE))
}

fn wilberforce(r: &mut Random, scalar: Scalar) -> Problem {
    let spring =
        Wilberforce { k: r.within(5.0, 20.0), δ: r.within(5.0, 20.0), ε: r.within(0.2, 1.0) };
    let q = [r.within(-1.0, 1.0), r.within(-1.0, 1.0)];
    Box::new(Trial::new(scalar, &spring, q, [0.0; 2], 10.0, Guide::FREE))
}

/// Creates an orbit of unit size that starts on the axis at the distance r.
fn orbit(scalar: Scalar, r: f64, e: f64, end: f64) -> Problem {
    let v = [0.0, ((1.0 + e) / (1.0 - e)).sqrt()];
    Box::new(Trial::new(scalar, &Kepler { μ: 1.0 }, [r, 0.0], v, end, Guide::FREE))
}

/// Creates a problem near the periodic orbit of Arenstorf.
fn restricted(r: &mut Random, scalar: Scalar) -> Problem {
    let q = [0.994 + r.within(-1e-3, 1e-3), 0.0];
    let v = [0.0, -2.001_585_106_379_082_5 + r.within(-0.05, 0.05)];
    Box::new(Trial::new(scalar, &Restricted { μ: 0.012_277_471 }, q, v, 1.5, Guide::FREE))
}

/// Creates a problem near the figure of eight of Chenciner and Montgomery.
fn stars(r: &mut Random, scalar: Scalar) -> Problem {
    let (x, y, vx, vy) = (0.970_004_36, -0.243_087_53, 0.466_203_69, 0.432_365_73);
    let mut near = |x: [f64; 6]| x.map(|x| x + r.within(-0.1, 0.1));
    let (q, v) = (near([x, -x, 0.0, y, -y, 0.0]), near([vx, vx, -2.0 * vx, vy, vy, -2.0 * vy]));
    Box::new(Trial::new(scalar, &Stars { G: 1.0 }, q, v, 4.0, Guide::FREE))
}

fn henon_heiles(r: &mut Random, scalar: Scalar) -> Problem {
    let (q, v) =
        ([r.within(-0.3, 0.3), r.within(-0.3, 0.3)], [r.within(-0.2, 0.2), r.within(-0.2, 0.2)]);
    Box::new(Trial::new(scalar, &HenonHeiles { λ: 1.0 }, q, v, 20.0, Guide::FREE))
}

fn toda(r: &mut Random, scalar: Scalar) -> Problem {
    let q = core::array::from_fn(|_| r.within(-1.0, 1.0));
    let v = core::array::from_fn(|_| r.within(-2.0, 2.0));
    Box::new(Trial::new(scalar, &Toda { a: r.within(1.0, 3.0) }, q, v, 5.0, Guide::FREE))
}

fn simple(r: &mut Random, scalar: Scalar) -> Problem {
    let (q, v) = ([r.within(-2.5, 2.5)], [r.within(-2.0, 2.0)]);
    let system = Simple { g: r.within(1.0, 10.0) };
    Box::new(Trial::new(scalar, &system, q, v, shorter(scalar, 10.0), Guide::FREE))
}

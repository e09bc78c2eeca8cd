//! The families: a system with a distribution of parameters, starts and intervals.

use crate::blocks::{Atoms, Double, Forced, Friction, Hung, Kepler, Relay, Simple, Trial, Valley, Wall};
use crate::case::{Case, Guide, Scalar};
use crate::motions::{Drive, Shape};
use crate::random::Random;

/// Problems of one kind.
pub(crate) struct Family {
    pub(crate) name: &'static str,
    pub(crate) scalar: Scalar,
    make: fn(&mut Random, Scalar) -> Box<dyn Case>,
}

impl Family {
    /// The problem of one run, and the generator that has made it.
    pub(crate) fn problem(&self, run: usize) -> (Box<dyn Case>, Random) {
        let mut random = Random::of(self.name, run);
        let case = (self.make)(&mut random, self.scalar);
        (case, random)
    }
}

const fn double(name: &'static str, make: fn(&mut Random, Scalar) -> Box<dyn Case>) -> Family {
    Family { name, scalar: Scalar::F64, make }
}

const fn single(name: &'static str, make: fn(&mut Random, Scalar) -> Box<dyn Case>) -> Family {
    Family { name, scalar: Scalar::F32, make }
}

pub(crate) const ALL: &[Family] = &[
    double("contact 1e-2", |r, s| contact(r, s, 1e-2)),
    double("contact 1e-3", |r, s| contact(r, s, 1e-3)),
    double("friction", friction),
    double("smoothed abs", smoothed_abs),
    double("smooth square wave", square_wave),
    double("sign(sin 10t)", relay),
    double("kick", kick),
    double("closure step", closure_step),
    double("kapitza 1 kHz", |r, s| kapitza(r, s, 1000.0, 0.3)),
    double("lennard-jones", lennard_jones),
    single("lennard-jones f32", lennard_jones),
    double("simple", simple),
    double("double", coupled),
    double("moving", moving),
    double("kepler", kepler),
];

fn contact(r: &mut Random, scalar: Scalar, w: f64) -> Box<dyn Case> {
    let wall = Wall { g: 9.81, k: 1e4, w };
    let (q, v) = ([r.within(0.3, 1.2)], [r.within(-1.0, 1.0)]);
    Box::new(Trial::new(scalar, &wall, q, v, 3.0, Guide::max_step(5.0 * w)))
}

fn friction(r: &mut Random, scalar: Scalar) -> Box<dyn Case> {
    let (μ, ω) = (r.within(0.3, 1.0), r.within(0.5, 3.0));
    let block = Friction { k: 4.0, μ, w: 0.03, s: 0.0, u: 1.0, f: 1.5, ω };
    let (q, v) = ([r.within(-1.0, 1.0)], [r.within(-1.0, 1.0)]);
    Box::new(Trial::new(scalar, &block, q, v, 10.0, Guide::max_step(0.05)))
}

fn smoothed_abs(r: &mut Random, scalar: Scalar) -> Box<dyn Case> {
    let valley = Valley { k: r.within(0.5, 2.0), d: 1e-8 };
    let (q, v) = ([r.within(-1.0, 1.0)], [r.within(-1.0, 1.0)]);
    Box::new(Trial::new(scalar, &valley, q, v, 10.0, Guide::max_step(0.02)))
}

const UNFORCED: Forced = Forced { g: 9.81, a: 0.0, ω: 1.0, w: 1.0, k: 0.0, c: 0.0, s: 1.0, b: 0.0 };

fn square_wave(r: &mut Random, scalar: Scalar) -> Box<dyn Case> {
    let forced = Forced { a: r.within(0.5, 3.0), ω: 10.0, w: 1e-2, ..UNFORCED };
    let (q, v) = ([r.within(-1.5, 1.5)], [r.within(-2.0, 2.0)]);
    Box::new(Trial::new(scalar, &forced, q, v, 5.0, Guide::max_step(0.02)))
}

fn relay(r: &mut Random, scalar: Scalar) -> Box<dyn Case> {
    let relay = Relay { g: 9.81, a: r.within(0.5, 3.0), ω: 10.0 };
    let (q, v) = ([r.within(-1.5, 1.5)], [r.within(-2.0, 2.0)]);
    Box::new(Trial::new(scalar, &relay, q, v, 5.0, Guide::max_step(0.05)))
}

fn kick(r: &mut Random, scalar: Scalar) -> Box<dyn Case> {
    let forced = Forced { k: r.within(30.0, 100.0), c: r.within(2.0, 6.0), s: 0.01, ..UNFORCED };
    let (q, v) = ([r.within(-1.5, 1.5)], [r.within(-2.0, 2.0)]);
    Box::new(Trial::new(scalar, &forced, q, v, 8.0, Guide::max_step(0.02)))
}

fn closure_step(r: &mut Random, scalar: Scalar) -> Box<dyn Case> {
    let hung = Hung { l: r.within(0.3, 1.0), g: 9.81 };
    let drive = Drive::Closure(Shape::Jump { a: r.within(1.0, 5.0), at: r.within(1.0, 6.0) }, [1.0, 0.3]);
    let (q, v) = ([r.within(-1.5, 1.5)], [r.within(-2.0, 2.0)]);
    Box::new(Trial::new(scalar, &hung, q, v, 8.0, Guide::FREE).driven(drive))
}

fn kapitza(r: &mut Random, scalar: Scalar, frequency: f64, end: f64) -> Box<dyn Case> {
    let ω = core::f64::consts::TAU * frequency;
    let hung = Hung { l: r.within(0.2, 0.4), g: 9.81 };
    let drive = Drive::Sinusoid(Shape::Sine { a: r.within(3.0, 6.0) / ω, ω, φ: r.within(0.0, 6.0) }, [0.0, 1.0]);
    let (q, v) = ([r.within(2.0, 4.2)], [r.within(-2.0, 2.0)]);
    Box::new(Trial::new(scalar, &hung, q, v, end, Guide::max_step(0.1 / frequency)).driven(drive))
}

fn lennard_jones(r: &mut Random, scalar: Scalar) -> Box<dyn Case> {
    let (q, v) = ([r.within(1.05, 2.5), 0.0], [r.within(-2.0, 2.0), r.within(-0.5, 0.5)]);
    Box::new(Trial::new(scalar, &Atoms { ε: 1.0 }, q, v, 5.0, Guide::FREE))
}

fn simple(r: &mut Random, scalar: Scalar) -> Box<dyn Case> {
    let (q, v) = ([r.within(-2.5, 2.5)], [r.within(-2.0, 2.0)]);
    Box::new(Trial::new(scalar, &Simple { g: r.within(1.0, 10.0) }, q, v, 10.0, Guide::FREE))
}

fn coupled(r: &mut Random, scalar: Scalar) -> Box<dyn Case> {
    let double = Double { m: [1.0, r.within(0.5, 1.5)], l: [1.0, r.within(0.5, 1.5)], g: 9.81 };
    let q = [r.within(-1.2, 1.2), r.within(-1.2, 1.2)];
    Box::new(Trial::new(scalar, &double, q, [r.within(-1.0, 1.0), r.within(-1.0, 1.0)], 5.0, Guide::FREE))
}

fn moving(r: &mut Random, scalar: Scalar) -> Box<dyn Case> {
    let hung = Hung { l: r.within(0.3, 1.0), g: 9.81 };
    let shape = Shape::Sine { a: r.within(0.05, 0.2), ω: r.within(1.0, 5.0), φ: r.within(0.0, 6.0) };
    let (q, v) = ([r.within(-1.0, 1.0)], [r.within(-1.0, 1.0)]);
    Box::new(Trial::new(scalar, &hung, q, v, 8.0, Guide::FREE).driven(Drive::Sinusoid(shape, [1.0, 0.2])))
}

fn kepler(r: &mut Random, scalar: Scalar) -> Box<dyn Case> {
    let e: f64 = r.within(0.0, 0.7);
    let (q, v) = ([1.0 - e, 0.0], [0.0, ((1.0 + e) / (1.0 - e)).sqrt()]);
    Box::new(Trial::new(scalar, &Kepler { μ: 1.0 }, q, v, 10.0, Guide::FREE))
}

//! The jets of generated systems: their series fulfil the equations of motion for all functions and
//! forms of the language.
//!
//! At a small time h after the start the accelerations of the equations at the summed state have to
//! equal the sum of the series of the accelerations. Both are computed by different code: by
//! formulas, and order by order.

use pendulum_runtime::integrate::{Taylor, solve};
use pendulum_runtime::jet::{JetDynamics, Jets, MAX_ORDER, Path, Series, Unrolling};
use pendulum_runtime::motion::{Curve, Side, Sinusoid, Still};
use pendulum_runtime::scalar::{DoubleDouble, Float};
use pendulum_runtime::time::Time;

use systems::random::Random;

/// Returns Σ x[k] hᵏ.
fn sum(series: &Series<f64>, h: f64) -> f64 {
    series[..=MAX_ORDER].iter().rev().fold(0.0, |sum, coefficient| sum * h + coefficient)
}

fn check<D: JetDynamics<N, Scalar = f64>, const N: usize>(
    name: &str,
    dynamics: &D,
    t: f64,
    q: [f64; N],
    v: [f64; N],
    h: f64,
) {
    let system = dynamics.system();
    let (mut path, mut drive, mut work) =
        (Path::<f64, N>::new(), D::System::drive(), system.work());
    path.t = t;
    for i in 0..N {
        (path.q[i][0], path.v[i][0]) = (q[i], v[i]);
    }
    dynamics.drive(Time::new(t), Side::After, MAX_ORDER, &mut drive);
    <D::System as Jets<N>>::Unrolling::run(system, MAX_ORDER, &mut path, &drive, &mut work);
    for h in [0.0, 0.5 * h, -0.5 * h, h] {
        let at = |series: &[Series<f64>; N]| -> [f64; N] {
            core::array::from_fn(|i| sum(&series[i], h))
        };
        let exact =
            dynamics.accelerations_at(Time::new(t + h), Side::After, &at(&path.q), &at(&path.v));
        let mut accelerations = path.a;
        for series in &mut accelerations {
            // The last order of the accelerations is not computed.
            series[MAX_ORDER] = 0.0;
        }
        let found = at(&accelerations);
        let size = exact.iter().fold(1.0f64, |size, a| size.max(a.abs()));
        for i in 0..N {
            let error = (found[i] - exact[i]).abs() / size;
            assert!(
                error < 2e-12,
                "{name}, h = {h}, coordinate {i}: {} for {}",
                found[i],
                exact[i]
            );
        }
    }
}

macro_rules! forces {
    ($($name:ident: $force:tt;)+) => {
        mod forces {
            $(pendulum_runtime::lagrangian! {
                pub(crate) struct $name { c }
                coordinate x;
                coordinate y;
                kinetic = (ẋ^2 + ẏ^2)/2;
                potential = 0;
                force x = $force;
                force y = c*x;
            })+
        }

        #[test]
        fn every_function() {
            let mut random = Random::new(5);
            for _ in 0..20 {
                let (q, v) = ([0.0; 2].map(|_| random.uniform(0.3, 0.6)), [0.0; 2].map(|_| random.uniform(-0.4, 0.4)));
                $(check(stringify!($force), &forces::$name::new(0.7), random.uniform(-1.0, 1.0), q, v, 0.05);)+
            }
        }
    };
}

forces! {
    Sine: (sin(x*y));
    Cosine: (cos(x - 2*y));
    Both: (sin(x)*cos(x) + sin(ẋ));
    Tangent: (tan(x + y/2));
    SineOverAngle: (sinc(5*x*y)*ẋ + sinc(x - y/3));
    ArcSine: (asin(x*y));
    ArcCosine: (acos(x*y));
    ArcTangent: (atan(x + ẏ));
    Angle: (atan2(x, y));
    AngleBack: (atan2(c, ẏ - 1));
    Hyperbolic: (sinh(x) + cosh(x*y) + tanh(ẋ + y));
    Secant: (sech(x*ẏ) + sech(x - 2*y)*tanh(x - 2*y));
    Exponential: (exp(x*ẏ));
    Logarithm: (ln(x + y));
    Root: (sqrt(x^2 + y^2));
    Power: ((x^2 + y^2)^(-3/2) + x^5);
    Exponent: (x^c + y^x + c^y);
    Magnitude: (abs(x - 4)*y);
    Sign: (sign(x)*y^2);
    Larger: (max(x*y, 2)*x + max(x, y - 3) + min(x, 5 + y)*ẏ);
    Quotient: (ẏ/(x + c) + c/y + x/c + 1/3);
    Time: (sin(3*t)*x + t^2/(1 + t^4));
}

mod sinc {
    pendulum_runtime::lagrangian! {
        /// Its equations have sinc and its derivative, at one argument and at another.
        pub(crate) struct Sinc { k }
        coordinate x;
        coordinate y;
        kinetic = (2 + sinc(x))*ẋ^2/2 + ẏ^2/2;
        potential = -k*sinc(x) - sinc(3*x*y)^2;
    }
}

/// Tests arguments at zero, near zero, and on both sides of the point at which the evaluation
/// changes.
#[test]
fn series_of_sinc_hold_at_zero() {
    let system = sinc::Sinc::new(1.5);
    for x in [0.0_f64, -0.0, 5e-324, 1e-160, -1e-9, 1e-3, 0.999_999, 1.000_001, 1.999, -2.001, 7.5]
    {
        // The larger x is, the faster the argument 3 x y changes.
        let h = 0.05 / (1.0 + x.abs());
        for v in [0.0, 1e-7, -0.8] {
            for [y, w] in [[0.4, 0.3], [0.0, 0.9]] {
                check(&format!("sinc at {x}, {y}, {v}"), &system, 0.0, [x, y], [v, w], h);
            }
        }
    }
}

mod sech {
    pendulum_runtime::lagrangian! {
        /// A particle in the well of Pöschl and Teller.
        pub(crate) struct Well { m: kg, k: J, w: m }
        coordinate x: m;
        kinetic = m/2*ẋ^2;
        potential = -k*sech(x/w)^2;
    }
}

/// With the energy −e, sinh(x/w) is √((k − e)/e) sin(t √(2e/m)/w).
#[test]
fn the_well_has_its_motion() {
    fn error<T: Float>(rtol: f64) -> f64 {
        let n = T::from_f64;
        let well = sech::Well::new(n(2.0), n(3.0), n(0.5));
        // Here e = 3/4, and x swings over 1.3 w with the frequency √3.
        let solution = solve(&well, (0.0, 10.0), [n(0.0)], [n(1.5)]).method(Taylor::new());
        let end = solution.rtol(rtol).atol(rtol).run().unwrap().end;
        let root = n(3.0).sqrt();
        let exact = root * (n(10.0) * root).sin();
        ((end.q[0] / n(0.5)).sinh() - exact).to_f64().abs()
    }
    for (found, bound) in [
        (error::<f32>(1e-6), 3e-5),
        (error::<f64>(1e-14), 1e-13),
        (error::<DoubleDouble>(1e-28), 1e-26),
    ] {
        assert!(found < bound, "{found:e} {bound:e}");
    }
}

mod blocks {
    use pendulum_runtime::lagrangian;

    lagrangian! {
        pub struct Chain { m: [1; 4], l: [1; 4], g }
        coordinate θ[4];
        let y[k in 0..4] = sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
        kinetic = sum(k in 0..4, m[k]/2*|ẏ[k]|^2);
        potential = sum(k in 0..4, m[k]*g*height(y[k]));
    }

    lagrangian! {
        /// Two blocks of the mass matrix that move, one that does not, and one by itself.
        pub struct Blocks { a }
        coordinate p;
        coordinate q;
        coordinate r;
        coordinate s;
        coordinate u;
        coordinate w;
        coordinate z;
        kinetic = ṗ^2 + ṗ*q̇*cos(p - q) + q̇^2 + ṙ^2*(2 + sin(s)) + ṙ*ṡ*exp(r/4)/2 + ṡ^2 + u̇^2 + a*u̇*ẇ + ẇ^2 + ż^2*(2 + cos(z));
        potential = sin(p*r) + cos(q - s) + u^2*w + z*u;
    }

    lagrangian! {
        /// The pivot moves on two axes, and the length with it.
        pub struct Moving { g, c }
        coordinate q;
        coordinate f;
        driven x: [1; 2];
        driven l: 1;
        let r = x + (2 + l)*[sin(q), -cos(q)];
        let e = r + [sin(f), -cos(f)];
        kinetic = |ṙ|^2/2 + |ė|^2/2;
        potential = g*height(r) + g*height(e);
        dissipation = c*(q̇ - ḟ)^2/8;
    }

    lagrangian! {
        /// A chain on a moving pivot whose first link grows, with friction in the joints and in the
        /// air, a motor, and a wheel at its end.
        pub struct Machine { m: [1; 3], l: [1; 3], g, c, w, d, n }
        coordinate θ[3];
        coordinate φ;
        driven x: [1; 2];
        driven s: 1;
        let y[k in 0..3] = x + s*[sin(θ[0]), -cos(θ[0])] + sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
        kinetic = sum(k in 0..3, m[k]/2*|ẏ[k]|^2) + w/2*(φ̇ + θ̇[2])^2 + w/5*cos(φ)*φ̇*θ̇[0];
        potential = sum(k in 0..3, m[k]*g*height(y[k])) + d*sin(φ - θ[1])*n*t;
        dissipation = c/2*(θ̇[1] - θ̇[0])^2 + c/8*|ẏ[2]|^2;
        force θ[0] = d*sin(n*t) - c*θ̇[0];
        force φ = c*cos(φ)*φ̇;
    }

    lagrangian! {
        /// Two arms on a shoulder, in angles against the link before and with lengths that stretch;
        /// a spring between the hands.
        pub struct Tree { g, k }
        coordinate a;
        coordinate b;
        coordinate c;
        coordinate r;
        coordinate d;
        let s = (2 + r^2)*[sin(a), -cos(a)];
        let h = s + [sin(a + b), -cos(a + b)];
        let e = s + (1 + d)*[cos(c), sin(c)];
        kinetic = |ṡ|^2/2 + |ḣ|^2 + |ė|^2/3 + ṙ^2/2;
        potential = g*height(s) + g*height(h) + g*height(e) + k/2*|h - e|^2 + k*(r^2 + d^2);
    }
}

#[test]
fn coupled_coordinates() {
    let mut random = Random::new(9);
    for _ in 0..20 {
        let mut state = || {
            (
                [0.0; 4].map(|_| random.uniform(-3.0, 3.0)),
                [0.0; 4].map(|_| random.uniform(-1.0, 1.0)),
            )
        };
        let (q, v) = state();
        check(
            "chain",
            &blocks::Chain::new([1.0, 0.5, 2.0, 1.0], [1.0, 1.5, 0.7, 1.0], 9.81),
            0.0,
            q,
            v,
            0.01,
        );
        let (q, v) = (
            [0.0; 7].map(|_| random.uniform(-1.0, 1.0)),
            [0.0; 7].map(|_| random.uniform(-1.0, 1.0)),
        );
        check("blocks", &blocks::Blocks::new(0.3), 0.0, q, v, 0.03);
        let (q, v) = (
            [0.0; 5].map(|_| random.uniform(0.2, 0.9)),
            [0.0; 5].map(|_| random.uniform(-1.0, 1.0)),
        );
        check("tree", &blocks::Tree::new(9.81, 3.0), 0.0, q, v, 0.01);
    }
}

#[test]
fn driven_coordinates() {
    let mut random = Random::new(3);
    let sinusoid = Sinusoid::new([0.1, 0.3], 2.0, [0.4, -1.0]).about([1.0, 2.0]);
    let keys: Vec<f64> = (0..6).map(f64::from).collect();
    let values: Vec<[f64; 1]> = (0..6).map(|_| [random.uniform(-0.3, 0.3)]).collect();
    let spline = Curve::spline(&keys, &values).unwrap();
    for _ in 0..20 {
        let t = 2.3;
        let (q, v) = (
            [0.0; 2].map(|_| random.uniform(-3.0, 3.0)),
            [0.0; 2].map(|_| random.uniform(-1.0, 1.0)),
        );
        check(
            "sinusoid and spline",
            &blocks::Moving::new(9.81, 0.3).driven_by(sinusoid, spline.clone()),
            t,
            q,
            v,
            0.02,
        );
        let machine =
            blocks::Machine::new([1.0, 0.5, 2.0], [1.0, 1.5, 0.7], 9.81, 0.3, 0.4, 0.7, 1.3);
        let (angles, rates) = (
            [0.0; 4].map(|_| random.uniform(-3.0, 3.0)),
            [0.0; 4].map(|_| random.uniform(-1.0, 1.0)),
        );
        check("machine", &machine.driven_by(sinusoid, spline.clone()), t, angles, rates, 0.01);
        let keys = [[0.0, 0.1], [0.2, -0.1], [0.1, 0.0], [0.0, 0.2]];
        let clip = Curve::catmull_rom(&[0.0, 1.0, 2.0, 3.0], &keys);
        check(
            "clip and rest",
            &blocks::Moving::new(9.81, 0.3).driven_by(clip.unwrap(), Still::new([0.1])),
            t,
            q,
            v,
            0.02,
        );
    }
}

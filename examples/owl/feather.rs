//! A feather: a compound pendulum on a joint that moves and turns, with a spring (the skin).

use pendulum_runtime::body::Body;
use pendulum_runtime::prelude::*;
use std::f64::consts::PI;

lagrangian! {
    /// A flat body whose quill sits in a joint that moves and turns.
    #[derive(Clone, Debug)]
    pub struct Feather {
        /// The vane as seen from the quill, as drawn.
        B: body,
        /// The quill as seen from the joint, as drawn.
        d: [m; 2],
        /// The stiffness of the skin.
        k: N*m,
        /// The friction in the skin.
        c: N*m*s,
        /// The angle by which the skin pulls beyond the drawn one, so that the feather hangs as
        /// drawn.
        δ: rad,
        /// The gravitational acceleration.
        g: m/s^2,
    }

    coordinate θ: rad;
    driven x: [m; 2];
    driven φ: rad;

    let r(p) = x + cis(φ)*d + cis(θ)*p;
    kinetic     = integral(p in B, |dot(r(p))|^2 / 2);
    potential   = integral(p in B, g*height(r(p))) + k/2 * (θ - φ - δ)^2;
    dissipation = c/2 * (θ̇ - φ̇)^2;
}

/// The gravitational acceleration under which feathers hang as drawn, in m/s².
const DRAWN: f64 = 9.81;

/// The frequencies in Hz of feathers on their skin without gravity, by prefixes of their names.
const FREQUENCIES: [(&str, f64); 7] = [
    ("primary", 3.4),
    ("secondary", 3.4),
    ("covert", 4.2),
    ("breast", 3.6),
    ("tail", 3.0),
    ("ruff", 3.8),
    ("tuft", 4.6),
];

/// Returns the angular frequency of a feather in rad/s; neighbours differ slightly.
pub(crate) fn frequency(name: &str, number: usize) -> f64 {
    let kind = FREQUENCIES
        .iter()
        .find(|(start, _)| name.starts_with(start))
        .map_or(3.0, |&(_, hertz)| hertz);
    // The golden ratio distributes any sequence of consecutive numbers evenly.
    let spread = (number as f64 * 0.618033988749895).fract() - 0.5;
    2.0 * PI * kind * (1.0 + 0.08 * spread)
}

impl Feather {
    /// Creates a feather with the given angular frequency and damping ratio on its skin.
    pub(crate) fn swinging(
        body: Body,
        quill: [f64; 2],
        frequency: f64,
        damping: f64,
        gravity: f64,
    ) -> Self {
        let stiffness = body.inertia() * frequency * frequency;
        let pull = body.mass * DRAWN * body.center[0] / stiffness;
        Self::new(body, quill, stiffness, 2.0 * damping * frequency * body.inertia(), pull, gravity)
    }
}

#[cfg(test)]
mod tests {
    use super::Feather;
    use pendulum_runtime::body::Polygon;
    use pendulum_runtime::motion::Sample;
    use pendulum_runtime::prelude::*;

    fn vane() -> Feather {
        let body =
            Polygon::new(&[[0.0, 0.0], [0.1, -0.02], [0.12, -0.05]]).unwrap().body(0.2).unwrap();
        Feather::swinging(body, [0.05, 0.2], 20.0, 0.1, 9.81)
    }

    #[test]
    fn a_feather_hangs_as_drawn() {
        let inputs = (Sample { position: [1.0, 2.0], ..Sample::zero() }, Sample::zero());
        let at = At { t: 0.0, q: &[0.0], v: &[0.0], inputs: &inputs };
        assert!(vane().accelerations(at)[0].abs() < 1e-12);
        // Without gravity the feather rises.
        assert!(0.0 < Feather { g: 0.0, ..vane() }.accelerations(at)[0]);
    }

    /// The equation derived by hand: I θ̈ = −m ⟨ẍ + (φ̈ i − φ̇²) e^{iφ} d + g e_y, i e^{iθ} c⟩ − k
    /// (θ − φ − δ) − c (θ̇ − φ̇).
    #[test]
    fn the_equation_is_that_of_the_translating_compound_pendulum() {
        let feather = vane();
        for n in 0..40 {
            let n = f64::from(n);
            let (θ, ω, φ, φ1, φ2) =
                (0.1 * n - 2.0, 3.0 - 0.2 * n, 0.07 * n, 1.0 - 0.1 * n, 5.0 + n);
            let x =
                Sample { position: [0.3, 0.4], velocity: [1.0, -n], acceleration: [n - 7.0, 4.0] };
            let turn = Sample { position: [φ], velocity: [φ1], acceleration: [φ2] };
            let rotated = |[a, b]: [f64; 2], angle: f64| {
                let (sin, cos) = Real::sin_cos(angle);
                [cos * a - sin * b, sin * a + cos * b]
            };
            let [a, b] = rotated(feather.d, φ);
            let quill = [
                x.acceleration[0] - φ2 * b - φ1 * φ1 * a,
                x.acceleration[1] + φ2 * a - φ1 * φ1 * b + feather.g,
            ];
            let [u, v] = rotated(feather.B.center, θ);
            let torque = -feather.B.mass * (v * -quill[0] + u * quill[1]);
            let expected = (torque - feather.k * (θ - φ - feather.δ) - feather.c * (ω - φ1))
                / feather.B.inertia();
            let found =
                feather.accelerations(At { t: 0.0, q: &[θ], v: &[ω], inputs: &(x, turn) })[0];
            assert!(
                (found - expected).abs() < 1e-10 * expected.abs().max(1.0),
                "{found} is not {expected}"
            );
        }
    }
}

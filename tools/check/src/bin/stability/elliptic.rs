//! The motion of the simple pendulum in closed form, to about 30 digits.
//!
//! Jacobi's amplitude is computed with the descending arithmetic–geometric mean (Abramowitz and
//! Stegun 1964, 16.4).

use pendulum_runtime::scalar::{DoubleDouble, Float, Real};

/// The modulus k and the arithmetic–geometric means of its complement k′.
pub(crate) struct Elliptic {
    modulus: DoubleDouble,
    /// aₙ and cₙ.
    means: Vec<(DoubleDouble, DoubleDouble)>,
    /// The quarter period K.
    pub(crate) quarter: DoubleDouble,
}

impl Elliptic {
    pub(crate) fn new(modulus: DoubleDouble, complement: DoubleDouble) -> Self {
        let half = DoubleDouble::from(0.5);
        let (mut a, mut b) = (DoubleDouble::from(1.0), complement);
        let mut means = vec![(a, modulus)];
        while 1e-33 < means[means.len() - 1].1.to_f64().abs() && means.len() < 12 {
            let c = (a - b) * half;
            (a, b) = ((a + b) * half, (a * b).sqrt());
            means.push((a, c));
        }
        Self { modulus, means, quarter: DoubleDouble::PI / (a + a) }
    }

    /// Returns the amplitude of an argument of moderate size.
    fn amplitude(&self, u: DoubleDouble) -> DoubleDouble {
        let (half, last) = (DoubleDouble::from(0.5), self.means.len() - 1);
        let mut angle = DoubleDouble::from(f64::from(1u32 << last)) * self.means[last].0 * u;
        for &(a, c) in self.means[1..].iter().rev() {
            angle = (angle + (c / a * angle.sin()).asin()) * half;
        }
        angle
    }

    /// Returns `u` reduced by integer multiples of `period`, and the number of multiples.
    fn reduced(u: DoubleDouble, period: DoubleDouble) -> (DoubleDouble, f64) {
        let count = (u / period).to_f64().round();
        (u - period * DoubleDouble::from(count), count)
    }
}

/// A pendulum with g = l = 1 released at rest.
pub(crate) struct Swing(Elliptic);

impl Swing {
    pub(crate) fn from(amplitude: f64) -> Self {
        let (k, complement) = (DoubleDouble::from(amplitude) * DoubleDouble::from(0.5)).sin_cos();
        Self(Elliptic::new(k, complement))
    }

    /// Returns the period, four quarter periods.
    pub(crate) fn period(&self) -> DoubleDouble {
        self.0.quarter * DoubleDouble::from(4.0)
    }

    /// Returns q = 2 asin(k sn(K − t)) and q̇ = −2k cn(K − t).
    pub(crate) fn at(&self, t: f64) -> [DoubleDouble; 2] {
        let (t, _) = Elliptic::reduced(DoubleDouble::from(t), self.period());
        let (sn, cn) = self.0.amplitude(self.0.quarter - t).sin_cos();
        let (k, two) = (self.0.modulus, DoubleDouble::from(2.0));
        [two * (k * sn).asin(), -(two * k * cn)]
    }

    /// Returns the time by which a state is ahead of the motion.
    pub(crate) fn phase(&self, t: f64, q: f64, v: f64) -> f64 {
        let [exact, speed] = self.at(t);
        let force = -exact.sin().to_f64();
        let (dq, dv) =
            ((DoubleDouble::from(q) - exact).to_f64(), (DoubleDouble::from(v) - speed).to_f64());
        let speed = speed.to_f64();
        (dq * speed + dv * force) / (speed * speed + force * force)
    }
}

/// A pendulum with g = l = 1 that rotates: q(0) = 0, q̇(0) = 2.5, with k = 0.8.
pub(crate) struct Turning(Elliptic);

impl Turning {
    pub(crate) fn new() -> Self {
        Self(Elliptic::new(DoubleDouble::ratio(4.0, 5.0), DoubleDouble::ratio(3.0, 5.0)))
    }

    /// Returns q = 2 am(1.25 t) as the angle within half a turn and the number of turns, and the
    /// velocity 2.5 dn(1.25 t).
    pub(crate) fn at(&self, t: f64) -> (DoubleDouble, f64, DoubleDouble) {
        let (two, k) = (DoubleDouble::from(2.0), self.0.modulus);
        let (u, turns) = Elliptic::reduced(
            DoubleDouble::from(1.25) * DoubleDouble::from(t),
            two * self.0.quarter,
        );
        let amplitude = self.0.amplitude(u);
        let sn = k * amplitude.sin();
        (
            two * amplitude,
            turns,
            DoubleDouble::from(2.5) * (DoubleDouble::from(1.0) - sn * sn).sqrt(),
        )
    }
}

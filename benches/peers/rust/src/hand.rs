//! Accelerations written by hand, as one takes them from a textbook: the parameters are folded in,
//! sine and cosine are those of `std`.

/// The pendulum with g/L = 9.8.
pub fn simple(_: f64, q: &[f64; 1], _: &[f64; 1]) -> [f64; 1] {
    [-9.8 * q[0].sin()]
}

/// Its pivot at x = ¼ sin 2t, g = L = 1.
pub fn moving(t: f64, q: &[f64; 1], _: &[f64; 1]) -> [f64; 1] {
    let (sin, cos) = q[0].sin_cos();
    [(2.0 * t).sin() * cos - sin]
}

/// A body with m = 1.5, centre (¼, −¾), I = 1.25 and g = 9.8, its pivot at (¼ sin 2t, ⅛ sin(2t +
/// 1)).
pub fn moving_compound(t: f64, q: &[f64; 1], _: &[f64; 1]) -> [f64; 1] {
    let (sin, cos) = q[0].sin_cos();
    let (x, y) = (-(2.0 * t).sin(), -0.5 * (2.0 * t + 1.0).sin());
    let (across, along) = (0.25 * cos + 0.75 * sin, 0.25 * sin - 0.75 * cos);
    [-1.2 * ((y + 9.8) * across - x * along)]
}

/// A bob on a spring: k = 8, l = g = m = 1.
pub fn elastic(_: f64, q: &[f64; 2], v: &[f64; 2]) -> [f64; 2] {
    let (sin, cos) = q[1].sin_cos();
    [q[0] * v[1] * v[1] + cos - 8.0 * (q[0] - 1.0), -(sin + 2.0 * v[0] * v[1]) / q[0]]
}

/// The double pendulum with unit links and masses, g = 1.
pub fn double(_: f64, q: &[f64; 2], v: &[f64; 2]) -> [f64; 2] {
    let (sin, cos) = (q[0] - q[1]).sin_cos();
    let f0 = -sin * v[1] * v[1] - 2.0 * q[0].sin();
    let f1 = sin * v[0] * v[0] - q[1].sin();
    let divisor = 2.0 - cos * cos;
    [(f0 - cos * f1) / divisor, (2.0 * f1 - cos * f0) / divisor]
}

/// Five unit links and masses, g = 1: M q̈ = f with M[i][j] = (5 − max(i, j)) cos(θᵢ − θⱼ), solved
/// by Gauss's elimination.
pub fn chain5(_: f64, q: &[f64; 5], v: &[f64; 5]) -> [f64; 5] {
    let (sin, cos) = (q.map(f64::sin), q.map(f64::cos));
    let (mut m, mut f) = ([[0.0; 5]; 5], [0.0; 5]);
    for i in 0..5 {
        f[i] = -((5 - i) as f64) * sin[i];
        for j in 0..5 {
            let weight = (5 - i.max(j)) as f64;
            m[i][j] = weight * (cos[i] * cos[j] + sin[i] * sin[j]);
            f[i] -= weight * (sin[i] * cos[j] - cos[i] * sin[j]) * v[j] * v[j];
        }
    }
    for k in 0..5 {
        for i in k + 1..5 {
            let factor = m[i][k] / m[k][k];
            for j in k + 1..5 {
                m[i][j] -= factor * m[k][j];
            }
            f[i] -= factor * f[k];
        }
    }
    for k in (0..5).rev() {
        for j in k + 1..5 {
            f[k] -= m[k][j] * f[j];
        }
        f[k] /= m[k][k];
    }
    f
}

/// A planet around a unit mass.
pub fn kepler(_: f64, q: &[f64; 2], _: &[f64; 2]) -> [f64; 2] {
    let square = q[0] * q[0] + q[1] * q[1];
    let factor = -1.0 / (square * square.sqrt());
    [factor * q[0], factor * q[1]]
}

/// Hénon and Heiles (1964).
pub fn henon_heiles(_: f64, q: &[f64; 2], _: &[f64; 2]) -> [f64; 2] {
    [-q[0] - 2.0 * q[0] * q[1], -q[1] - q[0] * q[0] + q[1] * q[1]]
}

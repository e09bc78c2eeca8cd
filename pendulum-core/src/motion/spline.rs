//! Cubic splines: the velocities at the keys.

/// The boundary conditions of a spline.
pub(crate) enum Ends<const D: usize> {
    Natural,
    Clamped([f64; D], [f64; D]),
    Periodic,
}

/// Computes the velocities at the keys for which the acceleration is continuous.
pub(crate) fn velocities<const D: usize>(
    times: &[f64],
    values: &[[f64; D]],
    ends: &Ends<D>,
) -> Vec<[f64; D]> {
    let count = times.len();
    if count < 2 {
        return vec![[0.0; D]; count];
    }
    let step = |key: usize| times[key + 1] - times[key];
    let chord = |key: usize, d: usize| (values[key + 1][d] - values[key][d]) / step(key);
    // Each row contains the entries below, on and above the diagonal, and the right-hand side. The
    // inner rows are the conditions of continuous acceleration.
    let mut rows = vec![([0.0, 1.0, 0.0], [0.0; D]); count];
    let inner =
        |before: f64, after: f64, left: &dyn Fn(usize) -> f64, right: &dyn Fn(usize) -> f64| {
            let mut side = [0.0; D];
            for (d, value) in side.iter_mut().enumerate() {
                *value = 3.0 * (after * left(d) + before * right(d));
            }
            ([after, 2.0 * (before + after), before], side)
        };
    for key in 1..count - 1 {
        rows[key] = inner(step(key - 1), step(key), &|d| chord(key - 1, d), &|d| chord(key, d));
    }
    let last = count - 1;
    match ends {
        Ends::Natural => {
            rows[0].0 = [0.0, 2.0, 1.0];
            rows[last].0 = [1.0, 2.0, 0.0];
            for d in 0..D {
                rows[0].1[d] = 3.0 * chord(0, d);
                rows[last].1[d] = 3.0 * chord(last - 1, d);
            }
        }
        Ends::Clamped(first, end) => {
            rows[0].1 = *first;
            rows[last].1 = *end;
        }
        Ends::Periodic => {
            return periodic(
                &rows,
                inner(step(last - 1), step(0), &|d| chord(last - 1, d), &|d| chord(0, d)),
            );
        }
    }
    tridiagonal(&rows)
}

type Row<const D: usize> = ([f64; 3], [f64; D]);

/// Solves a tridiagonal system by Gaussian elimination without pivoting: the rows are diagonally
/// dominant.
fn tridiagonal<const D: usize>(rows: &[Row<D>]) -> Vec<[f64; D]> {
    let mut rows = rows.to_vec();
    for key in 1..rows.len() {
        let factor = rows[key].0[0] / rows[key - 1].0[1];
        rows[key].0[1] -= factor * rows[key - 1].0[2];
        for d in 0..D {
            let part = factor * rows[key - 1].1[d];
            rows[key].1[d] -= part;
        }
    }
    let mut solution = vec![[0.0; D]; rows.len()];
    for key in (0..rows.len()).rev() {
        for d in 0..D {
            let above =
                if key + 1 < rows.len() { rows[key].0[2] * solution[key + 1][d] } else { 0.0 };
            solution[key][d] = (rows[key].1[d] - above) / rows[key].0[1];
        }
    }
    solution
}

/// Solves the cyclic system, in which the first and last velocities are equal; `seam` is their row.
///
/// The corner entries are treated by bordering: one solution for the right-hand side, and one for a
/// unit velocity at the seam.
fn periodic<const D: usize>(rows: &[Row<D>], seam: Row<D>) -> Vec<[f64; D]> {
    let count = rows.len();
    let inner = &rows[1..count - 1];
    let mut first = vec![[0.0; D]; inner.len()];
    let mut unit = vec![[0.0; 1]; inner.len()];
    if !inner.is_empty() {
        first = tridiagonal(inner);
        let mut border: Vec<Row<1>> = inner.iter().map(|row| (row.0, [0.0])).collect();
        border[0].1[0] -= inner[0].0[0];
        let end = inner.len() - 1;
        border[end].1[0] -= inner[end].0[2];
        unit = tridiagonal(&border);
    }
    let mut solution = vec![[0.0; D]; count];
    for d in 0..D {
        let ([below, on, above], side) = seam;
        let (next, previous) = match inner.len() {
            // A single piece is its own neighbour.
            0 => (([0.0; D], 1.0), ([0.0; D], 1.0)),
            len => ((first[0], unit[0][0]), (first[len - 1], unit[len - 1][0])),
        };
        let top = side[d] - below * previous.0[d] - above * next.0[d];
        let bottom = on + below * previous.1 + above * next.1;
        let velocity = top / bottom;
        solution[0][d] = velocity;
        solution[count - 1][d] = velocity;
        for key in 1..count - 1 {
            solution[key][d] = first[key - 1][d] + unit[key - 1][0] * velocity;
        }
    }
    solution
}

//! Quaternions on the graph: w, x, y, z, of which the last three are the vector.

use crate::algebra::expr::{Graph, Id};
use crate::algebra::number::Rational;

pub(crate) type Quaternion = [Id; 4];

pub(crate) fn conjugate(graph: &mut Graph, [w, x, y, z]: Quaternion) -> Quaternion {
    [w, graph.negative(x), graph.negative(y), graph.negative(z)]
}

/// Returns `factor` a b.
pub(crate) fn product(
    graph: &mut Graph,
    factor: Rational,
    a: Quaternion,
    b: Quaternion,
) -> Quaternion {
    // For each part of the product, the parts of a and b and the sign.
    const TERMS: [[(usize, usize, bool); 4]; 4] = [
        [(0, 0, false), (1, 1, true), (2, 2, true), (3, 3, true)],
        [(0, 1, false), (1, 0, false), (2, 3, false), (3, 2, true)],
        [(0, 2, false), (2, 0, false), (3, 1, false), (1, 3, true)],
        [(0, 3, false), (3, 0, false), (1, 2, false), (2, 1, true)],
    ];
    TERMS.map(|part| {
        let terms = part.map(|(i, j, minus)| {
            let factor = if minus { factor.negative() } else { factor };
            (graph.mul(a[i], b[j]), factor)
        });
        graph.sum(&terms)
    })
}

/// Returns the matrix of the rotation by a unit quaternion, row by row.
pub(crate) fn matrix(graph: &mut Graph, q: Quaternion) -> [Id; 9] {
    let two = Rational::whole(2);
    core::array::from_fn(|entry| {
        let (row, column) = (entry / 3, entry % 3);
        let (i, j) = (1 + (column + 1) % 3, 1 + (column + 2) % 3);
        if row == column {
            // 1 − 2 y² − 2 z²
            let squares = [i, j].map(|k| (graph.power(q[k], two), two.negative()));
            return graph.sum(&[(Graph::ONE, Rational::ONE), squares[0], squares[1]]);
        }
        // 2 x y ∓ 2 w z
        let third = 3 - row - column;
        let sign = if (row + 1) % 3 == column { two.negative() } else { two };
        let plane = graph.mul(q[1 + row], q[1 + column]);
        let turned = graph.mul(q[0], q[1 + third]);
        graph.sum(&[(plane, two), (turned, sign)])
    })
}

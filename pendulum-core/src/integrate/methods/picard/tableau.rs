//! The coefficients of collocation at Gauss–Legendre nodes, eight per vector.

use crate::integrate::methods::gauss::Tableau;
use crate::integrate::step::gap;

/// The number of lanes of a vector: the number of `f64` in 64 bytes.
pub(super) const S: usize = 8;

/// One number for each node of a vector.
pub(super) type Nodes = [f64; S];

/// The contribution of the value at each node, by vector and lane, to each of the nodes of `H`
/// vectors.
pub(super) type Columns<const G: usize, const H: usize> = [[[Nodes; H]; S]; G];

/// Integrals and coefficients of a polynomial from its values at 8 `G` nodes.
#[derive(Debug)]
#[repr(C, align(64))]
pub(super) struct Collocation<const G: usize> {
    /// The nodes c on [0, 1].
    pub(super) nodes: [Nodes; G],
    /// A: the integrals from 0 to all nodes.
    pub(super) once: Columns<G, G>,
    /// A²: the integrals of the polynomials through the integrals `once`.
    pub(super) twice: Columns<G, G>,
    /// The values one step later.
    pub(super) ahead: Columns<G, G>,
    /// The integrals from one step later, as in `once`.
    pub(super) once_ahead: Columns<G, G>,
    /// The integrals of the integrals from one step later, as in `twice`.
    pub(super) twice_ahead: Columns<G, G>,
    /// The integral over the step and the integral of the integral; the other lanes are zero.
    pub(super) ends: Columns<G, 1>,
    /// All coefficients of Σ α_k P_k(2θ − 1), by vector and lane.
    pub(super) legendre: Columns<G, G>,
    /// 1/∏ (c_j − c_k) over the other nodes of the vector.
    pub(super) lagrange: [Nodes; G],
}

// Statics, because constants would be computed again in every crate that uses them.
pub(super) static EIGHT: Collocation<1> = collocation(EIGHT_NODES);
pub(super) static SIXTEEN: Collocation<2> = collocation(SIXTEEN_NODES);

/// The points between the nodes of a step, at which the closing sweeps also evaluate the
/// accelerations.
///
/// The points halve the gaps between neighbouring nodes. They are the points that Kronrod adds to
/// the eight nodes, except the first one, which the start of the step replaces, and the last one,
/// which is moved to the end.
pub(super) static BETWEEN: Between = between();

/// The coefficients of the points between the nodes.
#[derive(Debug)]
#[repr(C, align(64))]
pub(super) struct Between {
    /// The points on [0, 1].
    pub(super) points: [Nodes; 1],
    /// The integrals from 0 to the points.
    pub(super) once: Columns<1, 1>,
    /// The integrals from 0 to the points of the polynomials through the integrals to the nodes.
    pub(super) twice: Columns<1, 1>,
    /// From the values at the nodes: the integral over the step and the integral of the integral.
    /// From the values at nodes and points: the Legendre coefficients α₁₅, α₁₄, α₁₃, α₁₂ of the
    /// polynomial through all sixteen values, and α₁₆ of the polynomial through these values and
    /// zero at the start. The last lane is zero.
    pub(super) ends: Columns<2, 1>,
    /// The weight in α₁₆ of the value at the start.
    pub(super) start: f64,
}

const fn between() -> Between {
    let zero = [[[[0.0; S]; 1]; S]; 1];
    let mut between = Between {
        points: [POINTS],
        once: zero,
        twice: zero,
        ends: [[[[0.0; S]; 1]; S]; 2],
        start: 0.0,
    };
    let eight = collocation(EIGHT_NODES);
    let mut j = 0;
    while j < S {
        let mut i = 0;
        while i < S {
            between.once[0][j][0][i] = integral(&EIGHT_NODES, j, POINTS[i]);
            i += 1;
        }
        j += 1;
    }
    between.twice = product(&between.once, &eight.once);
    j = 0;
    while j < 2 * S {
        let lanes = &mut between.ends[j / S][j % S][0];
        if j < S {
            lanes[0] = eight.ends[0][j][0][0];
            lanes[1] = eight.ends[0][j][0][1];
        }
        let mut lane = 2;
        while lane < 6 {
            lanes[lane] = coefficient_of_all(2 * S + 1 - lane, j);
            lane += 1;
        }
        lanes[6] = last_coefficient(j);
        j += 1;
    }
    between.start = last_coefficient(2 * S);
    between
}

/// Returns the weight of value j, at a node, a point or the start, in the coefficient of P₁₆ of the
/// polynomial through all seventeen values: its leading coefficient, 1/∏ (x_j − x_i), over that of
/// P₁₆, ∏ (4k − 2)/k.
const fn last_coefficient(j: usize) -> f64 {
    let (mut part, mut i) = (1.0, 0);
    while i <= 2 * S {
        if i != j {
            part /= node_or_point(j) - node_or_point(i);
        }
        i += 1;
    }
    let mut k = 1;
    while k <= 2 * S {
        part *= k as f64 / (4 * k - 2) as f64;
        k += 1;
    }
    part
}

/// Returns the weight of the value at node or point j in the coefficient of P_k of the polynomial
/// through all sixteen values, by the Gauss rule with sixteen nodes.
const fn coefficient_of_all(k: usize, j: usize) -> f64 {
    let (nodes, weights) = SIXTEEN_NODES;
    let (mut sum, mut m) = (0.0, 0);
    while m < 2 * S {
        let at = nodes[m / S][m % S];
        sum += weights[m / S][m % S] * legendre(k, at) * value_of_all(j, 2 * S, at);
        m += 1;
    }
    (2 * k + 1) as f64 * sum
}

/// Returns the value at θ of the polynomial that is 1 at node or point j and 0 at the others of the
/// first `count`.
const fn value_of_all(j: usize, count: usize, theta: f64) -> f64 {
    let (mut value, mut i) = (1.0, 0);
    while i < count {
        if i != j {
            value *= (theta - node_or_point(i)) / (node_or_point(j) - node_or_point(i));
        }
        i += 1;
    }
    value
}

/// Returns the nodes, followed by the points between them and the start.
const fn node_or_point(j: usize) -> f64 {
    if j < S {
        EIGHT_NODES.0[0][j]
    } else if j < 2 * S {
        POINTS[j - S]
    } else {
        0.0
    }
}

/// The zeros of the Stieltjes polynomial of degree 9 except the first and the last (Kronrod 1965),
/// and 1 − 2⁻⁵²: so close to the end that nothing can lie between, but before a kink at the end.
const POINTS: Nodes = [
    0.052939546576271789,
    0.163822964527420661,
    0.319649451035934021,
    0.5,
    0.680350548964065979,
    0.836177035472579339,
    0.947060453423728211,
    0.9999999999999998,
];

/// The values at sixteen nodes of the polynomial through those at eight.
pub(super) static REFINED: Columns<1, 2> = {
    let mut refined = [[[[0.0; S]; 2]; S]; 1];
    let mut j = 0;
    while j < S {
        let mut i = 0;
        while i < 2 * S {
            refined[0][j][i / S][i % S] = value(&EIGHT_NODES, j, SIXTEEN_NODES.0[i / S][i % S]);
            i += 1;
        }
        j += 1;
    }
    refined
};

/// The values at sixteen nodes of the polynomial through those at eight, at the points between them
/// and at the start.
pub(super) static UNITED: (Columns<2, 2>, [Nodes; 2]) = {
    let (mut united, mut start) = ([[[[0.0; S]; 2]; S]; 2], [[0.0; S]; 2]);
    let mut i = 0;
    while i < 2 * S {
        let (to, at) = (i / S, i % S);
        let theta = SIXTEEN_NODES.0[to][at];
        let mut j = 0;
        while j < 2 * S {
            united[j / S][j % S][to][at] = value_of_all(j, 2 * S + 1, theta);
            j += 1;
        }
        start[to][at] = value_of_all(2 * S, 2 * S + 1, theta);
        i += 1;
    }
    (united, start)
};

const fn collocation<const G: usize>((nodes, weights): ([Nodes; G], [Nodes; G])) -> Collocation<G> {
    let zero = [[[[0.0; S]; G]; S]; G];
    let mut tableau = Collocation {
        nodes,
        once: zero,
        twice: zero,
        ahead: zero,
        once_ahead: zero,
        twice_ahead: zero,
        ends: [[[[0.0; S]; 1]; S]; G],
        legendre: zero,
        lagrange: [[1.0; S]; G],
    };
    let all = S * G;
    let mut j = 0;
    while j < all {
        let (g, lane) = (j / S, j % S);
        let mut i = 0;
        while i < all {
            let (to, at) = (i / S, i % S);
            tableau.once[g][lane][to][at] = integral(&(nodes, weights), j, nodes[to][at]);
            tableau.ahead[g][lane][to][at] = value(&(nodes, weights), j, 1.0 + nodes[to][at]);
            tableau.legendre[g][lane][to][at] = coefficient(&(nodes, weights), i, j);
            if to == g && at != lane {
                tableau.lagrange[g][lane] /= nodes[g][lane] - nodes[g][at];
            }
            i += 1;
        }
        // The nodes are symmetric: 1 − c_j is one of them.
        let mirrored = nodes[G - 1 - g][S - 1 - lane];
        tableau.ends[g][lane][0] =
            [weights[g][lane], weights[g][lane] * mirrored, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        j += 1;
    }
    tableau.twice = product(&tableau.once, &tableau.once);
    tableau.once_ahead = product(&tableau.once, &tableau.ahead);
    tableau.twice_ahead = product(&tableau.twice, &tableau.ahead);
    tableau
}

/// Returns the columns that apply `first`, and then `second` to the result.
const fn product<const G: usize>(second: &Columns<G, G>, first: &Columns<G, G>) -> Columns<G, G> {
    let mut product = [[[[0.0; S]; G]; S]; G];
    let all = S * G;
    let mut j = 0;
    while j < all {
        let mut i = 0;
        while i < all {
            let mut k = 0;
            while k < all {
                product[j / S][j % S][i / S][i % S] +=
                    second[k / S][k % S][i / S][i % S] * first[j / S][j % S][k / S][k % S];
                k += 1;
            }
            i += 1;
        }
        j += 1;
    }
    product
}

/// Returns P_k(2θ − 1), from (k + 1) P_{k+1}(x) = (2k + 1) x P_k(x) − k P_{k−1}(x).
const fn legendre(k: usize, theta: f64) -> f64 {
    let x = theta - (1.0 - theta);
    let (mut before, mut now, mut degree) = (0.0, 1.0, 0);
    while degree < k {
        let d = degree as f64;
        (before, now) = (now, ((2.0 * d + 1.0) * x * now - d * before) / (d + 1.0));
        degree += 1;
    }
    now
}

/// Returns the contribution (2k + 1) b_j P_k(2 c_j − 1) of the value at node j to the coefficient
/// of P_k.
const fn coefficient<const G: usize>(
    (nodes, weights): &([Nodes; G], [Nodes; G]),
    k: usize,
    j: usize,
) -> f64 {
    (2 * k + 1) as f64 * weights[j / S][j % S] * legendre(k, nodes[j / S][j % S])
}

/// Returns the value at θ of the polynomial that is 1 at node j and 0 at the other nodes.
const fn value<const G: usize>(rule: &([Nodes; G], [Nodes; G]), j: usize, theta: f64) -> f64 {
    let (mut sum, mut k) = (0.0, S * G);
    while 0 < k {
        k -= 1;
        sum += coefficient(rule, k, j) * legendre(k, theta);
    }
    sum
}

/// Returns the integral from 0 to θ of that polynomial: ∫ P_k = (P_{k+1} − P_{k−1})/(4k + 2).
const fn integral<const G: usize>(rule: &([Nodes; G], [Nodes; G]), j: usize, theta: f64) -> f64 {
    let (mut sum, mut k) = (0.0, S * G);
    while 1 < k {
        k -= 1;
        sum += coefficient(rule, k, j) * (legendre(k + 1, theta) - legendre(k - 1, theta))
            / (4 * k + 2) as f64;
    }
    sum + coefficient(rule, 0, j) * theta
}

/// The nodes and their weights.
const EIGHT_NODES: ([Nodes; 1], [Nodes; 1]) = {
    let Tableau { nodes, weights, .. } = Tableau::<S>::GAUSS;
    ([nodes], [weights])
};

/// The widest gap between two neighbouring nodes or points.
pub(super) const GAP: f64 = {
    let (mut all, mut j) = ([0.0; 2 * S], 0);
    while j < 2 * S {
        all[j] = node_or_point(j);
        j += 1;
    }
    gap::widest(&all, &gap::all::<{ 2 * S }>())
};

// Printed by tests/data/gauss.py.

const SIXTEEN_NODES: ([Nodes; 2], [Nodes; 2]) = (
    [
        [
            0.005299532504175033,
            0.02771248846338371,
            0.06718439880608412,
            0.12229779582249849,
            0.19106187779867811,
            0.2709916111713863,
            0.35919822461037054,
            0.4524937450811813,
        ],
        [
            0.5475062549188188,
            0.6408017753896295,
            0.7290083888286137,
            0.8089381222013219,
            0.8777022041775016,
            0.9328156011939158,
            0.9722875115366163,
            0.994700467495825,
        ],
    ],
    [
        [
            0.013576229705877048,
            0.031126761969323947,
            0.04757925584124639,
            0.06231448562776694,
            0.07479799440828837,
            0.08457825969750127,
            0.09130170752246179,
            0.09472530522753425,
        ],
        [
            0.09472530522753425,
            0.09130170752246179,
            0.08457825969750127,
            0.07479799440828837,
            0.06231448562776694,
            0.04757925584124639,
            0.031126761969323947,
            0.013576229705877048,
        ],
    ],
);

#[cfg(test)]
mod tests {
    use super::{
        BETWEEN, Collocation, EIGHT, EIGHT_NODES, GAP, Nodes, REFINED, S, SIXTEEN, SIXTEEN_NODES,
        UNITED, legendre,
    };

    /// Returns the sums of the columns with the values of θᵖ at the nodes.
    fn sums<const G: usize, const W: usize, const H: usize>(
        nodes: &[Nodes; G],
        columns: &[[[[f64; W]; H]; S]; G],
        p: i32,
    ) -> Vec<f64> {
        let mut sums = vec![0.0; W * H];
        for (g, nodes) in nodes.iter().enumerate() {
            for (j, node) in nodes.iter().enumerate() {
                for (sum, column) in sums.iter_mut().zip(columns[g][j].as_flattened()) {
                    *sum += node.powi(p) * column;
                }
            }
        }
        sums
    }

    fn check<const G: usize>(tableau: &Collocation<G>, weights: &[Nodes; G]) {
        let nodes = tableau.nodes.as_flattened();
        let close = |a: f64, b: f64, within: f64| assert!((a - b).abs() < within, "{a}, not {b}");
        for p in 0..8 * G as i32 {
            let degree = f64::from(p);
            for (i, c) in nodes.iter().enumerate() {
                close(
                    sums(&tableau.nodes, &tableau.once, p)[i],
                    c.powi(p + 1) / (degree + 1.0),
                    4e-16,
                );
                // The integral is a polynomial through the nodes, unless its degree is too high.
                if p + 1 < 8 * G as i32 {
                    let twice = c.powi(p + 2) / ((degree + 1.0) * (degree + 2.0));
                    close(sums(&tableau.nodes, &tableau.twice, p)[i], twice, 4e-16);
                }
                if G == 1 {
                    close(sums(&tableau.nodes, &tableau.ahead, p)[i], (1.0 + c).powi(p), 1e-10);
                    let once = ((1.0 + c).powi(p + 1) - 1.0) / (degree + 1.0);
                    close(sums(&tableau.nodes, &tableau.once_ahead, p)[i], once, 1e-10);
                    if p < 7 {
                        let twice = ((1.0 + c).powi(p + 2) - 1.0 - (degree + 2.0) * c)
                            / ((degree + 1.0) * (degree + 2.0));
                        close(sums(&tableau.nodes, &tableau.twice_ahead, p)[i], twice, 1e-10);
                    }
                }
                let series: f64 = (0..8 * G)
                    .map(|k| sums(&tableau.nodes, &tableau.legendre, p)[k] * legendre(k, *c))
                    .sum();
                close(series, c.powi(p), 1e-14);
            }
            let ends = sums(&tableau.nodes, &tableau.ends, p);
            close(ends[0], 1.0 / (degree + 1.0), 4e-16);
            close(ends[1], 1.0 / ((degree + 1.0) * (degree + 2.0)), 4e-16);
        }
        // The rule is exact for degrees below twice the number of nodes (Gauss 1814).
        for p in 0..16 * G as i32 {
            let sum: f64 =
                nodes.iter().zip(weights.as_flattened()).map(|(c, b)| b * c.powi(p)).sum();
            close(sum, 1.0 / (f64::from(p) + 1.0), 4e-16);
        }
    }

    #[test]
    fn polynomials_are_integrated_exactly() {
        check(&EIGHT, &EIGHT_NODES.1);
        check(&SIXTEEN, &SIXTEEN_NODES.1);
    }

    #[test]
    fn gaps_are_halved() {
        assert!((GAP - 0.0917).abs() < 1e-4, "{GAP}");
    }

    #[test]
    fn points_lie_between_the_nodes() {
        let (nodes, points) = (&EIGHT.nodes[0], &BETWEEN.points[0]);
        for k in 0..S {
            assert!(nodes[k] < points[k] && points[k] < nodes.get(k + 1).copied().unwrap_or(1.0));
        }
        for p in 0..8 {
            let degree = f64::from(p);
            let (once, twice) =
                (sums(&EIGHT.nodes, &BETWEEN.once, p), sums(&EIGHT.nodes, &BETWEEN.twice, p));
            for (k, c) in points.iter().enumerate() {
                assert!((once[k] - c.powi(p + 1) / (degree + 1.0)).abs() < 4e-16);
                assert!(
                    p == 7
                        || (twice[k] - c.powi(p + 2) / ((degree + 1.0) * (degree + 2.0))).abs()
                            < 4e-16
                );
            }
        }
    }

    /// P_k has the coefficient 1 for itself and 0 for the others; the ends do not depend on the
    /// points between the nodes.
    #[test]
    fn sixteen_values_give_the_last_coefficients() {
        for k in 0..17 {
            let mut lanes = [0.0; S];
            for (g, points) in [EIGHT.nodes[0], BETWEEN.points[0]].iter().enumerate() {
                for (j, c) in points.iter().enumerate() {
                    for (sum, column) in lanes.iter_mut().zip(BETWEEN.ends[g][j][0]) {
                        *sum += column * legendre(k, *c);
                    }
                    assert!(g == 0 || BETWEEN.ends[g][j][0][..2] == [0.0; 2]);
                }
            }
            for lane in (2..6).filter(|_| k < 16) {
                let expected = f64::from(u8::from(k + lane == 2 * S + 1));
                assert!((lanes[lane] - expected).abs() < 1e-13, "{k} {lane}: {}", lanes[lane]);
            }
            let last = lanes[6] + BETWEEN.start * legendre(k, 0.0);
            assert!((last - f64::from(u8::from(k == 16))).abs() < 1e-13, "{k}: {last}");
        }
    }

    #[test]
    fn eight_nodes_become_sixteen() {
        for p in 0..8 {
            for (value, c) in
                sums(&EIGHT.nodes, &REFINED, p).iter().zip(SIXTEEN.nodes.as_flattened())
            {
                assert!((value - c.powi(p)).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn seventeen_values_become_sixteen() {
        let (columns, start) = &UNITED;
        let nodes = [EIGHT.nodes[0], BETWEEN.points[0]];
        for k in 0..17 {
            let mut values: Vec<f64> =
                start.as_flattened().iter().map(|column| column * legendre(k, 0.0)).collect();
            for (g, j) in (0..2 * S).map(|j| (j / S, j % S)) {
                for (value, column) in values.iter_mut().zip(columns[g][j].as_flattened()) {
                    *value += column * legendre(k, nodes[g][j]);
                }
            }
            for (value, c) in values.iter().zip(SIXTEEN.nodes.as_flattened()) {
                assert!((value - legendre(k, *c)).abs() < 1e-14, "{k} {c}: {value}");
            }
        }
    }
}

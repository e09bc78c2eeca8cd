//! The coefficients of the Gauss methods.

/// Nodes and weights of collocation at `S` points.
#[derive(Clone, Copy, Debug)]
pub(in crate::integrate) struct Tableau<const S: usize> {
    /// The nodes c: the roots of P_S(2c − 1).
    pub(in crate::integrate) nodes: [f64; S],
    /// The weights b of the quadrature on [0, 1].
    pub(in crate::integrate) weights: [f64; S],
    /// m_ij = a_ij/b_j, for which m_ij + m_ji = 1 holds exactly: this property, not the accuracy of
    /// b, makes the rounded method symplectic.
    pub(in crate::integrate) ratios: [[f64; S]; S],
    /// The value at 1 + c_i of the polynomial that is 1 at c_j and 0 at the other nodes.
    pub(in crate::integrate) ahead: [[f64; S]; S],
}

impl<const S: usize> Tableau<S> {
    /// The coefficients for S = 1, 2, 3, 4 or 8; other values of S do not compile.
    pub(in crate::integrate) const GAUSS: Self = {
        let (nodes, weights, below) = match S {
            1 => GAUSS1,
            2 => GAUSS2,
            3 => GAUSS3,
            4 => GAUSS4,
            8 => GAUSS8,
            _ => panic!("`Gauss<S>` has 1, 2, 3, 4 or 8 stages"),
        };
        let mut tableau = Self {
            nodes: [0.0; S],
            weights: [0.0; S],
            ratios: [[0.5; S]; S],
            ahead: [[1.0; S]; S],
        };
        let mut i = 0;
        while i < S {
            tableau.nodes[i] = nodes[i];
            tableau.weights[i] = weights[i];
            let mut j = 0;
            while j < i {
                // All ratios lie between ½ and 2, where their difference from 1 is exact (Sterbenz
                // 1974).
                tableau.ratios[i][j] = below[i - 1][j];
                tableau.ratios[j][i] = 1.0 - below[i - 1][j];
                j += 1;
            }
            j = 0;
            while j < S {
                let mut k = 0;
                while k < S {
                    if k != j {
                        tableau.ahead[i][j] *= (1.0 + nodes[i] - nodes[k]) / (nodes[j] - nodes[k]);
                    }
                    k += 1;
                }
                j += 1;
            }
            i += 1;
        }
        tableau
    };
}

/// c, b, and the rows of m below its diagonal.
type Digits = (&'static [f64], &'static [f64], &'static [&'static [f64]]);

// Printed by tests/data/gauss.py.

const GAUSS1: Digits = (&[0.5], &[1.0], &[]);

const GAUSS2: Digits =
    (&[0.2113248654051871, 0.7886751345948129], &[0.5, 0.5], &[&[1.0773502691896257]]);

const GAUSS3: Digits = (
    &[0.11270166537925831, 0.5, 0.8872983346207417],
    &[0.2777777777777778, 0.4444444444444444, 0.2777777777777778],
    &[&[1.0809475019311126], &[0.96475800154489, 1.0809475019311126]],
);

const GAUSS4: Digits = (
    &[0.06943184420297371, 0.33000947820757187, 0.6699905217924281, 0.9305681557970263],
    &[0.17392742256872692, 0.32607257743127305, 0.32607257743127305, 0.17392742256872692],
    &[
        &[1.08158975003228],
        &[0.9612740734321142, 1.0855037514105192],
        &[1.0204404206840407, 0.9612740734321142, 1.08158975003228],
    ],
);

const GAUSS8: Digits = (
    &[
        0.019855071751231884,
        0.10166676129318664,
        0.2372337950418355,
        0.4082826787521751,
        0.591717321247825,
        0.7627662049581645,
        0.8983332387068134,
        0.9801449282487681,
    ],
    &[
        0.05061426814518813,
        0.11119051722668724,
        0.15685332293894363,
        0.181341891689181,
        0.181341891689181,
        0.15685332293894363,
        0.11119051722668724,
        0.05061426814518813,
    ],
    &[
        &[1.0818949631055814],
        &[0.959957296222055, 1.0869589243008326],
        &[1.0247213458032003, 0.9550588736973743, 1.0880938387323082],
        &[0.9830238267636289, 1.0287597754747493, 0.9538345351852, 1.0883471611098279],
        &[
            1.012225914113298,
            0.9799828723635913,
            1.029603873064978,
            0.9538345351852,
            1.0880938387323082,
        ],
        &[
            0.9912514332308027,
            1.014074355889167,
            0.9799828723635913,
            1.0287597754747493,
            0.9550588736973743,
            1.0869589243008326,
        ],
        &[
            1.005482808253216,
            0.9912514332308027,
            1.012225914113298,
            0.9830238267636289,
            1.0247213458032003,
            0.959957296222055,
            1.0818949631055814,
        ],
    ],
);

#[cfg(test)]
mod tests {
    use super::Tableau;

    fn check<const S: usize>() {
        let Tableau { nodes, weights, ratios, ahead } = Tableau::<S>::GAUSS;
        for i in 0..S {
            // Collocation: Σ a_ij c_j^(k−1) = c_i^k/k for k ≤ S, and Σ b_j c_j^(k−1) = 1/k for k ≤
            // 2S.
            for k in 1..=2 * S as i32 {
                let sum = |row: &[f64; S]| {
                    (0..S).map(|j| row[j] * weights[j] * nodes[j].powi(k - 1)).sum::<f64>()
                };
                assert!((sum(&[1.0; S]) - 1.0 / f64::from(k)).abs() < 2e-16, "S = {S}, k = {k}");
                if k <= S as i32 {
                    assert!(
                        (sum(&ratios[i]) - nodes[i].powi(k) / f64::from(k)).abs() < 2e-16,
                        "S = {S}, i = {i}, k = {k}"
                    );
                }
            }
            for j in 0..S {
                // The method is symplectic exactly, and symmetric in time.
                assert_eq!(ratios[i][j] + ratios[j][i], 1.0);
                assert!(
                    (ratios[i][j] - ratios[S - 1 - j][S - 1 - i]).abs() < 3e-16
                        && weights[i] == weights[S - 1 - i]
                );
            }
            let polynomial =
                |c: f64| (1..S as i32).fold(1.0, |sum, k| sum + f64::from(k) * c.powi(k));
            let extrapolated = (0..S).map(|j| ahead[i][j] * polynomial(nodes[j])).sum::<f64>();
            assert!((extrapolated / polynomial(1.0 + nodes[i]) - 1.0).abs() < 1e-10);
        }
    }

    #[test]
    fn nodes_weights_and_ratios_belong_together() {
        check::<1>();
        check::<2>();
        check::<3>();
        check::<4>();
        check::<8>();
    }
}

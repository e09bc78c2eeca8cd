//! Moments of a region by Green's theorem: integrals along its boundary.

use super::curve::{Curve, Point};
use crate::sum::Sum;

/// Nodes and weights of the Gauss–Legendre rule of six points on [−1, 1], exact for degree 11
/// (Abramowitz and Stegun 1964, table 25.4).
const GAUSS: [(f64, f64); 3] = [
    (0.238619186083196909, 0.467913934572691047),
    (0.661209386466264514, 0.360761573048138608),
    (0.932469514203152028, 0.171324492379170345),
];

/// Computes area, ∫x, ∫y, ∫x², ∫xy and ∫y² about a point.
pub(super) fn integrals(boundary: &[(Curve, f64)], [cx, cy]: Point) -> [f64; 6] {
    let mut sums = [Sum::default(); 6];
    for (curve, weight) in boundary {
        for (node, share) in GAUSS.iter().flat_map(|&(node, share)| [(-node, share), (node, share)])
        {
            let t = 0.5 + 0.5 * node;
            let ([x, y], [dx, dy]) = (curve.at(t), curve.slope(t));
            let [x, y] = [x - cx, y - cy];
            let scale = 0.5 * share * weight;
            sums[0].add(scale * 0.5 * (x * dy - y * dx));
            sums[1].add(scale * 0.5 * x * x * dy);
            sums[2].add(-scale * 0.5 * y * y * dx);
            sums[3].add(scale * x * x * x * dy / 3.0);
            sums[4].add(scale * 0.5 * x * x * y * dy);
            sums[5].add(-scale * y * y * y * dx / 3.0);
        }
    }
    sums.map(Sum::value)
}

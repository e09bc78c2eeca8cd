//! The criterion by which a pendulum falls asleep.

use crate::group::hung::Hung;
use crate::group::rest::project;
use crate::lanes::limits::Limits;
use crate::system::SceneSystem;
use core::cmp::Reverse;
use pendulum_core::nalgebra::DMatrix;
use pendulum_core::scalar::{Float, Real};
use pendulum_core::system::{At, Purpose};
use std::collections::BinaryHeap;

/// The alarms of sleeping pendulums: pairs of a tick and a pendulum, the earliest first.
pub(crate) type Alarms = BinaryHeap<Reverse<(i64, u32)>>;

/// The bounds within which a pendulum falls asleep while its joints rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SleepCriterion<T, const N: usize> {
    /// The tick in which the joints move again. The criterion is valid up to this tick.
    pub(super) until: i64,
    /// The coordinates at which the pendulum comes to rest.
    pub(super) rest: [T; N],
    /// The largest energy, relative to the state of rest, with which the pendulum falls asleep;
    /// negative if it must not sleep.
    pub(super) energy: T,
    /// Upper bounds of the velocities at this energy.
    pub(super) speed: [T; N],
    /// An upper bound of the distance of each coordinate from rest at this energy.
    pub(super) near: T,
    /// The distance from rest within which the pendulum returns to `rest`.
    pub(super) reach: T,
}

impl<T: Float, const N: usize> SleepCriterion<T, N> {
    /// Returns `true` if the criterion does not need to be computed again: a pendulum that moves
    /// fast does not fall asleep, and a pendulum within `reach` has the same state of rest.
    pub(super) fn lasts(&self, q: &[T; N], v: &[T; N]) -> bool {
        let fast = (0..N).any(|i| T::from_f64(4.0) * self.speed[i] < Real::abs(v[i]));
        fast || T::from_f64(0.0) < self.energy && self.distance(q) <= self.reach
    }

    /// Returns the largest distance of a coordinate from rest.
    pub(super) fn distance(&self, q: &[T; N]) -> T {
        (0..N).fold(T::from_f64(0.0), |distance, i| {
            Real::max(distance, Real::abs(q[i] - self.rest[i]))
        })
    }
}

/// A pendulum whose joints rest at their current positions.
pub(super) struct AtRest<'a, S: SceneSystem<T, N>, T: Float, const N: usize> {
    system: &'a S,
    pub(super) t: T,
    pub(super) forces: S::Inputs,
    momenta: S::Inputs,
    limits: &'a Limits<T, N>,
}

impl<'a, S: SceneSystem<T, N>, T: Float, const N: usize> AtRest<'a, S, T, N> {
    pub(super) fn new(hung: &'a Hung<'_, S, T, N>) -> Self {
        let t = hung.world.now();
        let [forces, momenta] =
            [Purpose::Accelerations, Purpose::Momenta].map(|purpose| hung.resting(t, purpose));
        let (system, limits) = (&hung.system, &hung.pendulum.limits);
        Self { system, t: T::from_f64(t), forces, momenta, limits }
    }

    /// Returns the kinetic energy q̇ᵀMq̇/2.
    pub(super) fn kinetic(&self, q: &[T; N], v: &[T; N]) -> T {
        T::from_f64(0.5) * self.product(q, v, v)
    }

    /// Returns aᵀMb.
    pub(super) fn product(&self, q: &[T; N], a: &[T; N], b: &[T; N]) -> T {
        let p = |v: &[T; N]| self.system.momenta(At { t: self.t, q, v, inputs: &self.momenta });
        let (moving, still) = (p(b), p(&[T::from_f64(0.0); N]));
        (0..N).fold(T::from_f64(0.0), |sum, i| sum + a[i] * (moving[i] - still[i]))
    }

    /// Splits a displacement from `rest`: the one along the constraints, to a state that fulfils
    /// them, and the part that leads away from them.
    pub(super) fn split(&self, rest: &[T; N], by: &[T; N]) -> [[T; N]; 2] {
        let at = At { t: self.t, q: rest, v: by, inputs: &self.forces };
        let away = self.system.correction(at, &self.system.misfits(at)[1]);
        let along = core::array::from_fn(|i| rest[i] + (by[i] - away[i]));
        let held = project(self.system, self.t, along, &self.forces);
        [core::array::from_fn(|i| held[i] - rest[i]), away]
    }

    /// Returns the work of a displacement `by` from `rest`, by Simpson's rule over the forces;
    /// infinity beyond a hard limit. A difference of energies would lose all its digits in single
    /// precision.
    pub(super) fn lifted(&self, rest: &[T; N], by: &[T; N]) -> T {
        let zero = [T::from_f64(0.0); N];
        if self.limits.is_hard()
            && (0..N).any(|i| {
                rest[i] + by[i] < self.limits.low[i] || self.limits.high[i] < rest[i] + by[i]
            })
        {
            return T::from_f64(f64::INFINITY);
        }
        let work = |part: f64| {
            let q = core::array::from_fn(|i| rest[i] + T::from_f64(part) * by[i]);
            let forces =
                self.system.forces(At { t: self.t, q: &q, v: &zero, inputs: &self.forces });
            let work = (0..N).fold(T::from_f64(0.0), |sum, i| sum - by[i] * forces[i]);
            if self.limits.stiffness == zero[0] {
                work
            } else {
                work - self.product(&q, by, &self.limits.push(&q))
            }
        };
        (work(0.0) + T::from_f64(4.0) * work(0.5) + work(1.0)) / T::from_f64(6.0)
    }

    /// Returns (M⁻¹)ᵢᵢ.
    pub(super) fn mobility(&self, q: &[T; N], i: usize) -> T {
        let rest = At { t: self.t, q, v: &[T::from_f64(0.0); N], inputs: &self.momenta };
        let mut p = self.system.momenta(rest);
        p[i] += T::from_f64(1.0);
        self.system.velocities(self.t, q, &p, &self.momenta)[i]
    }
}

/// Returns the least energy with which a coordinate can move farther than `tolerance` from a
/// minimum; `None` if the state is not a minimum.
///
/// For the energy qᵀHq/2 this is the minimum over i of tolerance²/(2 (H⁻¹)ᵢᵢ): the other
/// coordinates take the values of least energy.
pub(super) fn barrier<const N: usize>(
    tolerance: f64,
    above: impl Fn(&[f64; N]) -> f64,
) -> Option<f64> {
    let at = |moves: &[(usize, f64)]| {
        let mut by = [0.0; N];
        for &(i, sign) in moves {
            by[i] += sign * tolerance;
        }
        above(&by)
    };
    // A single coordinate moves to the side with less energy.
    let sides = |i: usize| [at(&[(i, 1.0)]), at(&[(i, -1.0)])];
    let energy = if N == 1 {
        let [ahead, behind] = sides(0);
        ahead.min(behind)
    } else {
        let hessian = DMatrix::from_fn(N, N, |i, j| {
            if i == j {
                let [ahead, behind] = sides(i);
                ahead + behind
            } else {
                let corner = |a, b| at(&[(i, a), (j, b)]);
                (corner(1.0, 1.0) - corner(1.0, -1.0) - corner(-1.0, 1.0) + corner(-1.0, -1.0))
                    / 4.0
            }
        });
        let inverse = hessian.cholesky()?.inverse();
        (0..N).map(|i| 0.5 / inverse[(i, i)]).fold(f64::INFINITY, f64::min)
    };
    (0.0 < energy && energy < f64::INFINITY).then_some(energy)
}

#[cfg(test)]
mod tests {
    use super::barrier;

    #[test]
    fn coupled_coordinates_help_each_other_over_the_barrier() {
        // A stiff spring couples both coordinates, so they move together.
        let tied = |by: &[f64; 2]| {
            0.5 * (by[0] * by[0] + by[1] * by[1]) + 50.0 * (by[0] - by[1]) * (by[0] - by[1])
        };
        let energy = barrier(0.01, tied).unwrap();
        let exact = 0.5e-4 / (101.0 / (101.0 * 101.0 - 1e4));
        assert!((energy / exact - 1.0).abs() < 1e-9, "{energy} for {exact}");
        assert_eq!(barrier(0.01, |by: &[f64; 1]| -by[0] * by[0]), None);
        assert_eq!(barrier(0.01, |by: &[f64; 2]| by[0] * by[0] - by[1] * by[1]), None);
        assert_eq!(barrier(0.01, |by: &[f64; 1]| by[0] * by[0]), Some(0.01 * 0.01));
    }
}

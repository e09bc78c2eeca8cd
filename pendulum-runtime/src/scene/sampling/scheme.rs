//! The fixed-step methods of a scene as data: where in a tick they look, and with which weights.

use crate::integrate::methods::{leapfrog, srkn6b};
use crate::integrate::{Leapfrog, Rk4, Srkn6b};
use crate::sealed::Sealed;
use crate::system::{Facts, System, VelocityFree};

/// A fixed-step method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Scheme {
    /// [`Leapfrog`](crate::integrate::Leapfrog): order 2, one evaluation a step, for velocity-free
    /// systems.
    Leapfrog,
    /// [`Srkn6b`](crate::integrate::Srkn6b): order 4, six evaluations a step, for velocity-free
    /// systems.
    Srkn6b,
    /// [`Rk4`](crate::integrate::Rk4): order 4, four evaluations a step, for all systems.
    Rk4,
}

/// The methods of [`integrate`](crate::integrate) that a scene has, for the systems `S` that they
/// are right for.
pub trait Fixed<S, const N: usize>: Sealed {
    /// The method as data.
    const SCHEME: Scheme;
}

impl Sealed for Leapfrog {}

impl Sealed for Srkn6b {}

impl Sealed for Rk4 {}

impl<S: VelocityFree<N>, const N: usize> Fixed<S, N> for Leapfrog {
    const SCHEME: Scheme = Scheme::Leapfrog;
}

impl<S: VelocityFree<N>, const N: usize> Fixed<S, N> for Srkn6b {
    const SCHEME: Scheme = Scheme::Srkn6b;
}

impl<S: System<N>, const N: usize> Fixed<S, N> for Rk4 {
    const SCHEME: Scheme = Scheme::Rk4;
}

/// A method and the equal steps that it takes in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Grid {
    pub(crate) scheme: Scheme,
    pub(crate) substeps: u32,
}

/// The most steps into which a tick is divided.
pub(crate) const MOST_SUBSTEPS: u32 = 64;

/// The most evaluations in a step.
pub(crate) const MOST_STAGES: usize = 7;

impl Scheme {
    /// The times of the evaluations of a step, in steps.
    pub(crate) fn stages(self) -> &'static [f64] {
        const SRKN6B: [f64; 7] = {
            let [a, b, c, d, e, f] = srkn6b::SPLITTING.times;
            [0.0, a, b, c, d, e, f]
        };
        match self {
            Self::Leapfrog => &leapfrog::SPLITTING.times,
            Self::Srkn6b => &SRKN6B,
            Self::Rk4 => &[0.0, 0.5, 1.0],
        }
    }

    /// New evaluations in a step.
    fn cost(self) -> u32 {
        match self {
            Self::Leapfrog => 1,
            Self::Srkn6b => 6,
            Self::Rk4 => 4,
        }
    }

    /// The longest step in radians whose relative error of the phase is `tolerance`, within what is
    /// stable.
    ///
    /// The error is (hω)²/24 for leapfrog, 1.5·10⁻⁵ (hω)⁴ for SRKN6b and (hω)⁴/120 for RK4.
    fn longest(self, tolerance: f64) -> f64 {
        let (step, stable) = match self {
            Self::Leapfrog => ((24.0 * tolerance).sqrt(), 1.0),
            Self::Srkn6b => ((tolerance / 1.5e-5).sqrt().sqrt(), 1.5),
            Self::Rk4 => ((120.0 * tolerance).sqrt().sqrt(), 1.0),
        };
        if step < stable { step } else { stable }
    }

    /// The steps in a tick of `phase` radians, a power of two.
    pub(crate) fn substeps(self, phase: f64, tolerance: f64) -> u32 {
        let (longest, mut substeps) = (self.longest(tolerance), 1);
        while substeps < MOST_SUBSTEPS && longest * f64::from(substeps) < phase {
            substeps *= 2;
        }
        substeps
    }

    /// The cheapest method for a system in ticks of `phase` radians.
    pub(crate) fn cheapest(facts: &Facts, phase: f64, tolerance: f64) -> Grid {
        let grid = |scheme: Self| Grid { scheme, substeps: scheme.substeps(phase, tolerance) };
        if !(facts.velocity_free && facts.constant_mass_matrix) {
            return grid(Self::Rk4);
        }
        let (leapfrog, srkn) = (grid(Self::Leapfrog), grid(Self::Srkn6b));
        let cost = |grid: Grid| grid.scheme.cost() * grid.substeps;
        let enough = phase <= Self::Leapfrog.longest(tolerance) * f64::from(leapfrog.substeps);
        if enough && cost(leapfrog) <= cost(srkn) { leapfrog } else { srkn }
    }
}

impl Grid {
    /// The times of all evaluations in a tick, in ticks, step by step.
    pub(crate) fn fractions(self) -> impl Iterator<Item = f64> {
        let steps = f64::from(self.substeps);
        (0..self.substeps).flat_map(move |step| {
            self.scheme.stages().iter().map(move |stage| (f64::from(step) + stage) / steps)
        })
    }

    pub(crate) fn count(self) -> usize {
        self.substeps as usize * self.scheme.stages().len()
    }
}

#[cfg(test)]
mod tests {
    use super::{Grid, Scheme};
    use crate::system::Facts;

    #[test]
    fn faster_systems_take_more_steps_and_better_methods() {
        let facts = Facts {
            velocity_free: true,
            constant_mass_matrix: true,
            ..Facts::new("Pendulum", &["θ"])
        };
        let cheapest = |phase, tolerance| Scheme::cheapest(&facts, phase, tolerance);
        assert_eq!(cheapest(0.02, 1e-3), Grid { scheme: Scheme::Leapfrog, substeps: 1 });
        assert_eq!(cheapest(0.3, 1e-3), Grid { scheme: Scheme::Leapfrog, substeps: 2 });
        assert_eq!(cheapest(0.3, 1e-8), Grid { scheme: Scheme::Srkn6b, substeps: 2 });
        assert_eq!(
            Scheme::cheapest(&Facts::new("Chain", &["θ"]), 0.02, 1e-3),
            Grid { scheme: Scheme::Rk4, substeps: 1 }
        );
    }

    #[test]
    fn evaluations_of_a_tick_lie_within_it() {
        for scheme in [Scheme::Leapfrog, Scheme::Srkn6b, Scheme::Rk4] {
            let grid = Grid { scheme, substeps: 4 };
            assert_eq!(grid.fractions().count(), grid.count());
            assert!(grid.fractions().all(|fraction| (0.0..=1.0).contains(&fraction)));
        }
    }
}

//! The fixed-step methods of a scene as data: their evaluation times, costs and longest steps.

use pendulum_core::integrate::limits::PARTS;
use pendulum_core::integrate::{Leapfrog, Rk4, Srkn6b};
use pendulum_core::system::{Facts, System, VelocityFree};

/// A fixed-step method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Scheme {
    /// [`Leapfrog`](pendulum_core::integrate::Leapfrog): order 2, one evaluation a step, for
    /// velocity-free systems.
    Leapfrog,
    /// [`Srkn6b`](pendulum_core::integrate::Srkn6b): order 4, seven evaluations a step, for
    /// velocity-free systems.
    Srkn6b,
    /// [`Rk4`](pendulum_core::integrate::Rk4): order 4, four evaluations a step, for all systems.
    Rk4,
}

/// A method of [`integrate`](pendulum_core::integrate) that scenes support, for the systems `S` that
/// it suits.
pub trait Fixed<S, const N: usize> {
    /// The method as data.
    const SCHEME: Scheme;
}

impl<S: VelocityFree<N>, const N: usize> Fixed<S, N> for Leapfrog {
    const SCHEME: Scheme = Scheme::Leapfrog;
}

impl<S: VelocityFree<N>, const N: usize> Fixed<S, N> for Srkn6b {
    const SCHEME: Scheme = Scheme::Srkn6b;
}

impl<S: System<N>, const N: usize> Fixed<S, N> for Rk4 {
    const SCHEME: Scheme = Scheme::Rk4;
}

/// A method and the number of its equal steps in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Grid {
    pub(crate) scheme: Scheme,
    pub(crate) substeps: u32,
    /// `true` if gaps are evaluated on the way, at the ends and in the middles of the parts of each
    /// step.
    pub(crate) watched: bool,
}

/// The properties shared by all pendulums of a bucket.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Kind {
    pub(crate) grid: Grid,
    /// `true` if their joints rest for ever.
    pub(crate) still: bool,
    /// The number of pendulums that carry one another below them, at most.
    pub(crate) level: u32,
}

/// The maximum number of steps in a tick.
pub(crate) const MOST_SUBSTEPS: u32 = 1024;

/// The number of places in a step at which gaps are evaluated: the ends and the middles of its parts.
pub(crate) const PLACES: usize = 2 * PARTS + 1;

/// The maximum number of evaluation times in a step.
pub(crate) const MOST_STAGES: usize = 7;

impl Scheme {
    /// Returns the distinct evaluation times in a step, as fractions of the step.
    pub(crate) fn stages(self) -> &'static [f64] {
        const SRKN6B: [f64; 7] = {
            let [a, b, c, d, e, f] = Srkn6b::SPLITTING.times;
            [0.0, a, b, c, d, e, f]
        };
        match self {
            Self::Leapfrog => &Leapfrog::SPLITTING.times,
            Self::Srkn6b => &SRKN6B,
            Self::Rk4 => &[0.0, 0.5, 1.0],
        }
    }

    /// Returns the number of evaluations per step.
    fn cost(self) -> u32 {
        match self {
            Self::Leapfrog => 1,
            Self::Srkn6b => 7,
            Self::Rk4 => 4,
        }
    }

    /// Returns the longest stable step, in radians, whose relative phase error is at most
    /// `tolerance`.
    ///
    /// The error is (hω)²/24 for leapfrog, 1.5·10⁻⁵ (hω)⁴ for SRKN6b and (hω)⁴/120 for RK4. The
    /// amplitude of RK4 decays by (hω)⁵/144 per radian, which is less than the tolerance for all
    /// these steps.
    fn longest(self, tolerance: f64) -> f64 {
        let (step, stable) = match self {
            Self::Leapfrog => ((24.0 * tolerance).sqrt(), 1.0),
            Self::Srkn6b => ((tolerance / 1.5e-5).sqrt().sqrt(), 1.5),
            Self::Rk4 => ((120.0 * tolerance).sqrt().sqrt(), 1.0),
        };
        if step < stable { step } else { stable }
    }

    /// Returns the number of steps, a power of two, for a tick of `phase` radians; `None` if it
    /// exceeds [`MOST_SUBSTEPS`].
    fn substeps(self, phase: f64, tolerance: f64) -> Option<u32> {
        let (longest, mut substeps) = (self.longest(tolerance), 1);
        while longest * f64::from(substeps) < phase {
            if substeps == MOST_SUBSTEPS {
                return None;
            }
            substeps *= 2;
        }
        Some(substeps)
    }

    /// Returns the cheapest method and its steps for a system in ticks of `phase` radians.
    fn cheapest(facts: &Facts, phase: f64, tolerance: f64) -> Option<Grid> {
        let grid = |scheme: Self| {
            let watched = !facts.limits.is_empty();
            scheme.substeps(phase, tolerance).map(|substeps| Grid { scheme, substeps, watched })
        };
        // Only Runge–Kutta methods keep contacts.
        let splits = facts.velocity_free && facts.constant_mass_matrix;
        if !splits || !facts.limits.is_empty() {
            return grid(Self::Rk4);
        }
        let cost = |grid: &Grid| grid.scheme.cost() * grid.substeps;
        // At equal costs the first method is chosen.
        [grid(Self::Leapfrog), grid(Self::Srkn6b)].into_iter().flatten().min_by_key(cost)
    }
}

impl Grid {
    /// Returns the steps for a system in ticks of `phase` radians, with the method set by the user
    /// or with the cheapest method; `None` if there would be too many steps.
    pub(crate) fn of(
        facts: &Facts,
        chosen: Option<Scheme>,
        phase: f64,
        tolerance: f64,
    ) -> Option<Self> {
        match chosen {
            None => Scheme::cheapest(facts, phase, tolerance),
            Some(scheme) => {
                let watched = !facts.limits.is_empty();
                let grid = |substeps| Self { scheme, substeps, watched };
                scheme.substeps(phase, tolerance).map(grid)
            }
        }
    }

    /// Returns the times of all evaluations in a tick, as fractions of the tick, step by step.
    pub(crate) fn fractions(self) -> impl Iterator<Item = f64> {
        let steps = f64::from(self.substeps);
        (0..self.substeps).flat_map(move |step| {
            self.places().iter().map(move |place| (f64::from(step) + place) / steps)
        })
    }

    /// Returns the places in a step at which inputs are sampled.
    fn places(self) -> &'static [f64] {
        const WATCHED: [f64; PLACES] = {
            let (mut places, mut k) = ([0.0; PLACES], 0);
            while k < PLACES {
                places[k] = k as f64 / (PLACES - 1) as f64;
                k += 1;
            }
            places
        };
        if self.watched { &WATCHED } else { self.scheme.stages() }
    }
}

#[cfg(test)]
mod tests {
    use super::{Grid, Scheme};
    use pendulum_core::system::Facts;

    fn velocity_free() -> Facts {
        let mut facts = Facts::new("Pendulum", &["θ"]);
        facts.velocity_free = true;
        facts.constant_mass_matrix = true;
        facts
    }

    #[test]
    fn faster_systems_take_more_steps_and_better_methods() {
        let facts = velocity_free();
        let cheapest = |phase, tolerance| Grid::of(&facts, None, phase, tolerance);
        let steps = |scheme, substeps| Some(Grid { scheme, substeps, watched: false });
        assert_eq!(cheapest(0.02, 1e-3), steps(Scheme::Leapfrog, 1));
        assert_eq!(cheapest(0.3, 1e-3), steps(Scheme::Leapfrog, 2));
        assert_eq!(cheapest(0.3, 1e-8), steps(Scheme::Srkn6b, 2));
        let chain = Facts::new("Chain", &["θ"]);
        assert_eq!(Grid::of(&chain, None, 0.02, 1e-3), steps(Scheme::Rk4, 1));
    }

    /// With the longest step of each method, a tick has at most 1024 steps.
    #[test]
    fn steps_that_are_too_many_are_none() {
        let facts = velocity_free();
        for (chosen, longest) in [
            (None, 1.5),
            (Some(Scheme::Leapfrog), 2.4f64.sqrt().min(1.0)),
            (Some(Scheme::Rk4), 1.0),
        ] {
            let most = Grid::of(&facts, chosen, longest * 1024.0, 0.1);
            assert_eq!(most.map(|grid| grid.substeps), Some(1024), "{chosen:?}");
            assert_eq!(Grid::of(&facts, chosen, longest * 1024.001, 0.1), None, "{chosen:?}");
        }
    }

    #[test]
    fn evaluations_of_a_tick_lie_within_it() {
        for scheme in [Scheme::Leapfrog, Scheme::Srkn6b, Scheme::Rk4] {
            let grid = Grid { scheme, substeps: 4, watched: false };
            assert_eq!(grid.fractions().count(), 4 * scheme.stages().len());
            assert!(grid.fractions().all(|fraction| (0.0..=1.0).contains(&fraction)));
        }
    }
}

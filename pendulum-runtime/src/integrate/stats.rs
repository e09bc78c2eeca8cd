//! The counters of an integration.

use core::fmt;

/// The counters of an integration.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Stats {
    /// The name of the method.
    pub method: &'static str,
    /// Evaluations of the accelerations, those for dense output included.
    /// [`Taylor`](crate::integrate::Taylor) counts an order of its series as one; the one at the
    /// end of each step, by which it checks them, is not counted.
    pub evaluations: u64,
    /// Steps taken.
    pub accepted: u64,
    /// Steps tried and rejected by step control, which tried again with shorter ones: nothing is
    /// lost but their time. Many of them, compared with those accepted, tell of corners or of noise
    /// in the forces.
    pub rejected: u64,
    /// Kinks crossed.
    pub kinks: u64,
    /// The misfits of the constraints; `None` without constraints and before the first step.
    pub constraints: Option<ConstraintStats>,
}

/// The misfits of the constraints of a system at the ends of steps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct ConstraintStats {
    /// The least independence of a constraint of those before it, from 0 to 1, as
    /// [`System::independence`](crate::system::System::independence) gives it.
    pub independence: Extreme,
    /// The largest misfit of positions that a step has left before it was projected, in the unit of
    /// the constraint.
    pub misfit: Extreme,
}

/// An extreme value, where and when it was met.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// The time in seconds.
    pub t: f64,
    /// The constraint.
    pub constraint: &'static str,
}

impl Stats {
    pub(crate) const fn new(method: &'static str) -> Self {
        Self { method, evaluations: 0, accepted: 0, rejected: 0, kinks: 0, constraints: None }
    }
}

impl fmt::Display for Stats {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { method, evaluations, accepted, rejected, kinks, constraints } = self;
        write!(
            f,
            "{method}: {accepted} steps, {rejected} rejected, {kinks} kinks, {evaluations} evaluations"
        )?;
        if let Some(ConstraintStats { independence, misfit }) = constraints {
            write!(
                f,
                ", least independence {:.1e} of {} at {:?}, largest misfit {:.1e} of {} at {:?}",
                independence.value,
                independence.constraint,
                independence.t,
                misfit.value,
                misfit.constraint,
                misfit.t
            )?;
        }
        Ok(())
    }
}

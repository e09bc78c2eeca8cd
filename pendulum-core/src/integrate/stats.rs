//! The counters of an integration.

use core::fmt;

/// The counters of an integration.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Stats {
    /// The name of the method.
    pub method: &'static str,
    /// The number of evaluations of the accelerations, including those for dense output.
    /// [`Taylor`](crate::integrate::Taylor) counts each order of its series as one evaluation. The
    /// check at the end of each of its steps is not counted.
    pub evaluations: u64,
    /// The number of steps taken.
    pub accepted: u64,
    /// The number of steps that the step control rejected and repeated with a shorter length, at no
    /// loss but their time. A large number, compared with `accepted`, indicates corners or noise in
    /// the forces.
    pub rejected: u64,
    /// The number of kinks crossed.
    pub kinks: u64,
    /// The misfits of the constraints; `None` without constraints and before the first step.
    pub constraints: Option<ConstraintStats>,
}

/// The misfits of the constraints of a system at the ends of steps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct ConstraintStats {
    /// The least independence of a constraint from the constraints before it, from 0 to 1, as
    /// returned by [`System::independence`](crate::system::System::independence).
    pub independence: Extreme,
    /// The largest misfit of positions at the end of a step before its projection, in the unit of
    /// the constraint.
    pub misfit: Extreme,
}

/// An extreme value, with its time and its constraint.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// The time in seconds.
    pub t: f64,
    /// The name of the constraint.
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

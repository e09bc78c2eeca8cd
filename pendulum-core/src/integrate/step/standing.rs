//! The states of limits and dry frictions that one step passes to the next.

use crate::integrate::field::contacts::Contacts;
use crate::integrate::step::frictions::Modes;
use crate::system::{Facts, MOST_LIMITS as L};

/// The state of the gap of a limit between two steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Standing {
    /// The gap is open.
    #[default]
    Clear,
    /// The gap is zero up to rounding and opens; its sign counts after it has been positive.
    Rising,
    /// The gap is held at zero.
    Contact,
}

use Standing::{Clear, Contact, Rising};

/// The states of all limits and dry frictions between two steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Standings {
    pub(super) limits: [Standing; L],
    pub(super) frictions: Modes,
}

impl Standings {
    /// No limit in contact, and no friction.
    pub const OPEN: Self = Self { limits: [Clear; L], frictions: Modes::NONE };

    /// Returns `true` if all gaps are open and there is no friction.
    pub fn is_open(&self) -> bool {
        *self == Self::OPEN
    }

    /// Returns `true` if a limit is in contact or a friction sticks.
    pub fn holds(&self) -> bool {
        self.contacts().hold()
    }

    /// Returns `true` if a limit is in contact or there is a friction.
    pub fn pushes(&self) -> bool {
        self.contacts().any()
    }

    /// Returns a number for each limit and each friction of a system with these facts.
    pub fn codes(&self, facts: &Facts) -> impl Iterator<Item = f64> {
        let limits = self.limits.map(|standing| standing as usize);
        let frictions = (0..facts.frictions.len()).map(|k| self.frictions.code(k) as f64);
        limits.into_iter().take(facts.limits.len()).map(|code| code as f64).chain(frictions)
    }

    /// Creates the states from their numbers; `None` if there is no such state.
    pub fn from_codes(facts: &Facts, codes: impl IntoIterator<Item = f64>) -> Option<Self> {
        let (mut codes, mut own) = (codes.into_iter(), Self::OPEN);
        let mut next =
            || codes.next().filter(|code| (0.0..8.0).contains(code) && code.fract() == 0.0);
        for standing in own.limits.iter_mut().take(facts.limits.len()) {
            *standing = *[Clear, Rising, Contact].get(next()? as usize)?;
        }
        for k in 0..facts.frictions.len() {
            own.frictions.set(k, next()? as usize)?;
        }
        Some(own)
    }

    pub(crate) fn contacts(&self) -> Contacts {
        let on = self.limits.map(|standing| standing == Contact);
        Contacts::new(on, self.frictions.grips)
    }
}

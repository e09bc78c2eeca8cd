//! The choice of a method.

use super::adaptive_step::AdaptiveStep;
use super::blame;
use super::control::{Control, Course, Memory};
use super::dop853::Dop853;
use super::field::{Counted, Field};
use super::method::{Method, Suits};
use super::node::Node;
use super::picard::{Picard, SideBySide};
use super::piece::Piece;
use super::span::Span;
use super::splitting::drift_kick_drift_in_two_words;
use super::srkn14a::{self, Srkn14a};
use super::stepper::Stepper;
use super::taylor::{RoomOf, Taylor};
use crate::error::Error;
use crate::jet::{Jets, Known, MaybeJets, Unrolling};
use crate::real::Float;
use crate::system::{Dynamics, System};

/// The method that what is known about the system and the tolerance decide; [`Stats`](super::Stats)
/// say which it was.
///
/// | steps | choice |
/// |---|---|
/// | adaptive | [`Picard`] |
/// | | [`Taylor`] for linear systems without time and driven inputs, whose series converge everywhere |
/// | | [`Taylor`] back in time, where there are series: every motion is [`Analytic`](crate::motion::Analytic) and the accelerations contain no `abs`, `sign`, `min` or `max` of something that moves |
/// | fixed | [`Srkn14a`], which is symplectic, for velocity-free systems, [`Dop853`] for others |
/// | | [`Taylor`] back in time |
///
/// Scalars of two words stand in no lanes. `Taylor` takes the place of `Picard` there, for every
/// tolerance if the equations are short, as for one pendulum, below 2e-7 if they are longer, as for
/// two or three links, and below 2e-14 if they are long; else `Dop853`.
///
/// Nothing shows beforehand that a system is stiff: for stiff springs and dampers name
/// [`Rodas4`](super::Rodas4) or [`Gauss`](super::Gauss), for long runs of a conservative system
/// with fixed steps `Gauss`. Systems written by hand have no recurrences to choose by, and name a
/// method too:
///
/// ```compile_fail,E0277
/// # use pendulum_runtime::{integrate::*, system::*};
/// fn swing<S: System<1, Scalar = f64, Inputs = ()>>(system: &S) -> Result<f64, Failure<f64, 1>> {
///     Ok(solve(system, (0.0, 10.0), [1.3], [0.0]).run()?.end.q[0])
/// }
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Auto;

/// What may be chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Choice {
    Dop853,
    Picard,
    Srkn14a,
    Taylor,
}

/// Room for whatever is chosen.
#[derive(Clone, Debug)]
pub struct Room<R, P, X> {
    choice: Option<Choice>,
    /// The relative tolerance of the adaptive steps that it was chosen for.
    chosen_for: Option<f64>,
    dop853: R,
    picard: P,
    taylor: X,
}

/// The room for the dynamics `D`.
type AnyRoom<D, const N: usize> = Room<
    <Dop853 as Method>::Stages<<D as Dynamics<N>>::Scalar, N>,
    <Picard as Stepper<D, N>>::Stages,
    RoomOf<D, N>,
>;

impl Auto {
    /// The choice for adaptive steps.
    fn adaptive<D: MaybeJets<N, Scalar: Float>, const N: usize>(
        dynamics: &D,
        rtol: f64,
        backwards: bool,
    ) -> Choice {
        let facts = &<D::System as System<N>>::FACTS;
        let two_words = D::Scalar::EPSILON.to_f64() < 1e-17;
        let pays = if two_words {
            rtol < <D::System as Jets<N>>::Unrolling::PAYS_BELOW
        } else {
            facts.linear && facts.autonomous
        };
        if (pays || backwards) && goes_by_series(dynamics) {
            Choice::Taylor
        } else if two_words {
            Choice::Dop853
        } else {
            Choice::Picard
        }
    }
}

/// Whether Taylor series are right.
fn goes_by_series<D: MaybeJets<N>, const N: usize>(dynamics: &D) -> bool {
    <D::System as System<N>>::FACTS.smooth && dynamics.is_analytic()
}

impl<D: MaybeJets<N> + SideBySide<N>, const N: usize> Stepper<D, N> for Auto {
    const NAME: &'static str = "Auto";
    type Stages = AnyRoom<D, N>;

    fn goes_back(&self, dynamics: &D) -> bool {
        goes_by_series(dynamics)
    }

    fn room(&self, dynamics: &D) -> AnyRoom<D, N> {
        let (dop853, taylor) = (Dop853::stages(), Taylor::new().room(&Known(dynamics)));
        Room { choice: None, chosen_for: None, dop853, picard: Picard.room(dynamics), taylor }
    }

    fn name(&self, room: &AnyRoom<D, N>) -> &'static str {
        match room.choice {
            None => "Auto",
            Some(Choice::Dop853) => <Dop853 as Method>::NAME,
            Some(Choice::Picard) => <Picard as Stepper<D, N>>::NAME,
            Some(Choice::Srkn14a) => <Srkn14a as Method>::NAME,
            Some(Choice::Taylor) => <Taylor as Stepper<Known<'_, D>, N>>::NAME,
        }
    }

    #[inline]
    fn advance(
        &self,
        field: &mut Counted<'_, D>,
        span: &Span,
        from: &mut Node<D::Scalar, N>,
        room: &mut AnyRoom<D, N>,
    ) -> Node<D::Scalar, N> {
        room.chosen_for = None;
        if span.h < 0.0 {
            // The stages of the others would see a kink at the start from the wrong side.
            room.choice = Some(Choice::Taylor);
            let known = Known(field.dynamics);
            let mut series = Counted::new(&known);
            let to = Taylor::new().advance(&mut series, span, from, &mut room.taylor);
            field.evaluations += series.evaluations;
            to
        } else if <D::System as System<N>>::FACTS.velocity_free {
            room.choice = Some(Choice::Srkn14a);
            Symplectic.step(field, span, from, &mut ())
        } else {
            room.choice = Some(Choice::Dop853);
            Dop853.step(field, span, from, &mut room.dop853)
        }
    }

    fn within(
        &self,
        field: &mut Counted<'_, D>,
        span: &Span,
        from: &mut Node<D::Scalar, N>,
        to: &mut Node<D::Scalar, N>,
        room: &mut AnyRoom<D, N>,
    ) -> Piece<D::Scalar, N> {
        match room.choice {
            Some(Choice::Taylor) => Taylor::new().within(
                &mut Counted::new(&Known(field.dynamics)),
                span,
                from,
                to,
                &mut room.taylor,
            ),
            Some(Choice::Picard) => Picard.within(field, span, from, to, &mut room.picard),
            Some(Choice::Srkn14a) => Symplectic.dense(field, span, from, to, &mut ()),
            _ => Dop853.dense(field, span, from, to, &mut room.dop853),
        }
    }

    fn fault(
        &self,
        dynamics: &D,
        span: &Span,
        from: &Node<D::Scalar, N>,
        room: &AnyRoom<D, N>,
    ) -> Option<Error> {
        match room.choice {
            Some(Choice::Taylor) => Taylor::new().fault(&Known(dynamics), span, from, &room.taylor),
            Some(Choice::Picard) => Picard.fault(dynamics, span, from, &room.picard),
            Some(Choice::Srkn14a) => blame::fault(&Symplectic, dynamics, span, from, &()),
            _ => blame::fault(&Dop853, dynamics, span, from, &room.dop853),
        }
    }

    fn kink(&self, dynamics: &D, t: f64, backwards: bool) -> Option<f64> {
        if backwards { dynamics.last_kink(t) } else { dynamics.next_kink(t) }
    }
}

impl<D: MaybeJets<N> + SideBySide<N>, const N: usize> Control<Auto, D, N> for AdaptiveStep<N> {
    fn check(&self) -> Result<(), Error> {
        self.positive::<D::Scalar>()
    }

    fn least_steps(&self, length: f64) -> f64 {
        self.least_steps_over(length)
    }

    fn step(&self, memory: &mut Memory, course: Course<'_, '_, D, Auto, N>) -> Result<Span, Error> {
        let Course { field, from, to, stages: room, target, stats, .. } = course;
        let dynamics = field.dynamics;
        let backwards = target < from.t.to_f64();
        let (rtol, _) = self.tolerances::<D::Scalar>();
        if room.chosen_for != Some(rtol) || backwards && room.choice != Some(Choice::Taylor) {
            let choice = Auto::adaptive(dynamics, rtol, backwards);
            (room.choice, room.chosen_for) = (Some(choice), Some(rtol));
        }
        if room.choice == Some(Choice::Taylor) {
            let known = Known(dynamics);
            let mut series = Counted::new(&known);
            let stages = &mut room.taylor;
            let taken = Control::step(
                self,
                memory,
                Course {
                    method: &Taylor::new(),
                    field: &mut series,
                    from,
                    to,
                    stages,
                    target,
                    stats,
                },
            );
            field.evaluations += series.evaluations;
            return taken;
        }
        if room.choice == Some(Choice::Picard) {
            return Control::step(
                self,
                memory,
                Course {
                    method: &Picard,
                    field,
                    from,
                    to,
                    stages: &mut room.picard,
                    target,
                    stats,
                },
            );
        }
        Control::<Dop853, D, N>::check(self)?;
        Control::step(
            self,
            memory,
            Course { method: &Dop853, field, from, to, stages: &mut room.dop853, target, stats },
        )
    }
}

/// [`Srkn14a`] for systems of which only a value says that they are velocity-free.
#[derive(Clone, Copy, Debug)]
struct Symplectic;

impl Method for Symplectic {
    const NAME: &'static str = <Srkn14a as Method>::NAME;
    const ORDER: u32 = Srkn14a::ORDER;
    const DENSE_ORDER: u32 = Srkn14a::DENSE_ORDER;
    type Stages<T: Float, const N: usize> = ();

    fn stages<T: Float, const N: usize>() {}
}

impl<S: System<N, Scalar: Float>, const N: usize> Suits<S, N> for Symplectic {
    #[inline]
    fn step(
        &self,
        field: &mut impl Field<S, N>,
        span: &Span,
        from: &mut Node<S::Scalar, N>,
        (): &mut (),
    ) -> Node<S::Scalar, N> {
        drift_kick_drift_in_two_words(&srkn14a::SPLITTING, field, span, from)
    }
}

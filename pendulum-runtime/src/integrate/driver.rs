//! The loop that all ways of integrating share: one step at a time, onto kinks and over them.

use super::control::{Control, Course, Memory};
use super::field::{Counted, coordinate, first_in_inputs, first_in_state};
use super::method::{Method, Suits};
use super::node::Node;
use super::piece::Piece;
use super::solution::{State, Stats};
use super::span::Span;
use crate::error::{Error, Part};
use crate::motion::Side;
use crate::real::Float;
use crate::system::{Dynamics, Purpose, System};
use crate::time::Time;

/// An integration under way, apart from the dynamics.
#[derive(Clone, Debug)]
pub(crate) struct Driver<T: Float, const N: usize, M: Method, C> {
    pub(crate) method: M,
    pub(crate) control: C,
    /// The state reached; at a kink the one after it.
    pub(crate) node: Node<T, N>,
    pub(crate) stats: Stats,
    /// The last step and the node at its start; nothing before the first step.
    last: Option<Span>,
    from: Node<T, N>,
    /// The motion within it, once somebody has asked.
    within: Option<Piece<T, N>>,
    /// The node at its end before the kink, if it ended on one.
    before_kink: Option<Node<T, N>>,
    stages: M::Stages<T, N>,
    memory: Memory,
    /// The next kink, infinite if there is none.
    kink: f64,
}

impl<T: Float, const N: usize, M: Method, C> Driver<T, N, M, C> {
    /// At `q`, `v` and `t`, if they are finite.
    pub(crate) fn new<D: Dynamics<N, Scalar = T>>(
        dynamics: &D,
        method: M,
        control: C,
        t: f64,
        q: [T; N],
        v: [T; N],
    ) -> Result<Self, Error> {
        check_start::<D, T, N>(t, &q, &v)?;
        let node = Node::new(Time::new(t), q, v);
        let kink = next_kink(dynamics, t)?;
        let stats = Stats::new(M::NAME);
        let (stages, memory) = (M::stages(), Memory::default());
        Ok(Self { method, control, node, stats, last: None, from: node, within: None, before_kink: None, stages, memory, kink })
    }

    /// Puts the state elsewhere; counters and step size stay.
    pub(crate) fn reset<D: Dynamics<N, Scalar = T>>(&mut self, dynamics: &D, t: f64, q: [T; N], v: [T; N]) -> Result<(), Error> {
        check_start::<D, T, N>(t, &q, &v)?;
        self.kink = next_kink(dynamics, t)?;
        self.node = Node::new(Time::new(t), q, v);
        (self.last, self.within, self.before_kink) = (None, None, None);
        Ok(())
    }

    /// The same integration under another control.
    pub(crate) fn controlled<B>(self, control: B) -> Driver<T, N, M, B> {
        let Self { method, node, stats, last, from, within, before_kink, stages, kink, .. } = self;
        Driver { method, control, node, stats, last, from, within, before_kink, stages, memory: Memory::default(), kink }
    }

    /// Takes one step towards `target`, which may be infinite, and over a kink if it ends on one.
    ///
    /// On failure the state is the one before the step.
    #[inline]
    pub(crate) fn step<D: Dynamics<N, Scalar = T>>(&mut self, dynamics: &D, target: f64) -> Result<(), Error>
    where
        M: Suits<D::System, N>,
        C: Control<M, N>,
    {
        let target = if self.kink < target { self.kink } else { target };
        let mut field = Counted::new(dynamics);
        let mut from = self.node;
        let course = Course {
            method: &self.method,
            field: &mut field,
            from: &mut from,
            stages: &mut self.stages,
            target,
            stats: &mut self.stats,
        };
        let taken = self.control.step(&mut self.memory, course);
        self.stats.evaluations += field.evaluations;
        let (span, mut to) = taken?;
        if span.end == Time::new(self.kink) {
            let before = to;
            self.kink = cross(dynamics, &mut to)?;
            self.stats.kinks += 1;
            self.before_kink = Some(before);
        } else if self.before_kink.is_some() {
            self.before_kink = None;
        }
        (self.last, self.within) = (Some(span), None);
        self.from = from;
        self.node = to;
        Ok(())
    }

    /// The motion within the last step, if there was one; evaluates what the method needs for it.
    pub(crate) fn piece<D: Dynamics<N, Scalar = T>>(&mut self, dynamics: &D) -> Option<Piece<T, N>>
    where
        M: Suits<D::System, N>,
    {
        let span = self.last.as_ref()?;
        if self.within.is_some() {
            return self.within;
        }
        let to = self.before_kink.as_mut().unwrap_or(&mut self.node);
        let mut field = Counted::new(dynamics);
        let piece = self.method.dense(&mut field, span, &mut self.from, to, &mut self.stages);
        self.stats.evaluations += field.evaluations;
        self.within = Some(piece);
        self.within
    }

    /// The accelerations at the state reached; the next step begins with them.
    pub(crate) fn accelerations<D: Dynamics<N, Scalar = T>>(&mut self, dynamics: &D) -> [T; N] {
        let mut field = Counted::new(dynamics);
        let a = self.node.start_acceleration(&mut field);
        self.stats.evaluations += field.evaluations;
        a
    }

    /// The end of the last step; if that was on a kink, the states on both sides.
    pub(crate) fn ends(&self) -> (Node<T, N>, Option<Node<T, N>>) {
        self.before_kink.map_or((self.node, None), |before| (before, Some(self.node)))
    }

    /// Ends the last step at a state within.
    pub(crate) fn cut(&mut self, t: Time, state: &State<T, N>) {
        self.uncross();
        self.node = Node::new(t, state.q, state.v);
    }

    /// Takes the last step back.
    pub(crate) fn retreat(&mut self) {
        self.uncross();
        self.node = self.from;
        (self.last, self.within) = (None, None);
    }

    /// Forgets that the last step ended on a kink, and the plan that led there.
    fn uncross(&mut self) {
        self.memory.left = 0;
        if let Some(before) = self.before_kink.take() {
            self.kink = before.t.to_f64();
            self.stats.kinks -= 1;
        }
    }

    /// The state just before a kink, if the last step has ended on one.
    pub(crate) fn before_kink(&self) -> Option<&Node<T, N>> {
        self.before_kink.as_ref()
    }

    /// The time reached.
    pub(crate) fn t(&self) -> f64 {
        self.node.t.to_f64()
    }
}

/// Whether an integration can begin there.
fn check_start<D: Dynamics<N, Scalar = T>, T: Float, const N: usize>(t: f64, q: &[T; N], v: &[T; N]) -> Result<(), Error> {
    if !t.is_finite() {
        return Err(Error::Interval { start: t, end: t });
    }
    for (part, values) in [(Part::Position, q), (Part::Velocity, v)] {
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            let coordinate = coordinate(&<D::System as System<N>>::FACTS, index);
            return Err(Error::InitialState { part, coordinate, value: values[index].to_f64() });
        }
    }
    Ok(())
}

/// The first kink after `t`, infinite if there is none.
fn next_kink<D: Dynamics<N>, const N: usize>(dynamics: &D, t: f64) -> Result<f64, Error> {
    match dynamics.next_kink(t) {
        None => Ok(f64::INFINITY),
        Some(kink) if t < kink => Ok(kink),
        Some(kink) => Err(Error::Kink { t, kink }),
    }
}

/// Carries the velocities over the kink at `node.t` and returns the next kink.
fn cross<D: Dynamics<N, Scalar = T>, T: Float, const N: usize>(dynamics: &D, node: &mut Node<T, N>) -> Result<f64, Error> {
    let v = dynamics.across_kink(node.t, &node.q.high, &node.v.high);
    let facts = &<D::System as System<N>>::FACTS;
    if let Some(velocity) = first_in_state(facts, &node.q.high, &v) {
        let input = |side| first_in_inputs(facts, &dynamics.inputs(node.t, side, Purpose::Momenta));
        let what = input(Side::Before).or_else(|| input(Side::After)).unwrap_or(velocity);
        return Err(Error::NotFinite { t: node.t.to_f64(), what, suspects: Vec::new() });
    }
    for i in 0..N {
        // Where nothing jumps, the low words stay.
        if v[i] != node.v.high[i] {
            (node.v.high[i], node.v.low[i]) = (v[i], T::from_f64(0.0));
        }
    }
    node.a = None;
    next_kink(dynamics, node.t.to_f64())
}

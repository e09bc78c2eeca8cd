//! Rotations as products of factors, and space vectors that remember the rotations before them.
//!
//! A rotation is never multiplied out: R u costs a few operations for each factor of R, a matrix
//! would cost eighteen for each and hide that it is orthogonal. A vector keeps R and u apart until
//! components are needed, so that |R u|² is |u|², and |d(R p)/dt|² is |Ω × p|² with the rates Ω in
//! the frame behind R, in place of a polynomial in the entries of a matrix that would have to be
//! simplified to it.

use crate::algebra::expr::{Graph, Id, Symbol};
use crate::algebra::functions::Function;
use crate::algebra::number::Rational;
use crate::mechanics::quaternion::{self, Quaternion};

/// The components of a vector in one frame.
pub(super) type Parts = [Id; 3];

pub(super) const ZERO: Parts = [Graph::ZERO; 3];

/// The limit on the factors of a rotation, through which the functions below recurse.
pub(super) const MOST_FACTORS: usize = 256;

/// A rotation that is not a product of others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Turn {
    /// About an axis of length one.
    Axis { axis: Parts, angle: Id },
    /// By a unit quaternion, whose matrix is given row by row, or back, with the rates about the
    /// axes behind the turn forwards.
    Matrix { quaternion: Quaternion, entries: [Id; 9], rates: Parts, back: bool },
}

/// The product of turns, the outermost first.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Rotation(Vec<Turn>);

/// A space vector: its components in one frame, plus vectors in other frames, each with the turn
/// that leads there. Terms behind a common turn stay together.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Turned {
    own: Parts,
    behind: Vec<(Turn, Turned)>,
}

impl Turn {
    /// `axis` has length one.
    pub(super) fn about(graph: &mut Graph, axis: Parts, angle: Id) -> Self {
        // Turns about an axis of coordinates have one form, in which a turn and its inverse share
        // sine and cosine.
        let minus = graph.number(Rational::MINUS_ONE);
        let opposite = axis.map(|part| if part == minus { Graph::ONE } else { part });
        if basis(opposite).is_some() && opposite != axis {
            return Self::Axis { axis: opposite, angle: graph.negative(angle) };
        }
        Self::Axis { axis, angle }
    }

    pub(super) fn by_matrix(quaternion: Quaternion, entries: [Id; 9], rates: Parts) -> Self {
        Self::Matrix { quaternion, entries, rates, back: false }
    }

    /// Returns the turn of the rotation whose scalars begin with `first`.
    pub(super) fn by_symbols(graph: &mut Graph, first: usize) -> Self {
        let rates = [1, 2, 3].map(|part| graph.symbol(Symbol::Velocity(first + part)));
        let quaternion = [0, 1, 2, 3].map(|part| graph.symbol(Symbol::Coordinate(first + part)));
        let entries = core::array::from_fn(|entry| graph.symbol(Symbol::Entry(first, entry)));
        Self::by_matrix(quaternion, entries, rates)
    }

    fn quaternion(self, graph: &mut Graph) -> Quaternion {
        match self {
            Self::Axis { axis, angle } => {
                let half = graph.scale(Rational::HALF, angle);
                let sine = graph.call(Function::Sin, half);
                let [x, y, z] = scaled(graph, sine, axis);
                [graph.call(Function::Cos, half), x, y, z]
            }
            Self::Matrix { quaternion, back: true, .. } => quaternion::conjugate(graph, quaternion),
            Self::Matrix { quaternion, .. } => quaternion,
        }
    }

    /// Returns what the turn depends on.
    fn scalars(self) -> Vec<Id> {
        match self {
            Self::Axis { axis: [x, y, z], angle } => vec![x, y, z, angle],
            Self::Matrix { entries, .. } => entries.to_vec(),
        }
    }

    fn inverse(self, graph: &mut Graph) -> Self {
        match self {
            Self::Axis { axis, angle } => Self::Axis { axis, angle: graph.negative(angle) },
            Self::Matrix { quaternion, entries, rates, back } => {
                Self::Matrix { quaternion, entries, rates, back: !back }
            }
        }
    }

    fn apply(self, graph: &mut Graph, u: Parts) -> Parts {
        if u == ZERO {
            return u;
        }
        match self {
            Self::Axis { angle: Graph::ZERO, .. } => u,
            Self::Axis { axis, angle } => about_axis(graph, axis, angle, u),
            Self::Matrix { entries, back, .. } => by_matrix(graph, entries, back, u),
        }
    }

    /// Returns the rates in the frame behind the turn: Ω with d(R u)/dt = R (Ω × u) for constant u.
    fn rates(self, graph: &mut Graph, rate: &impl Fn(&mut Graph, Id) -> Id) -> Parts {
        let (axis, angle) = match self {
            Self::Axis { axis, angle } => (axis, angle),
            Self::Matrix { rates, back: false, .. } => return rates,
            Self::Matrix { entries, rates, .. } => {
                let rates = by_matrix(graph, entries, false, rates);
                return rates.map(|part| graph.negative(part));
            }
        };
        let speed = rate(graph, angle);
        let mut rates = scaled(graph, speed, axis);
        let moving = axis.map(|part| rate(graph, part));
        if moving != ZERO {
            // φ̇ n + ṅ sin φ − (1 − cos φ) n × ṅ
            let sine = graph.call(Function::Sin, angle);
            let cosine = graph.call(Function::Cos, angle);
            let rest = graph.sub(cosine, Graph::ONE);
            let across = cross(graph, axis, moving);
            for (parts, factor) in [(moving, sine), (across, rest)] {
                let parts = scaled(graph, factor, parts);
                rates = sum(graph, rates, parts);
            }
        }
        rates
    }

    /// Returns the rates behind the turn if the frame before it turns with `rates`.
    fn behind(
        self,
        graph: &mut Graph,
        rates: Parts,
        rate: &impl Fn(&mut Graph, Id) -> Id,
    ) -> Parts {
        let inverse = self.inverse(graph);
        let (outer, own) = (inverse.apply(graph, rates), self.rates(graph, rate));
        sum(graph, outer, own)
    }

    /// Returns `true` if the rates are the same before and behind the turn, because its axis rests.
    fn at_rest(self, graph: &mut Graph, rate: &impl Fn(&mut Graph, Id) -> Id) -> bool {
        match self {
            Self::Axis { axis, .. } => axis.iter().all(|&part| rate(graph, part) == Graph::ZERO),
            Self::Matrix { .. } => false,
        }
    }

    /// Returns `true` if a vector is its own image because it is parallel to an axis of coordinates
    /// about which this turns.
    fn keeps(self, u: Parts) -> bool {
        let Self::Axis { axis, .. } = self else { return false };
        let across = |k: usize| [(k + 1) % 3, (k + 2) % 3];
        basis(axis).is_some_and(|k| across(k).iter().all(|&i| u[i] == Graph::ZERO))
    }
}

impl Rotation {
    pub(super) fn of(turn: Turn) -> Self {
        Self(vec![turn])
    }

    /// Returns `true` if there is nothing but one turn by symbols.
    pub(super) fn is_one_matrix(&self) -> bool {
        matches!(self.0[..], [Turn::Matrix { .. }])
    }

    pub(super) fn factors(&self) -> usize {
        self.0.len()
    }

    /// Returns what the rotation consists of.
    pub(super) fn scalars(&self) -> Vec<Id> {
        self.0.iter().flat_map(|turn| turn.scalars()).collect()
    }

    /// Returns the product of two rotations. A factor beside its inverse goes.
    pub(super) fn times(mut self, graph: &mut Graph, other: &Self) -> Self {
        for &turn in &other.0 {
            match self.0.last() {
                Some(last) if last.inverse(graph) == turn => _ = self.0.pop(),
                _ => self.0.push(turn),
            }
        }
        self
    }

    pub(super) fn inverse(&self, graph: &mut Graph) -> Self {
        Self(self.0.iter().rev().map(|turn| turn.inverse(graph)).collect())
    }

    /// Returns the rotation with its longest beginning among `known` as one turn.
    pub(super) fn shortened(&self, known: &[(Self, Turn)]) -> Self {
        let beginning = known.iter().filter(|(own, _)| self.0.starts_with(&own.0));
        let Some((own, turn)) = beginning.max_by_key(|(own, _)| own.0.len()) else {
            return self.clone();
        };
        Self([&[*turn], &self.0[own.0.len()..]].concat())
    }

    /// Returns the entries of its matrix, row by row.
    pub(super) fn entries(&self, graph: &mut Graph) -> [Id; 9] {
        let columns = [0, 1, 2].map(|k| {
            let mut axis = ZERO;
            axis[k] = Graph::ONE;
            self.0.iter().rev().fold(axis, |image, turn| turn.apply(graph, image))
        });
        core::array::from_fn(|entry| columns[entry % 3][entry / 3])
    }

    /// Returns the rates in the frame behind the rotation.
    pub(super) fn rates(&self, graph: &mut Graph, rate: &impl Fn(&mut Graph, Id) -> Id) -> Parts {
        self.0.iter().fold(ZERO, |rates, &turn| turn.behind(graph, rates, rate))
    }

    /// Returns its unit quaternion.
    pub(super) fn quaternion(&self, graph: &mut Graph) -> Quaternion {
        let identity = [Graph::ONE, Graph::ZERO, Graph::ZERO, Graph::ZERO];
        self.0.iter().fold(identity, |product, turn| {
            let own = turn.quaternion(graph);
            quaternion::product(graph, Rational::ONE, product, own)
        })
    }

    /// Returns the image of a vector.
    pub(super) fn apply(&self, graph: &mut Graph, vector: Turned) -> Turned {
        self.0.iter().rev().fold(vector, |vector, &turn| vector.turned(graph, turn))
    }

    /// Returns the angular velocity, by ω(A B) = ω(A) + A ω(B).
    pub(super) fn angular_velocity(
        &self,
        graph: &mut Graph,
        rate: &impl Fn(&mut Graph, Id) -> Id,
    ) -> Turned {
        self.0.iter().rev().fold(Turned::from(ZERO), |inner, &turn| {
            let rates = turn.rates(graph, rate);
            if turn.at_rest(graph, rate) {
                let inner = inner.turned(graph, turn);
                return inner.plus(graph, &Turned::from(rates));
            }
            let inner = inner.plus(graph, &Turned::from(rates));
            inner.turned(graph, turn)
        })
    }
}

impl From<Parts> for Turned {
    fn from(own: Parts) -> Self {
        Self { own, behind: Vec::new() }
    }
}

impl Turned {
    /// Returns what the vector consists of.
    pub(super) fn scalars(&self) -> Vec<Id> {
        let behind = self
            .behind
            .iter()
            .flat_map(|&(turn, ref vector)| turn.scalars().into_iter().chain(vector.scalars()));
        self.own.into_iter().chain(behind).collect()
    }

    /// Returns the components of a vector without turns.
    pub(super) fn whole(&self) -> Option<Parts> {
        self.behind.is_empty().then_some(self.own)
    }

    pub(super) fn components(&self, graph: &mut Graph) -> Parts {
        let images = self.images(graph);
        [0, 1, 2].map(|k| graph.total([&self.own].into_iter().chain(&images).map(|part| part[k])))
    }

    /// Returns the components of the parts behind each turn.
    fn images(&self, graph: &mut Graph) -> Vec<Parts> {
        let image = |(turn, vector): &(Turn, Self)| {
            let components = vector.components(graph);
            turn.apply(graph, components)
        };
        self.behind.iter().map(image).collect()
    }

    /// Applies a linear function of scalars.
    pub(super) fn map(self, graph: &mut Graph, map: &mut impl FnMut(&mut Graph, Id) -> Id) -> Self {
        let own = self.own.map(|part| map(graph, part));
        let behind = self.behind.into_iter();
        let behind = behind.map(|(turn, vector)| (turn, vector.map(graph, map))).collect();
        Self { own, behind }
    }

    pub(super) fn plus(mut self, graph: &mut Graph, other: &Self) -> Self {
        self.own = sum(graph, self.own, other.own);
        for (turn, vector) in &other.behind {
            match self.behind.iter_mut().find(|(own, _)| own == turn) {
                Some((_, own)) => {
                    *own = std::mem::replace(own, Self::from(ZERO)).plus(graph, vector);
                }
                None => self.behind.push((*turn, vector.clone())),
            }
        }
        self.behind.retain(|(_, vector)| *vector != Self::from(ZERO));
        self
    }

    fn turned(mut self, graph: &mut Graph, turn: Turn) -> Self {
        let inverse = turn.inverse(graph);
        let mut result = Self::from(ZERO);
        if let Some(place) = self.behind.iter().position(|(own, _)| *own == inverse) {
            result = self.behind.remove(place).1;
        }
        if turn.keeps(self.own) {
            let own = std::mem::replace(&mut self.own, ZERO);
            result = result.plus(graph, &Self::from(own));
        }
        if self == Self::from(ZERO) {
            return result;
        }
        result.plus(graph, &Self { own: ZERO, behind: vec![(turn, self)] })
    }

    /// Returns the time derivative in a frame that turns with `rates`, which leads to R (Ω × u + u̇)
    /// for R u.
    pub(super) fn derivative(
        &self,
        graph: &mut Graph,
        rates: Parts,
        rate: &impl Fn(&mut Graph, Id) -> Id,
    ) -> Self {
        let across = cross(graph, rates, self.own);
        let own = self.own.map(|part| rate(graph, part));
        let mut result = Self::from(sum(graph, across, own));
        for (turn, vector) in &self.behind {
            let rates = turn.behind(graph, rates, rate);
            let behind = vec![(*turn, vector.derivative(graph, rates, rate))];
            result = result.plus(graph, &Self { own: ZERO, behind });
        }
        result
    }

    /// Returns two vectors without the turns that stand before all of both, and these turns.
    pub(super) fn common(a: &Self, b: &Self) -> (Self, Self, Rotation) {
        let (mut a, mut b, mut turns) = (a, b, Vec::new());
        while let (ZERO, ZERO, [(turn, inner)], [(other, own)]) =
            (a.own, b.own, &*a.behind, &*b.behind)
            && turn == other
        {
            turns.push(*turn);
            (a, b) = (inner, own);
        }
        (a.clone(), b.clone(), Rotation(turns))
    }

    /// Returns the inner product as a sum over pairs of terms. In rates it shows which terms do not
    /// depend on the attitude. A difference of positions would lose digits by it.
    pub(super) fn inner_by_terms(graph: &mut Graph, a: &Self, b: &Self) -> Id {
        let terms: Vec<Id> =
            Self::pairs(graph, a, b).iter().map(|(a, b)| graph.inner(a, b)).collect();
        graph.total(terms)
    }

    /// Returns pairs of terms, each in a common frame, whose inner products add up to that of both
    /// vectors.
    pub(super) fn pairs(graph: &mut Graph, a: &Self, b: &Self) -> Vec<(Parts, Parts)> {
        let (left, right) = (a.images(graph), b.images(graph));
        let mut pairs = vec![(a.own, b.own)];
        pairs.extend(right.iter().map(|&image| (a.own, image)));
        for ((turn, vector), &image) in a.behind.iter().zip(&left) {
            pairs.push((image, b.own));
            for ((other, own), &image_of_other) in b.behind.iter().zip(&right) {
                if turn == other {
                    pairs.extend(Self::pairs(graph, vector, own));
                } else {
                    pairs.push((image, image_of_other));
                }
            }
        }
        pairs
    }
}

/// Returns u cos φ + n × u sin φ + (1 − cos φ) (n·u) n.
fn about_axis(graph: &mut Graph, axis: Parts, angle: Id, u: Parts) -> Parts {
    let sine = graph.call(Function::Sin, angle);
    let cosine = graph.call(Function::Cos, angle);
    if let Some(k) = basis(axis) {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let mut turned = u;
        let (a, b) = (graph.mul(cosine, u[i]), graph.mul(sine, u[j]));
        turned[i] = graph.sub(a, b);
        let (a, b) = (graph.mul(sine, u[i]), graph.mul(cosine, u[j]));
        turned[j] = graph.add(a, b);
        return turned;
    }
    let across = cross(graph, axis, u);
    let along = graph.inner(&axis, &u);
    let rest = graph.sub(Graph::ONE, cosine);
    let along = graph.mul(rest, along);
    [0, 1, 2].map(|k| graph.inner(&[cosine, sine, along], &[u[k], across[k], axis[k]]))
}

fn by_matrix(graph: &mut Graph, entries: [Id; 9], back: bool, u: Parts) -> Parts {
    [0, 1, 2].map(|i| {
        let row = [0, 1, 2].map(|j| entries[if back { 3 * j + i } else { 3 * i + j }]);
        graph.inner(&row, &u)
    })
}

/// Returns the index of the axis of coordinates.
fn basis(axis: Parts) -> Option<usize> {
    let place = axis.iter().position(|&part| part == Graph::ONE)?;
    let alone = (0..3).all(|k| k == place || axis[k] == Graph::ZERO);
    alone.then_some(place)
}

fn sum(graph: &mut Graph, a: Parts, b: Parts) -> Parts {
    [0, 1, 2].map(|k| graph.add(a[k], b[k]))
}

fn scaled(graph: &mut Graph, factor: Id, parts: Parts) -> Parts {
    parts.map(|part| graph.mul(factor, part))
}

pub(super) fn cross(graph: &mut Graph, a: Parts, b: Parts) -> Parts {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| {
        let (first, second) = (graph.mul(a[i], b[j]), graph.mul(a[j], b[i]));
        graph.sub(first, second)
    })
}

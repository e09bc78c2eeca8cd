//! The frames of vectors in space, inferred from the rotations between them.
//!
//! A rotation leads from components along its own axes to others, which are those in space unless
//! the rotation stands behind another one. `A*B` and `A*u` need what A starts from; the terms of a
//! sum and the arguments of `inner` and `cross` have one frame. Each such equation makes two frames
//! one. Equations between two frames that a rotation keeps apart are reported.
//!
//! What consists of parameters and numbers alone stands in any number of frames: a parameter
//! `n: [1; 3]` may be an axis both in space and of a body, and a fixed tilt may belong to two
//! wheels. A vector that moves has one frame, which is unknown until it is used. A rotation about
//! an axis by one angle starts anew wherever it is used, because several joints may turn by one
//! angle, and its angular velocity has equal components on both sides. Products of such rotations,
//! as of the three angles of a body, keep frames apart once they have a name.

mod frames;
mod infer;

use super::resolved::{Element, Meaning, Model};
use crate::messages::{Errors, message};
use crate::syntax::ast::{Binder, Expr, Force, Slip};
use crate::syntax::text::{term, text};
use frames::{Frame, Frames, SPACE, inverse};
use infer::{Rotation, Value};
use std::collections::{BTreeMap, BTreeSet};

/// Checks a block without mistakes.
pub(crate) fn check(model: &Model, errors: &mut Errors) {
    if !errors.is_empty() {
        return;
    }
    let mut scan = Scan {
        model,
        frames: Frames::new(),
        quantities: BTreeMap::new(),
        scope: Vec::new(),
        lets: BTreeMap::new(),
        depth: 0,
        work: 0,
        late: false,
        equations: Vec::new(),
        uses: Vec::new(),
    };
    scan.declare();
    scan.block();
    scan.solve(errors);
    scan.check_uses(errors);
}

/// What makes two frames one, the strongest first: a sum that contradicts a product or a height is
/// the mistake, wherever it is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Evidence {
    Product,
    Height,
    /// A definition, which gives a rotation a name.
    Name,
    Sum,
}

/// What needs components along the axes of a frame.
enum Needs<'a> {
    /// A sum with this term, or another expression of vectors with one frame.
    Beside(&'a Expr),
    /// The rotations before a vector or, with its frame behind it, a rotation.
    Before(Vec<&'a Expr>, Option<(Rotation, Rotation)>),
    Height,
    Force(&'a Force),
    /// Nothing: the frames are those of a rotation with this name.
    Name(String),
}

/// The frame of an expression and the one that is needed.
struct Equation<'a> {
    own: Frame,
    needed: Frame,
    item: &'a Expr,
    needs: Needs<'a>,
    /// `true` for statements other than energies, which yield to these.
    late: bool,
    evidence: Evidence,
}

/// The use of a solid or a matrix along the axes of a frame.
struct Use<'a> {
    parameter: usize,
    frame: Frame,
    /// What has these components, and `true` if the matrix multiplies it.
    text: String,
    multiplied: bool,
    item: &'a Expr,
}

/// The meaning of a local name.
enum Local {
    Value(Value),
    Index(i64),
}

struct Scan<'m, 'a> {
    model: &'m Model<'a>,
    frames: Frames,
    /// The values of coordinates and inputs.
    quantities: BTreeMap<Meaning, Value>,
    scope: Vec<(String, Local)>,
    /// The values of definitions, by index and member.
    lets: BTreeMap<(usize, Option<i64>), Value>,
    /// The number of expressions under evaluation, and of all evaluations.
    depth: usize,
    work: usize,
    late: bool,
    equations: Vec<Equation<'a>>,
    uses: Vec<Use<'a>>,
}

impl<'a> Scan<'_, 'a> {
    /// Gives a frame to each vector that moves, and two to each rotation.
    fn declare(&mut self) {
        let coordinates = (0..self.model.coordinates.len()).map(Meaning::Coordinate);
        let inputs = (0..self.model.inputs.len()).map(Meaning::Input);
        let quantities = self.model.coordinates.iter().chain(&self.model.inputs);
        for (meaning, quantity) in coordinates.chain(inputs).zip(quantities) {
            let mut member = |name: String| match quantity.element {
                Element::Vector(3) => Value::Vector(self.frames.unknown(), false),
                Element::Rotation => {
                    let ends = [(); 2].map(|()| self.frames.unknown());
                    self.frames.link(name, ends);
                    Value::Rotation(Rotation::declared(ends))
                }
                _ => Value::Plain(false),
            };
            let name = quantity.name;
            let value = match quantity.members {
                None => member(name.to_string()),
                Some(count) => {
                    Value::Family((0..count).map(|k| member(format!("{name}[{k}]"))).collect())
                }
            };
            self.quantities.insert(meaning, value);
        }
    }

    fn block(&mut self) {
        // The pattern has no `..`, so that every field of the model is considered here.
        let Model {
            lets,
            of_outputs,
            energies,
            forces,
            rates,
            constraints,
            limits,
            frictions,
            outputs,
            parameters: _,
            coordinates: _,
            mechanical: _,
            inputs: _,
            block: _,
            driven: _,
            names: _,
            tables: _,
            unmentioned: _,
            unused: _,
        } = self.model;
        // Definitions in order, so that nesting stays flat.
        for index in (0..lets.len()).filter(|index| !of_outputs.contains(index)) {
            if lets[index].arguments.is_none() {
                self.each(lets[index].index.as_ref(), |scan, k| _ = scan.definition(index, k));
            }
        }
        for &(_, expr) in energies {
            self.expr(expr);
        }
        self.late = true;
        for own in constraints {
            self.each(own.index.as_ref(), |scan, _| _ = scan.expr(&own.difference));
        }
        for own in limits {
            self.each(own.index.as_ref(), |scan, _| _ = scan.expr(&own.difference));
        }
        for own in frictions {
            let Slip { rate, force, bound } = own.slip;
            self.each(own.index, |scan, _| {
                for expr in [rate, force].into_iter().chain(bound) {
                    scan.expr(expr);
                }
            });
        }
        for own in forces {
            self.each(own.index.as_ref(), |scan, _| scan.force(own));
        }
        for own in rates {
            self.each(own.index.as_ref(), |scan, _| scan.rate(own));
        }
        for own in outputs.iter().map(|output| output.statement) {
            self.each(own.index.as_ref(), |scan, _| _ = scan.expr(&own.expr));
        }
    }

    /// Evaluates for each index of a family.
    fn each(&mut self, index: Option<&Binder>, evaluate: impl Fn(&mut Self, Option<i64>)) {
        let Some(binder) = index else { return evaluate(self, None) };
        for k in self.range(binder) {
            self.bind(binder, k);
            evaluate(self, Some(k));
            self.scope.pop();
        }
    }

    fn force(&mut self, force: &'a Force) {
        let needed = match self.expr(&force.point) {
            Value::Rotation(rotation) if !rotation.is_single() => rotation.ends[0],
            Value::Vector(frame, _) => frame,
            _ => return,
        };
        if let Value::Vector(own, _) = self.expr(&force.expr) {
            self.equation(own, needed, &force.expr, Evidence::Sum, Needs::Force(force));
        }
    }

    fn rate(&mut self, rate: &'a Force) {
        if let (Value::Vector(needed, _), Value::Vector(own, _)) =
            (self.expr(&rate.point), self.expr(&rate.expr))
        {
            let needs = Needs::Beside(&rate.point);
            self.equation(own, needed, &rate.expr, Evidence::Sum, needs);
        }
    }

    fn equation(
        &mut self,
        own: Frame,
        needed: Frame,
        item: &'a Expr,
        evidence: Evidence,
        needs: Needs<'a>,
    ) {
        let late = self.late;
        self.equations.push(Equation { own, needed, item, needs, late, evidence });
    }

    /// Makes frames one, and reports those that are different.
    fn solve(&mut self, errors: &mut Errors) {
        let mut equations = std::mem::take(&mut self.equations);
        equations.sort_by_key(|own| (own.late, own.evidence));
        let (mut anchored, mut reported) = (false, BTreeSet::new());
        for Equation { own, needed, item, needs, late, evidence } in equations {
            if late && evidence == Evidence::Sum && !anchored {
                self.frames.anchor();
                anchored = true;
            }
            if let Needs::Name(name) = needs {
                self.frames.link(name, [own, needed]);
            } else if !self.frames.join(own, needed) {
                // The frame of what contains a mistake is not what the user means.
                let first = if let Needs::Beside(first) = needs { Some(first) } else { None };
                if !first.into_iter().chain([item]).any(|expr| contains(expr, &reported)) {
                    self.report(own, needed, item, &needs, errors);
                }
                reported.insert(item.source);
            }
        }
        self.frames.anchor();
    }

    fn report(&self, own: Frame, needed: Frame, item: &Expr, needs: &Needs, errors: &mut Errors) {
        let frames = &self.frames;
        let mut instead = frames.led(&[], [own, needed], &term(item));
        let mut has = "has";
        let who = match needs {
            Needs::Beside(first) => {
                let other = frames.led(&[], [needed, own], &term(first));
                let first = text(first);
                instead = format!("{instead}`, or `{other}` in place of `{first}");
                format!("`{first}` has components")
            }
            Needs::Before(factors, rotations) => {
                let factors: Vec<_> = factors.iter().map(|factor| text(factor)).collect();
                let (start, found) = (factors.join("*"), text(item));
                instead = frames.led(&factors, [own, needed], &term(item));
                if let Some((outer, inner)) = rotations {
                    has = "leads to";
                    if frames.are_same(inner.ends[1], outer.ends[0]) {
                        instead = format!("{found}*{start}");
                    } else if frames.are_same(own, outer.ends[0]) && start != found {
                        instead = format!("{}*{found}", inverse(&start));
                    }
                }
                format!("`{start}` turns vectors with components")
            }
            Needs::Force(Force { torque: true, point, .. }) => {
                format!("a torque on `{}` has components", text(point))
            }
            Needs::Force(force) => format!("a force on `{}` has components", text(&force.point)),
            Needs::Height | Needs::Name(_) => {
                instead = format!("height({instead})`, or `inner([0, 0, 1], {})", text(item));
                "a height is a component".to_owned()
            }
        };
        let [own, needed] = [own, needed].map(|frame| frames.place(frame));
        let message = message!(
            "`{}` {has} components {own}, but {who} {needed}; write `{instead}`",
            text(item)
        );
        errors.once(item.source, item.range, message);
    }

    /// Reports solids and matrices that are used both in space and along the axes of a body.
    /// Several bodies may share one.
    fn check_uses(&self, errors: &mut Errors) {
        let (uses, frames) = (&self.uses, &self.frames);
        for own in uses {
            let body = uses.iter().map(|other| (other.parameter, other.frame)).find(|other| {
                other.0 == own.parameter
                    && !frames.are_same(other.1, SPACE)
                    && frames.are_chained(other.1, SPACE)
            });
            let (Some((parameter, body)), true) = (body, frames.are_same(own.frame, SPACE)) else {
                continue;
            };
            let ends = if own.multiplied { [SPACE, body] } else { [body, SPACE] };
            let (found, name) = (&own.text, self.model.parameters[parameter].name);
            let (place, instead) = (frames.place(body), frames.led(&[], ends, found));
            let message = message!(
                "`{found}` has components in space here, but `{name}` has components {place} \
                 elsewhere; write `{instead}`"
            );
            errors.once(own.item.source, own.item.range, message);
        }
    }
}

/// Returns `true` if one of `sources` is an expression or a part of it.
fn contains(expr: &Expr, sources: &BTreeSet<usize>) -> bool {
    sources.contains(&expr.source) || expr.parts().into_iter().any(|part| contains(part, sources))
}

//! Evaluation of the generator's expressions, without the macro.

use super::nilpotent::{Function, Nilpotent};
use super::tree::{Expr, Index, Kind, Operation, Property, Shape, System};
use pendulum_runtime::scalar::Float;

/// The components of a scalar, a plane vector or a space vector.
type Value<T> = Vec<Nilpotent<T>>;

/// A body as point masses, over which integrals are sums.
#[derive(Clone, Debug)]
pub struct Points<T>(pub Vec<(T, [T; 2])>);

/// The constants.
#[derive(Clone, Debug)]
pub struct Constants<T> {
    /// All scalars of the parameters, in order.
    pub parameters: Vec<T>,
    /// The body of each parameter that is a body.
    pub bodies: Vec<Option<Points<T>>>,
}

/// The variables and their rates, all with the same infinitesimals.
#[derive(Clone, Debug)]
pub struct Leaves<T> {
    pub time: Nilpotent<T>,
    pub q: Vec<Nilpotent<T>>,
    pub v: Vec<Nilpotent<T>>,
    pub a: Vec<Nilpotent<T>>,
    /// For each driven input and component, the value and its derivatives up to the third.
    pub inputs: Vec<Vec<[Nilpotent<T>; 4]>>,
}

impl<T: Float> Leaves<T> {
    /// Returns the variables at a later time: each variable plus its rate times a new
    /// infinitesimal.
    pub fn later(&self) -> Self {
        let zero = Nilpotent::constant(T::from_f64(0.0), self.time.infinitesimals());
        let one = Nilpotent::constant(T::from_f64(1.0), self.time.infinitesimals());
        let join = |value: &Nilpotent<T>, rate: &Nilpotent<T>| value.clone().join(rate.clone());
        let all = |values: &[Nilpotent<T>], rates: &[Nilpotent<T>]| -> Vec<_> {
            values.iter().zip(rates).map(|(value, rate)| join(value, rate)).collect()
        };
        let input =
            |[x, v, a, j]: &[Nilpotent<T>; 4]| [join(x, v), join(v, a), join(a, j), join(j, &zero)];
        Self {
            time: join(&self.time, &one),
            q: all(&self.q, &self.v),
            v: all(&self.v, &self.a),
            a: all(&self.a, &vec![zero.clone(); self.a.len()]),
            inputs: self.inputs.iter().map(|parts| parts.iter().map(input).collect()).collect(),
        }
    }

    /// Returns the variables with a new infinitesimal whose coefficients are zero.
    pub fn widened(&self) -> Self {
        let mut wide = self.later();
        let inputs = wide.inputs.iter_mut().flatten().flatten();
        let motions = wide.q.iter_mut().chain(&mut wide.v).chain(&mut wide.a);
        for Nilpotent(coefficients) in motions.chain(inputs).chain([&mut wide.time]) {
            let half = coefficients.len() / 2;
            coefficients[half..].fill(T::from_f64(0.0));
        }
        wide
    }
}

/// The indices and arguments in scope.
#[derive(Clone, Debug)]
struct Scope<'s, T> {
    indices: Vec<(usize, usize)>,
    arguments: Option<(&'s [Expr], &'s Scope<'s, T>)>,
    point: Option<[T; 2]>,
}

impl<T> Scope<'_, T> {
    /// Creates the scope of an expression in which the outermost index may be bound.
    fn new(index: Option<usize>) -> Self {
        let indices = index.map(|k| (0, k)).into_iter().collect();
        Self { indices, arguments: None, point: None }
    }

    fn bound(&self, index: usize) -> usize {
        self.indices.iter().rev().find(|(own, _)| *own == index).expect("an index is bound").1
    }

    fn place(&self, index: Index) -> usize {
        match index {
            Index::Number(number) => number,
            Index::Bound(index) => self.bound(index),
            Index::Reversed(index, count) => count - 1 - self.bound(index),
        }
    }
}

/// What expressions are evaluated with, apart from the variables.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Evaluator<'s, T> {
    pub(crate) system: &'s System,
    pub(crate) constants: &'s Constants<T>,
}

impl<T: Float> Evaluator<'_, T> {
    /// Evaluates a scalar in which the outermost index may be bound.
    pub(crate) fn indexed(
        &self,
        expr: &Expr,
        leaves: &Leaves<T>,
        index: Option<usize>,
    ) -> Nilpotent<T> {
        self.scalar(expr, leaves, &Scope::new(index))
    }

    fn scalar(&self, expr: &Expr, leaves: &Leaves<T>, scope: &Scope<'_, T>) -> Nilpotent<T> {
        let mut parts = self.value(expr, leaves, scope);
        assert_eq!(parts.len(), 1, "{expr:?} is {parts:?}");
        parts.remove(0)
    }

    fn value(&self, expr: &Expr, leaves: &Leaves<T>, scope: &Scope<'_, T>) -> Value<T> {
        let depth = leaves.time.infinitesimals();
        let constant = |value: T| Nilpotent::constant(value, depth);
        let whole = |value: f64| constant(T::from_f64(value));
        let scalar = |expr: &Expr| self.scalar(expr, leaves, scope);
        let value = |expr: &Expr| self.value(expr, leaves, scope);
        let coordinate = |index: usize, member: Option<Index>| {
            self.system.first_coordinate(index) + member.map_or(0, |member| scope.place(member))
        };
        vec![match expr {
            Expr::Number(top, bottom) => {
                constant(T::from_f64(*top as f64) / T::from_f64(*bottom as f64))
            }
            Expr::Pi => constant(T::pi()),
            Expr::Imaginary => return vec![whole(0.0), whole(1.0)],
            Expr::Time => leaves.time.clone(),
            Expr::Parameter(index) => {
                let components = match self.system.parameters[*index].kind {
                    Kind::Vector(count) => count,
                    _ => 1,
                };
                let own = &self.constants.parameters[self.system.first_parameter(*index)..];
                return own[..components].iter().copied().map(constant).collect();
            }
            Expr::Member(index, member) => {
                let first = self.system.first_parameter(*index);
                constant(self.constants.parameters[first + scope.place(*member)])
            }
            Expr::Property(index, property) => {
                let property = self.property(*index, *property);
                return property.into_iter().map(constant).collect();
            }
            Expr::Coordinate(index, member) => leaves.q[coordinate(*index, *member)].clone(),
            Expr::Velocity(index, member, _) => leaves.v[coordinate(*index, *member)].clone(),
            Expr::Input(index, order) => {
                return leaves.inputs[*index].iter().map(|orders| orders[*order].clone()).collect();
            }
            Expr::Sum(items) => {
                let items = items.iter().map(|(minus, item)| {
                    let item = value(item);
                    if *minus { map(&item, Nilpotent::neg) } else { item }
                });
                return total(items);
            }
            Expr::Product(items) => {
                return items.iter().fold(vec![whole(1.0)], |product, (over, item)| {
                    let item = value(item);
                    multiply(&product, &if *over { reciprocal(&item) } else { item })
                });
            }
            Expr::Negative(inner) => return map(&value(inner), Nilpotent::neg),
            Expr::Power(base, top, bottom) => match &value(base)[..] {
                [base] => base.rational_power(*top, *bottom),
                // Among vectors, only complex numbers have integer powers.
                complex => {
                    let one = vec![whole(1.0), whole(0.0)];
                    return (0..*top).fold(one, |power, _| multiply(&power, complex));
                }
            },
            Expr::Vector(items) => return items.iter().map(scalar).collect(),
            Expr::Call(function, inner) => scalar(inner).call(*function),
            Expr::Of(operation, items) => return self.operation(*operation, items, leaves, scope),
            Expr::Component(a, component) => value(a)[*component].clone(),
            Expr::Cis(angle, _) => {
                let angle = scalar(angle);
                return vec![angle.call(Function::Cos), angle.call(Function::Sin)];
            }
            Expr::Let(index) => return self.definition(*index, None, leaves),
            Expr::LetDot(index) => {
                let later = self.definition(*index, None, &leaves.later());
                return map(&later, |part| part.split().1);
            }
            Expr::LetMember(index, member) => {
                return self.definition(*index, Some(scope.place(*member)), leaves);
            }
            Expr::Apply(index, arguments) => {
                let inner = Scope { arguments: Some((arguments, scope)), ..Scope::new(None) };
                return self.value(&self.system.lets[*index].expr, leaves, &inner);
            }
            Expr::Argument(index) => {
                let (arguments, outer) = scope.arguments.expect("an argument stands in a function");
                return self.value(&arguments[*index], leaves, outer);
            }
            Expr::Bound(index) => whole(scope.bound(*index) as f64),
            Expr::Over(index, count, _, term) => {
                return total((0..*count).map(|k| {
                    let mut inner = scope.clone();
                    inner.indices.push((*index, k));
                    self.value(term, leaves, &inner)
                }));
            }
            Expr::Integral(body, integrand) => {
                return total(self.points(*body).iter().map(|&(weight, point)| {
                    let inner = Scope { point: Some(point), ..scope.clone() };
                    let weight = constant(weight);
                    map(&self.value(integrand, leaves, &inner), |part| part.mul(&weight))
                }));
            }
            Expr::Point => {
                let point = scope.point.expect("a point stands in an integral");
                return point.map(constant).to_vec();
            }
        }]
    }

    /// Evaluates a function of several numbers or of vectors.
    fn operation(
        &self,
        operation: Operation,
        items: &[Expr],
        leaves: &Leaves<T>,
        scope: &Scope<'_, T>,
    ) -> Value<T> {
        if operation == Operation::Dot {
            // The total derivative with respect to time.
            let later = self.value(&items[0], &leaves.later(), scope);
            return map(&later, |part| part.split().1);
        }
        let items: Vec<_> = items.iter().map(|item| self.value(item, leaves, scope)).collect();
        let (a, b) = (&items[0], &items[items.len() - 1]);
        let minor = |i: usize, j: usize| a[i].mul(&b[j]).sub(&a[j].mul(&b[i]));
        match operation {
            Operation::Cross if a.len() == 3 => vec![minor(1, 2), minor(2, 0), minor(0, 1)],
            Operation::Cross => vec![minor(0, 1)],
            Operation::Perp => vec![a[1].neg(), a[0].clone()],
            Operation::Height => vec![a[a.len() - 1].clone()],
            Operation::Inner => vec![dot_product(a, b)],
            Operation::Magnitude if a.len() == 1 => vec![a[0].call(Function::Abs)],
            Operation::Magnitude => vec![dot_product(a, a).call(Function::Sqrt)],
            Operation::Atan2 => vec![a[0].atan2(&b[0])],
            Operation::Max => vec![a[0].max(&b[0])],
            Operation::Min => vec![a[0].min(&b[0])],
            Operation::Power => vec![a[0].power(&b[0])],
            Operation::Dot => unreachable!("it is evaluated at a later time"),
        }
    }

    fn definition(&self, index: usize, member: Option<usize>, leaves: &Leaves<T>) -> Value<T> {
        let definition = &self.system.lets[index];
        assert_eq!(matches!(definition.shape, Shape::Indexed(_)), member.is_some());
        self.value(&definition.expr, leaves, &Scope::new(member))
    }

    fn points(&self, body: usize) -> &[(T, [T; 2])] {
        &self.constants.bodies[body].as_ref().expect("a body has points").0
    }

    fn property(&self, index: usize, property: Property) -> Vec<T> {
        let moments = &self.constants.parameters[self.system.first_parameter(index)..];
        match property {
            Property::Mass => vec![moments[0]],
            Property::Center => moments[1..3].to_vec(),
            // The moment of inertia about the pivot.
            Property::Inertia => {
                let parts = self.points(index).iter().map(|&(w, [x, y])| w * (x * x + y * y));
                vec![parts.reduce(|a, b| a + b).expect("a body has points")]
            }
        }
    }
}

fn map<T: Float>(value: &[Nilpotent<T>], map: impl Fn(&Nilpotent<T>) -> Nilpotent<T>) -> Value<T> {
    value.iter().map(map).collect()
}

/// Returns the sum of at least one value. Only the real part of a complex number takes a real number.
fn total<T: Float>(values: impl Iterator<Item = Value<T>>) -> Value<T> {
    let add = |a: Value<T>, b: Value<T>| {
        let (mut long, short) = if a.len() < b.len() { (b, a) } else { (a, b) };
        assert!(short.len() == long.len() || [short.len(), long.len()] == [1, 2]);
        for (a, b) in long.iter_mut().zip(&short) {
            *a = a.add(b);
        }
        long
    };
    values.reduce(add).expect("a sum of something")
}

/// Multiplies a scalar by any value, or two complex numbers.
fn multiply<T: Float>(a: &[Nilpotent<T>], b: &[Nilpotent<T>]) -> Value<T> {
    match (a, b) {
        ([a], b) => map(b, |b| a.mul(b)),
        (a, [b]) => map(a, |a| a.mul(b)),
        ([a, b], [c, d]) => vec![a.mul(c).sub(&b.mul(d)), a.mul(d).add(&b.mul(c))],
        _ => panic!("a product of {a:?} and {b:?}"),
    }
}

fn reciprocal<T: Float>(value: &[Nilpotent<T>]) -> Value<T> {
    match value {
        [value] => vec![value.reciprocal()],
        [re, im] => {
            let square = re.mul(re).add(&im.mul(im));
            vec![re.div(&square), im.neg().div(&square)]
        }
        _ => panic!("a space vector has no reciprocal"),
    }
}

fn dot_product<T: Float>(a: &[Nilpotent<T>], b: &[Nilpotent<T>]) -> Nilpotent<T> {
    let products = a.iter().zip(b).map(|(a, b)| a.mul(b));
    products.reduce(|a, b| a.add(&b)).expect("a vector has components")
}

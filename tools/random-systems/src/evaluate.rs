//! Evaluation of the generator's expressions, without the macro.

use super::nilpotent::{Function, Nilpotent};
use super::tree::{Expr, Index, Kind, Property, Shape, System};
use pendulum_runtime::scalar::Float;

/// A scalar, a plane vector or a space vector.
#[derive(Clone, Debug)]
pub enum Value<T> {
    Scalar(Nilpotent<T>),
    Plane([Nilpotent<T>; 2]),
    Space([Nilpotent<T>; 3]),
}

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
    pub fn infinitesimals(&self) -> usize {
        self.time.infinitesimals()
    }

    /// Returns the variables at a later time: each variable plus its rate times a new
    /// infinitesimal.
    pub fn later(&self) -> Self {
        let zero = Nilpotent::constant(T::from_f64(0.0), self.infinitesimals());
        let one = Nilpotent::constant(T::from_f64(1.0), self.infinitesimals());
        let step = |values: &[Nilpotent<T>], rates: &[Nilpotent<T>]| {
            values
                .iter()
                .zip(rates)
                .map(|(value, rate)| value.clone().join(rate.clone()))
                .collect::<Vec<_>>()
        };
        let input = |[x, v, a, j]: &[Nilpotent<T>; 4]| {
            [
                x.clone().join(v.clone()),
                v.clone().join(a.clone()),
                a.clone().join(j.clone()),
                j.clone().join(zero.clone()),
            ]
        };
        Self {
            time: self.time.clone().join(one),
            q: step(&self.q, &self.v),
            v: step(&self.v, &self.a),
            a: self.a.iter().map(|a| a.clone().join(zero.clone())).collect(),
            inputs: self
                .inputs
                .iter()
                .map(|components| components.iter().map(input).collect())
                .collect(),
        }
    }

    /// Returns the variables with a new infinitesimal whose coefficients are zero.
    pub fn widened(&self) -> Self {
        let zero = Nilpotent::constant(T::from_f64(0.0), self.infinitesimals());
        let wide = |value: &Nilpotent<T>| value.clone().join(zero.clone());
        let all = |values: &[Nilpotent<T>]| values.iter().map(wide).collect::<Vec<_>>();
        let input = |orders: &[Nilpotent<T>; 4]| orders.each_ref().map(wide);
        Self {
            time: wide(&self.time),
            q: all(&self.q),
            v: all(&self.v),
            a: all(&self.a),
            inputs: self
                .inputs
                .iter()
                .map(|components| components.iter().map(input).collect())
                .collect(),
        }
    }
}

/// The indices and arguments in scope.
#[derive(Clone, Debug)]
struct Scope<'s, T> {
    indices: Vec<(usize, usize)>,
    arguments: Option<(&'s [Expr], &'s Scope<'s, T>)>,
    point: Option<[T; 2]>,
}

/// Evaluates a scalar.
pub fn scalar<T: Float>(
    system: &System,
    constants: &Constants<T>,
    leaves: &Leaves<T>,
    expr: &Expr,
) -> Nilpotent<T> {
    indexed(system, constants, leaves, expr, None)
}

/// Evaluates a scalar in which the outermost index is bound.
pub fn indexed<T: Float>(
    system: &System,
    constants: &Constants<T>,
    leaves: &Leaves<T>,
    expr: &Expr,
    index: Option<usize>,
) -> Nilpotent<T> {
    let scope = Scope {
        indices: index.map(|k| (0, k)).into_iter().collect(),
        arguments: None,
        point: None,
    };
    Evaluator { system, constants }.scalar(expr, leaves, &scope)
}

struct Evaluator<'s, T> {
    system: &'s System,
    constants: &'s Constants<T>,
}

impl<T: Float> Evaluator<'_, T> {
    fn scalar(&self, expr: &Expr, leaves: &Leaves<T>, scope: &Scope<'_, T>) -> Nilpotent<T> {
        match self.value(expr, leaves, scope) {
            Value::Scalar(value) => value,
            other => panic!("{expr:?} is {other:?}"),
        }
    }

    /// Returns the components of a vector.
    fn parts(&self, expr: &Expr, leaves: &Leaves<T>, scope: &Scope<'_, T>) -> Vec<Nilpotent<T>> {
        match self.value(expr, leaves, scope) {
            Value::Scalar(value) => vec![value],
            Value::Plane(parts) => parts.to_vec(),
            Value::Space(parts) => parts.to_vec(),
        }
    }

    fn value(&self, expr: &Expr, leaves: &Leaves<T>, scope: &Scope<'_, T>) -> Value<T> {
        let depth = leaves.infinitesimals();
        let constant = |value: T| Nilpotent::constant(value, depth);
        let whole = |value: f64| constant(T::from_f64(value));
        let scalar = |expr: &Expr| self.scalar(expr, leaves, scope);
        Value::Scalar(match expr {
            Expr::Number(top, bottom) => {
                constant(T::from_f64(*top as f64) / T::from_f64(*bottom as f64))
            }
            Expr::Pi => constant(T::pi()),
            Expr::Imaginary => return Value::Plane([whole(0.0), whole(1.0)]),
            Expr::Time => leaves.time.clone(),
            Expr::Parameter(index) => {
                let first = self.system.first_parameter(*index);
                let own = &self.constants.parameters[first..];
                match self.system.parameters[*index].kind {
                    Kind::Vector(2) => return Value::Plane([constant(own[0]), constant(own[1])]),
                    Kind::Vector(_) => {
                        return Value::Space([
                            constant(own[0]),
                            constant(own[1]),
                            constant(own[2]),
                        ]);
                    }
                    _ => constant(own[0]),
                }
            }
            Expr::Member(index, member) => constant(
                self.constants.parameters
                    [self.system.first_parameter(*index) + place(*member, scope)],
            ),
            Expr::Property(index, property) => return self.property(*index, *property, depth),
            Expr::Coordinate(index, member) => {
                leaves.q[self.coordinate(*index, *member, scope)].clone()
            }
            Expr::Velocity(index, member, _) => {
                leaves.v[self.coordinate(*index, *member, scope)].clone()
            }
            Expr::Input(index, order) => {
                let parts: Vec<_> =
                    leaves.inputs[*index].iter().map(|orders| orders[*order].clone()).collect();
                return vector(parts);
            }
            Expr::Sum(items) => {
                return items
                    .iter()
                    .map(|(minus, item)| {
                        let value = self.value(item, leaves, scope);
                        if *minus { map(value, Nilpotent::neg) } else { value }
                    })
                    .reduce(|a, b| add(&a, &b))
                    .expect("a sum of something");
            }
            Expr::Product(items) => {
                let one = Value::Scalar(whole(1.0));
                return items.iter().fold(one, |product, (over, item)| {
                    let value = self.value(item, leaves, scope);
                    multiply(&product, &if *over { reciprocal(&value) } else { value })
                });
            }
            Expr::Negative(inner) => return map(self.value(inner, leaves, scope), Nilpotent::neg),
            Expr::Power(base, top, bottom) => match self.value(base, leaves, scope) {
                Value::Scalar(base) => base.rational_power(*top, *bottom),
                // Among vectors, only complex numbers have integer powers.
                value => {
                    let one = Value::Plane([whole(1.0), whole(0.0)]);
                    return (0..*top).fold(one, |power, _| multiply(&power, &value));
                }
            },
            Expr::GeneralPower(base, exponent) => scalar(base).power(&scalar(exponent)),
            Expr::Call(function, inner) => scalar(inner).call(*function),
            Expr::Atan2(y, x) => scalar(y).atan2(&scalar(x)),
            Expr::Max(a, b) => scalar(a).max(&scalar(b)),
            Expr::Min(a, b) => scalar(a).min(&scalar(b)),
            Expr::Vector(items) => return vector(items.iter().map(scalar).collect()),
            Expr::Inner(a, b) => {
                dot_product(&self.parts(a, leaves, scope), &self.parts(b, leaves, scope))
            }
            Expr::Cross(a, b) => {
                let (a, b) = (self.parts(a, leaves, scope), self.parts(b, leaves, scope));
                let minor = |i: usize, j: usize| a[i].mul(&b[j]).sub(&a[j].mul(&b[i]));
                if a.len() == 3 {
                    return Value::Space([minor(1, 2), minor(2, 0), minor(0, 1)]);
                }
                minor(0, 1)
            }
            Expr::Perp(a) => {
                let parts = self.parts(a, leaves, scope);
                return Value::Plane([parts[1].neg(), parts[0].clone()]);
            }
            Expr::Height(a) => self.parts(a, leaves, scope).pop().expect("a vector has components"),
            Expr::Magnitude(a) => match self.value(a, leaves, scope) {
                Value::Scalar(value) => value.call(Function::Abs),
                Value::Plane(parts) => dot_product(&parts, &parts).call(Function::Sqrt),
                Value::Space(parts) => dot_product(&parts, &parts).call(Function::Sqrt),
            },
            Expr::Component(a, component) => self.parts(a, leaves, scope)[*component].clone(),
            Expr::Cis(angle, _) => {
                let angle = scalar(angle);
                return Value::Plane([angle.call(Function::Cos), angle.call(Function::Sin)]);
            }
            Expr::Dot(inner) => return self.rate(inner, leaves, scope),
            Expr::Let(index) => return self.definition(*index, None, leaves),
            Expr::LetDot(index) => {
                let later = self.definition(*index, None, &leaves.later());
                return map(later, |value| value.split().1);
            }
            Expr::LetMember(index, member) => {
                return self.definition(*index, Some(place(*member, scope)), leaves);
            }
            Expr::Apply(index, arguments) => {
                let inner =
                    Scope { indices: Vec::new(), arguments: Some((arguments, scope)), point: None };
                return self.value(&self.system.lets[*index].expr, leaves, &inner);
            }
            Expr::Argument(index) => {
                let (arguments, outer) = scope.arguments.expect("an argument stands in a function");
                return self.value(&arguments[*index], leaves, outer);
            }
            Expr::Bound(index) => whole(bound(*index, scope) as f64),
            Expr::Over(index, count, _, term) => {
                let term = |k: usize| {
                    let mut inner = scope.clone();
                    inner.indices.push((*index, k));
                    self.value(term, leaves, &inner)
                };
                return (0..*count)
                    .map(term)
                    .reduce(|a, b| add(&a, &b))
                    .expect("a sum over something");
            }
            Expr::Integral(body, integrand) => {
                let points = self.constants.bodies[*body].as_ref().expect("a body has points");
                let part = |&(weight, point): &(T, [T; 2])| {
                    let mut inner = scope.clone();
                    inner.point = Some(point);
                    map(self.value(integrand, leaves, &inner), |value| value.mul(&constant(weight)))
                };
                return points
                    .0
                    .iter()
                    .map(part)
                    .reduce(|a, b| add(&a, &b))
                    .expect("a body has points");
            }
            Expr::Point => {
                let point = scope.point.expect("a point stands in an integral");
                return Value::Plane(point.map(constant));
            }
        })
    }

    /// Returns the total derivative with respect to time.
    fn rate(&self, expr: &Expr, leaves: &Leaves<T>, scope: &Scope<'_, T>) -> Value<T> {
        map(self.value(expr, &leaves.later(), scope), |value| value.split().1)
    }

    fn definition(&self, index: usize, member: Option<usize>, leaves: &Leaves<T>) -> Value<T> {
        let definition = &self.system.lets[index];
        assert_eq!(matches!(definition.shape, Shape::Indexed(_)), member.is_some());
        let scope = Scope {
            indices: member.map(|k| (0, k)).into_iter().collect(),
            arguments: None,
            point: None,
        };
        self.value(&definition.expr, leaves, &scope)
    }

    fn coordinate(&self, index: usize, member: Option<Index>, scope: &Scope<'_, T>) -> usize {
        self.system.first_coordinate(index) + member.map_or(0, |member| place(member, scope))
    }

    fn property(&self, index: usize, property: Property, depth: usize) -> Value<T> {
        let first = self.system.first_parameter(index);
        let constant = |value: T| Nilpotent::constant(value, depth);
        let [mass, x, y] = [0, 1, 2].map(|offset| self.constants.parameters[first + offset]);
        match property {
            Property::Mass => Value::Scalar(constant(mass)),
            Property::Center => Value::Plane([constant(x), constant(y)]),
            // The moment of inertia about the pivot.
            Property::Inertia => {
                let points = &self.constants.bodies[index].as_ref().expect("a body has points").0;
                let parts = points.iter().map(|&(weight, [x, y])| weight * (x * x + y * y));
                Value::Scalar(constant(parts.reduce(|a, b| a + b).expect("a body has points")))
            }
        }
    }
}

fn bound<T>(index: usize, scope: &Scope<'_, T>) -> usize {
    scope.indices.iter().rev().find(|(own, _)| *own == index).expect("an index is bound").1
}

fn place<T>(index: Index, scope: &Scope<'_, T>) -> usize {
    match index {
        Index::Number(number) => number,
        Index::Bound(index) => bound(index, scope),
        Index::Reversed(index, count) => count - 1 - bound(index, scope),
    }
}

fn vector<T: Float>(parts: Vec<Nilpotent<T>>) -> Value<T> {
    let mut parts = parts.into_iter();
    let mut next = || parts.next();
    match (next(), next(), next()) {
        (Some(x), None, None) => Value::Scalar(x),
        (Some(x), Some(y), None) => Value::Plane([x, y]),
        (Some(x), Some(y), Some(z)) => Value::Space([x, y, z]),
        _ => panic!("a vector has components"),
    }
}

fn map<T: Float>(value: Value<T>, map: impl Fn(&Nilpotent<T>) -> Nilpotent<T>) -> Value<T> {
    match value {
        Value::Scalar(value) => Value::Scalar(map(&value)),
        Value::Plane(parts) => Value::Plane(parts.each_ref().map(map)),
        Value::Space(parts) => Value::Space(parts.each_ref().map(map)),
    }
}

fn add<T: Float>(a: &Value<T>, b: &Value<T>) -> Value<T> {
    match (a, b) {
        (Value::Scalar(a), Value::Scalar(b)) => Value::Scalar(a.add(b)),
        (Value::Plane(a), Value::Plane(b)) => Value::Plane([0, 1].map(|k| a[k].add(&b[k]))),
        (Value::Space(a), Value::Space(b)) => Value::Space([0, 1, 2].map(|k| a[k].add(&b[k]))),
        (Value::Plane([x, y]), Value::Scalar(real))
        | (Value::Scalar(real), Value::Plane([x, y])) => Value::Plane([x.add(real), y.clone()]),
        _ => panic!("a sum of {a:?} and {b:?}"),
    }
}

/// Multiplies a scalar by any value, or two complex numbers.
fn multiply<T: Float>(a: &Value<T>, b: &Value<T>) -> Value<T> {
    match (a, b) {
        (Value::Scalar(a), b) => map(b.clone(), |b| a.mul(b)),
        (a, Value::Scalar(b)) => map(a.clone(), |a| a.mul(b)),
        (Value::Plane([a, b]), Value::Plane([c, d])) => {
            Value::Plane([a.mul(c).sub(&b.mul(d)), a.mul(d).add(&b.mul(c))])
        }
        _ => panic!("a product of {a:?} and {b:?}"),
    }
}

fn reciprocal<T: Float>(value: &Value<T>) -> Value<T> {
    match value {
        Value::Scalar(value) => Value::Scalar(value.reciprocal()),
        Value::Plane([re, im]) => {
            let square = re.mul(re).add(&im.mul(im));
            Value::Plane([re.div(&square), im.neg().div(&square)])
        }
        Value::Space(_) => panic!("a space vector has no reciprocal"),
    }
}

fn dot_product<T: Float>(a: &[Nilpotent<T>], b: &[Nilpotent<T>]) -> Nilpotent<T> {
    a.iter()
        .zip(b)
        .map(|(a, b)| a.mul(b))
        .reduce(|a, b| a.add(&b))
        .expect("a vector has components")
}

//! Values of expressions: scalars, vectors, complex numbers and families.

use super::rotation::{Rotation, Turned};
use crate::algebra::expr::Id;

/// The value of an expression, by its components.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    Bad,
    Scalar(Id),
    /// A plane vector. `complex` is set if it was written as a complex number, so that a real
    /// number may be added to it.
    Plane {
        parts: [Id; 2],
        complex: bool,
    },
    Space([Id; 3]),
    /// A symmetric matrix, by its entries xx, yy, zz, xy, xz and yz.
    Matrix([Id; 6]),
    /// A space vector behind rotations.
    Turned(Turned),
    Rotation(Rotation),
    Family(Vec<Value>),
}

impl Value {
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Value::Bad => "unknown",
            Value::Scalar(_) => "a scalar",
            Value::Plane { complex: false, .. } => "a plane vector",
            Value::Plane { complex: true, .. } => "a complex number",
            Value::Space(_) | Value::Turned(_) => "a space vector",
            Value::Matrix(_) => "a matrix",
            Value::Rotation(_) => "a rotation",
            Value::Family(_) => "a family",
        }
    }

    /// Returns the lengths, outermost first.
    pub(super) fn lengths(&self) -> Vec<usize> {
        match self {
            Value::Bad | Value::Scalar(_) | Value::Rotation(_) => Vec::new(),
            Value::Plane { .. } => vec![2],
            Value::Space(_) | Value::Turned(_) => vec![3],
            Value::Matrix(_) => vec![3, 3],
            Value::Family(members) => {
                let inner = members.first().map(Value::lengths).unwrap_or_default();
                [vec![members.len()], inner].concat()
            }
        }
    }

    /// Returns the components, for a family those of all members, and for turned vectors and
    /// rotations what they consist of.
    pub(super) fn scalars(&self) -> Vec<Id> {
        match self {
            Value::Bad => Vec::new(),
            Value::Scalar(id) => vec![*id],
            Value::Plane { parts, .. } => parts.to_vec(),
            Value::Space(parts) => parts.to_vec(),
            Value::Matrix(entries) => entries.to_vec(),
            Value::Turned(vector) => vector.scalars(),
            Value::Rotation(rotation) => rotation.scalars(),
            Value::Family(members) => members.iter().flat_map(Self::scalars).collect(),
        }
    }

    /// Returns a plane vector of two components, or a space vector of three.
    pub(super) fn vector(parts: &[Id]) -> Self {
        match *parts {
            [x, y] => Self::Plane { parts: [x, y], complex: false },
            [x, y, z] => Self::Space([x, y, z]),
            _ => Self::Bad,
        }
    }

    /// Returns the components of a vector that nothing turns.
    pub(super) fn parts(&self) -> Option<&[Id]> {
        match self {
            Value::Plane { parts, .. } => Some(parts),
            Value::Space(parts) => Some(parts),
            _ => None,
        }
    }
}

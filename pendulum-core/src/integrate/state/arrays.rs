//! Serialization of arrays of any length with `serde`.

use core::fmt;
use core::marker::PhantomData;
use serde::de::{Error, SeqAccess, Visitor};
use serde::ser::SerializeTuple;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// An array of any length. `serde` itself supports only lengths up to 32, and no generic lengths.
struct Row<A>(A);

impl<T: Serialize, const N: usize> Serialize for Row<&[T; N]> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut tuple = serializer.serialize_tuple(N)?;
        for value in self.0 {
            tuple.serialize_element(value)?;
        }
        tuple.end()
    }
}

impl<'de, T: Deserialize<'de>, const N: usize> Deserialize<'de> for Row<[T; N]> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Rows<T, const N: usize>(PhantomData<T>);

        impl<'de, T: Deserialize<'de>, const N: usize> Visitor<'de> for Rows<T, N> {
            type Value = [T; N];

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{N} numbers")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<[T; N], A::Error> {
                let mut values = Vec::new();
                while values.len() < N {
                    match list.next_element()? {
                        Some(value) => values.push(value),
                        None => return Err(A::Error::invalid_length(values.len(), &self)),
                    }
                }
                let length = values.len();
                values.try_into().map_err(|_| A::Error::invalid_length(length, &self))
            }
        }

        deserializer.deserialize_tuple(N, Rows(PhantomData)).map(Row)
    }
}

/// The functions of an array for `#[serde(with)]`.
pub(crate) mod array {
    use super::{Deserialize, Deserializer, Row, Serialize, Serializer};

    pub(crate) fn serialize<T: Serialize, S: Serializer, const N: usize>(
        array: &[T; N],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        Row(array).serialize(serializer)
    }

    pub(crate) fn deserialize<'de, T: Deserialize<'de>, D: Deserializer<'de>, const N: usize>(
        deserializer: D,
    ) -> Result<[T; N], D::Error> {
        Row::deserialize(deserializer).map(|Row(array)| array)
    }
}

/// The functions of a list of arrays for `#[serde(with)]`.
pub(crate) mod rows {
    use super::{Deserialize, Deserializer, Row, Serialize, Serializer};

    pub(crate) fn serialize<T: Serialize, S: Serializer, const N: usize>(
        rows: &[[T; N]],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(rows.iter().map(Row))
    }

    pub(crate) fn deserialize<'de, T: Deserialize<'de>, D: Deserializer<'de>, const N: usize>(
        deserializer: D,
    ) -> Result<Vec<[T; N]>, D::Error> {
        let rows = Vec::<Row<[T; N]>>::deserialize(deserializer)?;
        Ok(rows.into_iter().map(|Row(row)| row).collect())
    }
}

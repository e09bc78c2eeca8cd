//! Members of the JSON text of a file, each checked when it is used.
//!
//! Most of a real file describes meshes, materials and extensions, which move nothing. A schema of
//! the whole text refuses a file for any of them; these functions look only at what is asked for.
//! A member that is `null` counts as absent, and `1.0` as a whole number.

use serde_json::Value;

/// Returns a member; `None` if it is absent or `null`.
pub(super) fn member<'a>(object: &'a Value, key: &str) -> Option<&'a Value> {
    object.get(key).filter(|value| !value.is_null())
}

/// Returns the elements of a list; none if it is absent.
pub(super) fn list<'a>(object: &'a Value, key: &str) -> &'a [Value] {
    member(object, key).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

/// Returns a name or another text; `None` if it is absent or no text.
pub(super) fn text<'a>(object: &'a Value, key: &str) -> Option<&'a str> {
    object.get(key).and_then(Value::as_str)
}

/// Returns a whole number that is not negative.
pub(super) fn number(value: &Value) -> Option<u64> {
    let whole = |value: &f64| 0.0 <= *value && *value < 9e15 && *value == value.floor();
    value.as_u64().or_else(|| value.as_f64().filter(whole).map(|value| value as u64))
}

/// Returns a whole number that may be absent.
pub(super) fn count(object: &Value, key: &str) -> Result<Option<u64>, String> {
    let whole = |value| number(value).ok_or_else(|| format!("its `{key}` is no whole number"));
    member(object, key).map(whole).transpose()
}

/// Returns the number of an element of another list.
pub(super) fn index(object: &Value, key: &str) -> Result<usize, String> {
    let found = count(object, key)?.ok_or_else(|| format!("its `{key}` is missing"))?;
    Ok(usize::try_from(found).unwrap_or(usize::MAX))
}

/// Returns `D` numbers in single precision, in which glTF stores them; `None` if they are absent.
pub(super) fn floats<const D: usize>(
    object: &Value,
    key: &str,
) -> Result<Option<[f64; D]>, String> {
    let Some(value) = member(object, key) else { return Ok(None) };
    let numbers: Option<Vec<f64>> = value.as_array().and_then(|parts| {
        parts.iter().map(|part| part.as_f64().map(|part| f64::from(part as f32))).collect()
    });
    let array = numbers.and_then(|numbers| numbers.try_into().ok());
    array.map(Some).ok_or_else(|| format!("its `{key}` is no list of {D} numbers"))
}

#[cfg(test)]
mod tests {
    use super::{count, floats, index, list, member};
    use serde_json::{Value, from_str};

    #[test]
    fn members_are_read_as_loosely_as_files_are_written() {
        let object: Value =
            from_str(r#"{"a":2.0,"b":null,"c":-1,"d":1.5,"e":[1,2.5],"f":[1,"x"],"g":1e300}"#)
                .unwrap();
        assert_eq!(index(&object, "a"), Ok(2));
        assert_eq!(count(&object, "b"), Ok(None));
        for key in ["c", "d", "e", "g"] {
            assert!(count(&object, key).unwrap_err().ends_with("is no whole number"), "{key}");
        }
        assert_eq!(index(&object, "b"), Err("its `b` is missing".into()));
        assert_eq!(floats(&object, "e"), Ok(Some([1.0, 2.5])));
        assert_eq!(floats::<2>(&object, "b"), Ok(None));
        assert!(floats::<3>(&object, "e").is_err() && floats::<2>(&object, "f").is_err());
        assert_eq!((list(&object, "e").len(), list(&object, "b").len()), (2, 0));
        assert_eq!(member(&object, "b"), None);
    }
}

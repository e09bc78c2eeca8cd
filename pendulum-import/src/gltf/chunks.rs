//! The chunks of a GLB file. Khronos Group, "glTF 2.0 Specification", section 4.4.

use super::error::GltfError;

/// Returns the JSON text of a file and its BIN chunk, if there is one.
pub(super) fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), GltfError> {
    let Some(rest) = bytes.strip_prefix(b"glTF") else { return Ok((bytes, None)) };
    let cut = |place: &str, what: String| {
        GltfError::new(place, what, "the file is cut off; fetch it again")
    };
    let header = || format!("the header does not fit the {} bytes of the file", bytes.len());
    let (version, rest) = word(rest).ok_or_else(|| cut("header", header()))?;
    let (length, mut rest) = word(rest).ok_or_else(|| cut("header", header()))?;
    if length < 12 || bytes.len() < length {
        return Err(cut("header", header()));
    }
    let fail = |what: String| GltfError::new("chunks", what, "give a file in the format glTF 2.0");
    if version != 2 {
        return Err(fail(format!("version {version} of the container")));
    }
    let (mut json, mut bin) = (None, None);
    // The JSON chunk is the first; later chunks of unknown kinds are to be ignored.
    while bin.is_none()
        && let Some((length, after)) = word(rest)
        && let Some((kind, after)) = after.split_first_chunk::<4>()
    {
        let Some((chunk, after)) = after.split_at_checked(length) else {
            return Err(cut("chunks", format!("a chunk of {length} bytes goes beyond the file")));
        };
        match kind {
            b"JSON" if json.is_none() => json = Some(chunk),
            _ if json.is_none() => return Err(fail("the first chunk is no JSON".into())),
            b"BIN\0" => bin = Some(chunk),
            _ => {}
        }
        rest = after;
    }
    let json = json.ok_or_else(|| fail("there is no JSON chunk".into()))?;
    // Some exporters fill chunks with zeros in place of spaces.
    let end = json.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
    Ok((&json[..end], bin))
}

/// Splits a number of four bytes off.
fn word(bytes: &[u8]) -> Option<(usize, &[u8])> {
    let (word, rest) = bytes.split_first_chunk::<4>()?;
    Some((u32::from_le_bytes(*word) as usize, rest))
}

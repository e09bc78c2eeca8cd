//! The buffers of a file: the chunk of a GLB file, data URIs, and files beside it.

use super::MEND;
use super::error::GltfError;
use super::json::{count, list, member, text};
use crate::contents;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use base64::{DecodeError, Engine};
use serde_json::Value;
use std::path::Path;

/// The advice for a buffer that is not found.
const BESIDE: &str = "put it beside the glTF file";

/// Returns `true` if a URI is a relative path.
fn beside(uri: &str) -> bool {
    !uri.starts_with('/') && !uri.contains(':') && !uri.contains('\\')
}

/// The bytes of a buffer, or the error of each use: motions that do not need it can be read.
pub(super) type Buffer = Result<Vec<u8>, GltfError>;

/// Reads all buffers of a file; buffers in other files are searched in `folder`. Fails if no buffer
/// can be read.
pub(super) fn buffers(
    root: &Value,
    blob: Option<&[u8]>,
    folder: Option<&Path>,
) -> Result<Vec<Buffer>, GltfError> {
    let parts = list(root, "buffers").iter().enumerate();
    let buffers: Vec<Buffer> = parts
        .map(|(index, part)| {
            let blob = if index == 0 { blob } else { None };
            bytes(part, &format!("buffers[{index}]"), blob, folder)
        })
        .collect();
    match buffers.first() {
        Some(Err(error)) if buffers.iter().all(Result::is_err) => Err(error.clone()),
        _ => Ok(buffers),
    }
}

/// Reads a buffer; `blob` is the BIN chunk if it may be this buffer.
fn bytes(
    buffer: &Value,
    place: &str,
    blob: Option<&[u8]>,
    folder: Option<&Path>,
) -> Result<Vec<u8>, GltfError> {
    let fail = |what: String, advice| GltfError::new(place, what, advice);
    let length = count(buffer, "byteLength").map_err(|what| fail(what, MEND))?;
    let length = length.ok_or_else(|| fail("its `byteLength` is missing".into(), MEND))?;
    let bytes = match (text(buffer, "uri"), blob) {
        (None, _) if is_fallback(buffer) => {
            let what = "its bytes are only there in compressed form";
            return Err(fail(what.into(), "export the file without compression of animations"));
        }
        (None, Some(blob)) => blob.to_vec(),
        (None, None) => {
            let advice = "give it a uri; only the first buffer may be the BIN chunk";
            return Err(fail("no uri and no BIN chunk".into(), advice));
        }
        (Some(uri), _) => match (uri.split_at_checked(5), folder) {
            (Some((scheme, data)), _) if scheme.eq_ignore_ascii_case("data:") => {
                inline(data).map_err(|what| fail(what, "mend the data URI"))?
            }
            (_, None) => {
                let what = format!("its bytes are in the file `{uri}`");
                return Err(fail(what, "read the file with `Gltf::open`, or pack it as .glb"));
            }
            (_, Some(folder)) if beside(uri) => contents(&folder.join(unescaped(uri)), length)
                .map_err(|error| fail(format!("`{uri}`: {error}"), BESIDE))?,
            (_, Some(_)) => {
                return Err(fail(format!("`{uri}` is no relative path"), BESIDE));
            }
        },
    };
    if (bytes.len() as u64) < length {
        let what = format!("{} bytes of {length}", bytes.len());
        return Err(fail(what, "the file is cut off; fetch it again"));
    }
    Ok(bytes)
}

/// Returns `true` for a buffer that stands in place of the decompressed bytes, as in
/// `EXT_meshopt_compression`.
fn is_fallback(buffer: &Value) -> bool {
    let extensions = member(buffer, "extensions").and_then(Value::as_object);
    extensions.is_some_and(|all| all.values().any(|extension| extension["fallback"] == true))
}

/// Decodes a data URI without its scheme.
fn inline(data: &str) -> Result<Vec<u8>, String> {
    let (head, body) = data.split_once(',').ok_or("a data URI without a comma")?;
    if head.to_ascii_lowercase().ends_with(";base64") {
        base64(body)
    } else {
        Err("a data URI that is not base64".into())
    }
}

/// Decodes base64 (RFC 4648, sections 4 and 5); padding is optional, and white space is ignored.
fn base64(text: &str) -> Result<Vec<u8>, String> {
    let config = GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::RequireNone)
        .with_decode_allow_trailing_bits(true);
    let digits = text.split_ascii_whitespace().collect::<String>();
    let digits = digits.trim_end_matches('=').replace('-', "+").replace('_', "/");
    GeneralPurpose::new(&STANDARD, config).decode(digits).map_err(|error| match error {
        DecodeError::InvalidByte(index, _) => format!("byte {index} is no digit of base64"),
        error => format!("base64 that is cut off: {error}"),
    })
}

/// Replaces the percent-encoded bytes of a URI, such as `%20`.
fn unescaped(uri: &str) -> String {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, tail @ ..] = rest {
        let code = match (first, tail) {
            (b'%', [high, low, ..]) => {
                char::from(*high).to_digit(16).zip(char::from(*low).to_digit(16))
            }
            _ => None,
        };
        if let Some((high, low)) = code {
            bytes.push((high * 16 + low) as u8);
            rest = &tail[2..];
        } else {
            bytes.push(*first);
            rest = tail;
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::{base64, unescaped};

    #[test]
    fn both_alphabets_are_read_with_and_without_padding() {
        for text in ["+/8=", "+/8", "-_8=", "-_8"] {
            assert_eq!(base64(text).unwrap(), [0xfb, 0xff], "{text}");
        }
        assert_eq!(base64("Zm9v!").unwrap_err(), "byte 4 is no digit of base64");
        assert!(base64("Zm9vY").unwrap_err().starts_with("base64 that is cut off"));
    }

    #[test]
    fn escapes_are_replaced() {
        assert_eq!(unescaped("a%20b%2Fc%zz%2"), "a b/c%zz%2");
    }
}

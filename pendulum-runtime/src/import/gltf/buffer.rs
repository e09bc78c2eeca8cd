//! The buffers of a file: the chunk of a GLB file, data URIs, and files beside it.

use super::error::GltfError;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use base64::{DecodeError, Engine};
use gltf::json::Root;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Returns `true` if a URI is a relative path.
fn beside(uri: &str) -> bool {
    !uri.starts_with('/') && !uri.contains(':') && !uri.contains('\\')
}

/// Reads all buffers of a file; buffers in other files are searched in `folder`.
pub(super) fn buffers(
    root: &Root,
    blob: Option<Vec<u8>>,
    folder: Option<&Path>,
) -> Result<Vec<Vec<u8>>, GltfError> {
    let mut blob = blob;
    let mut buffers = Vec::with_capacity(root.buffers.len());
    for (index, buffer) in root.buffers.iter().enumerate() {
        let place = format!("buffers[{index}]");
        let bytes = match &buffer.uri {
            None if index == 0 => blob.take().ok_or_else(|| {
                GltfError::new(&*place, "no uri and no BIN chunk", "give one of them")
            })?,
            None => {
                return Err(GltfError::new(
                    place,
                    "no uri",
                    "only the first buffer may be the BIN chunk",
                ));
            }
            Some(uri) => match (uri.strip_prefix("data:"), folder) {
                (Some(data), _) => inline(data)
                    .map_err(|what| GltfError::new(&*place, what, "mend the data URI"))?,
                (None, None) => {
                    let advice = "read the file with `Gltf::open`, or pack it as .glb";
                    return Err(GltfError::new(
                        place,
                        format!("its bytes are in the file `{uri}`"),
                        advice,
                    ));
                }
                (None, Some(folder)) if beside(uri) => {
                    outside(&folder.join(unescaped(uri)), buffer.byte_length.0).map_err(
                        |error| {
                            GltfError::new(
                                &*place,
                                format!("`{uri}`: {error}"),
                                "put it beside the glTF file",
                            )
                        },
                    )?
                }
                (None, Some(_)) => {
                    return Err(GltfError::new(
                        place,
                        format!("`{uri}` is no relative path"),
                        "put it beside the glTF file",
                    ));
                }
            },
        };
        if (bytes.len() as u64) < buffer.byte_length.0 {
            let what = format!("{} bytes of {}", bytes.len(), buffer.byte_length.0);
            return Err(GltfError::new(place, what, "the file is cut off; fetch it again"));
        }
        buffers.push(bytes);
    }
    Ok(buffers)
}

/// Reads at most `length` bytes of a file.
fn outside(path: &Path, length: u64) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(length).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Decodes a data URI without its scheme.
fn inline(data: &str) -> Result<Vec<u8>, String> {
    let (head, body) = data.split_once(',').ok_or("a data URI without a comma")?;
    if head.ends_with(";base64") {
        base64(body)
    } else {
        Err("a data URI that is not base64".into())
    }
}

/// Decodes base64 (RFC 4648, sections 4 and 5); padding is optional.
fn base64(text: &str) -> Result<Vec<u8>, String> {
    let config = GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::RequireNone)
        .with_decode_allow_trailing_bits(true);
    let digits = text.trim_end_matches('=').replace('-', "+").replace('_', "/");
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

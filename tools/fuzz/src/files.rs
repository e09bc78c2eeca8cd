//! Invalid files.

use random_systems::Random;

/// Fragments that are difficult for readers of numbers and lengths.
const SPLINTERS: [&[u8]; 16] = [
    b"-1",
    b"0",
    b"1e308",
    b"1e-320",
    b"nan",
    b"inf",
    b"18446744073709551616",
    b"4294967295",
    b"\xff\xfe",
    b"\0",
    b"\r",
    b" ",
    b"\n",
    b"{",
    b"}",
    b"\xe2\x80\x8b",
];

/// Returns a file with some bytes, words or ranges changed.
pub(crate) fn mutated(file: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = file.to_vec();
    for _ in 0..=random.below(6) {
        if bytes.is_empty() {
            break;
        }
        let at = random.below(bytes.len());
        // Most of the structure is in headers.
        let at = if random.once_in(2) { at.min(random.below(2000)) } else { at };
        let longest = random.of(&[4, 40, 4000]);
        let end = (at + 1 + random.below(longest)).min(bytes.len());
        match random.below(7) {
            0 => bytes[at] = random.bits() as u8,
            1 => drop(bytes.drain(at..end)),
            2 => {
                let stretch = bytes[at..end].to_vec();
                let to = random.below(bytes.len());
                bytes.splice(to..to, stretch);
            }
            3 => bytes.truncate(at),
            4 => {
                let word = bytes[at..]
                    .iter()
                    .position(u8::is_ascii_whitespace)
                    .map_or(bytes.len(), |length| at + length);
                bytes.splice(at..word, random.of(&SPLINTERS).iter().copied());
            }
            5 => drop(bytes.splice(at..at, random.of(&SPLINTERS).iter().copied())),
            _ => bytes[at] ^= 1 << random.below(8),
        }
    }
    bytes
}

/// Returns a text with some bytes or numbers changed.
#[cfg(any(feature = "gltf", feature = "svg"))]
pub(crate) fn changed(text: &[u8], random: &mut Random) -> Vec<u8> {
    if random.once_in(2) { mutated(text, random) } else { renumbered(text, random) }
}

/// Returns a text with some numbers changed, so that its syntax stays valid.
#[cfg(any(feature = "gltf", feature = "svg"))]
fn renumbered(text: &[u8], random: &mut Random) -> Vec<u8> {
    const NUMBERS: &str = "-1 0 1 2 3 7 255 5120 5126 65536 4294967295 18446744073709551615 \
                           1e-320 -1e38 1e308 0.1";
    let numbers: Vec<&str> = NUMBERS.split_whitespace().collect();
    let mut bytes = text.to_vec();
    for _ in 0..=random.below(4) {
        let from = random.below(bytes.len());
        let Some(start) =
            bytes[from..].iter().position(u8::is_ascii_digit).map(|length| from + length)
        else {
            continue;
        };
        let part = |byte: &u8| !(byte.is_ascii_digit() || matches!(byte, b'.' | b'-'));
        let end = bytes[start..].iter().position(part).map_or(bytes.len(), |length| start + length);
        bytes.splice(start..end, random.of(&numbers).bytes());
    }
    bytes
}

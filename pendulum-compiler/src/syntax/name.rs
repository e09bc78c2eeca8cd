//! Names as in mathematical notation: Greek letters, dots and their ASCII spellings.

use proc_macro2::Ident;

/// A name without its dots: `θ̇1`, `theta1_dot` and `θ1̇` are all `theta1` with one dot.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Name {
    /// The ASCII spelling of the Greek letters, everything else as written.
    pub(crate) base: String,
    /// The number of time derivatives.
    pub(crate) dots: u8,
}

/// Reads an identifier. Composed and decomposed letters have the same result.
pub(crate) fn read(text: &str) -> Name {
    let text = text.strip_prefix("r#").unwrap_or(text);
    let mut base = String::with_capacity(text.len());
    let mut dots = 0u8;
    for letter in text.chars() {
        match letter {
            '\u{307}' => dots = dots.saturating_add(1),
            '\u{308}' => dots = dots.saturating_add(2),
            '\u{20db}' => dots = dots.saturating_add(3),
            _ => {
                let (letter, composed) = decompose(letter);
                dots = dots.saturating_add(composed);
                match greek(letter) {
                    Some(spelled) => base.push_str(spelled),
                    None => base.push(letter),
                }
            }
        }
    }
    for (suffix, count) in [("_dddot", 3), ("_ddot", 2), ("_dot", 1)] {
        if let Some(stem) = base.strip_suffix(suffix).filter(|stem| !stem.is_empty()) {
            base.truncate(stem.len());
            dots = dots.saturating_add(count);
            break;
        }
    }
    Name { base, dots }
}

/// Returns a name without its dots, in the ASCII spelling of its letters.
pub(crate) fn plain(ident: &Ident) -> String {
    read(&ident.to_string()).base
}

/// Returns a name without accents, which may have been confused with dots; `None` if it has no
/// accents.
pub(crate) fn unaccented(text: &str) -> Option<String> {
    let marks = ['\u{300}', '\u{301}'];
    let plain = |letter: char| match ACCENTED.iter().find(|row| row.0.contains(letter)) {
        Some(&(_, plain)) => plain,
        None => letter,
    };
    let result: String = text.chars().filter(|letter| !marks.contains(letter)).map(plain).collect();
    Some(result).filter(|result| result != text)
}

/// Returns the spellings of a velocity: with a dot, if the name is a single letter, and with the
/// suffix.
pub(crate) fn dotted(text: &str) -> String {
    let suffixed = format!("`{}_dot`", read(text).base);
    match velocity(text) {
        Some(velocity) => format!("`{velocity}` or {suffixed}"),
        None => suffixed,
    }
}

/// Returns a name of a single letter, with or without a number, with a dot.
pub(crate) fn velocity(text: &str) -> Option<String> {
    let mut letters = text.chars();
    letters.next()?;
    let single = letters.all(|digit| digit.is_ascii_digit());
    single.then(|| with_dots(text, 1))
}

/// Returns a name with dots over its first letter, composed with them if Unicode does.
pub(crate) fn with_dots(text: &str, dots: u8) -> String {
    let mut letters = text.chars();
    let Some(letter) = letters.next() else { return String::new() };
    let rest = letters.as_str();
    let mark = if dots == 1 { '\u{307}' } else { '\u{308}' };
    match DOTTED.iter().find(|row| row.2 == dots && row.1 == letter) {
        Some((composed, ..)) => format!("{composed}{rest}"),
        None => format!("{letter}{mark}{rest}"),
    }
}

/// Returns `true` if a word is the English name of a Greek letter for which LaTeX has a command.
pub(crate) fn is_greek(word: &str) -> bool {
    GREEK.iter().any(|row| row.1 == word) && word != "omicron"
}

/// Returns the Greek letter with an English name.
pub(crate) fn letter(word: &str) -> Option<char> {
    GREEK.iter().find(|row| row.1 == word).and_then(|row| row.0.chars().next())
}

/// Returns the known name nearest to `name`, if the distance is small.
pub(crate) fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let limit = match name.chars().count() {
        0 | 1 => 1,
        length => 2 + length / 4 * 2,
    };
    known
        .map(|other| (distance(name, other), other))
        .filter(|&(distance, _)| distance <= limit)
        .min_by_key(|&(d, _)| d)
        .map(|(_, other)| other)
}

/// Returns twice the edit distance of two names. A change of case counts half.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().take(64).collect();
    let mut row: Vec<usize> = (0..=b.len()).map(|steps| 2 * steps).collect();
    for (i, x) in a.chars().take(64).enumerate() {
        let mut diagonal = row[0];
        row[0] = 2 * (i + 1);
        for (j, &y) in b.iter().enumerate() {
            let change = if x == y {
                0
            } else if x.eq_ignore_ascii_case(&y) {
                1
            } else {
                2
            };
            let best = (diagonal + change).min(row[j] + 2).min(row[j + 1] + 2);
            diagonal = row[j + 1];
            row[j + 1] = best;
        }
    }
    row[b.len()]
}

/// Returns a letter without the dots of its code point, and the number of these dots.
fn decompose(letter: char) -> (char, u8) {
    match DOTTED.iter().find(|row| row.0 == letter) {
        Some(&(_, plain, dots)) => (plain, dots),
        None => (letter, 0),
    }
}

/// Returns the English name of a Greek letter. Variant forms and the micro sign count as the
/// letters they represent.
fn greek(letter: char) -> Option<&'static str> {
    GREEK.iter().find(|row| row.0.contains(letter)).map(|row| row.1)
}

/// All letters with a dot or a diaeresis above that Unicode composes.
#[rustfmt::skip]
const DOTTED: &[(char, char, u8)] = &[
    ('Ȧ', 'A', 1), ('Ḃ', 'B', 1), ('Ċ', 'C', 1), ('Ḋ', 'D', 1), ('Ė', 'E', 1), ('Ḟ', 'F', 1), ('Ġ', 'G', 1), ('Ḣ', 'H', 1),
    ('İ', 'I', 1), ('Ṁ', 'M', 1), ('Ṅ', 'N', 1), ('Ȯ', 'O', 1), ('Ṗ', 'P', 1), ('Ṙ', 'R', 1), ('Ṡ', 'S', 1), ('Ṫ', 'T', 1),
    ('Ẇ', 'W', 1), ('Ẋ', 'X', 1), ('Ẏ', 'Y', 1), ('Ż', 'Z', 1),
    ('ȧ', 'a', 1), ('ḃ', 'b', 1), ('ċ', 'c', 1), ('ḋ', 'd', 1), ('ė', 'e', 1), ('ḟ', 'f', 1), ('ġ', 'g', 1), ('ḣ', 'h', 1),
    ('ṁ', 'm', 1), ('ṅ', 'n', 1), ('ȯ', 'o', 1), ('ṗ', 'p', 1), ('ṙ', 'r', 1), ('ṡ', 's', 1), ('ṫ', 't', 1),
    ('ẇ', 'w', 1), ('ẋ', 'x', 1), ('ẏ', 'y', 1), ('ż', 'z', 1),
    ('Ä', 'A', 2), ('Ë', 'E', 2), ('Ḧ', 'H', 2), ('Ï', 'I', 2), ('Ö', 'O', 2), ('Ü', 'U', 2), ('Ẅ', 'W', 2), ('Ẍ', 'X', 2), ('Ÿ', 'Y', 2),
    ('ä', 'a', 2), ('ë', 'e', 2), ('ḧ', 'h', 2), ('ï', 'i', 2), ('ö', 'o', 2), ('ẗ', 't', 2), ('ü', 'u', 2), ('ẅ', 'w', 2), ('ẍ', 'x', 2), ('ÿ', 'y', 2),
    ('Ϊ', 'Ι', 2), ('ϊ', 'ι', 2), ('Ϋ', 'Υ', 2), ('ϋ', 'υ', 2),
];

/// Letters with an acute or a grave accent, and the letter without it.
#[rustfmt::skip]
const ACCENTED: &[(&str, char)] = &[
    ("άὰ", 'α'), ("έὲ", 'ε'), ("ήὴ", 'η'), ("ίὶ", 'ι'), ("όὸ", 'ο'), ("ύὺ", 'υ'), ("ώὼ", 'ω'),
    ("ΆᾺ", 'Α'), ("ΈῈ", 'Ε'), ("ΉῊ", 'Η'), ("ΊῚ", 'Ι'), ("ΌῸ", 'Ο'), ("ΎῪ", 'Υ'), ("ΏῺ", 'Ω'),
    ("áà", 'a'), ("ć", 'c'), ("éè", 'e'), ("ǵ", 'g'), ("íì", 'i'), ("ḱ", 'k'), ("ĺ", 'l'), ("ḿ", 'm'), ("ńǹ", 'n'),
    ("óò", 'o'), ("ṕ", 'p'), ("ŕ", 'r'), ("ś", 's'), ("úù", 'u'), ("ẃẁ", 'w'), ("ýỳ", 'y'), ("ź", 'z'),
    ("ÁÀ", 'A'), ("Ć", 'C'), ("ÉÈ", 'E'), ("Ǵ", 'G'), ("ÍÌ", 'I'), ("Ḱ", 'K'), ("Ĺ", 'L'), ("Ḿ", 'M'), ("ŃǸ", 'N'),
    ("ÓÒ", 'O'), ("Ṕ", 'P'), ("Ŕ", 'R'), ("Ś", 'S'), ("ÚÙ", 'U'), ("ẂẀ", 'W'), ("ÝỲ", 'Y'), ("Ź", 'Z'),
];

/// The Greek alphabet.
#[rustfmt::skip]
const GREEK: &[(&str, &str)] = &[
    ("α", "alpha"), ("β", "beta"), ("γ", "gamma"), ("δ", "delta"), ("εϵ", "epsilon"), ("ζ", "zeta"), ("η", "eta"), ("θϑ", "theta"),
    ("ι", "iota"), ("κϰ", "kappa"), ("λ", "lambda"), ("μµ", "mu"), ("ν", "nu"), ("ξ", "xi"), ("ο", "omicron"), ("πϖ", "pi"),
    ("ρϱ", "rho"), ("σς", "sigma"), ("τ", "tau"), ("υ", "upsilon"), ("φϕ", "phi"), ("χ", "chi"), ("ψ", "psi"), ("ω", "omega"),
    ("Α", "Alpha"), ("Β", "Beta"), ("Γ", "Gamma"), ("Δ", "Delta"), ("Ε", "Epsilon"), ("Ζ", "Zeta"), ("Η", "Eta"), ("Θ", "Theta"),
    ("Ι", "Iota"), ("Κ", "Kappa"), ("Λ", "Lambda"), ("Μ", "Mu"), ("Ν", "Nu"), ("Ξ", "Xi"), ("Ο", "Omicron"), ("Π", "Pi"),
    ("Ρ", "Rho"), ("Σ", "Sigma"), ("Τ", "Tau"), ("Υ", "Upsilon"), ("Φ", "Phi"), ("Χ", "Chi"), ("Ψ", "Psi"), ("Ω", "Omega"),
];

#[cfg(test)]
mod tests {
    use super::{Name, nearest, read};

    fn name(base: &str, dots: u8) -> Name {
        Name { base: base.into(), dots }
    }

    #[test]
    fn spellings_of_one_name_agree() {
        for text in ["θ̇", "theta_dot", "ϑ̇"] {
            assert_eq!(read(text), name("theta", 1), "{text}");
        }
        for text in ["ẍ", "x\u{308}", "x\u{307}\u{307}", "x_ddot", "ẋ_dot"] {
            assert_eq!(read(text), name("x", 2), "{text}");
        }
        assert_eq!(read("θ̇1"), read("theta1_dot"));
        assert_eq!(read("θ1̇"), read("θ̇1"));
        assert_eq!(read("Ω"), name("Omega", 0));
        assert_eq!(read("µ"), read("μ"));
    }

    #[test]
    fn a_suffix_alone_is_a_name() {
        assert_eq!(read("_dot"), name("_dot", 0));
        assert_eq!(read("x_dots"), name("x_dots", 0));
    }

    #[test]
    fn the_nearest_name_is_near() {
        let known = ["theta", "m", "L", "g"];
        assert_eq!(nearest("l", known.into_iter()), Some("L"));
        assert_eq!(nearest("thata", known.into_iter()), Some("theta"));
        assert_eq!(nearest("velocity", known.into_iter()), None);
    }
}

//! Names of columns as written by users: with Greek letters and dots, or with their ASCII
//! spellings.

/// A name without its dots. For example, `θ̇[1]`, `theta_dot[1]` and `dot(θ[1])` are all `theta[1]`
/// with one dot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Name {
    /// The name with Greek letters spelled in ASCII, an index in brackets, and a component after a
    /// point.
    pub(crate) base: String,
    /// The number of time derivatives.
    pub(crate) dots: usize,
}

/// Parses a name. Composed and decomposed letters are equivalent, and white space is ignored.
pub(crate) fn read(text: &str) -> Name {
    let mut text: String = text.chars().filter(|letter| !letter.is_whitespace()).collect();
    let mut dots = 0;
    while let Some((inner, index)) =
        text.strip_prefix("dot(").and_then(|inner| inner.rsplit_once(')'))
        && (index.is_empty() || index.starts_with(['[', '.']))
    {
        (text, dots) = (format!("{inner}{index}"), dots + 1);
    }
    let (stem, index) = text.split_at(text.find(['[', '.']).unwrap_or(text.len()));
    let mut base = String::with_capacity(text.len());
    for letter in stem.chars() {
        match letter {
            '\u{307}' => dots += 1,
            '\u{308}' => dots += 2,
            _ => {
                let (letter, composed) = decompose(letter);
                dots += composed;
                match GREEK.iter().find(|row| row.0.contains(letter)) {
                    Some(&(_, spelled)) => base.push_str(spelled),
                    None => base.push(letter),
                }
            }
        }
    }
    for (suffix, count) in [("_ddot", 2), ("_dot", 1)] {
        if let Some(stem) = base.strip_suffix(suffix).filter(|stem| !stem.is_empty()) {
            base.truncate(stem.len());
            dots += count;
            break;
        }
    }
    base.push_str(index);
    Name { base, dots }
}

/// Returns the name of a velocity: a dot over the first letter, or the suffix `_dot` if the name is
/// a word of at least two ASCII letters or if all of the block is in ASCII.
pub(crate) fn velocity(name: &str, ascii: bool) -> String {
    let (stem, index) = name.split_at(name.find(['[', '.']).unwrap_or(name.len()));
    if ascii || stem.is_ascii() && 1 < stem.len() {
        return format!("{stem}_dot{index}");
    }
    let mut letters = stem.chars();
    let Some(first) = letters.next() else { return String::new() };
    match DOTTED.iter().find(|row| row.1 == first && row.2 == 1) {
        Some(&(composed, ..)) => format!("{composed}{}{index}", letters.as_str()),
        None => format!("{first}\u{307}{}{index}", letters.as_str()),
    }
}

/// Returns twice the edit distance of two names. A change of case counts as half an edit, and a
/// missing dot as one edit.
pub(crate) fn distance(a: &Name, b: &Name) -> usize {
    let letters = |name: &Name| -> Vec<char> { name.base.chars().take(64).collect() };
    let (a_letters, b_letters) = (letters(a), letters(b));
    let mut row: Vec<usize> = (0..=b_letters.len()).map(|steps| 2 * steps).collect();
    for (i, x) in a_letters.iter().enumerate() {
        let mut diagonal = row[0];
        row[0] = 2 * (i + 1);
        for (j, y) in b_letters.iter().enumerate() {
            let change = if x == y { 0 } else { 2 - usize::from(x.eq_ignore_ascii_case(y)) };
            let best = (diagonal + change).min(row[j] + 2).min(row[j + 1] + 2);
            diagonal = row[j + 1];
            row[j + 1] = best;
        }
    }
    row[b_letters.len()] + 2 * a.dots.abs_diff(b.dots)
}

/// Returns a letter without dots, and the number of dots contained in its code point.
fn decompose(letter: char) -> (char, usize) {
    match DOTTED.iter().find(|row| row.0 == letter) {
        Some(&(_, plain, dots)) => (plain, dots),
        None => (letter, 0),
    }
}

/// Every letter with a dot or a diaeresis above that Unicode composes, its plain letter, and its
/// number of dots.
#[rustfmt::skip]
const DOTTED: &[(char, char, usize)] = &[
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

/// The Greek alphabet. Variant forms and the micro sign have the spelling of their base letter.
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
    use super::{Name, read, velocity};

    #[test]
    fn spellings_of_one_name_agree() {
        for text in ["θ̇[2]", "theta_dot[2]", "dot(θ[2])", "ϑ̇ [2]", "dot( theta[2] )"] {
            assert_eq!(read(text), Name { base: "theta[2]".into(), dots: 1 }, "{text}");
        }
        for text in ["θ̇[2].y", "theta_dot[2].y", "dot(θ)[2].y", "dot(θ[2]).y", "dot(θ[2].y)"]
        {
            assert_eq!(read(text), Name { base: "theta[2].y".into(), dots: 1 }, "{text}");
        }
        assert_eq!(read("ẋ"), read("x\u{307}"));
        assert_eq!(read("ẋ"), read("x_dot"));
        assert_eq!(read("ẍ").dots, 2);
        assert_eq!(read("_dot"), Name { base: "_dot".into(), dots: 0 });
    }

    #[test]
    fn velocities_are_named_as_in_the_equations() {
        assert_eq!(velocity("θ", false), "θ\u{307}");
        assert_eq!(velocity("x", false), "ẋ");
        assert_eq!(velocity("φ[3]", false), "φ\u{307}[3]");
        assert_eq!(velocity("angle", false), "angle_dot");
        assert_eq!(velocity("x.y", false), "ẋ.y");
        assert_eq!(velocity("tip[1].z", false), "tip_dot[1].z");
        assert_eq!(velocity("x", true), "x_dot");
        assert_eq!(velocity("theta[0]", true), "theta_dot[0]");
    }
}

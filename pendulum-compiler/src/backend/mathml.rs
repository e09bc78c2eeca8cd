//! Equations in MathML, in which browsers draw dots above letters in every font.

use crate::backend::layout::Layout;
use crate::syntax::name;

/// Returns an equation as a MathML element.
pub(crate) fn equation(parts: &[Layout]) -> String {
    format!("<math displaystyle=\"true\">{}</math>", all(parts))
}

fn all(parts: &[Layout]) -> String {
    parts.iter().map(element).collect()
}

fn element(part: &Layout) -> String {
    match part {
        Layout::Plain(text) => plain(text),
        Layout::Letter(letter) => match name::letter(letter) {
            Some(greek) => format!("<mi>{greek}</mi>"),
            None => plain(letter),
        },
        Layout::Word(word) => format!("<mi mathvariant=\"normal\">{word}</mi>"),
        Layout::Command(command) => {
            let name = command.trim_start_matches('\\');
            match name.strip_prefix("operatorname{").and_then(|name| name.strip_suffix('}')) {
                Some(name) => format!("<mi mathvariant=\"normal\">{name}</mi>"),
                None => format!("<mi>{name}</mi>"),
            }
        }
        Layout::Sign('-') => operator('−'),
        Layout::Sign(sign) => operator(*sign),
        Layout::Minus => "<mo form=\"prefix\">−</mo>".into(),
        Layout::Comma => operator(','),
        // Signs have their own space. Factors, and functions before a bare argument, require one.
        Layout::Space => "<mspace width=\"0.17em\"/>".into(),
        Layout::Row(parts) => row(parts),
        // Full stops, which stay clear of the letter even in fonts without accents.
        Layout::Dots(letter, dots) => format!(
            "<mover><mrow>{}</mrow><mo>{}</mo></mover>",
            element(letter),
            ".".repeat(usize::from(*dots))
        ),
        Layout::Below(base, index) => {
            format!("<msub><mrow>{}</mrow>{}</msub>", element(base), row(index))
        }
        Layout::Above(base, exponent) => match &**base {
            Layout::Below(base, index) => format!(
                "<msubsup><mrow>{}</mrow>{}{}</msubsup>",
                element(base),
                row(index),
                row(exponent)
            ),
            base => format!("<msup><mrow>{}</mrow>{}</msup>", element(base), row(exponent)),
        },
        // Space on both sides of the bar, which only mathematical fonts provide.
        Layout::Fraction(above, below) => format!(
            "<mfrac><mrow>{}<mspace depth=\"0.25em\"/></mrow>\
             <mrow><mspace height=\"0.9em\"/>{}</mrow></mfrac>",
            row(above),
            row(below)
        ),
        Layout::Root(parts) => format!("<msqrt>{}</msqrt>", row(parts)),
        Layout::Fence(fences, parts) => {
            let [open, close] = fences.map(|sign| format!("<mo stretchy=\"true\">{sign}</mo>"));
            format!("<mrow>{open}{}{close}</mrow>", all(parts))
        }
        Layout::TooLong => "<mo>…</mo><mtext> (too long to write out)</mtext>".into(),
    }
}

fn row(parts: &[Layout]) -> String {
    format!("<mrow>{}</mrow>", all(parts))
}

/// Returns the elements of digits, letters and signs.
fn plain(text: &str) -> String {
    let mut elements = String::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let digits = rest.find(|letter: char| !letter.is_ascii_digit() && letter != '.');
        let split = match digits {
            Some(0) => first.len_utf8(),
            Some(end) => end,
            None => rest.len(),
        };
        let (part, after) = rest.split_at(split);
        rest = after;
        let element = match first {
            '-' => operator('−'),
            '\'' => operator('′'),
            _ if first.is_alphabetic() => format!("<mi>{part}</mi>"),
            _ if digits == Some(0) => operator(first),
            _ => format!("<mn>{part}</mn>"),
        };
        elements.push_str(&element);
    }
    elements
}

fn operator(sign: char) -> String {
    format!("<mo>{sign}</mo>")
}

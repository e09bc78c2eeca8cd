//! Equations in MathML, in which browsers draw dots above letters in every font.
//!
//! The source is the output of `latex`, a small subset of LaTeX.

use crate::syntax::name;

/// Converts an equation of `latex` to a MathML element.
pub(crate) fn equation(latex: &str) -> String {
    let mut reader = Reader { letters: latex.chars().collect(), place: 0 };
    format!("<math displaystyle=\"true\">{}</math>", reader.row(None))
}

const MINUS: &str = "<mo>−</mo>";

struct Reader {
    letters: Vec<char>,
    place: usize,
}

impl Reader {
    fn peek(&self) -> Option<char> {
        self.letters.get(self.place).copied()
    }

    /// Reads the elements up to a bracket or to the end.
    fn row(&mut self, closing: Option<char>) -> String {
        let mut text = String::new();
        // The last element, to which an exponent or an index may be added.
        let mut last = String::new();
        // `true` if a space precedes the next element.
        let mut spaced = false;
        while let Some(letter) = self.peek() {
            if Some(letter) == closing {
                self.place += 1;
                break;
            }
            if letter == '\\' && self.starts_with("\\right") {
                break;
            }
            match letter {
                ' ' => {
                    self.place += 1;
                    spaced = true;
                }
                '^' | '_' => {
                    self.place += 1;
                    let script = self.argument();
                    let inside = last.strip_prefix("<msub>");
                    last = match inside.and_then(|last| last.strip_suffix("</msub>")) {
                        Some(both) if letter == '^' => {
                            format!("<msubsup>{both}{script}</msubsup>")
                        }
                        _ => {
                            let tag = if letter == '^' { "msup" } else { "msub" };
                            format!("<{tag}>{}{script}</{tag}>", row(&last))
                        }
                    };
                }
                _ => {
                    let mut next = self.element();
                    if next == MINUS && (last.is_empty() || last.starts_with("<mo>")) {
                        next = MINUS.replace("<mo>", "<mo form=\"prefix\">");
                    }
                    // Signs have their own space. Factors, and functions before a bare argument,
                    // require a space.
                    let signs = [&last, &next]
                        .map(|element| element.starts_with("<mo>") || element.starts_with("<mo "));
                    let gap = spaced && !last.is_empty() && signs == [false; 2];
                    text.push_str(&std::mem::replace(&mut last, next));
                    text.push_str(if gap { "<mspace width=\"0.17em\"/>" } else { "" });
                    spaced = false;
                }
            }
        }
        text + &last
    }

    fn starts_with(&self, word: &str) -> bool {
        word.chars()
            .enumerate()
            .all(|(k, letter)| self.letters.get(self.place + k) == Some(&letter))
    }

    /// Reads the contents of braces as a single element.
    fn argument(&mut self) -> String {
        if self.peek() == Some('{') {
            self.place += 1;
            return row(&self.row(Some('}')));
        }
        self.element()
    }

    /// Reads the contents of braces as they are written.
    fn verbatim(&mut self) -> String {
        let rest = &self.letters[(self.place + 1).min(self.letters.len())..];
        let text: String = rest.iter().take_while(|&&letter| letter != '}').collect();
        self.place += text.chars().count() + 2;
        text.replace("\\_", "_")
    }

    /// Reads the next element.
    fn element(&mut self) -> String {
        let Some(letter) = self.peek() else { return String::new() };
        if letter.is_ascii_digit() {
            let number: String = self.letters[self.place..]
                .iter()
                .take_while(|letter| letter.is_ascii_digit() || **letter == '.')
                .collect();
            self.place += number.len();
            return format!("<mn>{number}</mn>");
        }
        if letter == '{' {
            return self.argument();
        }
        self.place += 1;
        match letter {
            '\\' => self.command(),
            '-' => MINUS.into(),
            '\'' => operator("′"),
            letter if letter.is_alphabetic() => format!("<mi>{letter}</mi>"),
            letter => operator(&letter.to_string()),
        }
    }

    fn command(&mut self) -> String {
        let name: String = self.letters[self.place..]
            .iter()
            .take_while(|letter| letter.is_ascii_alphabetic())
            .collect();
        self.place += name.len();
        match name.as_str() {
            "frac" => {
                let (above, below) = (self.argument(), self.argument());
                // Space on both sides of the bar, which only mathematical fonts provide.
                format!(
                    "<mfrac><mrow>{above}<mspace depth=\"0.25em\"/></mrow>\
                     <mrow><mspace height=\"0.9em\"/>{below}</mrow></mfrac>"
                )
            }
            "sqrt" => format!("<msqrt>{}</msqrt>", self.argument()),
            "dot" | "ddot" => {
                // Full stops, which stay clear of the letter even in fonts without accents.
                let dots = if name == "dot" { "." } else { ".." };
                format!("<mover>{}<mo>{dots}</mo></mover>", self.argument())
            }
            "left" => {
                let opening = self.peek().unwrap_or('(').to_string();
                self.place += 1;
                let inside = self.row(None);
                self.place += "\\right".len();
                let closing = self.peek().unwrap_or(')').to_string();
                self.place += 1;
                row(&format!("{}{inside}{}", fence(&opening), fence(&closing)))
            }
            "mathrm" | "operatorname" => {
                format!("<mi mathvariant=\"normal\">{}</mi>", self.verbatim())
            }
            "text" => format!("<mtext>{}</mtext>", self.verbatim()),
            "ldots" => operator("…"),
            "," | "" => String::new(),
            _ => match name::letter(&name) {
                Some(letter) => format!("<mi>{letter}</mi>"),
                None => format!("<mi>{name}</mi>"),
            },
        }
    }
}

fn fence(sign: &str) -> String {
    format!("<mo stretchy=\"true\">{sign}</mo>")
}

fn operator(sign: &str) -> String {
    format!("<mo>{sign}</mo>")
}

fn row(text: &str) -> String {
    format!("<mrow>{text}</mrow>")
}

#[cfg(test)]
mod tests {
    use super::equation;

    fn inside(latex: &str) -> String {
        let text = equation(latex);
        let text = text.strip_prefix("<math displaystyle=\"true\">").unwrap();
        text.strip_suffix("</math>").unwrap().replace("<mspace width=\"0.17em\"/>", " ")
    }

    #[test]
    fn dots_stand_over_their_letter() {
        assert_eq!(
            inside("\\ddot{\\theta} = -\\frac{g \\sin \\theta}{L}"),
            "<mover><mrow><mi>θ</mi></mrow><mo>..</mo></mover><mo>=</mo><mo form=\"prefix\">−</mo>\
             <mfrac><mrow><mrow><mi>g</mi> <mi>sin</mi> <mi>θ</mi></mrow><mspace depth=\"0.25em\"/>\
             </mrow><mrow><mspace height=\"0.9em\"/><mrow><mi>L</mi></mrow></mrow></mfrac>"
        );
    }

    #[test]
    fn exponents_and_indices_belong_to_the_element_before() {
        assert_eq!(
            inside("m l_{0}^{2} \\sin^{2}\\left(2 x\\right)"),
            "<mi>m</mi> <msubsup><mrow><mi>l</mi></mrow><mrow><mn>0</mn></mrow>\
             <mrow><mn>2</mn></mrow></msubsup> \
             <msup><mrow><mi>sin</mi></mrow><mrow><mn>2</mn></mrow></msup><mrow>\
             <mo stretchy=\"true\">(</mo><mn>2</mn> <mi>x</mi><mo stretchy=\"true\">)</mo></mrow>"
        );
    }

    /// The elements are balanced in every equation of the golden files.
    #[test]
    fn the_equations_of_the_golden_files_are_well_formed() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/golden");
        let mut count = 0;
        for entry in std::fs::read_dir(folder).unwrap() {
            let text = std::fs::read_to_string(entry.unwrap().path()).unwrap();
            for line in text.lines().filter_map(|line| line.strip_prefix("latex: ")) {
                let drawn = equation(line);
                let mut open: Vec<&str> = Vec::new();
                for tag in drawn.split('<').skip(1).filter_map(|part| part.split('>').next()) {
                    let name = tag.split(' ').next().unwrap();
                    match name.strip_prefix('/') {
                        Some(name) => assert_eq!(open.pop(), Some(name), "{line}"),
                        None if tag.ends_with('/') => {}
                        None => open.push(name),
                    }
                }
                assert!(open.is_empty() && !drawn.contains('\\'), "{line}\n{drawn}");
                // The numbers of dots and fractions are preserved.
                let dots = line.matches("dot{").count();
                assert_eq!(drawn.matches("<mover").count(), dots, "{line}");
                let fractions = line.matches("\\frac{").count();
                assert_eq!(drawn.matches("<mfrac>").count(), fractions, "{line}");
                count += 1;
            }
        }
        assert!(30 < count, "{count}");
    }
}

//! A bound of what the references of a drawing stand for, before they are followed.
//!
//! A mask may contain shapes with masks, and a marker is drawn at each vertex of a shape: a
//! kilobyte can stand for more elements than any memory holds. `usvg` bounds the elements of a file
//! and the copies by `use`, but not these.

use std::collections::BTreeMap;
use usvg::roxmltree::Node;

/// What a part of a drawing stands for.
#[derive(Clone, Copy, Default)]
struct Weight {
    /// The elements that are drawn.
    elements: u64,
    /// The elements of the part itself and of its copies, which inherit fills and strokes.
    own: u64,
    /// The letters of outlines: a bound of the vertices, at which markers are drawn.
    letters: u64,
}

impl Weight {
    fn add(&mut self, other: Self) {
        self.elements = self.elements.saturating_add(other.elements);
        self.own = self.own.saturating_add(other.own);
        self.letters = self.letters.saturating_add(other.letters);
    }
}

/// A rule of a style sheet.
struct Rule<'a> {
    /// The names of elements, classes and ids in its selector; without any, it selects all.
    names: Vec<&'a str>,
    declarations: &'a str,
}

/// The parts of a drawing and what they stand for, as far as it is known.
struct Weights<'a> {
    parts: BTreeMap<&'a str, Node<'a, 'a>>,
    rules: Vec<Rule<'a>>,
    /// No weight yet for parts that are being weighed: `usvg` cuts cycles.
    known: BTreeMap<&'a str, Weight>,
    /// The greatest depth of nested elements, through references.
    deepest: usize,
}

/// Returns a bound of the number of elements that a drawing stands for; the greatest number if they
/// are nested more deeply than `deepest`.
pub(super) fn elements<'a>(root: Node<'a, 'a>, deepest: usize) -> u64 {
    let mut parts = BTreeMap::new();
    for node in root.descendants() {
        if let Some(id) = node.attribute("id") {
            parts.entry(id).or_insert(node);
        }
    }
    let sheets = root.descendants().filter(|node| node.tag_name().name() == "style");
    let rules = sheets.filter_map(|sheet| sheet.text()).flat_map(rules).collect();
    Weights { parts, rules, known: BTreeMap::new(), deepest }.of(root, 0).elements
}

/// Returns the rules with references.
fn rules(sheet: &str) -> impl Iterator<Item = Rule<'_>> {
    let rules = sheet.split('}').filter_map(|rule| rule.rsplit_once('{'));
    rules.filter(|(_, declarations)| declarations.contains("url(")).map(
        |(selectors, declarations)| {
            let is_part = |letter: char| letter.is_alphanumeric() || "-_".contains(letter);
            let words = selectors.split(|letter| !is_part(letter)).filter(|word| !word.is_empty());
            // Other selectors than names count as selecting all.
            let names =
                if selectors.contains(['*', '[', ':']) { Vec::new() } else { words.collect() };
            Rule { names, declarations }
        },
    )
}

/// Returns the properties of a style with their values.
fn declared(style: &str) -> impl Iterator<Item = (&str, &str)> {
    let all = style.split(';').filter_map(|declaration| declaration.split_once(':'));
    all.map(|(name, value)| (name.trim(), value))
}

/// Returns the id in a value, as `url(#id)`.
fn referred(value: &str) -> Option<&str> {
    let (_, rest) = value.split_once("url(")?;
    let id = rest.split(')').next()?.trim_matches(|c: char| c.is_whitespace() || "'\"".contains(c));
    id.strip_prefix('#')
}

impl<'a> Weights<'a> {
    /// Returns the weight of an element with all that it contains and refers to.
    fn of(&mut self, node: Node<'a, 'a>, depth: usize) -> Weight {
        if self.deepest + 1 < depth {
            return Weight { elements: u64::MAX, ..Weight::default() };
        }
        let letters = ["d", "points"].map(|name| node.attribute(name).map_or(0, str::len));
        let letters = (letters[0] + letters[1]) as u64;
        let mut weight = Weight { elements: 1, own: 1, letters };
        for child in node.children().filter(Node::is_element) {
            weight.add(self.of(child, depth + 1));
        }
        let tag = node.tag_name().name();
        let mut properties: Vec<(&str, &str)> =
            node.attributes().map(|attribute| (attribute.name(), attribute.value())).collect();
        if let Some(style) = node.attribute("style") {
            properties.extend(declared(style));
        }
        let class = node.attribute("class").unwrap_or("");
        let names = class.split_whitespace().chain([tag]).chain(node.attribute("id"));
        for rule in &self.rules {
            let is_of = |name: &str| rule.names.contains(&name);
            if rule.names.is_empty() || names.clone().any(is_of) {
                properties.extend(declared(rule.declarations));
            }
        }
        for (name, value) in properties {
            let copied = if name == "href" { value.trim().strip_prefix('#') } else { None };
            let Some(id) = copied.or_else(|| referred(value)) else { continue };
            let part = self.part(id, depth + 1);
            let times = match name {
                "href" => {
                    weight.add(part);
                    continue;
                }
                "marker" | "marker-mid" => weight.letters,
                "fill" | "stroke" | "marker-start" | "marker-end" => weight.own,
                _ => 1,
            };
            let drawn = part.elements.saturating_mul(times);
            weight.elements = weight.elements.saturating_add(drawn);
        }
        weight
    }

    /// Returns the weight of the part with this id.
    fn part(&mut self, id: &'a str, depth: usize) -> Weight {
        if let Some(known) = self.known.get(id) {
            return *known;
        }
        self.known.insert(id, Weight::default());
        let Some(&node) = self.parts.get(id) else { return Weight::default() };
        // Gradients are read once, and contain nothing that is drawn.
        let is_gradient = node.tag_name().name().ends_with("Gradient");
        let weight = if is_gradient { Weight::default() } else { self.of(node, depth) };
        self.known.insert(id, weight);
        weight
    }
}

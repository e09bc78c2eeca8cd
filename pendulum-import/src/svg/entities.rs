//! The length of a text whose entities are expanded, before they are.

use std::collections::BTreeMap;

/// The depth to which entities may stand in entities; the parser refuses more than ten.
const DEEPEST: usize = 12;

/// Returns a bound of the work of expanding the entities of a text: the bytes that are inserted, and
/// the declarations that are searched for each of them.
pub(super) fn work(text: &str) -> u64 {
    let entities: Vec<(&str, &str)> = text
        .match_indices("<!ENTITY")
        .filter_map(|(at, word)| declared(&text[at + word.len()..]))
        .collect();
    let search = entities.len() as u64;
    let cost = |costs: &BTreeMap<&str, u64>, text: &str| -> u64 {
        let names = text.split('&').skip(1).filter_map(|rest| rest.split_once(';'));
        let known = names.filter_map(|(name, _)| costs.get(name));
        known.fold(0, |sum, cost| sum.saturating_add(*cost).saturating_add(search))
    };
    let mut costs = BTreeMap::new();
    for _ in 0..if entities.is_empty() { 0 } else { DEEPEST } {
        let mut deeper = BTreeMap::new();
        for &(name, value) in &entities {
            let inner = cost(&costs, value).saturating_add(value.len() as u64);
            // Of entities with one name, the parser takes the first; any may be the longest.
            let longest = deeper.entry(name).or_insert(inner);
            *longest = inner.max(*longest);
        }
        costs = deeper;
    }
    cost(&costs, text)
}

/// Returns the name and the value of an entity after `<!ENTITY`; `None` if it has no value of its
/// own.
fn declared(text: &str) -> Option<(&str, &str)> {
    let text = text.trim_start();
    let (name, text) =
        text.strip_prefix('%').unwrap_or(text).trim_start().split_once(char::is_whitespace)?;
    let mut letters = text.trim_start().chars();
    let quote = letters.next().filter(|quote| ['"', '\''].contains(quote))?;
    let (value, _) = letters.as_str().split_once(quote)?;
    Some((name, value))
}

#[cfg(test)]
mod tests {
    use super::work;

    #[test]
    fn work_is_what_is_inserted() {
        let head = "<!DOCTYPE svg [<!ENTITY a '12345678'> <!ENTITY % b\n\"&a;&a;\" > <!ENTITY c SYSTEM 'x'>]>";
        assert_eq!(work(head) - work("<svg>&amp;&#10; & &;</svg>"), 2 * (8 + 2));
        // The inner names count once more where they stand.
        let inner = 2 * (8 + 2) + 6;
        assert_eq!(work(&format!("{head}<svg a='&b;'>&a;&none;&lt;</svg>")), 20 + inner + 2 + 10);
        assert_eq!(work("<svg>&a;</svg>"), 0);
        // An entity that stands in itself is the parser's to refuse.
        assert!(work("<!ENTITY a '&a;&a;'><!ENTITY a ''>&a;") < 100_000);
        assert_eq!(work(&format!("<!ENTITY a '{}'>&a;", "&a;".repeat(1 << 12))), u64::MAX);
    }
}

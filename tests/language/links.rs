//! The links of all pages: files, headings, pages of the guide and definitions.

use std::fs;
use std::path::{Path, PathBuf};

/// The folder of the guide's pages.
const GUIDE: &str = "pendulum-runtime/src/guide";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Adds the files of a folder with an extension to `found`, including subfolders if `deep`.
fn files(folder: &Path, extension: &str, deep: bool, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            if deep {
                files(&path, extension, true, found);
            }
        } else if path.extension().is_some_and(|found| found == extension) {
            found.push(path);
        }
    }
}

/// Returns the pages of the repository. The README of `pendulum-runtime` is a link to the README at
/// the root.
fn pages() -> Vec<PathBuf> {
    let mut found = Vec::new();
    for folder in ["", "docs", "examples", "examples/data", GUIDE] {
        files(&root().join(folder), "md", false, &mut found);
    }
    found
}

/// Returns the text of a page without its code.
fn prose(text: &str) -> String {
    let mut fenced = false;
    let mut prose = String::new();
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
        } else if !fenced {
            prose.push_str(line);
        }
        prose.push('\n');
    }
    // Code within lines: every second part between backticks.
    prose.split('`').enumerate().map(|(k, part)| if k % 2 == 0 { part } else { "code" }).collect()
}

/// Returns the anchors of the headings of a page, as GitHub and rustdoc create them.
fn anchors(text: &str) -> Vec<String> {
    let mut fenced = false;
    let mut anchors: Vec<String> = Vec::new();
    for line in text.lines() {
        fenced ^= line.trim_start().starts_with("```");
        let heading = line.trim_start_matches('#');
        if fenced || heading.len() == line.len() || !heading.starts_with(' ') {
            continue;
        }
        let anchor: String = heading
            .trim()
            .chars()
            .filter(|c| c.is_alphanumeric() || " -_".contains(*c))
            .map(|c| if c == ' ' { '-' } else { c.to_ascii_lowercase() })
            .collect();
        let before = anchors.iter().filter(|found| **found == anchor).count();
        anchors.push(if before == 0 { anchor } else { format!("{anchor}-{before}") });
    }
    anchors
}

/// Returns the text up to one of the characters `end`.
fn until<'a>(text: &'a str, end: &[char]) -> &'a str {
    text.split(end).next().unwrap_or_default()
}

/// Returns the targets of links and pictures, in Markdown and in HTML, and of definitions.
fn targets(prose: &str) -> Vec<&str> {
    let mut targets: Vec<&str> =
        prose.split("](").skip(1).map(|part| until(part, &[')', ' ', '\n'])).collect();
    for attribute in ["src=\"", "srcset=\"", "href=\""] {
        targets.extend(prose.split(attribute).skip(1).map(|part| until(part, &['"'])));
    }
    targets.extend(definitions(prose).map(|(_, target)| target));
    targets
}

/// Returns the definitions of a page, `[name]: target`.
fn definitions(prose: &str) -> impl Iterator<Item = (&str, &str)> {
    prose.lines().filter_map(|line| line.strip_prefix('[')?.split_once("]: "))
}

/// Returns the fault of a link to a heading of a page, if any.
fn heading_fault(page: &Path, anchor: Option<&str>) -> Option<String> {
    let Ok(text) = fs::read_to_string(page) else {
        return Some(format!("there is no page {}", page.display()));
    };
    let anchor = anchor?;
    (!anchors(&text).iter().any(|found| found == anchor))
        .then(|| format!("no heading of {} has the anchor {anchor}", page.display()))
}

/// Returns the fault of a link, if any.
fn fault(page: &Path, target: &str) -> Option<String> {
    let (path, anchor) = match target.split_once('#') {
        Some((path, anchor)) => (path, Some(anchor)),
        None => (target, None),
    };
    if let Some((_, name)) = path.split_once("guide::") {
        // rustdoc checks the paths of other items.
        return heading_fault(&root().join(GUIDE).join(format!("{name}.md")), anchor);
    }
    if path.contains("://docs.rs/pendulum") {
        return Some(format!("{path} is not published"));
    }
    if path.contains("://") || path.contains("::") {
        return None;
    }
    if path.is_empty() {
        return heading_fault(page, anchor);
    }
    let file = page.parent()?.join(path);
    if !file.exists() {
        return Some(format!("there is no file {path}"));
    }
    anchor.and_then(|anchor| heading_fault(&file, Some(anchor)))
}

/// Returns the faults of a page and the number of its links.
fn faults(page: &Path, text: &str) -> (Vec<String>, usize) {
    let prose = prose(text);
    let targets = targets(&prose);
    let mut faults: Vec<String> = targets.iter().filter_map(|target| fault(page, target)).collect();
    for name in prose.split("][").skip(1).map(|part| until(part, &[']', '\n'])) {
        if !definitions(&prose).any(|(defined, _)| defined == name) {
            faults.push(format!("[{name}] is not defined"));
        }
    }
    (
        faults.into_iter().map(|fault| format!("{}: {fault}", page.display())).collect(),
        targets.len(),
    )
}

#[test]
fn links_lead_to_files_headings_and_definitions() {
    let (mut all, mut links) = (Vec::new(), 0);
    for page in pages() {
        let (faults, count) = faults(&page, &fs::read_to_string(&page).unwrap());
        all.extend(faults);
        links += count;
    }
    assert!(all.is_empty(), "{}", all.join("\n"));
    assert!(links > 60, "{links}");
}

/// Until the pages are published, they are read as files of the repository: there, paths of items
/// lead nowhere, and hidden lines are seen.
#[test]
fn pages_of_the_guide_are_readable_as_files() {
    let mut pages = Vec::new();
    files(&root().join(GUIDE), "md", false, &mut pages);
    assert!(8 < pages.len());
    for page in pages {
        let text = fs::read_to_string(&page).unwrap();
        let prose = prose(&text);
        let path = targets(&prose).into_iter().find(|target| target.contains("::"));
        assert_eq!(path, None, "{}", page.display());
        let hidden = text.split("```rust").skip(1).find_map(|program| {
            let program = program.split("```").next().unwrap_or_default();
            program.lines().find(|line| *line == "#" || line.starts_with("# "))
        });
        assert_eq!(hidden, None, "{}", page.display());
    }
}

/// rustdoc checks the pages of such links, but not their headings.
#[test]
fn documentation_links_headings_of_the_guide() {
    let (mut sources, mut links) = (Vec::new(), 0);
    files(&root().join("pendulum-runtime/src"), "rs", true, &mut sources);
    for source in sources {
        let text = fs::read_to_string(&source).unwrap();
        for line in text.lines().filter(|line| line.trim_start().starts_with("//")) {
            for target in line.split("](").skip(1).map(|part| until(part, &[')'])) {
                if target.contains("guide::") {
                    assert_eq!(fault(&source, target), None, "{}", source.display());
                    links += 1;
                }
            }
        }
    }
    assert!(links > 5, "{links}");
}

#[test]
fn each_kind_of_dead_link_is_found() {
    let page = root().join("README.md");
    let dead = [
        "[a](no/such/file.rs)",
        "![a](no/such/picture.svg)",
        "[a](CONTRIBUTING.md#no-such-heading)",
        "[a](#no-such-heading)",
        "[a](crate::guide::no_such_page)",
        "[a](crate::guide::accuracy#no-such-heading)",
        "[a](pendulum-runtime/src/guide/no_such_page.md)",
        "[a](pendulum-runtime/src/guide/scenes.md#no-such-heading)",
        "[a](https://docs.rs/pendulum-runtime)",
        "<img src=\"no/such/picture.png\">",
        "<a href=\"#no-such-heading\">a</a>",
        "[a][never defined]",
        "[a]: no/such/file.rs",
    ];
    for text in dead {
        assert_eq!(faults(&page, text).0.len(), 1, "{text}");
    }
    let alive = [
        "[a](CONTRIBUTING.md#benchmarks)",
        "[a](crate::guide::accuracy#bounds-that-do-not-hold)",
        "[a](crate::integrate::Solution)",
        "`[a](in/code)`\n```text\n[a](in/a/block)\n```\n",
        "[a][b]\n\n[b]: docs/architecture.md#layers",
    ];
    for text in alive {
        assert_eq!(faults(&page, text).0, Vec::<String>::new(), "{text}");
    }
}

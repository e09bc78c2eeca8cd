//! The page of the gallery, created from the sources of its systems: title and text from the
//! comment at the top, block, program, and the equations derived by the compiler. Pictures of
//! guides are embedded as data for pages that cannot have separate files.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use pendulum_compiler::compile;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// The systems in the order of the page: name of the picture, and source.
pub(crate) const SYSTEMS: [(&str, &str); 15] = [
    ("double-pendulum", include_str!("systems/double_pendulum.rs")),
    ("cart-pole", include_str!("systems/cart_pole.rs")),
    ("elastic-pendulum", include_str!("systems/elastic_pendulum.rs")),
    ("kepler", include_str!("systems/kepler.rs")),
    ("top", include_str!("systems/top.rs")),
    ("t-handle", include_str!("systems/t_handle.rs")),
    ("quadrotor", include_str!("systems/quadrotor.rs")),
    ("satellite", include_str!("systems/satellite.rs")),
    ("foucault", include_str!("systems/foucault.rs")),
    ("wilberforce", include_str!("systems/wilberforce.rs")),
    ("atwood", include_str!("systems/atwood.rs")),
    ("bead-on-hoop", include_str!("systems/bead_on_hoop.rs")),
    ("charged-particle", include_str!("systems/charged_particle.rs")),
    ("furuta", include_str!("systems/furuta.rs")),
    ("four-bar", include_str!("systems/four_bar.rs")),
];

const HEAD: &str = "\
# Gallery

Fifteen systems: what is written, the equations that `lagrangian!` derives from it, and the motion.
The page is made from programs: `cargo run --release -p pictures --features compiler --bin
gallery` runs them again. Take the block that is nearest to yours and change it.
";

/// Returns the folder of the guide.
pub(crate) fn guide() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../pendulum-runtime/src/guide")
}

/// Returns the whole page. An error states what is missing in a source.
pub(crate) fn page() -> Result<String, String> {
    let mut page = HEAD.to_owned();
    for (name, source) in SYSTEMS {
        section(&mut page, name, source).map_err(|what| format!("{name}: {what}"))?;
    }
    page.push('\n');
    for (name, _) in SYSTEMS {
        let _ = writeln!(page, "[{name}]: figures/{name}.svg");
    }
    Ok(page)
}

fn section(page: &mut String, name: &str, source: &str) -> Result<(), String> {
    let comment: Vec<&str> = source
        .lines()
        .map_while(|line| line.strip_prefix("//!"))
        .map(|line| line.strip_prefix(' ').unwrap_or(line))
        .collect();
    let [title, _, text @ ..] = &comment[..] else { return Err("no title".into()) };
    let block = between(source, "lagrangian! {\n", "\n}\n").ok_or("no block")?;
    let body = between(source, "fn motion() -> ", "\n}\n")
        .and_then(|motion| motion.split_once("{\n"))
        .and_then(|(_, body)| body.strip_suffix("\n    Ok(motion)"))
        .ok_or("no motion")?;
    let compiled = compile(block).map_err(|messages| format!("{messages:?}"))?;
    let _ = writeln!(
        page,
        "\n## {title}\n\n{}\n\n![The motion: {title}][{name}]\n\n```rust\n\
         use pendulum_runtime::prelude::*;\n\nlagrangian! {{\n{block}\n}}\n\n\
         fn main() -> Result<(), Box<dyn std::error::Error>> {{\n{body}\n    \
         println!(\"{{}}\", motion.table());\n    Ok(())\n}}\n```\n\n```text\n{}\n```\n\n\
         One evaluation takes {}.{}",
        text.join("\n"),
        compiled.equations.join("\n"),
        compiled.operations,
        match &compiled.conserved[..] {
            [] => String::new(),
            list => format!(" Conserved: `{}`.", list.join("`, `")),
        }
    );
    Ok(())
}

fn between<'a>(text: &'a str, before: &str, after: &str) -> Option<&'a str> {
    let rest = &text[text.find(before)? + before.len()..];
    Some(&rest[..rest.find(after)?])
}

/// Returns the definitions at the end of a page, `[name]: path`.
fn definitions(page: &str) -> impl Iterator<Item = (&str, &str)> {
    page.lines().filter_map(|line| line.strip_prefix('[')?.split_once("]: "))
}

/// Returns the pictures of a page as definitions with data. If this text precedes the page, its
/// definitions take precedence over those of the page, which are intended for readers of the file.
pub(crate) fn pictures(page: &str) -> std::io::Result<String> {
    let mut text = String::new();
    for (name, path) in definitions(page).filter(|(_, path)| path.contains("figures/")) {
        let data = std::fs::read(guide().join(path))?;
        let kind = if Path::new(path).extension().is_some_and(|kind| kind == "png") {
            "png"
        } else {
            "svg+xml"
        };
        let _ = writeln!(text, "[{name}]: data:image/{kind};base64,{}", STANDARD.encode(data));
    }
    Ok(text)
}

/// The pages with pictures.
pub(crate) const ILLUSTRATED: [&str; 4] = ["gallery", "scenes", "ensembles", "accuracy"];

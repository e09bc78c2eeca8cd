//! `cargo run --release -p pictures --features compiler --bin gallery` runs the systems of the
//! gallery, draws their motions into `pendulum-runtime/src/guide/figures`, and writes the page
//! `gallery.md` beside them. Pictures are also embedded in pages as data, for docs.rs.

// The modules are programs shown on the page. Items that they do not print need no documentation.
#![allow(missing_docs)]

mod page;
mod picture;
mod prelude;

mod systems {
    pub(crate) mod atwood;
    pub(crate) mod bead_on_hoop;
    pub(crate) mod cart_pole;
    pub(crate) mod charged_particle;
    pub(crate) mod double_pendulum;
    pub(crate) mod elastic_pendulum;
    pub(crate) mod foucault;
    pub(crate) mod four_bar;
    pub(crate) mod furuta;
    pub(crate) mod kepler;
    pub(crate) mod quadrotor;
    pub(crate) mod satellite;
    pub(crate) mod t_handle;
    pub(crate) mod top;
    pub(crate) mod wilberforce;
}

use page::{ILLUSTRATED, SYSTEMS, guide, page, pictures};

fn main() -> prelude::Result<()> {
    // The order is that of `SYSTEMS`.
    let drawn = [
        systems::double_pendulum::picture()?,
        systems::cart_pole::picture()?,
        systems::elastic_pendulum::picture()?,
        systems::kepler::picture()?,
        systems::top::picture()?,
        systems::t_handle::picture()?,
        systems::quadrotor::picture()?,
        systems::satellite::picture()?,
        systems::foucault::picture()?,
        systems::wilberforce::picture()?,
        systems::atwood::picture()?,
        systems::bead_on_hoop::picture()?,
        systems::charged_particle::picture()?,
        systems::furuta::picture()?,
        systems::four_bar::picture()?,
    ];
    for ((name, _), picture) in SYSTEMS.iter().zip(&drawn) {
        let svg = picture.svg();
        println!("{name}.svg: {} kB", svg.len().div_ceil(1000));
        std::fs::write(guide().join(format!("figures/{name}.svg")), svg)?;
    }
    std::fs::write(guide().join("gallery.md"), page()?)?;
    for name in ILLUSTRATED {
        let text = std::fs::read_to_string(guide().join(format!("{name}.md")))?;
        std::fs::write(guide().join(format!("figures/{name}.uri")), pictures(&text)?)?;
    }
    Ok(())
}

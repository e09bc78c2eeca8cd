//! The shared parts of both maps: options, a progress bar, and a picture.

use indicatif::{ProgressBar, ProgressStyle};
use lexopt::prelude::*;
use std::error::Error;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::PathBuf;

/// The options of a map.
#[derive(Clone, Debug)]
pub struct Options {
    /// The number of pixels in each direction.
    pub size: usize,
    /// The number of threads.
    pub threads: usize,
    /// The path of the picture.
    pub output: PathBuf,
    /// The folder for finished shards, if any.
    pub checkpoint: Option<PathBuf>,
}

impl Options {
    /// Reads the command line of the map `name`.
    ///
    /// # Errors
    /// An option is unknown or has no number.
    pub fn read(name: &str) -> Result<Self, Box<dyn Error>> {
        let mut options = Self {
            size: 400,
            threads: std::thread::available_parallelism().map_or(1, usize::from),
            output: PathBuf::from(format!("target/{name}.png")),
            checkpoint: None,
        };
        let mut words = lexopt::Parser::from_env();
        while let Some(word) = words.next()? {
            match word {
                Long("size") => options.size = words.value()?.parse()?,
                Long("threads") => options.threads = words.value()?.parse()?,
                Long("output") => options.output = words.value()?.into(),
                Long("checkpoint") => options.checkpoint = Some(words.value()?.into()),
                Short('h') | Long("help") => {
                    println!(
                        "{name} [--size PIXELS] [--threads COUNT] [--output FILE] [--checkpoint FOLDER]"
                    );
                    std::process::exit(0);
                }
                other => return Err(other.unexpected().into()),
            }
        }
        if options.size == 0 || 20_000 < options.size {
            return Err("`--size` has to be from 1 to 20000".into());
        }
        Ok(options)
    }

    /// Runs `work` on `self.threads` threads.
    ///
    /// # Errors
    /// The threads cannot be started.
    pub fn on_threads<R: Send>(
        &self,
        work: impl FnOnce() -> R + Send,
    ) -> Result<R, Box<dyn Error>> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.threads).build()?;
        Ok(pool.install(work))
    }

    /// Writes a picture of `size` × `size` pixels with red, green and blue components, from the top
    /// row to the bottom row.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, pixels: &[[u8; 3]]) -> Result<(), Box<dyn Error>> {
        if let Some(folder) = self.output.parent() {
            fs::create_dir_all(folder)?;
        }
        let file = BufWriter::new(File::create(&self.output)?);
        let size = u32::try_from(self.size)?;
        let mut encoder = png::Encoder::new(file, size, size);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.write_header()?.write_image_data(pixels.as_flattened())?;
        println!("{}", self.output.display());
        Ok(())
    }
}

/// Returns a progress bar for a number of members.
pub fn bar(members: usize) -> ProgressBar {
    let style = "{wide_bar} {percent:>3} %, {pos} of {len}, {eta} left";
    let bar = ProgressBar::new(members as u64);
    ProgressStyle::with_template(style).map_or(bar.clone(), |style| bar.with_style(style))
}

/// Returns the coordinate of the centre of a pixel, from −`most` to `most`.
pub fn place(pixel: usize, size: usize, most: f64) -> f64 {
    most * (2.0 * (pixel as f64 + 0.5) / size as f64 - 1.0)
}

/// Interpolates between two colours; `part` is clamped to [0, 1].
pub fn mix(from: [f64; 3], to: [f64; 3], part: f64) -> [f64; 3] {
    let part = part.clamp(0.0, 1.0);
    std::array::from_fn(|i| from[i] + part * (to[i] - from[i]))
}

/// Converts a colour with components from 0 to 1 to bytes.
pub fn bytes(color: [f64; 3]) -> [u8; 3] {
    color.map(|component| (255.0 * component).round().clamp(0.0, 255.0) as u8)
}

//! The table of error control: `cargo run --release -p zoo --features all -- [--quick] [--family
//! NAME] [--scalar f32|f64|dd] [--method NAME] [--count N] [--run K] [--threads N] [--no-time]
//! [--verbose] [--markdown PATH] [--csv PATH]`.
//!
//! Without `--features all`, the build takes a fraction of the time and contains only the families
//! of the short test. `--profile zoo` instead of `--release` builds faster after a change.
//! `--family` and `--method` may be given several times. The program fails if a bar is missed.

use lexopt::prelude::*;
use std::process::ExitCode;
use zoo::Options;

fn main() -> ExitCode {
    let options = match read() {
        Ok(options) => options,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::from(2);
        }
    };
    match zoo::run(&options) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

fn read() -> Result<Options, lexopt::Error> {
    let mut options = Options::default();
    let mut parser = lexopt::Parser::from_env();
    while let Some(argument) = parser.next()? {
        match argument {
            Long("quick") => options.count = 10,
            Long("count") => options.count = parser.value()?.parse()?,
            Long("run") => options.run = Some(parser.value()?.parse()?),
            Long("family") => options.families.push(parser.value()?.string()?),
            Long("scalar") => options.scalars.push(parser.value()?.string()?),
            Long("method") => options.methods.push(parser.value()?.string()?),
            Long("threads") => options.threads = parser.value()?.parse()?,
            Long("no-time") => options.clock = false,
            Long("verbose") => options.verbose = true,
            Long("csv") => options.csv = Some(parser.value()?.into()),
            Long("markdown") => options.markdown = Some(parser.value()?.into()),
            _ => return Err(argument.unexpected()),
        }
    }
    Ok(options)
}

//! Rows that another process runs and times on request.
//!
//! The output of the process is a line with its versions, a line for each row (system, method and
//! setting, separated by tabs), and `ready`. For each index that the process then reads, it prints
//! the seconds, the evaluations and the values, separated by spaces, or `failed` and the reason.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use systems::work_precision::measure::Run;

/// A process that provides rows.
pub struct Peer {
    /// The versions, as printed by the process.
    pub versions: String,
    /// The rows of the process: system, method, setting.
    pub rows: Vec<[String; 3]>,
    child: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
}

impl Peer {
    /// Starts the process and reads its rows.
    pub fn start(command: &mut Command) -> Result<Self, String> {
        let child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
        let mut child =
            child.map_err(|error| format!("{}: {error}", command.get_program().display()))?;
        let (input, output) = (child.stdin.take(), child.stdout.take().expect("a pipe"));
        let (versions, rows, output) = (String::new(), Vec::new(), BufReader::new(output));
        let mut peer = Self { versions, rows, child, input, output };
        peer.versions = peer.line()?;
        loop {
            let line = peer.line()?;
            if line == "ready" {
                return Ok(peer);
            }
            let mut words = line.split('\t').map(String::from);
            match [words.next(), words.next(), words.next()] {
                [Some(system), Some(method), Some(setting)] => {
                    peer.rows.push([system, method, setting]);
                }
                _ => return Err(format!("not a row: {line}")),
            }
        }
    }

    /// Requests a sample of a row.
    pub fn sample(&mut self, index: usize) -> Result<(f64, Run), String> {
        let input = self.input.as_mut().ok_or("it has ended")?;
        writeln!(input, "{index}")
            .and_then(|()| input.flush())
            .map_err(|error| error.to_string())?;
        let line = self.line()?;
        if let Some(reason) = line.strip_prefix("failed") {
            return Err(reason.trim().to_string());
        }
        let mut words = line.split(' ');
        let seconds = words
            .next()
            .and_then(|word| word.parse().ok())
            .ok_or_else(|| format!("no time: {line}"))?;
        let evaluations = words
            .next()
            .and_then(|word| word.parse().ok())
            .ok_or_else(|| format!("no count: {line}"))?;
        let values = words
            .map(str::parse)
            .collect::<Result<_, _>>()
            .map_err(|error| format!("{error}: {line}"))?;
        Ok((seconds, Run { values, evaluations }))
    }

    /// Closes the input of the process, and waits until the process has ended.
    pub fn end(mut self) {
        self.input = None;
        // The exit status is ignored.
        let _ = self.child.wait();
    }

    fn line(&mut self) -> Result<String, String> {
        let mut line = String::new();
        match self.output.read_line(&mut line) {
            Ok(0) => Err("it has ended".to_string()),
            Ok(_) => Ok(line.trim_end().to_string()),
            Err(error) => Err(error.to_string()),
        }
    }
}

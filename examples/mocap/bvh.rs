//! Reads motion capture in the BVH format: a skeleton with offsets and channels, and a row of
//! numbers for each frame.
//!
//! Meredith and Maddock, "Motion Capture File Formats Explained" (2001), section 3. A joint's
//! position channels take the place of its offset. Rotations are applied in the order of the
//! channels: `Zrotation Yrotation Xrotation` is `R_z R_y R_x`, in degrees.

use pendulum_runtime::scalar::Real;
use std::fmt;

/// No skeleton has more joints; a file that does is something else.
const MOST_JOINTS: usize = 4096;

/// No pose is farther away or turned farther.
const LARGEST: f64 = 1e9;

/// A skeleton and its motion.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Bvh {
    /// Parents stand before their children.
    pub(crate) joints: Vec<Joint>,
    /// The time between frames in seconds.
    pub(crate) frame_time: f64,
    /// The channels of all joints, frame after frame.
    rows: Vec<f64>,
    /// The number of channels.
    width: usize,
}

/// A joint, or the end of a limb.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Joint {
    /// The name in the file; an end site has that of its parent and " end".
    pub(crate) name: String,
    /// The index of the parent, unless this is a root.
    pub(crate) parent: Option<usize>,
    /// An end site, which has no channels.
    pub(crate) end: bool,
    offset: Option<[f64; 3]>,
    channels: Vec<Channel>,
    /// `CHANNELS` was read.
    listed: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Channel {
    Position(usize),
    Rotation(usize),
}

/// Why a file cannot be read: where, what is wrong, what to do.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BvhError {
    line: usize,
    what: String,
    advice: &'static str,
}

impl fmt::Display for BvhError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}; {}", self.line, self.what, self.advice)
    }
}

impl std::error::Error for BvhError {}

impl Bvh {
    /// Reads the text of a file.
    pub(crate) fn read(text: &str) -> Result<Self, BvhError> {
        let mut reader = Reader::new(text);
        let joints = reader.hierarchy()?;
        let width = joints.iter().map(|joint| joint.channels.len()).sum();
        let (frame_time, rows) = reader.motion(width)?;
        Ok(Self { joints, frame_time, rows, width })
    }

    /// The number of frames, at least one.
    pub(crate) fn frames(&self) -> usize {
        self.rows.len() / self.width
    }

    /// The positions of all joints in a frame, in the file's unit of length.
    pub(crate) fn pose(&self, frame: usize) -> Vec<[f64; 3]> {
        let mut values = self.rows[frame * self.width..][..self.width].iter();
        let mut places: Vec<Place> = Vec::with_capacity(self.joints.len());
        for joint in &self.joints {
            let mut local = Place { turn: IDENTITY, at: joint.offset.unwrap_or_default() };
            for (channel, &value) in joint.channels.iter().zip(&mut values) {
                match *channel {
                    Channel::Position(axis) => local.at[axis] = value,
                    Channel::Rotation(axis) => {
                        local.turn = product(&local.turn, &rotation(axis, value));
                    }
                }
            }
            places.push(match joint.parent {
                Some(parent) => places[parent].then(&local),
                None => local,
            });
        }
        places.into_iter().map(|place| place.at).collect()
    }
}

type Matrix = [[f64; 3]; 3];

const IDENTITY: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The place of a joint and its turn.
struct Place {
    turn: Matrix,
    at: [f64; 3],
}

impl Place {
    fn then(&self, local: &Self) -> Self {
        let mut at = self.at;
        for (value, row) in at.iter_mut().zip(&self.turn) {
            *value += row[0] * local.at[0] + row[1] * local.at[1] + row[2] * local.at[2];
        }
        Self { turn: product(&self.turn, &local.turn), at }
    }
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let mut c = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            c[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
        }
    }
    c
}

/// The right-handed turn about an axis, in degrees.
fn rotation(axis: usize, degrees: f64) -> Matrix {
    // Whole turns go first, so that a right angle after them is still one.
    let (sin, cos) = Real::sin_cos((degrees % 360.0).to_radians());
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut matrix = [[0.0; 3]; 3];
    matrix[axis][axis] = 1.0;
    matrix[next][next] = cos;
    matrix[last][last] = cos;
    matrix[next][last] = -sin;
    matrix[last][next] = sin;
    matrix
}

/// The lines that are not blank, with their numbers from one.
struct Reader<'a> {
    lines: Vec<(usize, &'a str)>,
    /// The line that is read next.
    next: usize,
}

/// One word and its line.
type Word<'a> = (usize, &'a str);

impl<'a> Reader<'a> {
    fn new(text: &'a str) -> Self {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let lines = text.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
        Self { lines: lines.filter(|(_, line)| !line.is_empty()).collect(), next: 0 }
    }

    /// The number of the last line, for what is missing at the end.
    fn end(&self) -> usize {
        self.lines.last().map_or(1, |line| line.0)
    }

    fn line(&mut self, missing: &str) -> Result<(usize, &'a str), BvhError> {
        let found = self.lines.get(self.next).copied();
        self.next += 1;
        found.ok_or_else(|| {
            error(
                self.end(),
                format!("the file ends before {missing}"),
                "it was cut off: copy it again",
            )
        })
    }

    /// Everything up to the line `MOTION`.
    fn hierarchy(&mut self) -> Result<Vec<Joint>, BvhError> {
        let (line, first) = self.line("HIERARCHY")?;
        if !first.eq_ignore_ascii_case("HIERARCHY") {
            return Err(error(
                line,
                format!("`{}` where HIERARCHY must stand", short(first)),
                "give a BVH file",
            ));
        }
        let mut tree = Tree::default();
        loop {
            let (line, text) = self.line("MOTION")?;
            if text.eq_ignore_ascii_case("MOTION") {
                return tree.finish(line);
            }
            // Braces may share a line with the words before them.
            let spaced = text.replace('{', " { ").replace('}', " } ");
            let words: Vec<Word<'_>> = spaced.split_whitespace().map(|word| (line, word)).collect();
            tree.line(&words)?;
        }
    }

    /// The time between frames and the rows.
    fn motion(&mut self, width: usize) -> Result<(f64, Vec<f64>), BvhError> {
        let (line, text) = self.line("`Frames:`")?;
        let count = after(text, &["Frames"]).ok_or_else(|| {
            error(
                line,
                format!("`{}` where `Frames: …` must stand", short(text)),
                "write the number of frames there",
            )
        })?;
        let frames: usize = count.parse().map_err(|_| {
            error(
                line,
                format!("`{}` is no number of frames", short(count)),
                "write the number of rows that follow",
            )
        })?;
        let (line_of_time, text) = self.line("`Frame Time:`")?;
        let step = after(text, &["Frame", "Time"]).ok_or_else(|| {
            error(
                line_of_time,
                format!("`{}` where `Frame Time: …` must stand", short(text)),
                "write the seconds between frames",
            )
        })?;
        let frame_time = number((line_of_time, step))?;
        if frame_time <= 0.0 {
            return Err(error(
                line_of_time,
                format!("a frame time of {step} s"),
                "write a positive number of seconds",
            ));
        }
        let rows = self.lines.get(self.next..).unwrap_or_default();
        if frames == 0 {
            return Err(error(line, "the file has no frames".into(), "record at least one"));
        }
        // Before anything is reserved: the count is compared with the rows that are there.
        if rows.len() < frames {
            let what = format!("{frames} frames are announced, {} rows follow", rows.len());
            return Err(error(
                line,
                what,
                "correct the number, or copy the file again if it was cut off",
            ));
        }
        if frames < rows.len() {
            let what = format!("a row after the last of {frames} frames");
            return Err(error(
                rows[frames].0,
                what,
                "correct the number at `Frames:` or remove the row",
            ));
        }
        let mut values = Vec::new();
        for &(line, row) in rows {
            let before = values.len();
            for word in row.split_whitespace() {
                values.push(number((line, word))?);
            }
            let found = values.len() - before;
            if found != width {
                let what = format!("{found} numbers in the row, {width} channels in the hierarchy");
                return Err(error(line, what, "give each channel one number, all on one line"));
            }
        }
        Ok((frame_time, values))
    }
}

/// The joints read so far.
#[derive(Default)]
struct Tree {
    joints: Vec<Joint>,
    /// The joints whose braces are open, with the lines of their names.
    open: Vec<(usize, usize)>,
    /// A joint was named and its brace has not come yet.
    named: bool,
}

impl Tree {
    fn line(&mut self, mut words: &[Word<'_>]) -> Result<(), BvhError> {
        while let Some((&(line, word), rest)) = words.split_first() {
            if self.named && word != "{" {
                return Err(error(
                    line,
                    format!("`{}` where the brace of a joint must open", short(word)),
                    "write `{` there",
                ));
            }
            let used = match word.to_ascii_uppercase().as_str() {
                "{" if self.named => {
                    self.named = false;
                    0
                }
                "}" => {
                    self.close(line)?;
                    0
                }
                "ROOT" => self.name(line, rest, false)?,
                "JOINT" => self.name(line, rest, false)?,
                "END" => self.name(line, rest, true)?,
                "OFFSET" => self.offset(line, rest)?,
                "CHANNELS" => self.channels(line, rest)?,
                _ => {
                    let what = format!("`{}` is not known in a hierarchy", short(word));
                    return Err(error(
                        line,
                        what,
                        "it takes ROOT, JOINT, End Site, OFFSET, CHANNELS, braces, then MOTION",
                    ));
                }
            };
            words = &rest[used..];
        }
        Ok(())
    }

    /// A new joint in the one that is open; says how many words its name has.
    fn name(&mut self, line: usize, rest: &[Word<'_>], end: bool) -> Result<usize, BvhError> {
        let count = rest.iter().position(|(_, word)| *word == "{").unwrap_or(rest.len());
        let words: Vec<&str> = rest[..count].iter().map(|(_, word)| *word).collect();
        let parent = self.open.last().map(|&(joint, _)| joint);
        if let Some(parent) = parent
            && self.joints[parent].end
        {
            return Err(error(
                line,
                "a joint inside an end site".into(),
                "close the end site first, or make it a JOINT",
            ));
        }
        let name = match parent {
            Some(parent) if end => format!("{} end", self.joints[parent].name),
            None if end => {
                return Err(error(
                    line,
                    "an end site outside of all joints".into(),
                    "put it into a joint",
                ));
            }
            _ => words.join(" "),
        };
        if name.is_empty() {
            return Err(error(
                line,
                "a joint without a name".into(),
                "write its name after ROOT or JOINT",
            ));
        }
        if self.joints.len() == MOST_JOINTS {
            return Err(error(
                line,
                format!("more than {MOST_JOINTS} joints"),
                "give a file with one skeleton",
            ));
        }
        self.open.push((self.joints.len(), line));
        self.named = true;
        self.joints.push(Joint {
            name,
            parent,
            end,
            offset: None,
            channels: Vec::new(),
            listed: false,
        });
        Ok(count)
    }

    fn current(&mut self, line: usize, word: &str) -> Result<&mut Joint, BvhError> {
        match self.open.last() {
            Some(&(joint, _)) => Ok(&mut self.joints[joint]),
            None => Err(error(
                line,
                format!("{word} outside of all joints"),
                "put it between the braces of a joint",
            )),
        }
    }

    fn close(&mut self, line: usize) -> Result<(), BvhError> {
        let joint = self.current(line, "a closing brace")?;
        if joint.offset.is_none() {
            let what = format!("`{}` has no OFFSET", short(&joint.name));
            return Err(error(
                line,
                what,
                "write three numbers after OFFSET before the brace closes",
            ));
        }
        self.open.pop();
        Ok(())
    }

    fn offset(&mut self, line: usize, rest: &[Word<'_>]) -> Result<usize, BvhError> {
        let joint = self.current(line, "OFFSET")?;
        if joint.offset.is_some() {
            return Err(error(
                line,
                format!("a second OFFSET in `{}`", short(&joint.name)),
                "keep one of them",
            ));
        }
        let words = rest.get(..3).ok_or_else(|| {
            error(
                line,
                format!("OFFSET with {} numbers", rest.len()),
                "write three, along x, y and z, on one line",
            )
        })?;
        let mut offset = [0.0; 3];
        for (value, word) in offset.iter_mut().zip(words) {
            *value = number(*word)?;
        }
        joint.offset = Some(offset);
        Ok(3)
    }

    fn channels(&mut self, line: usize, rest: &[Word<'_>]) -> Result<usize, BvhError> {
        let joint = self.current(line, "CHANNELS")?;
        if joint.end {
            return Err(error(
                line,
                "channels in an end site".into(),
                "make it a JOINT or remove them",
            ));
        }
        if joint.listed {
            return Err(error(
                line,
                format!("a second CHANNELS in `{}`", short(&joint.name)),
                "keep one of them",
            ));
        }
        joint.listed = true;
        let (first, names) = rest.split_first().ok_or_else(|| {
            error(
                line,
                "CHANNELS without a number".into(),
                "write how many channels follow, then their names",
            )
        })?;
        let count: usize = first.1.parse().ok().filter(|&count| count <= 6).ok_or_else(|| {
            error(
                line,
                format!("`{}` is no number of channels", short(first.1)),
                "write 0 to 6, then as many names",
            )
        })?;
        let names = names.get(..count).ok_or_else(|| {
            error(
                line,
                format!("{count} channels are announced, {} names follow", names.len()),
                "write as many names, on one line",
            )
        })?;
        for &(line, name) in names {
            let channel = channel(name).ok_or_else(|| {
                let what = format!("`{}` is no channel", short(name));
                error(line, what, "the channels are Xposition, Yposition, Zposition, Xrotation, Yrotation and Zrotation")
            })?;
            if let Channel::Position(_) = channel
                && joint.channels.contains(&channel)
            {
                return Err(error(
                    line,
                    format!("`{name}` twice in one joint"),
                    "keep one of them",
                ));
            }
            joint.channels.push(channel);
        }
        Ok(1 + count)
    }

    fn finish(self, line: usize) -> Result<Vec<Joint>, BvhError> {
        if let Some(&(joint, opened)) = self.open.last() {
            let what = format!("`{}` is not closed before MOTION", short(&self.joints[joint].name));
            return Err(error(opened, what, "write the missing `}`"));
        }
        if self.joints.iter().all(|joint| joint.channels.is_empty()) {
            return Err(error(
                line,
                "no joint has a channel".into(),
                "list what moves after CHANNELS",
            ));
        }
        Ok(self.joints)
    }
}

fn channel(name: &str) -> Option<Channel> {
    let name = name.to_ascii_lowercase();
    let axis = ["x", "y", "z"].iter().position(|axis| name.starts_with(axis))?;
    match &name[1..] {
        "position" => Some(Channel::Position(axis)),
        "rotation" => Some(Channel::Rotation(axis)),
        _ => None,
    }
}

/// The rest of a line behind the words and a colon, if it starts with them.
fn after<'a>(text: &'a str, words: &[&str]) -> Option<&'a str> {
    let (label, value) = text.split_once(':')?;
    let same = label
        .split_whitespace()
        .map(str::to_ascii_lowercase)
        .eq(words.iter().map(|word| word.to_ascii_lowercase()));
    same.then_some(value.trim())
}

fn number((line, word): Word<'_>) -> Result<f64, BvhError> {
    let value: Option<f64> = word.parse().ok();
    value.filter(|value| value.abs() <= LARGEST).ok_or_else(|| {
        let what = format!("`{}` is no number that a pose can have", short(word));
        error(line, what, "write a decimal number of at most 1e9")
    })
}

/// The beginning of a word, so that a message stays a line.
fn short(text: &str) -> String {
    let mut start: String = text.chars().take(24).collect();
    if start.len() < text.len() {
        start.push('…');
    }
    start
}

fn error(line: usize, what: String, advice: &'static str) -> BvhError {
    BvhError { line, what, advice }
}

#[cfg(test)]
#[path = "bvh_tests.rs"]
mod tests;

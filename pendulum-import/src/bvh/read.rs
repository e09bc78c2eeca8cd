//! Reading of the text of a BVH file.

use super::error::BvhError;

/// The greatest lengths and angles, in the units of the file.
pub(super) const LARGEST: f64 = 1e9;

/// A joint or an end site of a skeleton.
#[derive(Clone, Debug, PartialEq)]
pub struct SkeletonJoint {
    /// The name in the file; the name of an end site is the name of its parent, followed by " end".
    pub name: String,
    /// The index of the parent; `None` for a root.
    pub parent: Option<usize>,
    /// `true` for an end site, which has no channels.
    pub end: bool,
    pub(super) offset: [f64; 3],
    pub(super) channels: Vec<Channel>,
}

/// The greatest number of joints; a file with more joints is probably not a skeleton.
const MOST_JOINTS: usize = 4096;

/// A number of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Channel {
    /// A position along an axis.
    Position(usize),
    /// A rotation about an axis, in degrees.
    Rotation(usize),
}

/// A reader of the lines that are not blank.
pub(super) struct Reader<'a> {
    lines: Vec<Line<'a>>,
    /// The index of the next line.
    next: usize,
}

/// A line: its number counted from one, the whole line, and the line without surrounding white
/// space.
#[derive(Clone, Copy)]
struct Line<'a> {
    number: usize,
    whole: &'a str,
    text: &'a str,
}

/// A line and a column, both counted from one.
type At = (usize, usize);

impl<'a> Line<'a> {
    /// Returns the place of a part of the line.
    fn at(self, part: &str) -> At {
        let offset = (part.as_ptr() as usize).wrapping_sub(self.whole.as_ptr() as usize);
        let before = self.whole.get(..offset).unwrap_or(self.whole);
        (self.number, before.chars().count() + 1)
    }

    /// Returns the place of the first letter.
    fn start(self) -> At {
        self.at(self.text)
    }

    /// Returns the place after the last letter.
    fn end(self) -> At {
        (self.number, self.start().1 + self.text.chars().count())
    }

    /// Returns the words of the line; every brace is a separate word.
    fn words(self) -> Vec<Word<'a>> {
        let pieces = self.text.split_whitespace().flat_map(|word| {
            word.split_inclusive(['{', '}']).flat_map(|piece| {
                let brace = piece.len() - usize::from(piece.ends_with(['{', '}']));
                let (before, brace) = piece.split_at(brace);
                [before, brace]
            })
        });
        pieces.filter(|piece| !piece.is_empty()).map(|word| (self.at(word), word)).collect()
    }
}

/// A word and its place.
type Word<'a> = (At, &'a str);

impl<'a> Reader<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        // A line ends at LF, at CR LF, or at CR alone.
        let ended = text.split('\n').map(|line| line.strip_suffix('\r').unwrap_or(line));
        let lines = ended
            .flat_map(|line| line.split('\r'))
            .enumerate()
            .map(|(index, whole)| Line { number: index + 1, whole, text: whole.trim() });
        Self { lines: lines.filter(|line| !line.text.is_empty()).collect(), next: 0 }
    }

    /// Returns the end of the file, as the place of missing parts.
    fn end(&self) -> At {
        self.lines.last().map_or((1, 1), |line| line.end())
    }

    fn line(&mut self, missing: &str) -> Result<Line<'a>, BvhError> {
        let found = self.lines.get(self.next).copied();
        self.next += 1;
        found.ok_or_else(|| {
            let what = format!("the file ends before {missing}");
            error(self.end(), what, "it was cut off: copy it again")
        })
    }

    /// Reads the file up to the line `MOTION`.
    pub(super) fn hierarchy(&mut self) -> Result<Vec<SkeletonJoint>, BvhError> {
        if self.lines.is_empty() {
            return fail(self.end(), "the text is empty", "give a BVH file");
        }
        let first = self.line("HIERARCHY")?;
        if !first.text.eq_ignore_ascii_case("HIERARCHY") {
            let what = format!("`{}` where HIERARCHY must stand", short(first.text));
            return fail(first.start(), what, "give a BVH file");
        }
        let mut tree = Tree::default();
        loop {
            let line = self.line("MOTION")?;
            if line.text.eq_ignore_ascii_case("MOTION") {
                return tree.finish(line.start());
            }
            tree.line(&line.words())?;
        }
    }

    /// Reads the time between frames and the rows, and returns a note on a row that is left out.
    pub(super) fn motion(
        &mut self,
        width: usize,
    ) -> Result<(f64, Vec<f64>, Option<BvhError>), BvhError> {
        let line = self.line("`Frames:`")?;
        let count = after(line.text, &["Frames"]).ok_or_else(|| {
            let what = format!("`{}` where `Frames: …` must stand", short(line.text));
            error(line.start(), what, "write the number of frames there")
        })?;
        let frames: usize = count.parse().map_err(|_| {
            let what = format!("`{}` is no number of frames", short(count));
            error(line.at(count), what, "write the number of rows that follow")
        })?;
        let time = self.line("`Frame Time:`")?;
        let step = after(time.text, &["Frame", "Time"]).ok_or_else(|| {
            let what = format!("`{}` where `Frame Time: …` must stand", short(time.text));
            error(time.start(), what, "write the seconds between frames")
        })?;
        let frame_time = number(step).ok_or_else(|| not_a_number(time.at(step), step))?;
        if frame_time <= 0.0 {
            let what = format!("a frame time of {step} s");
            return fail(time.at(step), what, "write a positive number of seconds");
        }
        let rows = self.lines.get(self.next..).unwrap_or_default();
        if frames == 0 {
            return fail(line.at(count), "the file has no frames", "record at least one");
        }
        // Checks the number of frames against the existing rows before memory is allocated.
        if rows.len() < frames {
            let what = format!("{frames} frames are announced, {} rows follow", rows.len());
            let advice = "correct the number, or copy the file again if it was cut off";
            return fail(line.at(count), what, advice);
        }
        // The rows are read before those after them: a row on two lines makes one line too many.
        let mut values = Vec::new();
        for (index, &row) in rows[..frames].iter().enumerate() {
            let mut words = row.text.split_whitespace();
            for channel in 0..width {
                let word = words.next().ok_or_else(|| {
                    let what =
                        format!("{channel} numbers in the row, {width} channels in the hierarchy");
                    let at =
                        if is_wrapped(&rows[index..], width) { row.start() } else { row.end() };
                    error(at, what, "give each channel one number, all on one line")
                })?;
                values.push(number(word).ok_or_else(|| not_a_number(row.at(word), word))?);
            }
            if let Some(word) = words.next() {
                let found = width + 1 + words.count();
                let what = format!("{found} numbers in the row, {width} channels in the hierarchy");
                let advice = "give each channel one number, all on one line";
                return fail(row.at(word), what, advice);
            }
        }
        let Some(after) = rows.get(frames) else { return Ok((frame_time, values, None)) };
        let what = format!("a row after the last of {frames} frames");
        let note = error(after.start(), what, "correct the number at `Frames:` or remove the row");
        // Some programs count the frames from zero, and announce one less than they write.
        let words: Vec<&str> = after.text.split_whitespace().take(width + 1).collect();
        let is_row = words.len() == width && words.iter().all(|word| number(word).is_some());
        if is_row && rows.len() == frames + 1 {
            Ok((frame_time, values, Some(note)))
        } else {
            Err(note)
        }
    }
}

/// Returns `true` if the first line, which is short, and some of those after it make one row.
fn is_wrapped(lines: &[Line<'_>], width: usize) -> bool {
    let mut count = 0;
    lines.iter().any(|line| {
        count += line.text.split_whitespace().count();
        count == width
    })
}

/// A joint that may be incomplete.
struct Unfinished {
    name: String,
    parent: Option<usize>,
    end: bool,
    offset: Option<[f64; 3]>,
    channels: Option<Vec<Channel>>,
}

/// The joints read so far.
#[derive(Default)]
struct Tree {
    joints: Vec<Unfinished>,
    /// The joints with open braces, and the places of their names.
    open: Vec<(usize, At)>,
    /// `true` between the name of a joint and its opening brace.
    named: bool,
}

impl Tree {
    fn line(&mut self, mut words: &[Word<'_>]) -> Result<(), BvhError> {
        while let Some((&(at, word), rest)) = words.split_first() {
            if self.named && word != "{" {
                let what = format!("`{}` where the brace of a joint must open", short(word));
                return fail(at, what, "write `{` there");
            }
            let used = match word.to_ascii_uppercase().as_str() {
                "{" if self.named => {
                    self.named = false;
                    0
                }
                "}" => {
                    self.close(at)?;
                    0
                }
                "ROOT" => self.name(at, rest, false)?,
                "JOINT" => self.name(at, rest, false)?,
                "END" => self.name(at, rest, true)?,
                "OFFSET" => self.offset(at, rest)?,
                "CHANNELS" => self.channels(at, rest)?,
                _ => {
                    let what = format!("`{}` is not known in a hierarchy", short(word));
                    let advice =
                        "it takes ROOT, JOINT, End Site, OFFSET, CHANNELS, braces, then MOTION";
                    return fail(at, what, advice);
                }
            };
            words = &rest[used..];
        }
        Ok(())
    }

    /// Adds a joint to the innermost open joint; returns the number of words of its name.
    fn name(&mut self, at: At, rest: &[Word<'_>], end: bool) -> Result<usize, BvhError> {
        let count = rest.iter().position(|(_, word)| *word == "{").unwrap_or(rest.len());
        let words: Vec<&str> = rest[..count].iter().map(|(_, word)| *word).collect();
        let parent = self.open.last().map(|&(joint, _)| joint);
        if let Some(parent) = parent
            && self.joints[parent].end
        {
            let what = "a joint inside an end site";
            return fail(at, what, "close the end site first, or make it a JOINT");
        }
        let name = match parent {
            Some(parent) if end => format!("{} end", self.joints[parent].name),
            None if end => {
                return fail(at, "an end site outside of all joints", "put it into a joint");
            }
            _ => words.join(" "),
        };
        if name.is_empty() {
            return fail(at, "a joint without a name", "write its name after ROOT or JOINT");
        }
        if self.joints.len() == MOST_JOINTS {
            let what = format!("more than {MOST_JOINTS} joints");
            return fail(at, what, "give a file with one skeleton");
        }
        self.open.push((self.joints.len(), at));
        self.named = true;
        self.joints.push(Unfinished { name, parent, end, offset: None, channels: None });
        Ok(count)
    }

    fn current(&mut self, at: At, word: &str) -> Result<&mut Unfinished, BvhError> {
        match self.open.last() {
            Some(&(joint, _)) => Ok(&mut self.joints[joint]),
            None => fail(
                at,
                format!("{word} outside of all joints"),
                "put it between the braces of a joint",
            ),
        }
    }

    fn close(&mut self, at: At) -> Result<(), BvhError> {
        let joint = self.current(at, "a closing brace")?;
        if joint.offset.is_none() {
            let what = format!("`{}` has no OFFSET", short(&joint.name));
            return fail(at, what, "write three numbers after OFFSET before the brace closes");
        }
        self.open.pop();
        Ok(())
    }

    fn offset(&mut self, at: At, rest: &[Word<'_>]) -> Result<usize, BvhError> {
        let joint = self.current(at, "OFFSET")?;
        if joint.offset.is_some() {
            let what = format!("a second OFFSET in `{}`", short(&joint.name));
            return fail(at, what, "keep one of them");
        }
        let words = rest.get(..3).ok_or_else(|| {
            let what = format!("OFFSET with {} numbers", rest.len());
            error(at, what, "write three, along x, y and z, on one line")
        })?;
        let mut offset = [0.0; 3];
        for (value, word) in offset.iter_mut().zip(words) {
            *value = number(word.1).ok_or_else(|| not_a_number(word.0, word.1))?;
        }
        joint.offset = Some(offset);
        Ok(3)
    }

    fn channels(&mut self, at: At, rest: &[Word<'_>]) -> Result<usize, BvhError> {
        let joint = self.current(at, "CHANNELS")?;
        if joint.end {
            return fail(at, "channels in an end site", "make it a JOINT or remove them");
        }
        if joint.channels.is_some() {
            let what = format!("a second CHANNELS in `{}`", short(&joint.name));
            return fail(at, what, "keep one of them");
        }
        let (first, names) = rest.split_first().ok_or_else(|| {
            let what = "CHANNELS without a number";
            error(at, what, "write how many channels follow, then their names")
        })?;
        let count: usize = first.1.parse().ok().filter(|&count| count <= 6).ok_or_else(|| {
            let what = format!("`{}` is no number of channels", short(first.1));
            error(first.0, what, "write 0 to 6, then as many names")
        })?;
        let names = names.get(..count).ok_or_else(|| {
            let what = format!("{count} channels are announced, {} names follow", names.len());
            error(at, what, "write as many names, on one line")
        })?;
        let mut channels = Vec::with_capacity(count);
        for &(at, name) in names {
            let channel = channel(name).ok_or_else(|| {
                let what = format!("`{}` is no channel", short(name));
                error(at, what, "the channels are Xposition, Yposition, Zposition, Xrotation, Yrotation and Zrotation")
            })?;
            if let Channel::Position(_) = channel
                && channels.contains(&channel)
            {
                return fail(at, format!("`{name}` twice in one joint"), "keep one of them");
            }
            channels.push(channel);
        }
        joint.channels = Some(channels);
        Ok(1 + count)
    }

    fn finish(self, at: At) -> Result<Vec<SkeletonJoint>, BvhError> {
        if let Some(&(joint, opened)) = self.open.last() {
            let what = format!("`{}` is not closed before MOTION", short(&self.joints[joint].name));
            return fail(opened, what, "write the missing `}`");
        }
        let joints = self.joints.into_iter().map(|joint| SkeletonJoint {
            name: joint.name,
            parent: joint.parent,
            end: joint.end,
            offset: joint.offset.unwrap_or_default(),
            channels: joint.channels.unwrap_or_default(),
        });
        let joints: Vec<SkeletonJoint> = joints.collect();
        if joints.iter().all(|joint| joint.channels.is_empty()) {
            return fail(at, "no joint has a channel", "list what moves after CHANNELS");
        }
        Ok(joints)
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

/// Returns the part of a line after `words` and a colon, if the line starts with them.
fn after<'a>(text: &'a str, words: &[&str]) -> Option<&'a str> {
    let (label, value) = text.split_once(':')?;
    let same = label
        .split_whitespace()
        .map(str::to_ascii_lowercase)
        .eq(words.iter().map(|word| word.to_ascii_lowercase()));
    same.then_some(value.trim())
}

/// Parses a length or an angle.
fn number(word: &str) -> Option<f64> {
    word.parse().ok().filter(|value: &f64| value.abs() <= LARGEST)
}

fn not_a_number(at: At, word: &str) -> BvhError {
    let what = format!("`{}` is no number that a pose can have", short(word));
    error(at, what, "write a decimal number of at most 1e9")
}

/// Returns the start of a text, to keep messages short.
fn short(text: &str) -> String {
    let mut start: String = text.chars().take(24).collect();
    if start.len() < text.len() {
        start.push('…');
    }
    start
}

fn error(at: At, what: impl Into<String>, advice: &'static str) -> BvhError {
    BvhError::new(at, what.into(), advice)
}

fn fail<T>(at: At, what: impl Into<String>, advice: &'static str) -> Result<T, BvhError> {
    Err(error(at, what, advice))
}

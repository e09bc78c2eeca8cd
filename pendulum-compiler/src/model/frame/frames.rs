//! Frames, some of which turn out to be one, and the rotations between them.

use std::collections::VecDeque;

/// The axes along which vectors have components.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Frame(usize);

/// The frame of space.
pub(super) const SPACE: Frame = Frame(0);

/// All frames of a block.
///
/// Rotations with names do not depend on each other, so that no chain of them leads from a frame
/// back to the same frame: two frames with a chain between them are different.
#[derive(Debug)]
pub(super) struct Frames {
    /// For each frame, one that is the same, or itself.
    same: Vec<usize>,
    /// For each frame, one to which a chain leads, or itself.
    chained: Vec<usize>,
    /// The rotations with names, each with the frames to which and from which it leads.
    links: Vec<(String, [Frame; 2])>,
}

impl Frames {
    pub(super) fn new() -> Self {
        Self { same: vec![0], chained: vec![0], links: Vec::new() }
    }

    /// Returns a frame about which nothing is known.
    pub(super) fn unknown(&mut self) -> Frame {
        self.same.push(self.same.len());
        self.chained.push(self.chained.len());
        Frame(self.same.len() - 1)
    }

    /// Adds a rotation with a name, unless there is a chain between its frames.
    pub(super) fn link(&mut self, name: String, ends: [Frame; 2]) {
        if unite(&mut self.chained, ends) {
            self.links.push((name, ends));
        }
    }

    pub(super) fn are_same(&self, a: Frame, b: Frame) -> bool {
        root(&self.same, a) == root(&self.same, b)
    }

    pub(super) fn are_chained(&self, a: Frame, b: Frame) -> bool {
        root(&self.chained, a) == root(&self.chained, b)
    }

    /// Makes two frames one. Returns `false` if they are different.
    pub(super) fn join(&mut self, a: Frame, b: Frame) -> bool {
        let known = self.are_same(a, b);
        if !known && unite(&mut self.chained, [a, b]) {
            return unite(&mut self.same, [a, b]);
        }
        known
    }

    /// Returns the first rotation with a frame as this end.
    fn end(&self, frame: Frame, end: usize) -> Option<&(String, [Frame; 2])> {
        self.links.iter().find(|(_, ends)| self.are_same(ends[end], frame))
    }

    /// Lets rotations lead to space, unless they stand behind others or it is decided already.
    pub(super) fn anchor(&mut self) {
        for link in 0..self.links.len() {
            let mut outer = self.links[link].1[0];
            if self.are_chained(outer, SPACE) {
                continue;
            }
            while let Some(&(_, [next, _])) = self.end(outer, 1) {
                outer = next;
            }
            self.join(outer, SPACE);
        }
    }

    /// Returns where components along the axes of a frame are, for messages.
    pub(super) fn place(&self, frame: Frame) -> String {
        if self.are_same(frame, SPACE) {
            return "in space".to_owned();
        }
        match (self.end(frame, 1), self.end(frame, 0)) {
            (Some((name, _)), _) => format!("along the axes of `{name}`"),
            (None, Some((name, _))) => format!("to which `{name}` leads"),
            (None, None) => "in space".to_owned(),
        }
    }

    /// Returns the factors of the rotation that leads from a frame to another, the outermost first.
    fn chain(&self, from: Frame, to: Frame) -> Vec<String> {
        let mut found = vec![from];
        let mut open = VecDeque::from([(from, Vec::new())]);
        while let Some((frame, chain)) = open.pop_front() {
            if self.are_same(frame, to) {
                return chain;
            }
            for (name, [target, source]) in &self.links {
                let back = (*target, *source, inverse(name));
                for (start, end, factor) in [(*source, *target, name.clone()), back] {
                    if self.are_same(start, frame)
                        && !found.iter().any(|&known| self.are_same(known, end))
                    {
                        found.push(end);
                        open.push_back((end, [vec![factor], chain.clone()].concat()));
                    }
                }
            }
        }
        Vec::new()
    }

    /// Returns how to write `what` with the factors `before` it so that its components along the
    /// axes of one frame become those along the axes of another.
    pub(super) fn led(&self, before: &[String], ends: [Frame; 2], mut what: &str) -> String {
        let mut factors: Vec<String> = Vec::new();
        for factor in before.iter().cloned().chain(self.chain(ends[0], ends[1])) {
            match factors.last() {
                Some(last) if *last == inverse(&factor) => _ = factors.pop(),
                _ => factors.push(factor),
            }
        }
        while let Some(last) = factors.last()
            && let Some(rest) = what.strip_prefix(&inverse(last))
            && let Some(rest) = rest.strip_prefix('*')
        {
            what = rest;
            factors.pop();
        }
        factors.push(what.to_owned());
        factors.join("*")
    }
}

/// Returns the text of the rotation that turns back.
pub(super) fn inverse(factor: &str) -> String {
    match factor.strip_prefix("transpose(").and_then(|rest| rest.strip_suffix(')')) {
        Some(inner) => inner.to_owned(),
        None => format!("transpose({factor})"),
    }
}

/// Returns the representative of a set.
fn root(sets: &[usize], Frame(mut own): Frame) -> usize {
    while sets[own] != own {
        own = sets[own];
    }
    own
}

/// Makes two sets one, and shortens the ways to it. Returns `false` if they are one already.
fn unite(sets: &mut [usize], frames: [Frame; 2]) -> bool {
    let [a, b] = frames.map(|frame| root(sets, frame));
    for Frame(own) in frames {
        sets[own] = a.min(b);
    }
    sets[a.max(b)] = a.min(b);
    a != b
}

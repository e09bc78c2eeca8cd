//! Conversion of the tree of `usvg` to joints.

use super::drawing::{Drawing, DrawnJoint, Role, Skipped, Units, Why};
use super::error::DrawingError;
use super::{entities, references, size};
use pendulum_body::{Body, BodyError, FillRule, Outline};
use pendulum_core::scalar::Real;
use std::collections::{BTreeMap, BTreeSet};
use usvg::roxmltree::{Document, Node, ParsingOptions};
use usvg::tiny_skia_path::PathSegment;
use usvg::{ClipPath, Group, ImageHrefResolver, Options, Path, Transform, Tree};

/// The elements that are shapes.
const SHAPES: [&str; 9] =
    ["path", "rect", "circle", "ellipse", "line", "polyline", "polygon", "image", "text"];
/// The elements whose contents are drawn elsewhere or not drawn.
const STORED: [&str; 7] = ["defs", "symbol", "clipPath", "mask", "pattern", "marker", "filter"];

/// The greatest number of curves per shape; the time to find crossings grows with its square.
const MOST: usize = 1 << 14;

/// The greatest work of expanding entities, as of 16 MB of text: a few hundred kilobytes can stand
/// for gigabytes. Drawing programs abbreviate names of name spaces and styles by entities.
const MOST_WORK: u64 = 1 << 24;

/// The greatest number of elements that are drawn, as of elements that `usvg` reads.
const MOST_DRAWN: u64 = 1_000_000;

/// A pivot of the drawing.
struct Pivot {
    role: Role,
    /// The position in pixels of the drawing.
    at: [f64; 2],
}

/// The greatest depth of nested elements: reading a nested group takes some kilobytes of the stack.
const DEEPEST: usize = 100;

/// Returns the first element nested in more than [`DEEPEST`] others.
fn too_deep<'a>(document: &'a Document<'a>) -> Option<Node<'a, 'a>> {
    document.descendants().find(|node| DEEPEST + 1 < node.ancestors().take(DEEPEST + 2).count())
}

/// What the groups around a shape do to it.
#[derive(Clone, Copy)]
struct Around {
    joint: Option<usize>,
    opacity: f64,
    /// The part of the drawing that clip paths leave, in pixels: left, top, right and bottom.
    window: [f32; 4],
    /// A mask or a clip path that is no window.
    cut: Option<Why>,
}

/// The state of reading a drawing while its tree is traversed.
struct Reader {
    units: Units,
    /// The pivots by the names of their groups.
    pivots: BTreeMap<String, Pivot>,
    /// The starts of the groups of joints by name; `None` once the joint has been created.
    inside: BTreeMap<String, Option<usize>>,
    bodies: Vec<Vec<Body>>,
    drawing: Drawing,
}

impl Drawing {
    /// Reads the text of an SVG file.
    ///
    /// # Errors
    /// If the text is not valid SVG, if a unit is not positive, if a pivot has no position or no
    /// group of its name, if two pivots have the same name, if the transform of a joint shears or
    /// stretches it, or if a pendulum has no body.
    pub fn read(text: &str, units: Units) -> Result<Self, DrawingError> {
        for (what, value) in
            [("metres a pixel", units.pixel), ("kilograms a square metre", units.density)]
        {
            if !(0.0 < value && value < f64::INFINITY) {
                return Err(DrawingError::Unit { what, value });
            }
        }
        if MOST_WORK < entities::work(text) {
            let what = format!("its entities stand for more than {MOST_WORK} bytes");
            return Err(DrawingError::Syntax(what));
        }
        let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
        let document = Document::parse_with_options(text, options)
            .map_err(|error| DrawingError::Syntax(error.to_string()))?;
        if let Some(deep) = too_deep(&document) {
            let line = document.text_pos_at(deep.range().start).row;
            return Err(DrawingError::Deep { line, most: DEEPEST });
        }
        if MOST_DRAWN < references::elements(document.root_element(), DEEPEST) {
            let what = format!(
                "its markers, masks, patterns and copies stand for more than {MOST_DRAWN} \
                 elements, or are nested more than {DEEPEST} deep"
            );
            return Err(DrawingError::Syntax(what));
        }
        if let Some(vast) =
            document.descendants().find(|node| node.is_element() && size::is_vast(*node))
        {
            let line = || {
                format!(
                    "{} on line {}",
                    vast.tag_name().name(),
                    document.text_pos_at(vast.range().start).row
                )
            };
            return Err(DrawingError::Large {
                id: vast.attribute("id").map_or_else(line, str::to_owned),
            });
        }
        // Prevents access to data outside of the text.
        let none = ImageHrefResolver {
            resolve_data: Box::new(|_, _, _| None),
            resolve_string: Box::new(|_, _| None),
        };
        let options = Options { image_href_resolver: none, ..Options::default() };
        let tree = Tree::from_xmltree(&document, &options)
            .map_err(|error| DrawingError::Syntax(error.to_string()))?;
        let size = [tree.size().width(), tree.size().height()].map(f64::from);

        let mut reader = Reader {
            units,
            pivots: BTreeMap::new(),
            inside: BTreeMap::new(),
            bodies: Vec::new(),
            drawing: Self { joints: Vec::new(), skipped: Vec::new(), loose: 0, size },
        };
        let mut ids = BTreeSet::new();
        reader.find(tree.root(), &mut Vec::new(), &mut ids)?;
        reader.elements(&document, &ids)?;
        let window = [f32::NEG_INFINITY, f32::NEG_INFINITY, f32::INFINITY, f32::INFINITY];
        reader.weigh(tree.root(), Around { joint: None, opacity: 1.0, window, cut: None })?;
        reader.finish()
    }
}

impl Reader {
    /// Collects the pivots, and the ids of all drawn elements.
    fn find<'a>(
        &mut self,
        group: &'a Group,
        around: &mut Vec<&'a str>,
        ids: &mut BTreeSet<String>,
    ) -> Result<(), DrawingError> {
        around.push(group.id());
        for node in group.children() {
            ids.insert(node.id().to_string());
            match node {
                usvg::Node::Group(group) => self.find(group, around, ids)?,
                usvg::Node::Path(path) => {
                    let Some((name, role)) = pivot(path.id()) else { continue };
                    if !around.contains(&name) {
                        return Err(DrawingError::NoGroup { id: path.id().into() });
                    }
                    let bounds = path.data().bounds();
                    let middle = [bounds.left() + bounds.right(), bounds.top() + bounds.bottom()];
                    let at = map(path.abs_transform(), middle.map(|sum| 0.5 * f64::from(sum)));
                    if !at.iter().all(|value| value.is_finite()) {
                        return Err(DrawingError::NoPlace { id: path.id().into() });
                    }
                    if self.pivots.insert(name.into(), Pivot { role, at }).is_some() {
                        return Err(DrawingError::Twice { name: name.into() });
                    }
                }
                usvg::Node::Image(_) | usvg::Node::Text(_) => {}
            }
        }
        around.pop();
        Ok(())
    }

    /// Collects information that is available only in the text: the starts of groups, and shapes
    /// that the tree does not contain.
    fn elements(
        &mut self,
        document: &Document<'_>,
        ids: &BTreeSet<String>,
    ) -> Result<(), DrawingError> {
        for node in document.descendants().filter(Node::is_element) {
            let tag = node.tag_name().name();
            let id = node.attribute("id").unwrap_or("");
            if tag == "g" && self.pivots.contains_key(id) {
                let inside =
                    node.first_child().map_or(node.range().end, |child| child.range().start);
                if self.inside.insert(id.into(), Some(inside)).is_some() {
                    return Err(DrawingError::Twice { name: id.into() });
                }
            }
            if !SHAPES.contains(&tag)
                || node.ancestors().any(|outer| STORED.contains(&outer.tag_name().name()))
            {
                continue;
            }
            let drawn = ids.contains(id);
            let why = match tag {
                "image" => Why::Image,
                "text" => Why::Text,
                _ if id.is_empty() || drawn => continue,
                _ if pivot(id).is_some() => return Err(DrawingError::NoPlace { id: id.into() }),
                _ => Why::NotDrawn,
            };
            let line = || format!("{tag} on line {}", document.text_pos_at(node.range().start).row);
            self.drawing
                .skipped
                .push(Skipped { id: if id.is_empty() { line() } else { id.into() }, why });
        }
        Ok(())
    }

    /// Traverses a group.
    fn weigh(&mut self, group: &Group, around: Around) -> Result<(), DrawingError> {
        let Around { joint, opacity, mut window, mut cut } = around;
        let opacity = opacity * f64::from(group.opacity().get());
        match group.clip_path().map(|clip| rectangle(clip, group.abs_transform())) {
            Some(Some([left, top, right, bottom])) => {
                window = [
                    window[0].max(left),
                    window[1].max(top),
                    window[2].min(right),
                    window[3].min(bottom),
                ];
            }
            Some(None) => cut = Some(Why::Clipped),
            None => {}
        }
        if group.mask().is_some() {
            cut = Some(Why::Masked);
        }
        let joint = match self.pivots.get(group.id()) {
            None => joint,
            Some(pivot) => {
                let name = group.id().to_string();
                let element = self
                    .inside
                    .get_mut(&name)
                    .ok_or_else(|| DrawingError::NoGroup { id: name.clone() })?;
                let Some(inside) = element.take() else { return Err(DrawingError::Twice { name }) };
                let transform = group.abs_transform();
                let (scale, mirrored) = similarity(transform)
                    .ok_or_else(|| DrawingError::Sheared { name: name.clone() })?;
                let pixel = self.units.pixel;
                self.drawing.joints.push(DrawnJoint {
                    role: pivot.role,
                    parent: joint,
                    pivot: [pixel * pivot.at[0], -pixel * pivot.at[1]],
                    body: None,
                    shapes: 0,
                    anchor: unmap(transform, pivot.at),
                    mirrored,
                    scale,
                    inside,
                    name,
                });
                self.bodies.push(Vec::new());
                Some(self.bodies.len() - 1)
            }
        };
        let around = Around { joint, opacity, window, cut };
        for node in group.children() {
            match node {
                usvg::Node::Group(group) => self.weigh(group, around)?,
                usvg::Node::Path(path) if pivot(path.id()).is_none() => self.shape(path, around)?,
                _ => {}
            }
        }
        Ok(())
    }

    fn shape(&mut self, path: &Path, around: Around) -> Result<(), DrawingError> {
        let Around { joint, opacity, window, cut } = around;
        let joints = &self.drawing.joints;
        let id = match (path.id(), joint) {
            ("", Some(joint)) => format!("a shape of {}", joints[joint].name),
            ("", None) => "a shape".into(),
            (id, _) => id.into(),
        };
        let opacity = opacity * path.fill().map_or(0.0, |fill| f64::from(fill.opacity().get()));
        let why = match path.fill() {
            None => Some(Why::NoFill),
            Some(_) if !path.is_visible() => Some(Why::Hidden),
            Some(_) if opacity <= 0.0 => Some(Why::Transparent),
            Some(_) => None,
        };
        if let Some(why) = why {
            self.drawing.skipped.push(Skipped { id, why });
            return Ok(());
        }
        if MOST < path.data().len() {
            return Err(DrawingError::Large { id });
        }
        let rule = match path.fill().map(usvg::Fill::rule) {
            Some(usvg::FillRule::EvenOdd) => FillRule::EvenOdd,
            _ => FillRule::NonZero,
        };
        let pixel = self.units.pixel;
        let metres = |x: f32, y: f32| {
            let [x, y] = map(path.abs_transform(), [f64::from(x), f64::from(y)]);
            [pixel * x, -pixel * y]
        };
        let mut outline = Outline::new(rule);
        for segment in path.data().segments() {
            outline = match segment {
                PathSegment::MoveTo(to) => outline.move_to(metres(to.x, to.y)),
                PathSegment::LineTo(to) => outline.line_to(metres(to.x, to.y)),
                PathSegment::QuadTo(a, to) => outline.quad_to(metres(a.x, a.y), metres(to.x, to.y)),
                PathSegment::CubicTo(a, b, to) => {
                    outline.cubic_to(metres(a.x, a.y), metres(b.x, b.y), metres(to.x, to.y))
                }
                PathSegment::Close => outline,
            };
        }
        let body = outline.body(self.units.density * opacity);
        let bounds = path.abs_bounding_box();
        // Exporters clip whole drawings to their page: what it does not cut is not clipped.
        let slack = 1e-4 * bounds.width().max(bounds.height());
        let is_whole = window[0] <= bounds.left() + slack
            && window[1] <= bounds.top() + slack
            && bounds.right() <= window[2] + slack
            && bounds.bottom() <= window[3] + slack;
        if let (Some(why), Ok(_)) = (cut.or((!is_whole).then_some(Why::Clipped)), &body) {
            self.drawing.skipped.push(Skipped { id: id.clone(), why });
        }
        match (body, joint) {
            (Ok(body), Some(joint)) => {
                self.bodies[joint].push(body.with_pivot(self.drawing.joints[joint].pivot));
            }
            (Ok(_), None) => self.drawing.loose += 1,
            (Err(BodyError::NoArea { .. } | BodyError::NoMass), _) => {
                self.drawing.skipped.push(Skipped { id, why: Why::NoArea });
            }
            (Err(error), _) => return Err(DrawingError::Body { id, error }),
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Drawing, DrawingError> {
        for (joint, bodies) in self.drawing.joints.iter_mut().zip(self.bodies) {
            joint.shapes = bodies.len();
            joint.body = match Body::compound(bodies) {
                Ok(body) => Some(body),
                Err(BodyError::NoMass) if joint.role == Role::Keyed => None,
                Err(BodyError::NoMass) => {
                    return Err(DrawingError::NoBody { name: joint.name.clone() });
                }
                Err(error) => return Err(DrawingError::Body { id: joint.name.clone(), error }),
            };
        }
        Ok(self.drawing)
    }
}

/// Returns the name and the role in the id of a pivot.
fn pivot(id: &str) -> Option<(&str, Role)> {
    let roles = [(".keyed", Role::Keyed), (".pendulum", Role::Pendulum)];
    roles
        .into_iter()
        .find_map(|(end, role)| Some((id.strip_suffix(end)?, role)))
        .filter(|(name, _)| !name.is_empty())
}

fn map(transform: Transform, [x, y]: [f64; 2]) -> [f64; 2] {
    let [a, b, c, d, e, f] =
        [transform.sx, transform.ky, transform.kx, transform.sy, transform.tx, transform.ty]
            .map(f64::from);
    [a * x + c * y + e, b * x + d * y + f]
}

fn unmap(transform: Transform, [x, y]: [f64; 2]) -> [f64; 2] {
    let [a, b, c, d, e, f] =
        [transform.sx, transform.ky, transform.kx, transform.sy, transform.tx, transform.ty]
            .map(f64::from);
    let (x, y, area) = (x - e, y - f, a * d - b * c);
    [(d * x - c * y) / area, (a * y - b * x) / area]
}

/// Returns the window of a clip path that is a rectangle along the axes of the drawing: left, top,
/// right and bottom.
fn rectangle(clip: &ClipPath, group: Transform) -> Option<[f32; 4]> {
    let ([usvg::Node::Path(path)], None) = (clip.root().children(), clip.clip_path()) else {
        return None;
    };
    let to = group.pre_concat(clip.transform()).pre_concat(path.abs_transform());
    let &[a, b, c, d] = path.data().points() else { return None };
    let sides = [(a.x, c.y), (c.x, a.y)];
    let is_rectangle = path.data().len() == 5
        && (sides == [(b.x, b.y), (d.x, d.y)] || sides == [(d.x, d.y), (b.x, b.y)]);
    let along = to.kx == 0.0 && to.ky == 0.0;
    (is_rectangle && along).then(|| {
        let [x, y] = [[a.x, c.x].map(|x| to.sx * x + to.tx), [a.y, c.y].map(|y| to.sy * y + to.ty)];
        [x[0].min(x[1]), y[0].min(y[1]), x[0].max(x[1]), y[0].max(y[1])]
    })
}

/// Returns the scale factor of a similarity (up to single precision), and `true` if it mirrors;
/// `None` for other transforms.
fn similarity(transform: Transform) -> Option<(f64, bool)> {
    let [a, b, c, d] = [transform.sx, transform.ky, transform.kx, transform.sy].map(f64::from);
    let area = a * d - b * c;
    let mirrored = area < 0.0;
    let sign = if mirrored { -1.0 } else { 1.0 };
    let size = Real::sqrt(area.abs());
    let kept = (a - sign * d).abs() <= 1e-4 * size && (b + sign * c).abs() <= 1e-4 * size;
    (0.0 < size && size.is_finite() && kept).then_some((size, mirrored))
}

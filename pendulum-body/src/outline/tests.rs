use super::super::random::Random;
use super::super::{Body, BodyError, Polygon};
use super::{FillRule, Outline, Point};
use crate::tests::{close, same};
use core::f64::consts::PI;
use pendulum_core::scalar::Real;

fn ring(outline: Outline, points: &[Point]) -> Outline {
    points[1..].iter().fold(outline.move_to(points[0]), |outline, &point| outline.line_to(point))
}

fn square(outline: Outline, [x, y]: Point, half: f64, turn: bool) -> Outline {
    let mut corners =
        [[-half, -half], [half, -half], [half, half], [-half, half]].map(|[a, b]| [x + a, y + b]);
    if turn {
        corners.reverse();
    }
    ring(outline, &corners)
}

fn both(draw: impl Fn(Outline) -> Outline) -> [f64; 2] {
    [FillRule::NonZero, FillRule::EvenOdd]
        .map(|rule| draw(Outline::new(rule)).body(1.0).unwrap().mass)
}

#[test]
fn lines_are_polygons() {
    let mut random = Random::new(3);
    for _ in 0..100 {
        let count = 3 + (random.bits() % 9) as usize;
        let mut points: Vec<Point> = (0..count)
            .map(|k| {
                let (sin, cos) =
                    Real::sin_cos(2.0 * PI * (k as f64 + 0.9 * random.unit()) / count as f64);
                let radius = 0.3 + random.unit();
                [3.0 + radius * cos, -7.0 + radius * sin]
            })
            .collect();
        let Ok(polygon) = Polygon::new(&points) else { continue };
        let expected = polygon.body(2.0).unwrap();
        for rule in [FillRule::NonZero, FillRule::EvenOdd] {
            same(ring(Outline::new(rule), &points).body(2.0).unwrap(), expected, 1e-13);
            points.reverse();
        }
    }
}

/// The segment of a parabola with y from x² to 1: area 4/3, centre at 3/5, ∫x² = 4/15, ∫y² = 4/7.
#[test]
fn a_parabola_is_exact() {
    let outline =
        Outline::new(FillRule::NonZero).move_to([-1.0, 1.0]).quad_to([0.0, -1.0], [1.0, 1.0]);
    let body = outline.body(3.0).unwrap();
    close(body.mass, 4.0, 1e-15);
    close(body.center[1], 0.6, 1e-15);
    let [xx, xy, yy] = body.moments();
    close(xx, 3.0 * 4.0 / 15.0, 1e-15);
    close(yy, 3.0 * 4.0 / 7.0, 1e-15);
    assert!(xy.abs() < 1e-15);
}

/// The usual circle of four cubics is a circle within 2.7e-4. A fine polygon through points of the
/// cubics agrees better.
#[test]
fn cubics_agree_with_fine_polygons() {
    let k = 0.5522847498307936;
    let circle = Outline::new(FillRule::NonZero)
        .move_to([1.0, 0.0])
        .cubic_to([1.0, k], [k, 1.0], [0.0, 1.0])
        .cubic_to([-k, 1.0], [-1.0, k], [-1.0, 0.0])
        .cubic_to([-1.0, -k], [-k, -1.0], [0.0, -1.0])
        .cubic_to([k, -1.0], [1.0, -k], [1.0, 0.0]);
    let body = circle.body(1.0).unwrap();
    close(body.mass, PI, 3e-4);
    close(body.inertia(), PI / 2.0, 6e-4);
    let polygon = |count: usize| {
        let points: Vec<Point> = circle.rings[0]
            .iter()
            .flat_map(|curve| (0..count).map(move |index| curve.at(index as f64 / count as f64)))
            .collect();
        Polygon::new(&points).unwrap().body(1.0).unwrap()
    };
    // Chords lose an area proportional to the square of their length. Extrapolation from two
    // lengths removes this loss.
    let (coarse, fine) = (polygon(200), polygon(400));
    close(body.mass, (4.0 * fine.mass - coarse.mass) / 3.0, 1e-10);
    close(body.inertia(), (4.0 * fine.inertia() - coarse.inertia()) / 3.0, 1e-10);
}

#[test]
fn holes_follow_the_fill_rule() {
    let hole = |turn: bool| {
        move |outline| square(square(outline, [0.0; 2], 1.0, false), [0.2, 0.1], 0.5, turn)
    };
    assert_eq!(both(hole(true)).map(|mass| (mass * 1e9).round()), [3e9; 2]);
    assert_eq!(both(hole(false)).map(|mass| (mass * 1e9).round()), [4e9, 3e9]);
    let frame = hole(true)(Outline::new(FillRule::NonZero)).body(1.0).unwrap();
    let expected = Body::rectangle(4.0, 2.0, 2.0).unwrap();
    same(
        frame,
        expected.without(Body::rectangle(1.0, 1.0, 1.0).unwrap().translated([0.2, 0.1])).unwrap(),
        1e-14,
    );
}

#[test]
fn overlaps_count_once_or_not_at_all() {
    // Two squares of area 4 that overlap in an area of 1, in equal or opposite directions.
    for turn in [false, true] {
        let masses =
            both(|outline| square(square(outline, [0.0; 2], 1.0, false), [1.0, 1.0], 1.0, turn));
        // In opposite directions, the overlap has a winding number of zero.
        close(masses[0], if turn { 6.0 } else { 7.0 }, 1e-14);
        close(masses[1], 6.0, 1e-14);
    }
    // A pentagram, whose middle has a winding number of two.
    let star: Vec<Point> = (0..5)
        .map(|k| {
            let (sin, cos) = Real::sin_cos(0.8 * PI * f64::from(k));
            [sin, cos]
        })
        .collect();
    let masses = both(|outline| ring(outline, &star));
    let tan = |degrees: f64| Real::tan(degrees * PI / 180.0);
    let inner = Real::cos(0.4 * PI) / Real::cos(0.2 * PI);
    let pentagon = 2.5 * Real::sin(0.4 * PI) * inner * inner;
    // Five tips on the sides of the pentagon, each a triangle with base angles of 72°.
    let side = 2.0 * inner * Real::sin(0.2 * PI);
    let points = 5.0 * side * side / 4.0 * tan(72.0);
    close(masses[0], pentagon + points, 1e-14);
    close(masses[1], points, 1e-14);
    // A figure of eight, whose halves have opposite directions.
    let eight =
        both(|outline| ring(outline, &[[-1.0, -1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, 1.0]]));
    close(eight[0], 2.0, 1e-14);
    close(eight[1], 2.0, 1e-14);
}

/// Two discs of radius 1 whose centres are 1 apart: a lens of 2π/3 − √3/2.
#[test]
fn curves_that_cross_are_cut() {
    let disc = |outline: Outline, x: f64| {
        // Sixteen cubic arcs, which are a circle within 10⁻⁸.
        let step = PI / 8.0;
        let k = 4.0 / 3.0 * Real::tan(step / 4.0);
        let on = |angle: f64| Real::sin_cos(angle);
        (0..16).fold(outline.move_to([x + 1.0, 0.0]), |outline, arc| {
            let ((s0, c0), (s1, c1)) = (on(step * f64::from(arc)), on(step * f64::from(arc + 1)));
            let end = if arc == 15 { [x + 1.0, 0.0] } else { [x + c1, s1] };
            outline.cubic_to([x + c0 - k * s0, s0 + k * c0], [x + c1 + k * s1, s1 - k * c1], end)
        })
    };
    let lens = 2.0 * PI / 3.0 - Real::sqrt(3.0) / 2.0;
    let masses = both(|outline| disc(disc(outline, 0.0), 1.0));
    close(masses[0], 2.0 * PI - lens, 1e-7);
    close(masses[1], 2.0 * PI - 2.0 * lens, 1e-7);
    // A single cubic with a loop: it crosses itself once.
    let looped = |outline: Outline| {
        outline.move_to([0.0, 0.0]).cubic_to([3.0, 2.0], [-2.0, 2.0], [1.0, 0.0])
    };
    let [union, parity] = both(looped);
    close(union, parity, 1e-13);
}

/// Rectangles on a grid share edges, parts of edges and corners; the expected area is the number of
/// cells.
#[test]
fn edges_may_coincide() {
    let mut random = Random::new(5);
    for case in 0..300 {
        let count = 2 + case % 5;
        let mut pick = |below: u64| (random.bits() % below) as usize;
        let mut windings = [[0i32; 8]; 8];
        let mut corners = Vec::new();
        for _ in 0..count {
            let [left, low] = [pick(7), pick(7)];
            let [right, high] = [
                left + 1 + pick(7 - left as u64 + 1).min(7 - left),
                low + 1 + pick(7 - low as u64 + 1).min(7 - low),
            ];
            let back = pick(2) == 1;
            for row in &mut windings[low..high] {
                row[left..right].iter_mut().for_each(|cell| *cell += if back { -1 } else { 1 });
            }
            let mut ring = [[left, low], [right, low], [right, high], [left, high]];
            if back {
                ring.reverse();
            }
            ring.rotate_left(pick(4));
            corners.push(ring);
        }
        // Unrotated, rotated by an eighth of a turn, and rotated by another angle.
        for [cos, sin] in [[1.0, 0.0], [0.7, 0.7], [0.3, -0.9]] {
            let at = |[x, y]: [usize; 2]| {
                [cos * x as f64 - sin * y as f64, sin * x as f64 + cos * y as f64]
            };
            for rule in [FillRule::NonZero, FillRule::EvenOdd] {
                let cells =
                    windings.iter().flatten().filter(|&&winding| rule.inside(winding)).count();
                let outline = corners
                    .iter()
                    .fold(Outline::new(rule), |outline, corners| ring(outline, &corners.map(at)));
                match outline.body(1.0) {
                    Ok(body) => close(body.mass, cells as f64 * (cos * cos + sin * sin), 1e-12),
                    Err(error) => assert_eq!(
                        (cells, error),
                        (0, BodyError::NoArea { ring: 0 }),
                        "{corners:?}"
                    ),
                }
            }
        }
    }
}

/// The same curve twice, in equal or opposite directions, and two leaves with a common curve.
#[test]
fn curves_may_coincide() {
    let leaf = |outline: Outline| {
        outline
            .move_to([0.0, 0.0])
            .cubic_to([2.0, 1.0], [-1.0, 3.0], [0.0, 4.0])
            .quad_to([-3.0, 2.0], [0.0, 0.0])
    };
    let back = |outline: Outline| {
        outline.move_to([0.0, 0.0]).quad_to([-3.0, 2.0], [0.0, 4.0]).cubic_to(
            [-1.0, 3.0],
            [2.0, 1.0],
            [0.0, 0.0],
        )
    };
    let beside = |outline: Outline| {
        outline
            .move_to([0.0, 4.0])
            .cubic_to([-1.0, 3.0], [2.0, 1.0], [0.0, 0.0])
            .quad_to([5.0, 2.0], [0.0, 4.0])
    };
    let one = leaf(Outline::new(FillRule::NonZero)).body(1.0).unwrap().mass;
    let other = beside(Outline::new(FillRule::NonZero)).body(1.0).unwrap().mass;
    close(leaf(leaf(Outline::new(FillRule::NonZero))).body(1.0).unwrap().mass, one, 1e-13);
    assert_eq!(
        leaf(back(Outline::new(FillRule::NonZero))).body(1.0),
        Err(BodyError::NoArea { ring: 0 })
    );
    assert_eq!(
        leaf(leaf(Outline::new(FillRule::EvenOdd))).body(1.0),
        Err(BodyError::NoArea { ring: 0 })
    );
    for mass in both(|outline| beside(leaf(outline))) {
        close(mass, one + other, 1e-13);
    }
}

/// A grid of crossing bars, and a scribble with too many crossings.
#[test]
fn many_crossings_are_counted_and_too_many_refused() {
    let bars = |outline: Outline| {
        (0..60).fold(outline, |outline, bar| {
            let (from, to) = (f64::from(bar), f64::from(bar) + 0.5);
            let outline = ring(outline, &[[from, -1.0], [to, -1.0], [to, 61.0], [from, 61.0]]);
            ring(outline, &[[-1.0, from], [61.0, from], [61.0, to], [-1.0, to]])
        })
    };
    let masses = both(bars);
    close(masses[0], 60.0 * 62.0 - 900.0, 1e-12);
    close(masses[1], 60.0 * 62.0 - 1800.0, 1e-12);
    let mut random = Random::new(8);
    let points: Vec<Point> = (0..1500).map(|_| [random.unit(), random.unit()]).collect();
    assert_eq!(
        ring(Outline::new(FillRule::EvenOdd), &points).body(1.0),
        Err(BodyError::Tangled { pairs: super::crossing::CROSSINGS })
    );
}

#[test]
fn direction_and_place_do_not_matter() {
    let drawn = |[x, y]: Point| {
        let at = |p: Point| [p[0] + x, p[1] + y];
        Outline::new(FillRule::NonZero)
            .move_to(at([0.0, 0.0]))
            .cubic_to(at([2.0, 0.5]), at([2.0, -3.0]), at([0.0, -4.0]))
            .quad_to(at([-1.5, -2.0]), at([-0.5, -1.0]))
    };
    let near = drawn([0.0; 2]).body(1.0).unwrap();
    // Multiples of 2⁻²⁰ are exact at 10⁴.
    let far = drawn([8192.0, -4096.0]).body(1.0).unwrap();
    same(far.with_pivot([8192.0, -4096.0]), near, 1e-11);
    let back = Outline::new(FillRule::EvenOdd)
        .move_to([0.0, 0.0])
        .line_to([-0.5, -1.0])
        .quad_to([-1.5, -2.0], [0.0, -4.0])
        .cubic_to([2.0, -3.0], [2.0, 0.5], [0.0, 0.0]);
    same(back.body(1.0).unwrap(), near, 1e-14);
}

#[test]
fn outlines_without_area_are_refused() {
    let none = Outline::new(FillRule::NonZero);
    assert_eq!(none.body(1.0), Err(BodyError::NoMass));
    assert_eq!(none.clone().move_to([1.0, 2.0]).body(1.0), Err(BodyError::NoMass));
    let line = none.clone().move_to([1.0, 2.0]).line_to([3.0, 5.0]);
    assert_eq!(line.body(1.0), Err(BodyError::NoArea { ring: 0 }));
    let there_and_back =
        none.clone().move_to([1.0, 2.0]).cubic_to([3.0, 5.0], [3.0, 5.0], [1.0, 2.0]);
    assert_eq!(there_and_back.body(1.0), Err(BodyError::NoArea { ring: 0 }));
    let lost = none.move_to([0.0, 0.0]).line_to([f64::NAN, 1.0]).line_to([1.0, 0.0]);
    assert_eq!(lost.body(1.0), Err(BodyError::NotFinite { ring: 0, index: 1 }));
    assert!(matches!(lost.body(-1.0), Err(BodyError::Argument { name: "density", .. })));
}

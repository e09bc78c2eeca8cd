//! Tests with small drawings of known masses.

use super::{Drawing, DrawingError, Role, Units, Why};
use crate::random::Random;
use pendulum_body::Body;

const UNITS: Units = Units { pixel: 0.01, density: 3.0 };

fn read(inner: &str) -> Result<Drawing, DrawingError> {
    Drawing::read(
        &format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="100">{inner}</svg>"#
        ),
        UNITS,
    )
}

/// Returns the body of a pendulum with its pivot at (100, 20).
fn body(shapes: &str) -> Body {
    let drawing =
        read(&format!(r#"<g id="p"><circle id="p.pendulum" cx="100" cy="20" r="2"/>{shapes}</g>"#))
            .unwrap();
    assert_eq!(drawing.joints.len(), 1);
    drawing.joints[0].body.unwrap()
}

/// Checks agreement within the single precision of coordinates.
fn same(a: Body, b: Body) {
    let size = (b.inertia() / b.mass).sqrt();
    assert!((a.mass - b.mass).abs() <= 1e-6 * b.mass, "{a:?} is not {b:?}");
    assert!((0..2).all(|k| (a.center[k] - b.center[k]).abs() <= 1e-6 * size), "{a:?} is not {b:?}");
    assert!(
        (0..3).all(|k| (a.central[k] - b.central[k]).abs() <= 1e-6 * b.inertia()),
        "{a:?} is not {b:?}"
    );
}

/// 40 × 20 pixels, from the pivot downwards.
fn plank() -> Body {
    Body::rectangle(3.0 * 0.08, 0.4, 0.2).unwrap().translated([0.0, -0.1])
}

#[test]
fn a_rectangle_weighs_what_its_area_does() {
    same(body(r#"<rect x="80" y="20" width="40" height="20"/>"#), plank());
    same(body(r#"<path d="M80 20h40v20h-40z"/>"#), plank());
    same(body(r#"<polygon points="80,20 80,40 120,40 120,20"/>"#), plank());
}

#[test]
fn opacities_multiply_to_the_density() {
    let half = r#"<g opacity="0.5"><g><rect x="80" y="20" width="40" height="20" fill-opacity="0.5" opacity="0.8"/></g></g>"#;
    same(body(half), plank().scaled(0.2));
    same(
        body(r#"<rect x="80" y="20" width="40" height="20" fill="rgba(9,9,9,0.2)"/>"#),
        plank().scaled(0.2),
    );
    same(
        body(r#"<rect x="80" y="20" width="40" height="20" style="fill:red;fill-opacity:.5"/>"#),
        plank().scaled(0.5),
    );
}

#[test]
fn transforms_move_turn_and_mirror() {
    let turned = r#"<g transform="translate(100 20) rotate(90) scale(2)"><rect x="0" y="-10" width="10" height="20"/></g>"#;
    same(body(turned), plank());
    let mirrored =
        r#"<g transform="matrix(-1 0 0 1 200 0)"><rect x="85" y="20" width="40" height="20"/></g>"#;
    same(body(mirrored), plank().translated([-0.05, 0.0]));
    let drawing = read(
        r#"<g transform="translate(10 0)"><g id="a" transform="scale(-2 2)"><circle id="a.keyed" transform="translate(-3 0)" cx="-2" cy="7" r="1"/>
           <rect width="1" height="1"/></g></g>"#,
    )
    .unwrap();
    let joint = &drawing.joints[0];
    assert_eq!(
        (joint.pivot, joint.anchor, joint.mirrored, joint.scale),
        ([0.2, -0.14], [-5.0, 7.0], true, 2.0)
    );
    assert_eq!(joint.rotation(core::f64::consts::PI), [180.0, -5.0, 7.0]);
}

#[test]
fn units_and_the_view_box_are_scaled() {
    let text = r#"<svg xmlns="http://www.w3.org/2000/svg" width="400" height="200" viewBox="0 0 200 100"><g id="p">
        <circle id="p.pendulum" cx="100" cy="20" r="2"/><rect x="80" y="20" width="40" height="20"/></g></svg>"#;
    let body =
        Drawing::read(text, Units { pixel: 0.005, density: 3.0 }).unwrap().joints[0].body.unwrap();
    same(body, plank());
}

#[test]
fn curves_and_holes_follow_the_fill_rule() {
    let ring = |rule: &str| {
        format!(r#"<path fill-rule="{rule}" d="M70 20h60v60h-60z M90 40h20v20h-20z"/>"#)
    };
    let whole = Body::rectangle(3.0 * 0.36, 0.6, 0.6).unwrap().translated([0.0, -0.3]);
    let hole = Body::rectangle(3.0 * 0.04, 0.2, 0.2).unwrap().translated([0.0, -0.3]);
    same(body(&ring("nonzero")), whole);
    same(body(&ring("evenodd")), whole.without(hole).unwrap());
    // A segment of a parabola: two thirds of its bounding box.
    let vane = body(r#"<path d="M80 20Q100 100 120 20z"/>"#);
    assert!((vane.mass - 3.0 * 2.0 / 3.0 * 0.4 * 0.4).abs() < 1e-6 && vane.center[0].abs() < 1e-7);
    assert!((vane.center[1] + 0.4 * 0.4).abs() < 1e-6, "{vane:?}");
    // A circle made of cubics.
    let disc = body(r#"<circle cx="100" cy="50" r="10"/>"#);
    assert!((disc.mass / (3.0 * core::f64::consts::PI * 0.01) - 1.0).abs() < 5e-4);
}

#[test]
fn joints_stand_on_joints() {
    let text = r#"<rect id="ground" y="90" width="200" height="10"/>
      <g id="root"><g><circle id="root.keyed" cx="50" cy="50" r="1" fill="none"/></g><rect width="10" height="10"/>
        <g id="loose-shapes"><rect width="5" height="10"/>
          <g id="bell"><rect x="60" y="50" width="2" height="9"/><circle id="bell.pendulum" cx="61" cy="50" r="1" visibility="hidden"/></g></g>
        <g id="bare"><circle id="bare.keyed" cx="1" cy="2" r="1"/></g></g>"#;
    let drawing = read(text).unwrap();
    let found: Vec<_> = drawing
        .joints
        .iter()
        .map(|joint| (joint.name.as_str(), joint.role, joint.parent, joint.shapes))
        .collect();
    let expected = [
        ("root", Role::Keyed, None, 2),
        ("bell", Role::Pendulum, Some(0), 1),
        ("bare", Role::Keyed, Some(0), 0),
    ];
    assert_eq!(found, expected);
    assert_eq!((drawing.loose, drawing.size), (1, [200.0, 100.0]));
    assert!(drawing.skipped.is_empty(), "{:?}", drawing.skipped);
    // The opening tag of the bell ends at the start of its rectangle.
    let head = r#"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="100">"#.len();
    assert!(text[drawing.joints[1].inside - head..].starts_with(r#"<rect x="60""#));
}

#[test]
fn what_weighs_nothing_is_listed() {
    let text = r##"<g id="p"><circle id="p.pendulum" cx="100" cy="20" r="2"/><rect id="solid" width="4" height="4"/>
        <path id="wire" d="M0 0L9 9L9 0" fill="none" stroke="#000"/><rect id="ghost" width="4" height="4" fill-opacity="0"/>
        <path id="line" d="M0 0L9 9"/><rect id="dark" width="4" height="4" visibility="hidden"/>
        <rect id="flat" width="0" height="4"/><rect id="lost" width="4" height="4" transform="scale(0)"/>
        <image id="photo" width="9" height="9" href="/etc/passwd"/><text id="word">owl</text>
        <image width="9" height="9" href="data:image/png;base64,AAAA"/></g>"##;
    let drawing = read(text).unwrap();
    let mut found: Vec<_> =
        drawing.skipped.iter().map(|skipped| (skipped.id.as_str(), skipped.why)).collect();
    found.sort_by_key(|found| found.0);
    let expected = [
        ("dark", Why::Hidden),
        ("flat", Why::NotDrawn),
        ("ghost", Why::Transparent),
        ("image on line 6", Why::Image),
        ("line", Why::NoArea),
        ("lost", Why::NotDrawn),
        ("photo", Why::Image),
        ("wire", Why::NoFill),
        ("word", Why::Text),
    ];
    assert_eq!(found, expected);
    assert_eq!(
        drawing.skipped[0].to_string(),
        "`flat` is not drawn: it has no size, a transform that leaves none, `display=\"none\"`, or an empty clip path or filter"
    );
    same(
        drawing.joints[0].body.unwrap(),
        Body::rectangle(3.0 * 0.0016, 0.04, 0.04).unwrap().translated([-0.98, 0.18]),
    );
}

#[test]
fn errors_name_the_element() {
    let rect = r#"<rect width="4" height="4"/>"#;
    let pivot = r#"<circle id="p.pendulum" cx="1" cy="1" r="1"/>"#;
    let cases = [
        (format!(r#"<g id="p">{pivot}</g>"#), DrawingError::NoBody { name: "p".into() }),
        (
            format!(r#"<g id="q">{pivot}{rect}</g>"#),
            DrawingError::NoGroup { id: "p.pendulum".into() },
        ),
        (
            format!(r#"<g id="p">{pivot}{pivot}{rect}</g>"#),
            DrawingError::Twice { name: "p".into() },
        ),
        (
            format!(r#"<g id="p">{pivot}{rect}</g><g id="p">{rect}</g>"#),
            DrawingError::Twice { name: "p".into() },
        ),
        (
            format!(r#"<g id="p" transform="scale(1 2)">{pivot}{rect}</g>"#),
            DrawingError::Sheared { name: "p".into() },
        ),
        (
            format!(r#"<g id="p" transform="skewX(9)">{pivot}{rect}</g>"#),
            DrawingError::Sheared { name: "p".into() },
        ),
        (
            format!(r#"<g id="p"><circle id="p.keyed" r="0"/>{rect}</g>"#),
            DrawingError::NoPlace { id: "p.keyed".into() },
        ),
        (
            format!(r#"<g id="p">{pivot}<circle id="vast" r="1e38"/></g>"#),
            DrawingError::Large { id: "vast".into() },
        ),
        (
            r#"<path d="M0 0A1e38 1e38 0 0 1 9 9"/>"#.into(),
            DrawingError::Large { id: "path on line 1".into() },
        ),
        (
            r#"<path id="arc" d="M0 0a1e-300 1 0 0 1 1 0"/>"#.into(),
            DrawingError::Large { id: "arc".into() },
        ),
    ];
    for (text, expected) in cases {
        assert_eq!(read(&text), Err(expected));
    }
    let message = |text: &str, units| Drawing::read(text, units).unwrap_err().to_string();
    assert!(message("<svg", UNITS).ends_with("give the text of an SVG file"));
    assert!(message("no", UNITS).contains("1:1"));
    assert_eq!(
        message("", Units { pixel: 0.0, ..UNITS }),
        "0 metres a pixel; give a positive number"
    );
    assert_eq!(
        message("", Units { density: f64::NAN, ..UNITS }),
        "NaN kilograms a square metre; give a positive number"
    );
}

/// Invalid numbers in all places of numbers.
#[test]
fn strange_numbers_never_become_strange_bodies() {
    for number in ["NaN", "inf", "1e400", "-1e38", "1e38", "3e-39", "", "x"] {
        for text in [
            format!(r#"<rect width="{number}" height="4"/>"#),
            format!(r#"<path d="M0 0L{number} 9L9 0z"/>"#),
            format!(r#"<rect width="4" height="4" transform="matrix({number} 0 0 1 0 0)"/>"#),
            format!(r#"<rect width="4" height="4" transform="translate({number})"/>"#),
            format!(r#"<rect width="4" height="4" fill-opacity="{number}"/>"#),
            format!(r#"<circle r="{number}" fill="red"/>"#),
        ] {
            for inner in [
                text.clone(),
                format!(
                    r#"<g id="p" transform="rotate({number})"><circle id="p.keyed" r="1"/>{text}</g>"#
                ),
            ] {
                let Ok(drawing) = read(&inner) else { continue };
                for body in drawing.joints.iter().filter_map(|joint| joint.body) {
                    assert!(body.checked().is_ok(), "{inner}: {body:?}");
                }
            }
        }
    }
}

/// Deep nesting, nested copies, nested entities and many elements are rejected or read quickly.
#[test]
fn vast_drawings_neither_hang_nor_overflow() {
    let nested = |depth: usize| {
        format!(
            "{}<rect width='1' height='1'/>{}",
            "<g opacity='.9'>".repeat(depth),
            "</g>".repeat(depth)
        )
    };
    assert_eq!(read(&nested(90)).unwrap().loose, 1);
    for depth in [101, 900, 100_000] {
        let refused = read(&nested(depth));
        assert!(matches!(refused, Err(DrawingError::Deep { most: 100, .. })), "{depth}");
    }
    let copies: Vec<String> = (1..25)
        .map(|k| format!("<g id='a{k}'><use href='#a{0}'/><use href='#a{0}'/></g>", k - 1))
        .collect();
    let copied = format!(
        "<defs><g id='a0'><rect width='1' height='1'/></g>{}</defs><use href='#a24'/>",
        copies.concat()
    );
    assert!(matches!(read(&copied), Err(DrawingError::Syntax(_))));
    let entities: Vec<String> = (1..10)
        .map(|k| format!("<!ENTITY e{k} '{}'>", format!("&e{};", k - 1).repeat(10)))
        .collect();
    let bomb = format!(
        "<!DOCTYPE svg [<!ENTITY e0 'ha'>{}]><svg xmlns='http://www.w3.org/2000/svg'><text>&e9;</text></svg>",
        entities.concat()
    );
    assert!(matches!(Drawing::read(&bomb, UNITS), Err(DrawingError::Syntax(_))));
    let joints: Vec<String> = (0..5000)
        .map(|k| format!("<g id='j{k}'><circle id='j{k}.keyed' r='1'/><rect id='r{k}' width='1' height='1'/></g>"))
        .collect();
    assert_eq!(read(&joints.concat()).unwrap().joints.len(), 5000);
}

/// What a few hundred kilobytes stand for is counted, not written down.
#[test]
fn entities_that_stand_for_too_much_are_refused() {
    let message = |entities: &str, inner: &str| {
        let head = format!("<!DOCTYPE svg [{entities}]><svg xmlns='http://www.w3.org/2000/svg'>");
        Drawing::read(&format!("{head}{inner}</svg>"), UNITS).unwrap_err().to_string()
    };
    let long = |inner: &str| format!("<!ENTITY a '{}'>", inner.repeat(100_000 / inner.len()));
    let joined = |texts: Vec<String>| texts.concat();
    let many = joined((0..5000).map(|k| format!("<!ENTITY e{k} ''>")).collect());
    let lists = joined(
        (1..10)
            .map(|k| format!("<!ENTITY e{k} '{}'>", format!("&e{};", k - 1).repeat(10)))
            .collect(),
    );
    for (entities, inner) in [
        // Few long entities in a text, in attributes and as elements.
        (long("ha"), "&a;".repeat(1000)),
        (long("ha"), format!("<text>{}</text>", "&a;".repeat(1000))),
        (long("1 "), format!("<path d='M{}'/>", "&a;".repeat(1000))),
        (long("M0 0"), "<path d='&a;'/>".repeat(1000)),
        (long("<rect width=\"1\" height=\"1\"/>"), "<g>&a;</g>".repeat(1000)),
        (long("é").replace('\'', "\""), "&a;".repeat(1000)),
        // Entities in entities, and entities that are long to find.
        (format!("{}<!ENTITY b '{}'>", long("x"), "&a;".repeat(100)), "&b;".repeat(10)),
        (format!("<!ENTITY e0 'ha'>{lists}"), "<text>&e9;</text>".into()),
        (many, "&e4999;".repeat(5000)),
    ] {
        let message = message(&entities, &inner);
        assert!(
            message.starts_with("its entities stand for more than 16777216 bytes; "),
            "{message}"
        );
    }
    // As drawing programs use them.
    let drawn = Drawing::read(
        r#"<?xml version="1.0"?><!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "svg11.dtd" [
            <!ENTITY ns "http://www.w3.org/2000/svg"> <!ENTITY st0 "fill:#fff;fill-opacity:.5">
            <!ENTITY plank '<rect x="80" y="20" width="40" height="20" style="&st0;"/>'>]>
            <svg xmlns="&ns;" width="200" height="100"><g id="p">
            <circle id="p.pendulum" cx="100" cy="20" r="2"/>&plank;</g></svg>"#,
        UNITS,
    );
    same(drawn.unwrap().joints[0].body.unwrap(), plank().scaled(0.5));
}

#[test]
fn references_that_stand_for_too_much_are_refused() {
    let zigzag = "M0 0".to_string() + &"l1 1".repeat(100);
    let marker = |k: u32, inner: &str| format!("<marker id='m{k}'>{inner}</marker>");
    let path = |k: u32| format!("<path d='{zigzag}' marker-mid='url(#m{k})'/>");
    let chain: String = (1..9).map(|k| marker(k, &path(k - 1))).collect();
    let dot = "<rect width='1' height='1'/>";
    let (many, one) = (marker(0, &dot.repeat(20_000)), marker(0, dot));
    let used = |rest: &str| format!("<g id='g'>{}</g>{rest}", path(0));
    for bomb in [
        format!("{one}{chain}{}", path(8)),
        format!("{many}{}", path(0)),
        format!("{one}<path id='p' d='{}' style='marker : url(#m0)'/>", zigzag.repeat(10_000)),
        format!(
            "{one}<style>.a {{ marker-mid: url(#m0) }}</style><path class='a' d='{}'/>",
            zigzag.repeat(10_000)
        ),
        format!("{one}{}", used(&"<use href='#g'/>".repeat(5000))),
        format!(
            "{one}<path id='p' d='{zigzag}'/><g marker-mid='url(#m0)'>{}</g>",
            "<use href='#p'/>".repeat(5000)
        ),
        format!("{many}{}", "<path d='M0 0h9' style='marker-end:url(#m0)'/>".repeat(100)),
    ] {
        let message = read(&bomb).unwrap_err().to_string();
        assert!(message.starts_with("its markers, masks, patterns and "), "{message}");
    }
    // Each contains two shapes that refer to the one before.
    let doubled = |tag: &str, property: &str, written: &dyn Fn(u32) -> String| {
        let shape = |k: u32| format!("<rect width='9' height='9' {}/>", written(k));
        let parts = (1..40).map(|k| {
            format!(
                "<{tag} id='m{k}' width='1' height='1'>{}{}</{tag}>",
                shape(k - 1),
                shape(k - 1)
            )
        });
        let parts: String = parts.collect();
        let message = read(&format!("<{tag} id='m0'>{dot}</{tag}>{parts}{}", shape(39)));
        let message = message.unwrap_err().to_string();
        assert!(message.starts_with("its markers, masks, patterns and "), "{property}: {message}");
    };
    let parts =
        [("mask", "mask"), ("clipPath", "clip-path"), ("pattern", "fill"), ("pattern", "stroke")];
    for (tag, property) in parts {
        doubled(tag, property, &|k| format!("{property}='url(#m{k})'"));
        doubled(tag, property, &|k| format!("style='x:y; {property} : url( \"#m{k}\" )'"));
        doubled(tag, property, &|k| {
            format!(
                "class='a c{k}'/><style>g .c{k}{{{property}:url(#m{k})}}</style><rect width='1' height='1'"
            )
        });
    }
    // As drawing programs use them.
    let arrow = "<path d='M0 0h9v9' fill='none' style='marker-start:none;marker-end:url(#m0)'/>";
    let drawn = format!("{one}{}{}", arrow.repeat(1000), used(&"<use href='#g'/>".repeat(100)));
    assert!(read(&drawn).is_ok());
}

#[test]
fn what_clips_and_masks_may_hide_is_listed() {
    let found = |text: &str| {
        let text = format!(
            r##"<clipPath id="disc"><circle cx="90" cy="30" r="5"/></clipPath>
            <clipPath id="page"><rect width="200" height="100"/></clipPath>
            <clipPath id="left"><path d="M0 0H90V100H0z"/></clipPath>
            <clipPath id="slope"><path d="M0 0H200V100H1z"/></clipPath>
            <clipPath id="turned" transform="rotate(45)"><rect x="-999" y="-999" width="1998" height="1998"/></clipPath>
            <clipPath id="both" clip-path="url(#disc)"><rect width="200" height="100"/></clipPath>
            <clipPath id="fitting" clipPathUnits="objectBoundingBox"><rect width="1" height="1"/></clipPath>
            <clipPath id="half" clipPathUnits="objectBoundingBox"><rect width=".5" height="1"/></clipPath>
            <mask id="mask"><rect width="200" height="100" fill="#888"/></mask>
            <style>.clipped {{ clip-path: url(#disc) }}</style>
            <g id="p"><circle id="p.pendulum" cx="100" cy="20" r="2" clip-path="url(#disc)"/>{text}</g>"##
        );
        let drawing = read(&text).unwrap();
        same(drawing.joints[0].body.unwrap(), plank());
        let skipped = drawing.skipped.into_iter().map(|skipped| (skipped.id, skipped.why));
        skipped.collect::<Vec<_>>()
    };
    let rect = r#"<rect id="wing" x="80" y="20" width="40" height="20"/>"#;
    let with = |more: &str| rect.replace("/>", &format!(" {more}/>"));
    let why = |why| vec![("wing".to_string(), why)];
    assert_eq!(found(rect), []);
    for clip in ["disc", "left", "slope", "turned", "both", "half"] {
        assert_eq!(found(&with(&format!("clip-path='url(#{clip})'"))), why(Why::Clipped), "{clip}");
        let group = format!("<g clip-path='url(#{clip})'>{rect}</g>");
        assert_eq!(found(&group), why(Why::Clipped), "{clip}");
    }
    // Windows that show the whole, also one through another.
    for clip in ["page", "fitting"] {
        assert_eq!(found(&with(&format!("clip-path='url(#{clip})'"))), []);
        assert_eq!(found(&format!("<g clip-path='url(#{clip})'><g>{rect}</g></g>")), []);
    }
    let inner = "<g clip-path='url(#left)'><g clip-path='url(#page)'>";
    assert_eq!(found(&format!("{inner}{rect}</g></g>")), why(Why::Clipped));
    let moved = rect.replace("x=\"80\"", "x=\"-70\"");
    assert_eq!(
        found(&format!("<g transform='translate(150)' clip-path='url(#page)'>{moved}</g>")),
        why(Why::Clipped)
    );
    assert_eq!(
        found(&format!("<g clip-path='url(#page)'><g transform='translate(150)'>{moved}</g></g>")),
        []
    );
    // Masks, styles, and what has no name.
    assert_eq!(found(&with("mask='url(#mask)'")), why(Why::Masked));
    assert_eq!(found(&format!("<g style='mask:url(#mask)'><g>{rect}</g></g>")), why(Why::Masked));
    assert_eq!(found(&with("class='clipped'")), why(Why::Clipped));
    let nameless = with("clip-path='url(#disc)'").replace("id=\"wing\"", "");
    assert_eq!(found(&nameless), [("a shape of p".to_string(), Why::Clipped)]);
    // Nested drawings clip what they contain.
    let nested = |size: u32| format!("<svg width='{size}' height='{size}'>{rect}</svg>");
    assert_eq!(found(&nested(100)), why(Why::Clipped));
    assert_eq!(found(&nested(120)), []);
    let drawing = read(
        &with("mask='url(#m)'")
            .replace("<rect", "<mask id='m'><rect width='9' height='9'/></mask><rect"),
    );
    assert_eq!(
        drawing.unwrap().skipped[0].to_string(),
        "`wing` is masked, but weighs as much as the whole; cut its outline instead"
    );
}

/// Ten thousand drawings with wrong bytes result in errors or bodies, never in a panic.
#[test]
fn wrong_bytes_never_panic() {
    let text = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 90 90"><g id="a" transform="rotate(30)"><circle id="a.keyed" cx="5" r="1"/>
        <path d="M1 2C3 4 5-6 7 8Q9 1 2 3zM4 5h9v1z" fill-rule="evenodd" opacity=".5"/><g id="b"><use href="#c"/><rect id="b.pendulum" x="3"
        width="2" height="2"/><ellipse id="c" rx="3" ry="2" style="fill:#123"/></g></g></svg>"##;
    assert!(Drawing::read(text, UNITS).is_ok());
    let mut random = Random::new(21);
    let [mut refused, mut taken] = [0, 0];
    for _ in 0..10_000 {
        let mut bytes = text.as_bytes().to_vec();
        for _ in 0..=random.bits() % 3 {
            let place = random.bits() as usize % bytes.len();
            let digit = bytes[place].is_ascii_digit();
            bytes[place] = if digit {
                b'0' + (random.bits() % 10) as u8
            } else {
                32 + (random.bits() % 95) as u8
            };
        }
        match Drawing::read(&String::from_utf8(bytes).unwrap(), UNITS) {
            Ok(drawing) => {
                taken += 1;
                let bodies = drawing.joints.iter().filter_map(|joint| joint.body);
                bodies.for_each(|body| assert!(body.checked().is_ok(), "{body:?}"));
            }
            Err(error) => {
                refused += 1;
                assert!(!error.to_string().is_empty());
            }
        }
    }
    assert!(1000 < refused && 1000 < taken, "{refused} {taken}");
}

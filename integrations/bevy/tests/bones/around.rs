//! Bodies that bones do not enter, and winds.

use super::*;
use bevy_pendulum::{SpringCollider, SpringColliders, Wind};

/// Spawns a bone that points along x and falls.
fn arm(app: &mut App) -> Entity {
    let parent = joint(app, Transform::default());
    let bone = spawn(app, parent, heavy(0.2 * Vec3::X));
    run(app, 60, SECOND / 10);
    bone
}

fn tip(app: &App, bone: Entity) -> Vec3 {
    let place = get::<GlobalTransform>(app, bone);
    place.transform_point(get::<SpringBone>(app, bone).tip)
}

/// The distance from the centre of a ball to the line of a bone.
fn off(app: &App, bone: Entity, center: Vec3) -> f32 {
    let start = get::<GlobalTransform>(app, bone).translation();
    let along = tip(app, bone) - start;
    let part = (center - start).dot(along) / along.length_squared();
    (start + part.clamp(0.0, 1.0) * along).distance(center)
}

/// A ball below the arm in its rest without gravity, and where the arm would hang within it.
const BALL: (Vec3, f32) = (Vec3::new(0.15, -0.12, 0.0), 0.05);

fn list(body: Entity) -> SpringColliders {
    SpringColliders { radius: 0.01, friction: 0.0, bodies: vec![body] }
}

fn ball(app: &mut App, transform: Transform, center: Vec3, radius: f32) -> Entity {
    app.world_mut().spawn((SpringCollider::Ball { center, radius }, transform)).id()
}

#[test]
fn bones_rest_on_bodies_and_fall_when_they_are_gone() {
    let mut app = app();
    let bone = arm(&mut app);
    run(&mut app, 60, 5 * SECOND);
    let free = tip(&app, bone);
    assert!(free.distance(BALL.0) < BALL.1, "{free}");
    let body = ball(&mut app, Transform::default(), BALL.0, BALL.1);
    app.world_mut().entity_mut(bone).insert(list(body));
    run(&mut app, 60, 5 * SECOND);
    assert!((off(&app, bone, BALL.0) - 0.06).abs() < 1e-4, "{}", off(&app, bone, BALL.0));
    // A smaller one, none in the list, and none at all.
    app.world_mut().entity_mut(body).insert(SpringCollider::Ball { center: BALL.0, radius: 0.04 });
    run(&mut app, 60, 5 * SECOND);
    assert!((off(&app, bone, BALL.0) - 0.05).abs() < 1e-4, "{}", off(&app, bone, BALL.0));
    app.world_mut().entity_mut(bone).insert(SpringColliders::default());
    run(&mut app, 60, 5 * SECOND);
    assert!(tip(&app, bone).distance(free) < 1e-4);
    app.world_mut().entity_mut(bone).insert(list(body));
    run(&mut app, 60, 5 * SECOND);
    assert!(tip(&app, bone).distance(free) > 0.01);
    app.world_mut().despawn(body);
    run(&mut app, 60, 5 * SECOND);
    assert!(tip(&app, bone).distance(free) < 1e-4);
    // A list that is removed, with a body that stays.
    let body = ball(&mut app, Transform::default(), BALL.0, BALL.1);
    app.world_mut().entity_mut(bone).insert(list(body));
    run(&mut app, 60, 5 * SECOND);
    assert!(tip(&app, bone).distance(free) > 0.01);
    app.world_mut().entity_mut(bone).remove::<SpringColliders>();
    run(&mut app, 60, 5 * SECOND);
    assert!(tip(&app, bone).distance(free) < 1e-4);
}

#[test]
fn a_body_that_turns_drags_bones_by_friction() {
    let mut app = app();
    let bone = arm(&mut app);
    let body = ball(&mut app, Transform::from_translation(BALL.0), Vec3::ZERO, BALL.1);
    app.world_mut().entity_mut(bone).insert(list(body));
    let turn = |app: &mut App| {
        for _ in 0..120 {
            app.world_mut().get_mut::<Transform>(body).unwrap().rotate_x(0.02);
            frame(app, SECOND / 60);
        }
        tip(app, bone).z
    };
    assert!(turn(&mut app).abs() < 1e-5);
    app.world_mut().get_mut::<SpringColliders>(bone).unwrap().friction = 0.5;
    let dragged = turn(&mut app);
    assert!(1e-3 < dragged.abs(), "{dragged}");
    app.world_mut().get_mut::<SpringColliders>(bone).unwrap().friction = 0.0;
    run(&mut app, 60, 5 * SECOND);
    assert!(turn(&mut app).abs() < 0.1 * dragged.abs());
}

#[test]
fn bodies_are_scaled_mirrored_and_moved_with_their_entities() {
    let mut app = app();
    let bone = arm(&mut app);
    // The ball at 0.25 of its lengths, reversed along x, and behind a shift.
    let shift = Vec3::new(0.3, 0.4, 0.5);
    let parent = joint(&mut app, Transform::from_scale(Vec3::new(-0.5, 0.5, 0.5)));
    let own = Transform::from_translation(shift).with_scale(Vec3::splat(0.5));
    let goal = BALL.0;
    let center = 4.0 * (Vec3::new(-goal.x, goal.y, goal.z) - 0.5 * shift);
    let shape = SpringCollider::Ball { center, radius: 4.0 * BALL.1 };
    let body = app.world_mut().spawn((shape, own, ChildOf(parent))).id();
    app.world_mut().entity_mut(bone).insert(list(body));
    run(&mut app, 60, 5 * SECOND);
    assert!((off(&app, bone, goal) - 0.06).abs() < 1e-4, "{}", off(&app, bone, goal));
    // Up by 5 cm within a second: the bone is lifted.
    let up = 0.05 * Vec3::Y;
    for _ in 0..60 {
        app.world_mut().get_mut::<Transform>(parent).unwrap().translation += up / 60.0;
        frame(&mut app, SECOND / 60);
    }
    run(&mut app, 60, 5 * SECOND);
    assert!((off(&app, bone, goal + up) - 0.06).abs() < 1e-4);
    app.world_mut().get_mut::<Transform>(parent).unwrap().scale *= 1.2;
    run(&mut app, 60, 5 * SECOND);
    let moved = up + 1.2 * goal;
    assert!((off(&app, bone, moved) - 0.07).abs() < 1e-4, "{}", off(&app, bone, moved));
}

#[test]
fn a_list_holds_for_the_bones_below_up_to_the_next() {
    let mut app = app();
    let root = joint(&mut app, Transform::default());
    let hang = |app: &mut App| {
        let upper = spawn(app, root, heavy(0.2 * Vec3::X));
        let lower = (heavy(0.3 * Vec3::X), Transform::from_xyz(0.2, 0.0, 0.0));
        [upper, spawn(app, upper, lower)]
    };
    let [upper, free] = hang(&mut app);
    run(&mut app, 60, 8 * SECOND);
    // Where the lower bone rests.
    let center = tip(&app, free);
    app.world_mut().despawn(upper);
    let body = ball(&mut app, Transform::from_translation(center), Vec3::ZERO, 0.05);
    app.world_mut().entity_mut(root).insert(list(body));
    let [_, lower] = hang(&mut app);
    let [apart, alone] = hang(&mut app);
    app.world_mut().entity_mut(apart).insert(SpringColliders::default());
    run(&mut app, 60, 8 * SECOND);
    assert!((off(&app, lower, center) - 0.06).abs() < 1e-4, "{}", off(&app, lower, center));
    assert!(off(&app, alone, center) < 1e-4);
}

#[test]
fn winds_add_to_gravity() {
    let mut app = app();
    let bone = arm(&mut app);
    let omega = std::f32::consts::TAU * 1.5;
    let along = |sum: Vec3| (omega * omega * Vec3::X + sum / 0.2).normalize();
    let weight = Vec3::new(0.0, -9.81, 0.0);
    let is_at = |app: &mut App, goal: Vec3| {
        run(app, 60, 8 * SECOND);
        assert!(direction(app, bone).distance(goal) < 1e-4, "{} {goal}", direction(app, bone));
    };
    is_at(&mut app, along(weight));
    let wind = Vec3::new(1.0, 2.0, 5.0);
    let parent = get::<ChildOf>(&app, bone).parent();
    app.world_mut().entity_mut(parent).insert(Wind(wind));
    is_at(&mut app, along(weight + wind));
    app.world_mut().entity_mut(parent).insert(Wind(-wind));
    is_at(&mut app, along(weight - wind));
    // The nearest wind counts, and one that is not a number is refused.
    app.world_mut().entity_mut(bone).insert(Wind(Vec3::Z));
    is_at(&mut app, along(weight + Vec3::Z));
    app.world_mut().entity_mut(bone).insert(Wind(Vec3::NAN));
    is_at(&mut app, along(weight + Vec3::Z));
    app.world_mut().entity_mut(bone).remove::<Wind>();
    app.world_mut().entity_mut(parent).remove::<Wind>();
    is_at(&mut app, along(weight));
}

//! Poses: rest, bits, frame rates, chains.

use super::*;
use bevy_pendulum::PendulumSystems;
use bevy_time::{Time, Virtual};
use pendulum_runtime::attitude::Attitude;
use pendulum_runtime::scene::{Bone, Scene};

#[test]
fn a_new_bone_rests_under_gravity() {
    let mut app = app();
    let turn = Quat::from_rotation_z(1.2);
    let head = joint(&mut app, Transform::from_xyz(0.3, 1.7, 0.1).with_rotation(turn));
    let ear = spawn(&mut app, head, heavy(Vec3::Y * 0.2));
    run(&mut app, 60, SECOND / 10);
    let rest = rest_of(turn * Vec3::Y, 0.2);
    assert!(direction(&app, ear).distance(rest) < 1e-5, "{} {rest}", direction(&app, ear));
}

#[test]
fn settings_of_vrm_rest_where_its_formula_rests() {
    let mut app = app();
    let gravity_dir = Vec3::new(0.6, -0.8, 0.0);
    let spring = Spring::Vrm { stiffness: 0.8, gravity_power: 0.5, gravity_dir, drag_force: 0.4 };
    let hair = app.world_mut().spawn(SpringBone { tip: Vec3::Y * 0.1, spring }).id();
    run(&mut app, 60, SECOND / 10);
    let rest = (0.8 * Vec3::Y + 0.5 * gravity_dir).normalize();
    assert!(direction(&app, hair).distance(rest) < 1e-5);
}

#[test]
fn tips_may_lie_in_any_direction() {
    for tip in [Vec3::X, Vec3::NEG_Y, Vec3::new(-0.3, 0.2, 0.9)].map(|tip| 0.2 * tip.normalize()) {
        let mut app = app();
        let turn = Quat::from_rotation_x(0.4);
        let bone = (heavy(tip), Transform::from_rotation(turn));
        let ear = app.world_mut().spawn(bone).id();
        run(&mut app, 60, SECOND / 10);
        let rest = rest_of(turn * tip.normalize(), 0.2);
        assert!(direction(&app, ear).distance(rest) < 1e-5, "{tip}");
    }
}

#[test]
fn mirrored_parents_mirror_their_bones() {
    let mut app = app();
    let tip = 0.2 * Vec3::new(-0.3, 0.2, 0.9).normalize();
    let turn = Quat::from_rotation_y(0.7);
    let flipped = Vec3::new(-1.0, 1.0, 1.0);
    let head = joint(&mut app, Transform::from_rotation(turn).with_scale(flipped));
    let mut frame = tip.normalize();
    let mut parent = head;
    for angle in [0.5, 0.0] {
        let local = Quat::from_euler(bevy_math::EulerRot::XYZ, angle, 0.0, -angle);
        let place = Transform::from_translation(if parent == head { Vec3::ZERO } else { tip });
        let bone = SpringBone::swinging(tip, 2.0, 0.5);
        let bone = spawn(&mut app, parent, (bone, place.with_rotation(local)));
        run(&mut app, 60, SECOND / 10);
        // Without gravity, each bone keeps the rotation with which it was added.
        assert!(apart(rotation(&app, bone), local) < 1e-6);
        parent = bone;
        frame = local * frame;
    }
    // Under gravity, the tip bends away from the direction in mirrored space.
    let local = Quat::from_rotation_x(0.5);
    let bone = spawn(&mut app, head, (heavy(tip), Transform::from_rotation(local)));
    run(&mut app, 60, SECOND / 10);
    let rest = rest_of(turn * (flipped * (local * tip.normalize())), 0.2);
    assert!(direction(&app, bone).distance(rest) < 1e-5);
}

#[test]
fn a_scene_driven_by_hand_has_the_same_bits() {
    let mut app = app();
    let place = |t: f32| {
        let turn = Quat::from_rotation_x((3.0 * t).sin()) * Quat::from_rotation_z(t * t);
        Transform::from_xyz(0.1 * (7.0 * t).sin(), 1.7, t * t).with_rotation(turn)
    };
    let offset = Transform::from_xyz(0.05, 0.1, 0.0);
    let head = joint(&mut app, place(0.0));
    let first = spawn(&mut app, head, (SpringBone::swinging(Vec3::Y * 0.25, 2.0, 0.2), offset));
    // Not at the tip of the first one.
    let bend = Transform::from_xyz(0.0625, 0.125, -0.25);
    let bend = bend.with_rotation(Quat::from_rotation_z(0.5));
    let second = spawn(&mut app, first, (SpringBone::swinging(Vec3::Y * 0.125, 3.0, 0.2), bend));
    frame(&mut app, 0);

    let sample = |t| {
        let above = GlobalTransform::from(place(t));
        let q = above.to_scale_rotation_translation().1.as_dquat().normalize();
        let position = above.transform_point(offset.translation).as_dvec3().to_array();
        (position, [q.w, q.x, q.y, q.z])
    };
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let (position, turn) = sample(0.0);
    let root = scene.live_frame(position, Attitude::from_quaternion(turn)).unwrap();
    let bone = Bone::swinging(0.25, 2.0, f64::from(0.2f32)).unwrap();
    let start = scene.joint_pose(root.1, 1.0);
    let one = scene.hang(root, bone, start, [0.0; 4]).unwrap();
    scene.reset_to_rest(one).unwrap();
    let q = bend.rotation.as_dquat();
    let bend = Attitude::from_quaternion([q.w, q.x, q.y, q.z]);
    let carried = scene.frame_on(one, ["tip", "turn"], [0.0625, -0.125, -0.25], bend).unwrap();
    let bone = Bone::swinging(0.125, 3.0, f64::from(0.2f32)).unwrap();
    let start = scene.joint_pose(carried.1, 1.0);
    let two = scene.hang(carried, bone, start, [0.0; 4]).unwrap();
    scene.reset_to_rest(two).unwrap();

    let mut swing = 0.0f32;
    for k in 1u16..=100 {
        let t = f32::from(k) / 70.0;
        *app.world_mut().get_mut(head).unwrap() = place(t);
        frame(&mut app, SECOND / 70);
        let (position, turn) = sample(t);
        scene.move_to(root.0, position).unwrap();
        scene.move_to(root.1, turn).unwrap();
        scene.advance(Duration::from_nanos(SECOND / 70).as_secs_f64()).unwrap();
        let ours = pendulums(&app);
        assert_eq!(ours.scene().state(ours.bone(first).unwrap()), scene.state(one), "{k}");
        assert_eq!(ours.scene().state(ours.bone(second).unwrap()), scene.state(two), "{k}");
        swing = swing.max(apart(rotation(&app, first), Quat::IDENTITY));
    }
    assert!(0.1 < swing, "{swing}");
}

#[test]
fn poses_at_equal_times_are_equal_at_30_and_144_frames_a_second() {
    let poses = |rate| {
        let mut app = app();
        let head = joint(&mut app, Transform::from_rotation(Quat::from_rotation_z(1.2)));
        let ear = spawn(&mut app, head, SpringBone::swinging(Vec3::Y * 0.2, 1.5, 0.3));
        let tip =
            (SpringBone::swinging(Vec3::Y * 0.1, 3.0, 0.1), Transform::from_xyz(0.0, 0.2, 0.0));
        let tip = spawn(&mut app, ear, tip);
        frame(&mut app, 0);
        // Both begin to swing.
        for bone in [ear, tip] {
            app.world_mut().get_mut::<SpringBone>(bone).unwrap().spring = heavy(Vec3::Y).spring;
        }
        let sixth = |app: &mut App| {
            run(app, rate, SECOND / 6);
            [ear, tip].map(|bone| rotation(app, bone).to_array())
        };
        [(); 6].map(|()| sixth(&mut app))
    };
    let slow = poses(30);
    assert_eq!(slow, poses(144));
    assert!(0.01 < apart(Quat::from_array(slow[0][0]), Quat::from_array(slow[1][0])));
}

#[test]
fn the_tip_of_a_bone_carries_the_next_one() {
    let mut app = app();
    let head = joint(&mut app, Transform::from_xyz(0.0, 1.7, 0.0));
    let sideways = 0.2 * Vec3::X;
    let ear = spawn(&mut app, head, heavy(sideways));
    let tip = (heavy(0.1 * Vec3::Y), Transform::from_translation(sideways));
    let tip = spawn(&mut app, ear, tip);
    run(&mut app, 60, SECOND / 10);
    // The next bone rests about the direction that the first one gives it.
    let turned = Quat::from_rotation_arc(Vec3::X, direction(&app, ear));
    assert!(direction(&app, ear).distance(rest_of(Vec3::X, 0.2)) < 1e-5);
    assert!(direction(&app, tip).distance(rest_of(turned * Vec3::Y, 0.1)) < 1e-4);
}

#[test]
fn entities_without_a_bone_may_stand_between_two_that_have_one() {
    let mut app = app();
    let ear = app.world_mut().spawn(heavy(Vec3::X * 0.2)).id();
    let between = spawn(&mut app, ear, Transform::from_xyz(0.2, 0.0, 0.0));
    let tip = spawn(&mut app, between, heavy(Vec3::X * 0.1));
    run(&mut app, 60, 6 * SECOND);
    assert!(direction(&app, tip).distance(rest_of(direction(&app, ear), 0.1)) < 1e-3);
}

#[test]
fn bones_that_rest_fall_asleep_and_wake_with_their_parents() {
    let mut app = app();
    let head = joint(&mut app, Transform::IDENTITY);
    let ear = spawn(&mut app, head, heavy(Vec3::X * 0.2));
    let scene = app.world_mut().resource_mut::<Pendulums>().into_inner().scene_mut();
    scene.set_sleep(Some(1e-3)).unwrap();
    run(&mut app, 60, SECOND);
    assert_eq!(pendulums(&app).scene().awake(), (0, 1));
    let before = rotation(&app, ear);
    app.world_mut().get_mut::<Transform>(head).unwrap().translation.y = 0.1;
    run(&mut app, 60, SECOND / 10);
    assert_eq!(pendulums(&app).scene().awake(), (1, 1));
    assert!(0.01 < apart(rotation(&app, ear), before));
}

#[test]
fn bones_follow_parents_where_they_are_in_this_frame() {
    let mut app = app();
    let grandparent = joint(&mut app, Transform::IDENTITY);
    let head = spawn(&mut app, grandparent, Transform::from_xyz(0.0, 1.0, 0.0));
    let ear = spawn(&mut app, head, SpringBone::swinging(Vec3::Y * 0.2, 40.0, 1.0));
    for k in 0u8..60 {
        let turn = Quat::from_rotation_z(f32::from(k) / 30.0);
        *app.world_mut().get_mut(grandparent).unwrap() = Transform::from_rotation(turn);
        frame(&mut app, SECOND / 60);
        // A stiff bone stays on a parent that turns.
        if 30 < k {
            assert!(direction(&app, ear).distance(turn * Vec3::Y) < 1e-3, "{k}");
        }
    }
}

#[test]
fn slow_motion_takes_the_same_way() {
    let mut app = app();
    let ear = app.world_mut().spawn(SpringBone::swinging(Vec3::X * 0.2, 1.5, 0.3)).id();
    frame(&mut app, 0);
    app.world_mut().get_mut::<SpringBone>(ear).unwrap().spring = heavy(Vec3::Y).spring;
    app.world_mut().resource_mut::<Time<Virtual>>().set_relative_speed(0.25);
    run(&mut app, 60, SECOND);
    assert_eq!(pendulums(&app).scene().tick(), 60);
}

#[test]
fn other_systems_run_before_or_after_bones() {
    use bevy_app::PostUpdate;
    use bevy_ecs::schedule::IntoScheduleConfigs;
    use bevy_ecs::system::Query;
    let mut app = app();
    let ear = app.world_mut().spawn(SpringBone::swinging(Vec3::X * 0.2, 1.5, 0.3)).id();
    let lift = move |mut all: Query<&mut Transform>| all.get_mut(ear).unwrap().translation.y = 1.0;
    app.add_systems(PostUpdate, lift.before(PendulumSystems));
    frame(&mut app, SECOND / 60);
    assert_eq!(get::<GlobalTransform>(&app, ear).translation(), Vec3::Y);
    let ours = pendulums(&app);
    let tip = ours.scene().observe(ours.bone(ear).unwrap(), 1.0);
    assert_eq!(tip.system.tip(tip.t, &tip.q, &tip.v, &tip.inputs)[1], 1.0);
}

//! The vertical plane of the motion, and the joints from which pendulums hang.

use pendulum_runtime::import::bvh::{Bvh, SkeletonJoint};
use pendulum_runtime::scalar::Real;

/// The vertical plane along the main horizontal direction of a path; the second axis of the file
/// points up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Plane {
    /// The unit vector along the plane, in x and z.
    along: [f64; 2],
    /// The point that becomes the origin, in x and z.
    origin: [f64; 2],
    /// The metres in a unit of the file.
    scale: f64,
}

impl Plane {
    /// Fits a plane to a path by least squares. The path leads from left to right and starts at
    /// zero.
    pub(crate) fn fit(path: &[[f64; 3]], scale: f64) -> Self {
        let count = path.len() as f64;
        let flat = || path.iter().map(|&[x, _, z]| [x, z]);
        let mean = [0, 1].map(|axis| flat().map(|point| point[axis]).sum::<f64>() / count);
        let moment = |a: usize, b: usize| {
            flat().map(|point| (point[a] - mean[a]) * (point[b] - mean[b])).sum::<f64>() / count
        };
        // The principal axis of the second moments: tan 2φ = 2 s_xz/(s_xx − s_zz).
        let angle = Real::atan2(2.0 * moment(0, 1), moment(0, 0) - moment(1, 1)) / 2.0;
        let (sin, cos) = Real::sin_cos(angle);
        let mut along = [cos, sin];
        let (first, last) = (path[0], path[path.len() - 1]);
        if along[0] * (last[0] - first[0]) + along[1] * (last[2] - first[2]) < 0.0 {
            along = along.map(|value| -value);
        }
        Self { along, origin: [first[0], first[2]], scale }
    }

    /// Returns the coordinates of a point along the plane, up, and towards the eye, in metres.
    pub(crate) fn view(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [x, z] = [x - self.origin[0], z - self.origin[1]];
        let [a, b] = self.along;
        [a * x + b * z, y, a * z - b * x].map(|value| value * self.scale)
    }
}

/// Returns the first joint with one of the names, or else the first whose name contains one of
/// them.
pub(crate) fn find(bvh: &Bvh, names: &[&str]) -> Option<usize> {
    let plain: Vec<String> = bvh.joints().iter().map(|joint| plain(&joint.name)).collect();
    let same = |name: &&str| plain.iter().position(|joint| joint == name);
    let within = |name: &&str| plain.iter().position(|joint| joint.contains(*name));
    names.iter().find_map(same).or_else(|| names.iter().find_map(within))
}

/// Returns the letters and digits of a name in lower case, without the rig's prefix:
/// `mixamorig:LeftHand` and `left_hand` are both `lefthand`.
fn plain(name: &str) -> String {
    let name = name.rsplit(':').next().unwrap_or(name);
    name.chars().filter(|letter| letter.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// Returns the limbs: runs of joints from a branch, or the root, to an end.
pub(crate) fn limbs(joints: &[SkeletonJoint]) -> Vec<Vec<usize>> {
    let mut parents = vec![false; joints.len()];
    for parent in joints.iter().filter_map(|joint| joint.parent) {
        parents[parent] = true;
    }
    let mut drawn = vec![false; joints.len()];
    let mut limbs = Vec::new();
    for end in (0..joints.len()).filter(|&joint| !parents[joint]) {
        let mut limb = vec![end];
        drawn[end] = true;
        while let Some(parent) = joints[limb[limb.len() - 1]].parent {
            limb.push(parent);
            if drawn[parent] {
                break;
            }
            drawn[parent] = true;
        }
        limb.reverse();
        limbs.push(limb);
    }
    limbs
}

#[cfg(test)]
mod tests {
    use super::{Plane, find, limbs};
    use pendulum_runtime::import::bvh::Bvh;

    fn rig(names: [&str; 4]) -> Bvh {
        let [a, b, c, d] = names;
        let joint = "OFFSET 0 1 0 CHANNELS 1 Xrotation";
        Bvh::read(&format!(
            "HIERARCHY\nROOT {a} {{ {joint}\nJOINT {b} {{ {joint}\nJOINT {c} {{ {joint} }}\nJOINT {d} {{ {joint} }}\n}} }}\nMOTION\n\
             Frames: 1\nFrame Time: 1\n0 0 0 0\n"
        ))
        .unwrap()
    }

    #[test]
    fn a_diagonal_path_leads_from_left_to_right() {
        for (x, z) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-3.0, -4.0)] {
            let path: Vec<[f64; 3]> =
                (0..9).map(|k| [x * f64::from(k), 7.0, z * f64::from(k) + 2.0]).collect();
            let plane = Plane::fit(&path, 0.5);
            let [along, up, side] = plane.view(path[8]);
            let length = 8.0 * (x * x + z * z).sqrt() / 2.0;
            assert!(
                (along - length).abs() < 1e-12 && (up - 3.5).abs() < 1e-12 && side.abs() < 1e-12,
                "{along} {up} {side}"
            );
        }
    }

    /// For a path along x, the axes of the view are x to the right, y up, and z towards the eye.
    #[test]
    fn the_view_is_right_handed() {
        let plane = Plane::fit(&[[0.0; 3], [1.0, 0.0, 0.0]], 1.0);
        assert_eq!(plane.view([2.0, 3.0, 5.0]), [2.0, 3.0, 5.0]);
    }

    #[test]
    fn a_path_that_stays_is_seen_along_x() {
        assert_eq!(Plane::fit(&[[1.0, 2.0, 3.0]; 4], 1.0).view([2.0, 3.0, 5.0]), [1.0, 3.0, 2.0]);
    }

    #[test]
    fn joints_are_found_however_they_are_written() {
        let bvh = rig(["mixamorig:Hips", "upper_left_hand_twist", "Left Hand", "R_Hand.001"]);
        assert_eq!(find(&bvh, &["hips"]), Some(0));
        assert_eq!(find(&bvh, &["lhand", "lefthand"]), Some(2));
        assert_eq!(find(&bvh, &["righthand", "rhand"]), Some(3));
        assert_eq!(find(&bvh, &["tail"]), None);
    }

    #[test]
    fn limbs_start_at_branches() {
        assert_eq!(limbs(rig(["a", "b", "c", "d"]).joints()), [vec![0, 1, 2], vec![1, 3]]);
    }
}

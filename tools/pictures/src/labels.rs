//! Vertical placement of labels near their preferred positions.

/// Returns heights in the order of `wanted` that are at least `gap` apart and as near as possible
/// to the wanted heights. They are between `top` and `bottom` if they fit.
pub(crate) fn spread(wanted: &[f64], gap: f64, top: f64, bottom: f64) -> Vec<f64> {
    let mut order: Vec<usize> = (0..wanted.len()).collect();
    order.sort_by(|a, b| wanted[*a].total_cmp(&wanted[*b]));
    // Groups of adjacent labels: the members, and the sum of their preferred positions of the first
    // label.
    let mut groups: Vec<(Vec<usize>, f64)> = Vec::new();
    let place = |group: &(Vec<usize>, f64)| {
        let count = group.0.len() as f64;
        let least = (bottom - gap * (count - 1.0)).max(top);
        (group.1 / count).clamp(top, least)
    };
    for index in order {
        groups.push((vec![index], wanted[index]));
        while let [.., above, below] = &groups[..] {
            if place(above) + gap * above.0.len() as f64 <= place(below) {
                break;
            }
            let (members, sum) = groups.pop().expect("two groups");
            let above = groups.last_mut().expect("two groups");
            above.1 += sum - gap * (above.0.len() * members.len()) as f64;
            above.0.extend(members);
        }
    }
    let mut heights = vec![0.0; wanted.len()];
    for group in &groups {
        for (row, index) in group.0.iter().enumerate() {
            heights[*index] = place(group) + gap * row as f64;
        }
    }
    heights
}

#[cfg(test)]
mod tests {
    use super::spread;

    #[test]
    fn labels_keep_their_distance_and_their_order() {
        assert_eq!(spread(&[50.0, 10.0], 20.0, 0.0, 100.0), [50.0, 10.0]);
        assert_eq!(spread(&[50.0, 50.0, 50.0], 20.0, 0.0, 100.0), [30.0, 50.0, 70.0]);
        assert_eq!(spread(&[99.0, 98.0], 20.0, 0.0, 100.0), [100.0, 80.0]);
        assert_eq!(spread(&[30.0, 35.0, 61.0], 20.0, 0.0, 100.0), [22.0, 42.0, 62.0]);
    }
}

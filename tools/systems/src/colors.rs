//! The colours of curves: red, green and blue.

/// Tableau's ten colours with two more, dark enough on white.
pub const COLORS: [(u8, u8, u8); 12] = [
    (31, 119, 180),
    (214, 39, 40),
    (44, 160, 44),
    (148, 103, 189),
    (255, 127, 14),
    (23, 150, 170),
    (227, 80, 170),
    (140, 86, 75),
    (150, 150, 20),
    (0, 80, 60),
    (60, 60, 200),
    (120, 0, 60),
];

"""Prints the exact moments of the polygons in the tests of `body`, by rational arithmetic."""

from fractions import Fraction as F

POLYGONS = {
    "pentagon": [("2", "0"), ("0", "2"), ("-2", "0"), ("-1", "-1"), ("1", "-1")],
    "slanted": [
        ("-2.625452", "4.425248"), ("-3.101252", "8.107347"), ("-4.639852", "5.767548"),
        ("-4.937052", "4.040548"), ("-3.365452", "3.517048"),
    ],
}
for name, points in POLYGONS.items():
    points = [(F(x), F(y)) for x, y in points]
    edges = [(p, q, p[0] * q[1] - q[0] * p[1]) for p, q in zip(points, points[1:] + points[:1])]
    area = sum(c for _, _, c in edges) / 2
    center = [sum((p[k] + q[k]) * c for p, q, c in edges) / (6 * area) for k in range(2)]
    inertia = sum(c * sum(p[k] * p[k] + p[k] * q[k] + q[k] * q[k] for k in range(2)) for p, q, c in edges) / 12
    about_center = inertia - area * (center[0] ** 2 + center[1] ** 2)
    print(name, float(area), [float(x) for x in center], repr(float(inertia)), repr(float(about_center)))

"""The motion of the bicycle in `tests/analysis/bicycle.rs`, by Newton's and Euler's equations.

Each of four bodies has a position, a quaternion, a velocity and an angular velocity. Three hinges
and two wheels that roll without slipping are 21 rows of the accelerations, whose multipliers are
the forces: no Lagrangian, no coordinates of joints, no reduction. `python3 bicycle.py` needs NumPy
and SciPy and prints the states that the test contains, for two tolerances.
"""

import numpy as np
from scipy.integrate import solve_ivp

REAR, FRAME, FORK, FRONT = range(4)
M = [2.0, 85.0, 4.0, 3.0]
TENSORS = [
    np.diag([0.0603, 0.12, 0.0603]),
    np.array([[9.2, 0, 2.4], [0, 11.0, 0], [2.4, 0, 2.8]]),
    np.array([[0.05892, 0, -0.00756], [0, 0.06, 0], [-0.00756, 0, 0.00708]]),
    np.diag([0.1405, 0.28, 0.1405]),
]
RADII = {REAR: 0.3, FRONT: 0.35}
WHEELBASE, TRAIL, TILT, G = 1.02, 0.08, np.pi / 10, 9.81
RIDER, FORK_CENTRE = np.array([0.3, 0, -0.6]), np.array([0.9 - 1.1, 0, -0.7])
HEAD = np.array([WHEELBASE + TRAIL, 0, RADII[REAR]])
AXLE = np.array([-TRAIL, 0, -RADII[FRONT]])
STEER = np.array([np.sin(TILT), 0, np.cos(TILT)])
# Pairs of bodies with the hinge's place in each, from its centre of mass, and the axis in the first.
HINGES = [
    (FRAME, REAR, -RIDER, np.zeros(3), np.array([0.0, 1, 0])),
    (FRAME, FORK, HEAD - RIDER, -FORK_CENTRE, STEER),
    (FORK, FRONT, AXLE - FORK_CENTRE, np.zeros(3), np.array([0.0, 1, 0])),
]
DOWN = np.array([0.0, 0, 1])


def matrix(q):
    w, x, y, z = q / np.linalg.norm(q)
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])


def skew(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def split(y):
    return y[:12].reshape(4, 3), y[12:28].reshape(4, 4), y[28:40].reshape(4, 3), y[40:].reshape(4, 3)


def rate(_, y):
    _, turns, speeds, rates = split(y)
    R = [matrix(q) for q in turns]
    mass, force = np.zeros((24, 24)), np.zeros(24)
    for body in range(4):
        own = slice(6 * body, 6 * body + 3), slice(6 * body + 3, 6 * body + 6)
        inertia = R[body] @ TENSORS[body] @ R[body].T
        mass[own[0], own[0]] = M[body] * np.eye(3)
        mass[own[1], own[1]] = inertia
        force[own[0]] = M[body] * G * DOWN
        force[own[1]] = -np.cross(rates[body], inertia @ rates[body])
    rows, right = [], []

    def row(parts, bias):
        """Adds rows: the sum of coefficients times accelerations is -bias."""
        block = np.zeros((len(bias), 24))
        for body, linear, angular in parts:
            block[:, 6 * body:6 * body + 3] += linear
            block[:, 6 * body + 3:6 * body + 6] += angular
        rows.append(block)
        right.append(-bias)

    for a, b, at_a, at_b, axis in HINGES:
        at_a, at_b, axis = R[a] @ at_a, R[b] @ at_b, R[a] @ axis
        swing = lambda body, arm: np.cross(rates[body], np.cross(rates[body], arm))
        row([(a, np.eye(3), -skew(at_a)), (b, -np.eye(3), skew(at_b))], swing(a, at_a) - swing(b, at_b))
        side = np.linalg.svd(axis.reshape(1, 3))[2][1:]
        turn = rates[b] - rates[a]
        bias = np.array([turn @ np.cross(rates[a], u) for u in side])
        row([(b, 0, side), (a, 0, -side)], bias)
    for body, radius in RADII.items():
        n = R[body] @ np.array([0.0, 1, 0])
        dn = np.cross(rates[body], n)
        s = np.sqrt(1 - n[2] ** 2)
        arm = radius * (DOWN - n[2] * n) / s
        darm = radius * (-(dn[2] * n + n[2] * dn) / s + (DOWN - n[2] * n) * n[2] * dn[2] / s**3)
        row([(body, np.eye(3), -skew(arm))], np.cross(rates[body], darm))
    C = np.vstack(rows)
    whole = np.block([[mass, C.T], [C, np.zeros((len(C), len(C)))]])
    a = np.linalg.solve(whole, np.concatenate([force, *right]))[:24].reshape(4, 6)
    dq = np.empty((4, 4))
    for body in range(4):
        (w, x), o = (turns[body][0], turns[body][1:]), rates[body]
        dq[body, 0], dq[body, 1:] = -o @ x / 2, (w * o + np.cross(o, x)) / 2
    return np.concatenate([speeds.ravel(), dq.ravel(), a[:, :3].ravel(), a[:, 3:].ravel()])


def start(speed, lean):
    places = np.array([[0, 0, -0.3], [0.3, 0, -0.9], [0.9, 0, -0.7], [1.02, 0, -0.35]])
    places[FORK] = np.array([0, 0, -0.3]) + HEAD + FORK_CENTRE
    turns = np.tile([1.0, 0, 0, 0], (4, 1))
    rates = np.zeros((4, 3))
    rates[:, 0] = lean
    speeds = np.array([[speed, 0, 0] + np.cross([lean, 0, 0], p) for p in places])
    for body, radius in RADII.items():
        rates[body, 1] = -speed / radius
    return np.concatenate([places.ravel(), turns.ravel(), speeds.ravel(), rates.ravel()])


def energy(y):
    places, turns, speeds, rates = split(y)
    total = 0
    for body in range(4):
        own = matrix(turns[body]).T @ rates[body]
        total += M[body] * (speeds[body] @ speeds[body] / 2 - G * places[body][2]) + own @ TENSORS[body] @ own / 2
    return total


for tolerance in [1e-12, 3e-14]:
    first = start(4.6, 0.5)
    run = solve_ivp(rate, (0, 3), first, "DOP853", rtol=tolerance, atol=1e-15, t_eval=[1, 2, 3])
    for t, y in zip(run.t, run.y.T):
        places, turns, speeds, rates = split(y)
        q = turns[FRAME] / np.linalg.norm(turns[FRAME])
        F, H = matrix(q), matrix(turns[FORK])
        # The angle of the fork about its axis: F^T H turns the axis y by it.
        between = F.T @ H
        across = np.cross(STEER, [0, 1, 0])
        steer = np.arctan2(between[:, 1] @ across, between[1, 1])
        axis = F @ STEER
        values = [*places[REAR], *q, steer, axis @ (rates[FORK] - rates[FRAME])]
        print(t, [float(f"{x:.14g}") for x in values])
        gap = [places[b][2] + r * np.sqrt(1 - (matrix(turns[b])[2, 1]) ** 2) for b, r in RADII.items()]
        print("  energy", energy(y) / energy(first) - 1, "gaps", gap, "n", run.nfev)

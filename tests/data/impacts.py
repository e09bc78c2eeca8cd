"""Impacts of a body's tip on a rough floor, along the path of impulses (Routh; Stronge).

Prints the change of the velocity and of the angular velocity of `Dart` in `tests/constraints/
strikes.rs`, attitude zero. A sliding rate u has dp = |u| ds, so that nothing is singular where it
stops: it decays exponentially in s. Needs numpy and scipy.
"""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq


def cross(r):
    return np.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0]])


def path(m, J, c, mu, e, v, w):
    c, v, w = map(np.array, (c, v, w))
    inverse = np.diag(1 / np.array(J))
    effect = np.eye(3) / m - cross(c) @ inverse @ cross(c)
    rate = v + np.cross(w, c)
    impulse, work, goal, log = np.zeros(3), 0.0, None, []

    def straight(y):
        """Goes to the next end with constant directions."""
        nonlocal impulse, work, rate
        f = effect @ y
        n = rate[2]
        if goal is None:
            p = -n / f[2]
        else:
            p = 2 * (goal - work) / (n + np.sqrt(n * n + 2 * f[2] * (goal - work)))
        impulse, work, rate = impulse + p * y, work + p * (n + f[2] * p / 2), rate + p * f

    def slide():
        """Slides until an end, or until the rate has stopped."""
        nonlocal impulse, work, rate
        start = rate

        def f(s, z):
            x = start + effect @ z[:3]
            u = np.hypot(x[0], x[1])
            d = x[:2] / u
            return [-mu * d[0] * u, -mu * d[1] * u, u, x[2] * u]

        x = lambda z: start + effect @ z[:3]
        stop = lambda s, z: np.hypot(*x(z)[:2]) - 1e-13
        end = (lambda s, z: x(z)[2]) if goal is None else (lambda s, z: z[3] - (goal - work))
        for event in (stop, end):
            event.terminal = True
        run = solve_ivp(f, (0, 1e4), [0.0] * 4, "DOP853", events=[stop, end],
                        rtol=1e-13, atol=1e-15)
        z = run.y[:, -1]
        stopped = len(run.t_events[0]) > 0
        impulse, work, rate = impulse + z[:3], work + z[3], start + effect @ z[:3]
        return stopped

    while True:
        if np.hypot(rate[0], rate[1]) > 1e-12:
            done = not slide()
            if not done:
                rate[:2] = 0
                log.append("stops")
        else:
            hold = np.append(-np.linalg.solve(effect[:2, :2], effect[:2, 2]), 1.0)
            if np.hypot(*hold[:2]) <= mu:
                log.append("sticks")
                straight(hold)
            else:
                def off(a):
                    d = np.array([np.cos(a), np.sin(a)])
                    g = (effect @ np.append(-mu * d, 1.0))[:2]
                    return d[0] * g[1] - d[1] * g[0]
                grid = np.linspace(0, 2 * np.pi, 721)
                for a, b in zip(grid, grid[1:]):
                    if off(a) * off(b) <= 0:
                        angle = brentq(off, a, b, xtol=1e-15)
                        d = np.array([np.cos(angle), np.sin(angle)])
                        y = np.append(-mu * d, 1.0)
                        if (effect @ y)[:2] @ d > 0:
                            break
                log.append("leaves")
                straight(y)
            done = True
        if done and goal is None:
            goal = (1 - e * e) * work
            if e == 0:
                break
        elif done:
            break
    log.append("slides" if np.hypot(rate[0], rate[1]) > 1e-12 else "rests")
    return v + impulse / m, w + inverse @ np.cross(c, impulse), impulse[2], log


if __name__ == "__main__":
    random = np.random.default_rng(39)
    print("# Printed by impacts.py. Each row: J, c, mu, e, v, w, then v and w after the impact, impulse.")
    found = {}
    for _ in range(400):
        J = random.uniform(0.15, 0.25, 3)
        c, w = random.uniform(-1, 1, 3), random.uniform(-3, 3, 3)
        v, (mu, e) = random.uniform(-3, 3, 3), random.uniform(0, 1, 2)
        if (v + np.cross(w, c))[2] > -0.3:
            continue
        v1, w1, p, log = path(1.0, J, c, mu, e, v, w)
        kind = " ".join(log)
        found[kind] = found.get(kind, 0) + 1
        if found[kind] <= 4:
            row = np.concatenate([J, c, [mu, e], v, w, v1, w1, [p]])
            print("#", kind)
            print(" ".join(repr(float(x)) for x in row), flush=True)

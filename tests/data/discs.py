"""Pucks and balls that stick and slide on plates, against a law with sets, by events.

Prints rows for `tests/constraints/plates.rs`. Points of the plane are complex numbers. Body k of
mass one has the place p, the velocity v and a spin s, the rate r = v + s - w on a plate with the
velocity w = i Omega p, and r' = g - c F r/|r|, where s' is 5/2 of the force of friction for a ball
(c = 7/2) and zero for a puck (c = 1). Steps go in a variable whose rate is 1 + sum 1/|r|, in which
a rate that stops decays exponentially. A rate that leaves zero begins with the first two terms of
its series, or in the direction that `creep` finds. Needs numpy and scipy.
"""

import cmath
import math
import sys

import numpy as np
from numpy.polynomial import Chebyshev
from scipy.integrate import solve_ivp

STOPPED, SHORT, LONG = 1e-11, 3e-5, 0.01


class Unclear(Exception):
    """Something else may change while a rate leaves zero."""


def solve(f, z, end, **more):
    """Integrates complex numbers."""
    flat = lambda x, y: np.array(f(x, y.view(complex).tolist())).view(float)
    start = np.array(z, complex).view(float)
    return solve_ivp(flat, (0, end), start, "DOP853", rtol=1e-13, atol=1e-15, **more)


class Case:
    def __init__(self, force, plate, friction, bound, ball=False):
        """`force(t, p, v)`; `plate(t)` returns Omega and its rate; F and S of each body."""
        self.force, self.plate, self.friction, self.bound = force, plate, friction, bound
        self.spin, self.effect = (2.5, 3.5) if ball else (0.0, 1.0)
        self.bodies = range(len(friction))

    def parts(self, t, z):
        """Returns v, r, g and the forces without friction."""
        n = len(self.bodies)
        p, v, s = z[:n], z[n:2 * n], z[2 * n:]
        turn, faster = self.plate(t)
        f = self.force(t, p, v)
        r = [v[k] + s[k] - 1j * turn * p[k] for k in self.bodies]
        g = [f[k] - 1j * (faster * p[k] + turn * v[k]) for k in self.bodies]
        return v, r, g, f

    def rates(self, t, z, sticks, aims={}):
        """Returns the rates of the state, and the sizes of the rates that slide."""
        v, r, g, f = self.parts(t, z)
        push, sizes = [], []
        for k in self.bodies:
            if sticks[k]:
                push.append(-g[k] / self.effect)
                continue
            size = abs(r[k])
            push.append(-self.friction[k] * (aims[k] if k in aims else r[k] / size))
            sizes.append(size)
        return v + [f[k] + push[k] for k in self.bodies] + [self.spin * x for x in push], sizes

    def motion(self, t, z, sticks, aims, times):
        """Returns the states at `times` with given directions of the rates that leave zero."""
        f = lambda x, y: self.rates(t + x, y, sticks, aims(x))[0]
        run = solve(f, z, times[-1], t_eval=times)
        return [y.copy().view(complex).tolist() for y in run.y.T]

    def leave(self, t, z, k, sticks):
        """Returns the state shortly after body k has left the rate zero."""
        slides = sticks[:k] + [False] + sticks[k + 1:]
        g0 = self.parts(t, z)[2][k]
        first, F, d = g0 / abs(g0), self.effect * self.friction[k], 1e-4
        a = abs(g0) - F
        if a < 1e-9:
            return self.creep(t, z, k, slides, first)
        times = (d, 2 * d)
        states = self.motion(t, z, slides, lambda _: {k: first}, times)
        g = [self.parts(t + x, y)[2][k] for x, y in zip(times, states)]
        # r = a t + b t^2 with a along g0.
        bend = ((4 * g[0] - 3 * g0 - g[1]) / (2 * d) / first).imag / (2 * a + F)
        aims = lambda x: {k: first * (1 + 1j * bend * x) / abs(1 + 1j * bend * x)}
        return t + SHORT, self.motion(t, z, slides, aims, (SHORT,))[0], slides

    def creep(self, t, z, k, slides, first):
        """Does so if g is no greater than the force of sliding: the rate grows so slowly that its
        direction follows g, by |r| times the rate of its angle. Rounds find the angle."""
        x = LONG / 2 * (1 - np.cos(np.pi * (np.arange(13) + 0.5) / 13))
        angle = Chebyshev([0.0], [0, LONG])
        for _ in range(30):
            states = self.motion(t, z, slides, lambda x: {k: first * cmath.rect(1, angle(x))},
                                 [*x, LONG])
            turns = []
            for x_i, y in zip(x, states):
                _, r, g, _ = self.parts(t + x_i, y)
                aside = abs(r[k]) * angle.deriv()(x_i) / abs(g[k])
                turns.append(cmath.phase(g[k] / first) - math.asin(max(-1, min(1, aside))))
            before, angle = angle, Chebyshev.fit(x, turns, 12, [0, LONG])
            if max(abs(before(x) - angle(x))) < 1e-13:
                break
        else:
            raise Unclear
        _, r, g, _ = self.parts(t + LONG, states[-1])
        for j in self.bodies:
            near = self.effect * self.bound[j] - abs(g[j]) if slides[j] else abs(r[j])
            if j != k and near < 10 * LONG:
                raise Unclear
        return t + LONG, states[-1], slides

    def run(self, end, p, v):
        """Returns the state at the end, and the numbers of stops and of departures."""
        n = len(self.bodies)
        z, t, counts = p + v + [0j] * n, 0.0, [0, 0]
        sticks = [r == 0 for r in self.parts(t, z)[1]]
        for k in self.bodies:
            if sticks[k] and abs(self.parts(t, z)[2][k]) > self.effect * self.bound[k]:
                t, z, sticks = self.leave(t, z, k, sticks)
        while True:
            held = sticks

            def f(_, y):
                rates, sizes = self.rates(y[0].real, y[1:], held)
                w = 1 / (1 + sum(1 / size for size in sizes))
                return [w] + [w * rate for rate in rates]

            def event(k):
                def at(_, y):
                    y = y.view(complex).tolist()
                    _, r, g, _ = self.parts(y[0].real, y[1:])
                    if held[k]:
                        return self.effect * self.bound[k] - abs(g[k])
                    return math.log(abs(r[k]) / STOPPED)
                at.terminal, at.direction = True, -1
                return at

            stop = lambda _, y: y[0] - end
            stop.terminal = True
            run = solve(f, [t] + z, 1e6, events=[event(k) for k in self.bodies] + [stop])
            t, *z = run.y[:, -1].copy().view(complex).tolist()
            t = t.real
            if len(run.t_events[n]):
                return z, counts
            k = next(k for k in self.bodies if len(run.t_events[k]))
            counts[held[k]] += 1
            if not held[k]:
                _, r, g, _ = self.parts(t, z)
                z[n + k] -= r[k] / self.effect
                z[2 * n + k] -= self.spin * r[k] / self.effect
                sticks = held[:k] + [True] + held[k + 1:]
                if abs(g[k]) <= self.effect * self.bound[k]:
                    continue
            t, z, sticks = self.leave(t, z, k, sticks)


def table(x):
    """A puck on a spring over a table whose speed swings."""
    k, c, turn, swing, w, F, S, x0, y0 = x
    return Case(lambda t, p, v: [-k * (p[0] - c)],
                lambda t: (turn + swing * math.sin(w * t), swing * w * math.cos(w * t)),
                [F], [S]), [x0 + 1j * y0], [0j]


def chain(x):
    """Three pucks between springs and a handle that goes round."""
    k, K, A, w, F, G, H, ratio = x

    def force(t, p, v):
        return [k * (p[1] - p[0]) - K * (p[0] - cmath.rect(A, w * t)),
                k * (p[0] + p[2] - 2 * p[1]), k * (p[1] - p[2])]
    return Case(force, lambda t: (0.0, 0.0), [F, G, H], [ratio * F, ratio * G, ratio * H]), \
        [0j] * 3, [0j] * 3


def ball(x):
    """A ball on a spring over a table that turns, pushed by a force that swings."""
    k, turn, P, w, F, S, x0, y0, u, v = x
    return Case(lambda t, p, v: [-k * p[0] + P * math.sin(w * t)], lambda t: (turn, 0.0),
                [F], [S], True), [x0 + 1j * y0], [u + 1j * v]


def couple(x):
    """Two pucks on a table that turns, with a spring between them and a damper each."""
    k, c, turn, F, G, S, T, d, x0, y0, x1, y1, u, v = x

    def force(t, p, v):
        pull = k * (p[1] - p[0])
        return [pull - k * (p[0] - c) - d * v[0], -pull - d * v[1]]
    return Case(force, lambda t: (turn, 0.0), [F, G], [S, T]), [x0 + 1j * y0, x1 + 1j * y1], \
        [u + 1j * v, 0j]


# End and ranges of the parameters of each family.
FAMILIES = {
    table: (8.0, [(0.5, 4), (0.2, 1.5), (-1, 1), (0, 1.5), (0.5, 3), (0.2, 1.5), (1, 2)]
            + [(-1, 1)] * 2),
    chain: (12.0, [(0.5, 4), (0.5, 4), (0.3, 1.5), (0.5, 2)] + [(0.1, 0.6)] * 3 + [(1, 1.5)]),
    ball: (8.0, [(0.1, 2), (-1.5, 1.5), (0.5, 5), (0.5, 3), (0.1, 0.6), (1, 1.6)]
           + [(-1, 1)] * 2 + [(-2, 2)] * 2),
    couple: (10.0, [(0.5, 4), (0.2, 1.5), (-1, 1), (0.1, 1), (0.1, 1), (1, 2), (1, 2), (0, 0.5)]
             + [(-1, 1)] * 4 + [(-2, 2)] * 2),
}


def draw(family, random):
    """Returns random parameters; bounds are drawn as multiples of forces, one in three equal."""
    x = [random.uniform(*range) for range in FAMILIES[family][1]]
    places = {table: [(6, 5)], chain: [], ball: [(5, 4)], couple: [(5, 3), (6, 4)]}[family]
    equal = random.uniform() < 0.33
    for bound, force in places:
        x[bound] = x[force] * (1 if equal else x[bound])
    if family is chain and equal:
        x[-1] = 1.0
    return [float(value) for value in x]


if __name__ == "__main__":
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 4
    print("# Printed by discs.py. Each row: family, parameters, places and velocities at the end.")
    for family, (end, _) in FAMILIES.items():
        random, found = np.random.default_rng(len(family.__name__)), 0
        while found < count:
            x = draw(family, random)
            case, p, v = family(x)
            try:
                z, (stops, departures) = case.run(end, p, v)
            except Unclear:
                continue
            if stops == 0 or stops + departures < 2:
                continue
            found += 1
            row = x + [part for value in z[:2 * len(p)] for part in (value.real, value.imag)]
            print(f"# {stops} stops, {departures} departures")
            print(family.__name__, " ".join(map(repr, row)), flush=True)

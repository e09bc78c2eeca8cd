#!/usr/bin/env python3
"""Computes the reference states of the benchmark `work_precision` to 30 digits and writes `reference.txt` beside itself.

    python3 -m venv venv && venv/bin/pip install mpmath
    venv/bin/python tools/systems/src/work_precision/reference.py

Each system is a first-order system on a tape of operations, advanced by Taylor series (Jorba and
Zou, 2005). Every value is computed twice, at 42 and 48 digits with different orders and steps, and the two agree to 32 digits. The
pendulum (to t = 200 by series) and the planet agree with the Jacobi functions and with Kepler's equation. The equations are
written here by hand, the chain as tridiagonal equations for the tensions of its rods (d'Alembert), and owe nothing to `lagrangian!`.
The three bodies take half an hour.
With the decimal start values of `tests/methods/problems.rs` the same code gives the digits that stand there.

A parameter that is no dyadic number is the double next to it, because that is what every program under test is given; so are the states at
t = 0, which `reference.txt` holds with all others: a line is a system, a time, the coordinates, the velocities.
"""

import pathlib
from mpmath import mp, mpf, sin, cos, sqrt, asin, ellipk, ellipfun, findroot


class Tape:
    """A graph of power series in t: coefficients of one order are computed from those of lower ones."""

    def __init__(self):
        self.rules, self.series, self.known = [], [], {}

    def new(self, rule, key=None):
        if key is not None and key in self.known:
            return self.known[key]
        self.rules.append(rule)
        self.series.append([])
        node = Node(self, len(self.rules) - 1)
        if key is not None:
            self.known[key] = node
        return node

    def constant(self, value):
        return self.new(lambda n: value if n == 0 else mpf(0))

    def sin_cos(self, x):
        key = ("sin_cos", x.index)
        if key not in self.known:
            s, c = len(self.rules), len(self.rules) + 1
            S = self.series

            def sine(n):
                if n == 0:
                    return sin(S[x.index][0])
                return sum(j * S[x.index][j] * S[c][n - j] for j in range(1, n + 1)) / n

            def cosine(n):
                if n == 0:
                    return cos(S[x.index][0])
                return -sum(j * S[x.index][j] * S[s][n - j] for j in range(1, n + 1)) / n

            self.known[key] = (self.new(sine), self.new(cosine))
        return self.known[key]

    def power(self, x, alpha):
        S, own = self.series, len(self.rules)

        def rule(n):
            if n == 0:
                return S[x.index][0] ** alpha
            return sum((alpha * (n - j) - j) * S[x.index][n - j] * S[own][j] for j in range(n)) / (n * S[x.index][0])

        return self.new(rule)


class Node:
    def __init__(self, tape, index):
        self.tape, self.index = tape, index

    def lift(self, other):
        return other if isinstance(other, Node) else self.tape.constant(mpf(other))

    def __add__(self, other):
        a, b, S = self.index, self.lift(other).index, self.tape.series
        return self.tape.new(lambda n: S[a][n] + S[b][n])

    def __mul__(self, other):
        if not isinstance(other, Node):
            a, factor, S = self.index, mpf(other), self.tape.series
            return self.tape.new(lambda n: factor * S[a][n])
        a, b, S = self.index, other.index, self.tape.series
        return self.tape.new(lambda n: sum(S[a][j] * S[b][n - j] for j in range(n + 1)))

    def __truediv__(self, other):
        a, b, S, own = self.index, self.lift(other).index, self.tape.series, len(self.tape.rules)
        return self.tape.new(lambda n: (S[a][n] - sum(S[own][j] * S[b][n - j] for j in range(n))) / S[b][0])

    def __neg__(self):
        return self * -1

    def __sub__(self, other):
        return self + -self.lift(other)

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, other):
        return -self + other


def taylor(accelerations, q, v, times, order, tolerance):
    """The states at `times`, by Taylor series; `accelerations(tape, t, q, v)` gives the nodes of q̈.

    The last two terms of each series stay below the tolerance, which chooses the step.
    """
    size, tape = len(q), Tape()
    state = [tape.new(None) for _ in range(2 * size + 1)]
    t, q_nodes, v_nodes = state[0], state[1 : size + 1], state[size + 1 :]
    a_nodes = accelerations(tape, t, q_nodes, v_nodes)
    S, now, out = tape.series, [mpf(0), *map(mpf, q), *map(mpf, v)], []
    for target in map(mpf, times):
        while now[0] < target:
            for series in S:
                series.clear()
            for n in range(order + 1):
                for i in range(2 * size + 1):
                    if n == 0:
                        S[i].append(now[i])
                    elif i == 0:
                        S[i].append(mpf(1 if n == 1 else 0))
                    elif i <= size:
                        S[i].append(S[i + size][n - 1] / n)
                    else:
                        S[i].append(S[a_nodes[i - size - 1].index][n - 1] / n)
                for i in range(2 * size + 1, len(S)):
                    S[i].append(tape.rules[i](n))
            h = target - now[0]
            for n in (order - 1, order):
                last = max(abs(series[n]) for series in S[1 : 2 * size + 1])
                if last:
                    h = min(h, (tolerance / last) ** (mpf(1) / n))
            for i in range(2 * size + 1):
                value = mpf(0)
                for coefficient in reversed(S[i]):
                    value = value * h + coefficient
                now[i] = value
        out.append(now[1:])
    return out


def agreeing(system, q, v, times):
    """The states computed twice."""
    runs = []
    for digits, order in getattr(system, "digits", [(48, 52), (42, 44)]):
        mp.dps = digits
        runs.append(taylor(system.accelerations, q, v, times, order, mpf(10) ** (4 - digits)))
    mp.dps = 42
    difference = max(abs(a - b) for one, other in zip(*runs) for a, b in zip(one, other))
    assert difference < mpf("1e-32"), (system.__name__, difference)
    return runs[0]


class simple:
    """θ̈ = −g sin θ, g = 9.8."""

    q, v, end, g = [1.3], [0], 1000, 9.8

    def accelerations(tape, t, q, v):
        return [-mpf(simple.g) * tape.sin_cos(q[0])[0]]

    def closed(times):
        k, w = sin(mpf(simple.q[0]) / 2), sqrt(mpf(simple.g))
        angle = lambda t: 2 * asin(k * ellipfun("sn")(ellipk(k**2) - w * t, m=k**2))
        velocity = lambda t: -2 * k * w * ellipfun("cn")(ellipk(k**2) - w * t, m=k**2)
        return [[angle(mpf(t)), velocity(mpf(t))] for t in times]


class moving:
    """θ̈ = −sin θ − ẍ cos θ with the pivot at x = ¼ sin 2t."""

    q, v, end = [0.5], [0], 50

    def accelerations(tape, t, q, v):
        s, c = tape.sin_cos(q[0])
        return [tape.sin_cos(t * 2)[0] * c - s]

    known = {50: ["-0.350555636092739243758209241117", "0.308351913703010857018850921122"]}


class moving_compound:
    """I θ̈ = −m((g + ÿ)(c₁ cos θ − c₂ sin θ) − ẍ(c₁ sin θ + c₂ cos θ)), the pivot at (¼ sin 2t, ⅛ sin(2t + 1))."""

    q, v, end = [0.5], [0], 50
    m, c, I, g = mpf("1.5"), [mpf("0.25"), mpf("-0.75")], mpf("1.25"), 9.8

    def accelerations(tape, t, q, v):
        p = moving_compound
        s, c = tape.sin_cos(q[0])
        x = tape.sin_cos(t * 2)[0] * -1
        y = tape.sin_cos(t * 2 + 1)[0] * mpf("-0.5")
        across, along = c * p.c[0] - s * p.c[1], s * p.c[0] + c * p.c[1]
        return [-(((y + mpf(p.g)) * across - x * along) * (p.m / p.I))]


class elastic:
    """r̈ = r θ̇² + cos θ − 8(r − 1), r θ̈ = −sin θ − 2 ṙ θ̇."""

    q, v, end = [1.25, 1], [0, 0], 50

    def accelerations(tape, t, q, v):
        s, c = tape.sin_cos(q[1])
        return [q[0] * v[1] * v[1] + c - (q[0] - 1) * 8, -(s + v[0] * v[1] * 2) / q[0]]

    known = {
        50: [
            "1.29545691542668824527723732242",
            "-0.483936434498866270731524745212",
            "-0.282627468072122329849361983834",
            "0.629208120447168222511859411288",
        ]
    }


def chain(tape, q, v):
    """Unit links and masses, g = 1: the tensions T of the rods first, from a tridiagonal system, then the accelerations."""
    n = len(q)
    angles = [tape.sin_cos(a) for a in q]
    between = [tape.sin_cos(q[i + 1] - q[i]) for i in range(n - 1)]
    right = [v[i] * v[i] + angles[0][1] if i == 0 else v[i] * v[i] for i in range(n)]
    diagonal = [tape.constant(mpf(1 if i == 0 else 2)) for i in range(n)]
    for i in range(1, n):
        factor = between[i - 1][1] / diagonal[i - 1]
        diagonal[i] = diagonal[i] - factor * between[i - 1][1]
        right[i] = right[i] + factor * right[i - 1]
    tension = [None] * n
    tension[n - 1] = right[n - 1] / diagonal[n - 1]
    for i in reversed(range(n - 1)):
        tension[i] = (right[i] + between[i][1] * tension[i + 1]) / diagonal[i]
    accelerations = []
    for i in range(n):
        a = -angles[0][0] if i == 0 else -(tension[i - 1] * between[i - 1][0])
        accelerations.append(a + tension[i + 1] * between[i][0] if i + 1 < n else a)
    return accelerations


class double_regular:
    """The double pendulum, small."""

    q, v, end = [0.5, -0.25], [0, 0], 100

    def accelerations(tape, t, q, v):
        return chain(tape, q, v)

    known = {
        100: [
            "0.268517909805266652887785519904",
            "-0.424955772876473185056390670537",
            "0.145710024766195778264939544579",
            "-0.560065536725151040213534517241",
        ]
    }


class double_chaotic:
    """The double pendulum, wild."""

    q, v, end = [2, 2.5], [0, 0], 10

    def accelerations(tape, t, q, v):
        return chain(tape, q, v)

    known = {
        10: [
            "-0.87121375423784908225211262002",
            "0.496465638832208351668027167202",
            "1.74267166332543351683557441542",
            "-1.63636427051421256734327374519",
        ]
    }


class chain5:
    """Five links."""

    q, v, end = [0.25, 0.5, 0.75, 1, 1.25], [0] * 5, 10

    def accelerations(tape, t, q, v):
        return chain(tape, q, v)

    known = {
        10: [
            "0.052208138677065808858628265713",
            "0.107828523926031759348899674363",
            "0.135291700110650637054603868582",
            "0.37745677737390874857930324884",
            "0.599662487007149207428415128681",
            "0.0831443392191481076658963092633",
            "0.178449545775233787146338463124",
            "0.150801452432605638470870591182",
            "0.666345299488365064687986011127",
            "0.950937414991748986421414021976",
        ]
    }


class kepler:
    """r̈ = −r/|r|³ from the perihelion of an orbit of eccentricity ½."""

    q, v, end = [0.5, 0], [0, float(3**0.5)], 20

    def accelerations(tape, t, q, v):
        cube = tape.power(q[0] * q[0] + q[1] * q[1], mpf("-1.5"))
        return [-(q[0] * cube), -(q[1] * cube)]

    def closed(times):
        x, w = mpf(kepler.q[0]), mpf(kepler.v[1])
        a = 1 / (2 / x - w**2)
        e, b, n = 1 - x / a, x * w / sqrt(1 / a), a ** mpf("-1.5")
        # b = a √(1 − e²) from the angular momentum x w = √(a (1 − e²)).
        out = []
        for t in times:
            E = findroot(lambda E: E - e * sin(E) - n * t, n * t)
            rate = n / (1 - e * cos(E))
            out.append([a * (cos(E) - e), b * sin(E), -a * sin(E) * rate, b * cos(E) * rate])
        return out

    known = {
        20: [
            "-0.57804329530353612327514584",
            "0.86338400091941928013357307",
            "-0.959508373038072735626449",
            "-0.065049151267120901677193546",
        ]
    }


class henon_heiles:
    """ẍ = −x − 2xy, ÿ = −y − x² + y²."""

    q, v, end = [0.1, 0], [0, 0.5], 100

    def accelerations(tape, t, q, v):
        x, y = q
        return [-(x + x * y * 2), y * y - y - x * x]

    known = {
        100: [
            "-0.0401942378760688167944025003237",
            "0.679016921772021642134721800872",
            "0.038450928951859834502033199529",
            "0.0485948315530036422431066413754",
        ]
    }


class pythagorean:
    """r̈_j = Σ m_k (r_k − r_j)/|r_k − r_j|³, masses 3, 4, 5 at rest in the corners opposite to sides of these lengths (Burrau, 1913)."""

    q, v, end, masses = [1, 3, -2, -1, 1, -1], [0] * 6, 60, [3, 4, 5]
    # Encounters magnify errors by eight powers of ten.
    digits = [(54, 56), (48, 50)]

    def accelerations(tape, t, q, v):
        a = [None] * 6
        for j, k in [(0, 1), (0, 2), (1, 2)]:
            apart = [q[2 * k + c] - q[2 * j + c] for c in range(2)]
            cube = tape.power(apart[0] * apart[0] + apart[1] * apart[1], mpf("-1.5"))
            for c in range(2):
                pull = apart[c] * cube
                for i, mass in [(2 * j + c, pythagorean.masses[k]), (2 * k + c, -pythagorean.masses[j])]:
                    a[i] = pull * mass if a[i] is None else a[i] + pull * mass
        return a


def exact_start(system):
    """The start values as the published digits have them, before they are rounded to doubles."""
    mp.dps = 48
    if system is kepler:
        return system.q, [mpf(0), sqrt(mpf(3))]
    if system is henon_heiles:
        return [mpf(1) / 10, mpf(0)], system.v
    return system.q, system.v


def main():
    lines = ["# Computed by reference.py: system, time, coordinates, velocities. Doubles at time 0, 30 digits after it."]
    systems = [simple, moving, moving_compound, elastic, double_regular, double_chaotic, chain5, kepler, henon_heiles, pythagorean]
    for system in systems:
        times = [mpf(system.end) * k / 5 for k in range(1, 6)]
        if hasattr(system, "closed"):
            mp.dps = 48
            states = system.closed(times)
            few = times[:1] if system is simple else times
            for one, other in zip(states, agreeing(system, system.q, system.v, few)):
                assert max(abs(a - b) for a, b in zip(one, other)) < mpf("1e-32"), (system.__name__, one, other)
        else:
            states = agreeing(system, system.q, system.v, times)
        for time, digits in getattr(system, "known", {}).items():
            (state,) = agreeing(system, *exact_start(system), [time])
            for found, expected in zip(state, digits):
                assert abs(found - mpf(expected)) < mpf("1e-23"), (system.__name__, time, found, expected)
        name = system.__name__
        lines.append(" ".join([name, "0", *(repr(float(x)) for x in [*system.q, *system.v])]))
        mp.dps = 42
        for time, state in zip(times, states):
            lines.append(" ".join([name, mp.nstr(time, 6), *(mp.nstr(x, 30, strip_zeros=False) for x in state)]))
        print(name, "computed", flush=True)
    pathlib.Path(__file__).with_name("reference.txt").write_text("\n".join(lines) + "\n")


main()

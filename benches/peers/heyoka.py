#!/usr/bin/env python3
"""Measures heyoka on the systems of the benchmark `work_precision` and writes `target/work-precision-heyoka.csv`.

heyoka (F. Biscani and D. Izzo, 2021) is a Taylor integrator whose code is compiled while the program runs. It is wanted in a virtual
environment, with numpy; from the root of the repository:

    python3 -m venv target/venv
    target/venv/bin/pip install heyoka numpy
    target/venv/bin/python benches/peers/heyoka.py [--quick] [SYSTEM…]

or, with the times of heyoka and of all others taken in turn, in the same run:

    cargo bench -p pendulum-runtime --bench work_precision -- --heyoka target/venv/bin/python

The method `heyoka Cartesian` is given what `lagrangian!` is given: positions in the plane, differentiated into velocities, a kinetic and a
potential energy, and from them heyoka's own `lagrangian()`. The method `heyoka simplified` is given the Lagrangian or the equations as a
person simplifies them on paper. Tolerances go from 1e-3 to 1e-18; below 1e-15 the polynomials are summed with compensation
(`high_accuracy`). The states at the output times come from `propagate_grid`, which evaluates the Taylor polynomials; the time is that of
this call alone, and the median over the rounds. The compile time, without any cache, has a column of its own. heyoka counts no
evaluations; the column holds its steps.
"""

import decimal
import gc
import os
import pathlib
import statistics
import sys
import time

# This file has the name of the package; its folder must not hide it.
sys.path[:] = [entry for entry in sys.path if pathlib.Path(entry or ".").resolve() != pathlib.Path(__file__).resolve().parent]

import heyoka as hy
import numpy as np
from heyoka import cos, sin, sqrt

ROOT = pathlib.Path(__file__).resolve().parents[2]
REFERENCE = ROOT / "tools/systems/src/work_precision/reference.txt"
TABLE = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "work-precision-heyoka.csv"
TOLERANCES = ["1e-3", "1e-5", "1e-7", "1e-9", "1e-11", "1e-13", "1e-15", "1e-18"]


def names(count):
    """Coordinates and velocities."""
    make = lambda letter: [hy.make_vars(f"{letter}{i}") for i in range(count)]
    return make("q"), make("v")


# heyoka differentiates by variables only: a motion is written in this one, which becomes the time afterwards.
t = hy.make_vars("t")


def velocity(position, q, v):
    """The total derivative of each component."""
    total = lambda x: sum((hy.diff(x, a) * b for a, b in zip(q, v)), hy.diff(x, t))
    return [total(x) for x in position]


def lagrangian(energy, q, v):
    """The equations of motion, from heyoka."""
    return hy.lagrangian(hy.subs(energy, {t: hy.time}), q, v)


def square(vector):
    return sum(x * x for x in vector)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def equations(accelerations, q, v):
    """The first-order system of q̈."""
    return [*zip(q, v), *zip(v, accelerations)]


def simple_cartesian():
    (q, v) = names(1)
    y = [sin(q[0]), -cos(q[0])]
    return lagrangian(0.5 * square(velocity(y, q, v)) - 9.8 * y[1], q, v)


def simple_simplified():
    (q, v) = names(1)
    return equations([-9.8 * sin(q[0])], q, v)


def moving_cartesian():
    (q, v) = names(1)
    y = [0.25 * sin(2.0 * t) + sin(q[0]), -cos(q[0])]
    return lagrangian(0.5 * square(velocity(y, q, v)) - y[1], q, v)


def moving_simplified():
    (q, v) = names(1)
    return equations([sin(2.0 * hy.time) * cos(q[0]) - sin(q[0])], q, v)


def moving_compound_cartesian():
    (q, v) = names(1)
    (m, (cx, cy), inertia, g) = (1.5, (0.25, -0.75), 1.25, 9.8)
    x = [0.25 * sin(2.0 * t), 0.125 * sin(2.0 * t + 1.0)]
    r = [cx * cos(q[0]) - cy * sin(q[0]), cx * sin(q[0]) + cy * cos(q[0])]
    x_dot, r_dot = velocity(x, q, v), velocity(r, q, v)
    kinetic = 0.5 * m * square(x_dot) + m * dot(x_dot, r_dot) + 0.5 * inertia * v[0] * v[0]
    return lagrangian(kinetic - m * g * (x[1] + r[1]), q, v)


def moving_compound_simplified():
    (q, v) = names(1)
    x, y = -sin(2.0 * hy.time), -0.5 * sin(2.0 * hy.time + 1.0)
    across, along = 0.25 * cos(q[0]) + 0.75 * sin(q[0]), 0.25 * sin(q[0]) - 0.75 * cos(q[0])
    return equations([-1.2 * ((y + 9.8) * across - x * along)], q, v)


def elastic_cartesian():
    (q, v) = names(2)
    (r, angle) = q
    y = [r * sin(angle), -r * cos(angle)]
    return lagrangian(0.5 * square(velocity(y, q, v)) - y[1] - 4.0 * (r - 1.0) ** 2, q, v)


def elastic_simplified():
    (q, v) = names(2)
    (r, angle) = q
    kinetic = 0.5 * (v[0] ** 2 + r**2 * v[1] ** 2)
    return lagrangian(kinetic + r * cos(angle) - 4.0 * (r - 1.0) ** 2, q, v)


def chain_cartesian(count):
    (q, v) = names(count)
    x, y, energy = 0.0, 0.0, 0.0
    for angle in q:
        x, y = x + sin(angle), y - cos(angle)
        energy = energy + 0.5 * square(velocity([x, y], q, v)) - y
    return lagrangian(energy, q, v)


def chain_simplified(count):
    (q, v) = names(count)
    energy = sum((count - i) * (0.5 * v[i] ** 2 + cos(q[i])) for i in range(count))
    for i in range(count):
        energy += sum((count - j) * v[i] * v[j] * cos(q[i] - q[j]) for j in range(i + 1, count))
    return lagrangian(energy, q, v)


def kepler_cartesian():
    (q, v) = names(2)
    return lagrangian(0.5 * square(v) + 1.0 / sqrt(square(q)), q, v)


def kepler_simplified():
    (q, v) = names(2)
    cube = square(q) ** -1.5
    return equations([-q[0] * cube, -q[1] * cube], q, v)


def henon_heiles_cartesian():
    (q, v) = names(2)
    (x, y) = q
    return lagrangian(0.5 * square(v) - 0.5 * square(q) - x * x * y + y**3 / 3.0, q, v)


def henon_heiles_simplified():
    (q, v) = names(2)
    (x, y) = q
    return equations([-x - 2.0 * x * y, y * y - y - x * x], q, v)


SYSTEMS = {
    "simple": (simple_cartesian, simple_simplified),
    "moving": (moving_cartesian, moving_simplified),
    "moving_compound": (moving_compound_cartesian, moving_compound_simplified),
    "elastic": (elastic_cartesian, elastic_simplified),
    "double_regular": (lambda: chain_cartesian(2), lambda: chain_simplified(2)),
    "double_chaotic": (lambda: chain_cartesian(2), lambda: chain_simplified(2)),
    "chain5": (lambda: chain_cartesian(5), lambda: chain_simplified(5)),
    "kepler": (kepler_cartesian, kepler_simplified),
    "henon_heiles": (henon_heiles_cartesian, henon_heiles_simplified),
}


def problem(system):
    """The start, the output times and the reference states, as they stand in `reference.txt`."""
    lines = [line.split() for line in REFERENCE.read_text().splitlines() if line.startswith(system + " ")]
    start = [float(word) for word in lines[0][2:]]
    times = [float(line[1]) for line in lines]
    return start, np.array(times), [[decimal.Decimal(word) for word in line[2:]] for line in lines[1:]]


class Row:
    """A system, an input and a tolerance."""

    def __init__(self, system, form, tolerance):
        self.system, self.method, self.setting = system, f"heyoka {form}", f"tol={tolerance}"
        self.form, self.tolerance = form, float(tolerance)
        self.start, self.times, self.reference = problem(system)
        self.integrator, self.compile, self.samples, self.result = None, 0.0, [], None

    def prepare(self):
        """Derives the equations and compiles the integrator."""
        start = time.perf_counter()
        equations = SYSTEMS[self.system][0 if self.form == "Cartesian" else 1]()
        tight = self.tolerance < 1e-15
        self.integrator = hy.taylor_adaptive(equations, self.start, tol=self.tolerance, high_accuracy=tight)
        self.compile = time.perf_counter() - start

    def once(self):
        """Seconds, steps and the states of one run; raises if it fails."""
        integrator = self.integrator
        integrator.time = 0.0
        integrator.state[:] = self.start
        start = time.perf_counter()
        result = integrator.propagate_grid(self.times)
        seconds = time.perf_counter() - start
        if result[0] != hy.taylor_outcome.time_limit:
            raise RuntimeError(f"the integration ended with {result[0]}")
        return seconds, result[3], result[-1][1:]

    def sample(self):
        """The same as `Row::sample` in `measure.rs`."""
        if self.integrator is None:
            self.prepare()
        gc.disable()
        seconds, steps, states = self.once()
        if seconds < 0.05:
            seconds = min(seconds, *(self.once()[0] for _ in range(int(min(max(0.001 / seconds, 2), 25)))))
        gc.enable()
        self.samples.append(seconds)
        self.result = (steps, states)
        return seconds, steps, states

    def error(self):
        """The largest distance from the reference; not a number if a value is none."""
        pairs = zip(self.result[1], self.reference)
        return max(abs(float(decimal.Decimal(float(x)) - y)) for state, known in pairs for x, y in zip(state, known))

    def line(self):
        """Its line in the table."""
        name = f"{self.system},{self.method},{self.setting}"
        if self.result is None or not np.isfinite(self.result[1]).all():
            return f"{name},failed,,,{self.compile:.6e}"
        return f"{name},{self.error():.3e},{statistics.median(self.samples):.6e},{self.result[0]},{self.compile:.6e}"


def attempt(row):
    """Samples a row; the reason if it fails."""
    try:
        return row.sample()
    except Exception as error:
        row.result = None
        return f"failed {error}".replace("\n", " ")


HEADER = "system,method,setting,error,seconds,evaluations,compile_seconds"


def write(rows):
    """Writes the table; systems that were not measured keep the lines that they have in it."""
    measured = [row for row in rows if row.compile]
    systems = {row.system for row in measured}
    old = TABLE.read_text().splitlines() if TABLE.exists() else []
    kept = [line for line in old[1:] if line.split(",")[0] not in systems] if old[:1] == [HEADER] else []
    TABLE.parent.mkdir(exist_ok=True)
    TABLE.write_text("\n".join([HEADER, *kept, *(row.line() for row in measured)]) + "\n")


def serve(rows, about):
    """Lets `work_precision` choose what to run; `peer.rs` describes the lines."""
    print(about)
    for row in rows:
        print(row.system, row.method, row.setting, sep="\t")
    print("ready", flush=True)
    for line in sys.stdin:
        answer = attempt(rows[int(line)])
        if not isinstance(answer, str):
            seconds, steps, states = answer
            answer = " ".join([repr(seconds), str(steps), *(repr(float(x)) for x in np.ravel(states))])
        print(answer, flush=True)
    write(rows)


def main():
    hy.llvm_state.set_diskcache_enabled(False)
    hy.llvm_state.set_memcache_limit(0)
    words = [word for word in sys.argv[1:] if not word.startswith("--")]
    unknown = [word for word in words if word not in SYSTEMS]
    if unknown:
        sys.exit(f"no system {', '.join(unknown)}; there are {', '.join(SYSTEMS)}")
    quick = "--quick" in sys.argv
    tolerances = TOLERANCES[::2] if quick else TOLERANCES
    rows = [Row(s, form, tol) for s in SYSTEMS if not words or s in words for form in ("Cartesian", "simplified") for tol in tolerances]
    about = f"heyoka {hy.__version__}, numpy {np.__version__}, Python {sys.version.split()[0]}"
    if "--serve" in sys.argv:
        return serve(rows, about)
    print(about)
    for round in range(5 if quick else 25):
        for row in rows if round % 2 == 0 else reversed(rows):
            if round == 0 or row.result is not None:
                answer = attempt(row)
                if round == 0:
                    print(row.system, row.method, row.setting, answer if isinstance(answer, str) else f"compiled in {row.compile:.2f} s", flush=True)
    write(rows)
    print("written:", TABLE)


main()

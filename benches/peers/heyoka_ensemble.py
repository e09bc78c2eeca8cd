#!/usr/bin/env python3
"""Runs heyoka's ensembles on the problems of the benchmark `ensemble`, which starts this program and tells it by lines what to do.

heyoka (F. Biscani and D. Izzo, 2021) is wanted in a virtual environment, with numpy; from the root of the repository:

    python3 -m venv target/venv
    target/venv/bin/pip install heyoka numpy
    cargo bench -p pendulum-runtime --bench ensemble --features rayon -- --heyoka target/venv/bin/python

A line `flip SIDE SECONDS TOLERANCE THREADS WAY` asks for the times at which SIDE × SIDE double pendulums turn over, `ends NAME THREADS WAY` for the end states
of 512 pendulums. WAY is `ensemble` for `ensemble_propagate_until_batch`, which copies the integrator for each group, or `loop` for one copy a thread. The answer is a line with the seconds that it took and a line with the numbers found. All use the batch mode with terminal events;
the faster of four and eight lanes, found by a short run, counts, and compiling does not.
"""

import concurrent.futures
import copy
import pathlib
import sys
import time

# The file beside this one has the name of the package; their folder must not hide it.
sys.path[:] = [entry for entry in sys.path if pathlib.Path(entry or ".").resolve() != pathlib.Path(__file__).resolve().parent]

import heyoka as hy
import numpy as np
from heyoka import cos, sin

AMPLITUDES = 0.1 + 2.9 * np.arange(512) / 512


def double(gravity):
    """The double pendulum of equal links, as heyoka's own `lagrangian()` makes it of what a person simplifies on paper."""
    a, b, va, vb = hy.make_vars("a", "b", "va", "vb")
    (m, n, k, l) = (hy.par[i] for i in range(4))
    kinetic = 0.5 * (m + n) * k * k * va**2 + 0.5 * n * l * l * vb**2 + n * k * l * va * vb * cos(a - b)
    energy = kinetic + hy.par[4] * ((m + n) * k * cos(a) + n * l * cos(b))
    return hy.lagrangian(energy, [a, b], [va, vb]), [1.0] * 4 + [gravity], b


def simple():
    """The pendulum with g/L = 9.8."""
    q, v = hy.make_vars("q", "v")
    return [(q, v), (v, -hy.par[0] * sin(q))], [9.8], q


class First:
    """Takes note of the first event of each lane, and stops them all after the last."""

    def __init__(self, lanes):
        self.times = np.full(lanes, np.inf)

    def __call__(self, ta, _, lane):
        self.times[lane] = min(self.times[lane], ta.time[lane])
        return bool(np.isinf(self.times).any())


def integrator(system, lanes, tolerance, flips, way):
    equations, parameters, last = system
    pars = np.repeat(np.array(parameters)[:, None], lanes, axis=1)
    note = {"callback": First(lanes)} if way == "ensemble" else {}
    events = [hy.t_event_batch(last * last - np.pi**2, **note)] if flips else []
    return hy.taylor_adaptive_batch(equations, np.zeros((len(equations), lanes)), pars=pars, tol=tolerance, t_events=events)


def run(ta, states, end, threads, way):
    """The seconds, and the times and states at which all motions end."""
    lanes = ta.batch_size
    count = states.shape[1]

    def begin(ta, i):
        # The last group is filled up with its last member.
        index = np.minimum(np.arange(i * lanes, (i + 1) * lanes), count - 1)
        ta.set_time(0.0)
        ta.state[:] = states[:, index]
        return ta

    start = time.perf_counter()
    groups = -(-count // lanes)
    if way == "ensemble":
        # A terminal event in one lane stops them all, unless it has a callback.
        done = hy.ensemble_propagate_until_batch(ta, end, groups, begin, max_workers=threads)
        seconds = time.perf_counter() - start
        noted = [group[0].t_events[0].callback.times if group[0].with_events else np.inf for group in done]
        times = np.concatenate([np.minimum(group[0].time, first) for group, first in zip(done, noted)])[:count]
        ends = np.concatenate([group[0].state for group in done], axis=1)[:, :count]
        return seconds, times, ends
    times, ends = np.empty(groups * lanes), np.empty((len(states), groups * lanes))
    waiting = iter(range(groups))

    def work(own):
        while (i := next(waiting, None)) is not None:
            begin(own, i)
            targets = np.full(lanes, end)
            # A terminal event in one lane stops them all: the others go on.
            while True:
                own.propagate_until(targets)
                stopped = np.array([int(result[0]) for result in own.propagate_res])
                over = (stopped > -1000) & (stopped < 0)
                if not over.any():
                    break
                targets[over] = own.time[over]
            times[i * lanes : (i + 1) * lanes] = own.time
            ends[:, i * lanes : (i + 1) * lanes] = own.state

    with concurrent.futures.ThreadPoolExecutor(threads) as pool:
        list(pool.map(work, [copy.deepcopy(ta) for _ in range(threads)]))
    return time.perf_counter() - start, times[:count], ends[:, :count]


def flip_starts(side):
    angles = -3.0 + 6.0 * (np.arange(side) + 0.5) / side
    first, second = np.meshgrid(angles, angles)
    return np.array([first.ravel(), second.ravel(), np.zeros(side * side), np.zeros(side * side)])


def main():
    built = {}

    def best(key, make, states, end, way):
        """The integrator with the number of lanes that is faster on some members."""
        if key not in built:
            some = states[:, :: max(1, states.shape[1] // 64)]
            candidates = [make(lanes) for lanes in (4, 8)]
            built[key] = min(candidates, key=lambda ta: min(run(ta, some, end, 1, way)[0] for _ in range(3)))
        return built[key]

    print(f"heyoka {hy.__version__}, numpy {np.__version__}, Python {sys.version.split()[0]}", flush=True)
    for line in sys.stdin:
        what, *rest = line.split()
        way = rest[-1]
        if what == "flip":
            side, end, tolerance, threads = int(rest[0]), float(rest[1]), float(rest[2]), int(rest[3])
            states = flip_starts(side)
            make = lambda lanes: integrator(double(9.81), lanes, tolerance, True, way)
            ta = best(("flip", tolerance, way), make, states, end, way)
            seconds, times, _ = run(ta, states, end, threads, way)
            numbers = times
        else:
            name, threads = rest[0], int(rest[1])
            system, end = (simple(), 100.0) if name == "pendulum" else (double(1.0), 20.0)
            if name == "pendulum":
                states = np.array([AMPLITUDES, 0.0 * AMPLITUDES])
            else:
                states = np.array([0.5 * AMPLITUDES, -0.25 * AMPLITUDES, 0.0 * AMPLITUDES, 0.0 * AMPLITUDES])
            make = lambda lanes: integrator(system, lanes, float(np.finfo(float).eps), False, way)
            ta = best((name, way), make, states, end, way)
            seconds, _, ends = run(ta, states, end, threads, way)
            numbers = ends[: len(ends) // 2].ravel()
        print(f"{seconds!r} {ta.batch_size} {ta.order}")
        print(" ".join(repr(float(number)) for number in numbers), flush=True)


main()

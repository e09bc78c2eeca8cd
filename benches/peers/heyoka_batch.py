#!/usr/bin/env python3
"""Measures heyoka's batch mode on the batches of the benchmark `taylor`: nanoseconds for each lane and step, and the error at the end.

heyoka (F. Biscani and D. Izzo, 2021) is wanted in a virtual environment, with numpy; from the root of the repository:

    python3 -m venv target/venv
    target/venv/bin/pip install heyoka numpy
    target/venv/bin/python benches/peers/heyoka_batch.py [ROUNDS]

and beside it, as the ratio of two runs taken one after the other:

    cargo bench -p pendulum-runtime --bench taylor -- batch

512 motions of one system and different amplitudes go through an integrator of 4 or 8 lanes, group after group; the amplitudes within a group are
close, so that its lanes end together. The equations are those that heyoka's own `lagrangian()` makes of the Lagrangian as a person simplifies it on
paper. The tolerance is the machine epsilon, which means order 20. The error is the largest of every 37th motion, against heyoka in extended
precision; the time is the median of the rounds, 11 without an argument, and their least. Compiling does not count.
"""

import pathlib
import statistics
import sys
import time

# The file beside this one has the name of the package; their folder must not hide it.
sys.path[:] = [entry for entry in sys.path if pathlib.Path(entry or ".").resolve() != pathlib.Path(__file__).resolve().parent]

import heyoka as hy
import numpy as np
from heyoka import cos, sin

MOTIONS = 512
AMPLITUDES = 0.1 + 2.9 * np.arange(MOTIONS) / MOTIONS


def simple():
    """The pendulum with g/L = 9.8 over 100 s."""
    q, v = hy.make_vars("q", "v")
    return [(q, v), (v, -hy.par[0] * sin(q))], np.array([AMPLITUDES, 0.0 * AMPLITUDES]), [9.8], 100.0


def double():
    """The double pendulum of equal links over 20 s."""
    a, b, va, vb = hy.make_vars("a", "b", "va", "vb")
    (m, n, k, l) = (hy.par[i] for i in range(4))
    kinetic = 0.5 * (m + n) * k * k * va**2 + 0.5 * n * l * l * vb**2 + n * k * l * va * vb * cos(a - b)
    energy = kinetic + hy.par[4] * ((m + n) * k * cos(a) + n * l * cos(b))
    states = np.array([0.5 * AMPLITUDES, -0.25 * AMPLITUDES, 0.0 * AMPLITUDES, 0.0 * AMPLITUDES])
    return hy.lagrangian(energy, [a, b], [va, vb]), states, [1.0] * 5, 20.0


def exact(equations, states, parameters, end):
    """The ends of every 37th motion in extended precision."""
    number = np.longdouble
    parameters = [number(p) for p in parameters]
    integrator = hy.taylor_adaptive(equations, np.zeros(len(states), dtype=number), pars=parameters, fp_type=number, tol=number(1e-21))
    ends = []
    for start in states.T[::37]:
        integrator.time = number(0.0)
        integrator.state[:] = start.astype(number)
        integrator.propagate_until(number(end))
        ends.append(integrator.state.copy())
    return np.array(ends).T


def run(integrator, states, end, lanes):
    """Seconds, steps and the ends of all motions."""
    ends, steps, seconds = np.empty_like(states), 0, 0.0
    for first in range(0, MOTIONS, lanes):
        integrator.set_time(0.0)
        integrator.state[:] = states[:, first : first + lanes]
        start = time.perf_counter()
        integrator.propagate_until(end)
        seconds += time.perf_counter() - start
        for outcome, _, _, taken in integrator.propagate_res:
            if outcome != hy.taylor_outcome.time_limit:
                raise RuntimeError(f"the integration ended with {outcome}")
            steps += taken
        ends[:, first : first + lanes] = integrator.state
    return seconds, steps, ends


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 11
    print(f"heyoka {hy.__version__}, numpy {np.__version__}, Python {sys.version.split()[0]}")
    for name, system in [("pendulum", simple), ("double", double)]:
        equations, states, parameters, end = system()
        known = exact(equations, states, parameters, end)
        for lanes in (4, 8):
            pars = np.repeat(np.array(parameters)[:, None], lanes, axis=1)
            integrator = hy.taylor_adaptive_batch(equations, states[:, :lanes].copy(), pars=pars, tol=float(np.finfo(float).eps))
            times = []
            for _ in range(rounds):
                seconds, steps, ends = run(integrator, states, end, lanes)
                times.append(1e9 * seconds / steps)
            half = len(states) // 2
            error = float(np.max(np.abs(ends[:half, ::37].astype(np.longdouble) - known[:half])))
            print(
                f"batch {name:<9} error {error:8.1e}   {statistics.median(times):6.1f} ns a lane and step (least {min(times):.1f})"
                f"   {steps} steps   {lanes} lanes, order {integrator.order}",
                flush=True,
            )


main()

"""Writes double_double.txt: functions of numbers in two words, from 2400 bits of arithmetic.

    python double_double.py > double_double.txt        (needs mpmath)

A line is the name of a function, its arguments and its value, each in two words of hexadecimal bits.
"""

import math
import random
import struct

from mpmath import mp, mpf

mp.prec = 2400
RNG = random.Random(1)


def bits(value):
    return "%016x" % struct.unpack("<Q", struct.pack("<d", value))[0]


def words(value):
    high = float(value)
    return high, float(value - mpf(high)) if math.isfinite(high) else 0.0


def value(pair):
    return mpf(pair[0]) + mpf(pair[1])


def uniform(least, greatest):
    return words(mpf(RNG.uniform(least, greatest)) * (1 + mpf(RNG.getrandbits(80)) / 2**132))


def sized(least, greatest):
    """Any sign, exponents of two between the given ones."""
    high, low = uniform(1, 2)
    scale = 2.0 ** RNG.randint(least, greatest) * RNG.choice([-1, 1])
    return high * scale, low * scale


def angles():
    for _ in range(25):
        yield uniform(-1, 1)
    for _ in range(25):
        yield uniform(-20, 20)
    for least, greatest in [(-60, -5), (5, 40), (40, 200), (200, 1020)]:
        for _ in range(10):
            yield sized(least, greatest)
    # Next to multiples of a quarter of pi, also of two far apart words.
    for k in [1, 2, 3, 4, 6, 100, 12345, 2**40 + 1, 2**90 + 3]:
        yield words(mp.pi / 4 * k)
    for k in [1, 2, 3, 10**6, 10**17]:
        high = float(mp.pi / 2 * k)
        yield high, 0.0
        yield high, float(mp.pi / 2 * k - high) * 2.0**-20
        yield -high, 5e-324
    yield 6381956970095103 * 2.0**797, 0.0
    yield 1e22, 1e-300


def of(arguments, count):
    return [arguments() for _ in range(count)]


UNIT = of(lambda: uniform(-1, 1), 20) + of(lambda: sized(-80, -4), 10) + [words(1 - mpf(2) ** -k) for k in [10, 50, 70, 100]] + [(1.0, 0.0), (-1.0, 0.0)]
SMALL = of(lambda: uniform(-3, 3), 20) + of(lambda: uniform(-45, 45), 15) + of(lambda: sized(-100, -4), 10) + [uniform(700, 709), uniform(-600, -500)]
POSITIVE = of(lambda: uniform(0.3, 3), 25) + [tuple(map(abs, sized(-600, 600)))[:1] + (0.0,) for _ in range(20)] + [words(1 + s * mpf(2) ** -k) for k in [3, 20, 60, 100] for s in [1, -1]]
FAR = of(lambda: sized(-900, 1000), 30)

ONE = {
    "sin": (mp.sin, list(angles())),
    "cos": (mp.cos, list(angles())),
    "tan": (mp.tan, list(angles())[:60]),
    "asin": (mp.asin, UNIT),
    "acos": (mp.acos, UNIT),
    "atan": (mp.atan, UNIT + FAR),
    "sinh": (mp.sinh, SMALL),
    "cosh": (mp.cosh, SMALL),
    "tanh": (mp.tanh, SMALL),
    "sech": (mp.sech, SMALL),
    "exp": (mp.exp, SMALL),
    "ln": (mp.log, POSITIVE),
    "sqrt": (mp.sqrt, POSITIVE + [(x, 0.0) for x in [5e-320, 1e-300, 1.7e308]]),
}
TWO = {
    "add": (lambda a, b: a + b, [(sized(-3, 3), sized(-60, 3)) for _ in range(40)]),
    "mul": (lambda a, b: a * b, [(sized(-400, 400), sized(-400, 400)) for _ in range(40)] + [(sized(1000, 1020), sized(-1000, -20)) for _ in range(10)]),
    "div": (lambda a, b: a / b, [(sized(-400, 400), sized(-400, 400)) for _ in range(40)] + [(sized(990, 1020), sized(10, 1020)) for _ in range(10)]
            + [(sized(-900, -800), sized(-960, -800)) for _ in range(10)]),
    "atan2": (mp.atan2, [(sized(-10, 10), sized(-10, 10)) for _ in range(40)] + [(sized(-900, 1000), sized(-900, 1000)) for _ in range(20)]
              + [((0.0, 0.0), (-2.0, 0.0)), ((3.0, 0.0), (0.0, 0.0)), ((1.0, 0.0), (-1.0, 0.0)), ((1e-200, 0.0), (-1.0, 0.0))]),
    "powf": (mp.power, [(uniform(0.2, 5), (k / 2, 0.0)) for k in range(-9, 10)] + [(uniform(0.2, 5), uniform(-5, 5)) for _ in range(20)]),
}
ORDERS = [0, 1, 2, 5, 20]


def sinc(x, order):
    """The derivative of sin(x)/x, by x s_n + n s_{n-1} = the n-th derivative of sin x."""
    result = mp.sin(x) / x
    for n in range(1, order + 1):
        result = ([mp.sin, mp.cos, lambda x: -mp.sin(x), lambda x: -mp.cos(x)][n % 4](x) - n * result) / x
    return result


def main():
    for name, (function, arguments) in ONE.items():
        for x in arguments:
            result = function(value(x))
            if mpf(2) ** -900 < abs(result):
                print(name, *map(bits, x + words(result)))
    for order in ORDERS:
        for x in SMALL[:45] + of(lambda: uniform(0, 25), 20):
            print(f"sinc{order}", *map(bits, x + words(sinc(value(x), order))))
    for name, (function, arguments) in TWO.items():
        for x, y in arguments:
            result = function(value(x), value(y))
            if mpf(2) ** -900 < abs(result) < mpf(2) ** 1023:
                print(name, *map(bits, x + y + words(result)))


main()

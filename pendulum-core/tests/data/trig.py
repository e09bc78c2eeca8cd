"""Writes trig.txt: arguments in hexadecimal bits, their sines and cosines as two words, from 1500 bits of arithmetic.

    python trig.py > trig.txt        (needs mpmath)
"""

import math
import random
import struct

from mpmath import mp, mpf

mp.prec = 1500
HALF_PI = mp.pi / 2
LIMIT = float(HALF_PI * 2**20)


def bits(value):
    return "%016x" % struct.unpack("<Q", struct.pack("<d", value))[0]


def words(value):
    hi = float(value)
    return bits(hi) + " " + bits(float(value - mpf(hi)))


def near_multiples():
    """The floats p 2^e nearest to multiples of pi/2: convergents and some intermediate fractions of (pi/2)/2^e."""
    for e in range(-53, -31):
        rest = HALF_PI / mpf(2) ** e
        p, p_before = 1, 0
        for _ in range(60):
            digit = int(mp.floor(rest))
            for part in sorted({1, digit - 1, digit} - {0}):
                numerator = part * p + p_before
                if numerator < 2**53 and 0.7 <= numerator * 2.0**e <= LIMIT:
                    yield numerator * 2.0**e
            p, p_before = digit * p + p_before, p
            if 2**53 <= p:
                break
            rest = 1 / (rest - digit)


def arguments():
    rng = random.Random(1)
    yield from [0.0, 5e-324, 2.0**-1022, math.nextafter(2.0**-1022, 0), 1e-300, 1e-160, 2.0**-27, 2.0**-26, 1e-8]
    for e in range(-1074, 0, 13):
        yield 2.0**e * (1 + rng.random())
    for width in [math.pi / 4, 3.2, 10.0, 1000.0]:
        for _ in range(150):
            yield rng.uniform(0, width)
    for _ in range(150):
        yield LIMIT ** rng.random()
    for k in [1, 3, 5, 7] + [rng.randrange(2**21) | 1 for _ in range(30)]:
        middle = float(HALF_PI / 2 * k)
        yield from [math.nextafter(middle, 0), middle, math.nextafter(middle, math.inf)]
    for k in [1, 2, 3, 4] + [rng.randrange(2**20) for _ in range(30)]:
        yield float(HALF_PI * k)
    yield from sorted(set(near_multiples()))
    yield from [math.nextafter(LIMIT, 0), LIMIT, math.nextafter(LIMIT, math.inf)]
    yield from [1647100.0, 1e7, 2.0**31, 1e15, 2.0**53, 1e22, 6381956970095103 * 2.0**797, 1e300, 1.7976931348623157e308]
    for _ in range(60):
        yield 2.0 ** rng.uniform(21, 1024)


def main():
    rng = random.Random(2)
    for x in arguments():
        x = rng.choice([x, -x])
        print(bits(x), words(mp.sin(mpf(x))), words(mp.cos(mpf(x))))


main()

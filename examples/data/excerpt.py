"""Makes jumps.bvh from the CMU clip 01_01.bvh: python3 excerpt.py path/to/01_01.bvh > jumps.bvh

Keeps the hierarchy, takes every fourth frame (30 Hz) of the eight seconds from 0.5 s on, and gives lengths in metres.
Says on stderr which length of the file's unit the flights give, in which nothing but gravity acts.
"""

import sys

# The scale of the subject's skeleton file is 0.45, for inches: 1 unit = 1/0.45 in.
METRES = 0.0254 / 0.45
RATE = 120.0
FIRST, LAST, EVERY = 60, 1020, 4
# Frames during which both feet are off the ground.
FLIGHTS = [(232, 267), (600, 635), (788, 829)]


def number(value, digits):
    text = f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def fall(heights, rate):
    """The second derivative of the parabola of least squares."""
    n = len(heights)
    t = [k - (n - 1) / 2 for k in range(n)]
    s2, s4 = sum(x**2 for x in t), sum(x**4 for x in t)
    h0, h2 = sum(heights), sum(x * x * h for x, h in zip(t, heights))
    return 2 * (n * h2 - s2 * h0) / (n * s4 - s2 * s2) * rate * rate


def main():
    lines = [line.strip() for line in open(sys.argv[1], encoding="ascii")]
    motion = lines.index("MOTION")
    depth, positions = 0, []
    for line in lines[:motion]:
        words = line.split()
        depth -= words[0] == "}"
        if words[0] == "OFFSET":
            words[1:] = [number(float(word) * METRES, 5) for word in words[1:]]
        if words[0] == "CHANNELS":
            positions += [word.endswith("position") for word in words[2:]]
        print("\t" * depth + " ".join(words))
        depth += words[0] == "{"
    frames = [[float(word) for word in line.split()] for line in lines[motion + 3 :] if line]
    for first, last in FLIGHTS:
        g = -fall([frame[1] for frame in frames[first : last + 1]], RATE)
        print(f"frames {first} to {last}: the hips fall at {g:.1f} units/s^2, so 1 unit = {9.81 / g:.4f} m", file=sys.stderr)
    kept = frames[FIRST : LAST + 1 : EVERY]
    print(f"MOTION\nFrames: {len(kept)}\nFrame Time: {number(EVERY / RATE, 7)}")
    for frame in kept:
        print(" ".join(number(v * METRES, 5) if p else number(v, 3) for v, p in zip(frame, positions)))


main()

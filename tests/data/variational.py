"""Prints the forced pendulum v̇ = cos t − p v − sin x at t = 3 from (0.2, 0.3) with p = 0.4, its derivatives by x₀, v₀ and p, and its second
derivatives by (x₀x₀), (x₀v₀), (v₀v₀), from the variational equations by Taylor series (needs mpmath)."""

from mpmath import cos, mp, mpf, odefun, sin

mp.dps = 25


def rates(t, y):
    p = mpf("0.4")
    x, v = y[:2]
    out = [v, cos(t) - p * v - sin(x)]
    for k in range(3):
        dx, dv = y[2 + 2 * k : 4 + 2 * k]
        out += [dv, -cos(x) * dx - p * dv - (v if k == 2 else 0)]
    for a, b, at in [(2, 2, 8), (2, 4, 10), (4, 4, 12)]:
        out += [y[at + 1], -cos(x) * y[at] + sin(x) * y[a] * y[b] - p * y[at + 1]]
    return out


start = [mpf("0.2"), mpf("0.3"), 1, 0, 0, 1] + [mpf(0)] * 8
for value in odefun(rates, mpf(0), start)(mpf(3)):
    print(mp.nstr(value, 20))

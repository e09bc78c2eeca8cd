"""Prints angle and velocity of the pendulum θ̈ = −sin θ from θ = 1.3 at rest, by Jacobi's functions (needs mpmath)."""

from mpmath import ellipfun, ellipk, asin, cos, mp, mpf, sin, sqrt

mp.dps = 60
START = mpf("1.3")
k = sin(START / 2)
m = k * k
K = ellipk(m)
for t in [1, 10, 100]:
    sn, cn = ellipfun("sn", K - t, m), ellipfun("cn", K - t, m)
    print(t, mp.nstr(2 * asin(k * sn), 36), mp.nstr(-2 * k * cn, 36))

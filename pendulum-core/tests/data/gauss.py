"""Prints the constants of src/integrate/gauss/tableau.rs, and sixteen nodes and weights for src/integrate/picard/tableau.rs: Gauss-Legendre
collocation to 50 digits, rounded once.

    python gauss.py        (needs mpmath)

c are the roots of P_s(2c - 1), b_j the integral of the Lagrange polynomial l_j over [0, 1], a_ij that over [0, c_i]
(Hairer, Lubich and Wanner 2006, Geometric Numerical Integration, II.1.3), and m_ij = a_ij / b_j for j < i.
"""

from mpmath import chop, legendre, mp, mpf, polyroots, polyval, taylor

mp.dps = 60


def times_linear(poly, root):
    """poly(x) (x - root), coefficients from the highest down."""
    return [a - root * b for a, b in zip(poly + [0], [0] + poly)]


def tableau(s):
    poly = [chop(x) for x in taylor(lambda x: legendre(s, x), 0, s)][::-1]
    roots = sorted((1 + r.real) / 2 for r in polyroots(poly, maxsteps=500, extraprec=500))
    weights, ratios = [], []
    for j, c in enumerate(roots):
        lagrange = [mpf(1)]
        for k, root in enumerate(roots):
            if k != j:
                lagrange = [x / (c - root) for x in times_linear(lagrange, root)]
        integral = polyint(lagrange)
        weights.append(polyval(integral, 1))
        ratios.append([polyval(integral, x) / weights[-1] for x in roots])
    below = [[ratios[j][i] for j in range(i)] for i in range(1, s)]
    return roots, weights, below


def polyint(poly):
    n = len(poly)
    return [x / (n - k) for k, x in enumerate(poly)] + [mpf(0)]


def row(values):
    return "[" + ", ".join(repr(float(x)) for x in values) + "]"


for s in (1, 2, 3, 4, 8, 16):
    c, b, below = tableau(s)
    print("// S =", s)
    print("&" + row(c) + ",")
    print("&" + row(b) + ",")
    if s < 16:
        print("&[" + ", ".join("&" + row(x) for x in below) + "],")

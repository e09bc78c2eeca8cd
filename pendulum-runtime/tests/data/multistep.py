"""Prints the constants of src/integrate/methods/quinlan_tremaine, from exact fractions.

    python multistep.py        (needs nothing)

Explicit methods d_n + sum_j a_j d_{n-j} = sum_j b_j f_{n-j} for the second differences h^2 d_n = q_{n+1} - 2 q_n + q_{n-1}.
"""

from fractions import Fraction as F


def solve(matrix, right):
    rows = [row[:] + [x] for row, x in zip(matrix, right)]
    for i in range(len(rows)):
        pivot = next(r for r in range(i, len(rows)) if rows[r][i] != 0)
        rows[i], rows[pivot] = rows[pivot], rows[i]
        rows[i] = [x / rows[i][i] for x in rows[i]]
        for r in range(len(rows)):
            if r != i and rows[r][i] != 0:
                rows[r] = [x - rows[r][i] * y for x, y in zip(rows[r], rows[i])]
    return [row[-1] for row in rows]


def kicks(a, count):
    """The b with which the method is exact for all polynomials q of degree below count + 2."""
    matrix, right = [], []
    for degree in range(2, count + 2):
        q = lambda t: F(t) ** degree
        f = lambda t: degree * (degree - 1) * F(t) ** (degree - 2)
        matrix.append([f(-j) for j in range(count)])
        right.append(sum(x * (q(1 - j) - 2 * q(-j) + q(-1 - j)) for j, x in enumerate([1] + a)))
    return solve(matrix, right)


def velocities(count):
    """The g with v_{n+1} = (q_{n+1} - q_n)/h + h sum_j g_j f_{n+1-j}, exact for f of degree below count."""
    matrix = [[F(1 - j) ** degree for j in range(count)] for degree in range(count)]
    return solve(matrix, [F(1, degree + 2) for degree in range(count)])


def second_quotient(alpha):
    """alpha(z)/(z - 1)^2, without its leading one."""
    for _ in range(2):
        sums = [sum(alpha[: i + 1]) for i in range(len(alpha))]
        assert sums[-1] == 0
        alpha = sums[:-1]
    return alpha[1:]


def row(values):
    return "[" + ", ".join(repr(float(x)) for x in values) + "]"


# Quinlan and Tremaine (1990), table 2.
ALPHA = {
    8: [1, -2, 2, -1, 0, -1, 2, -2, 1],
    10: [1, -1, 1, -1, 1, -2, 1, -1, 1, -1, 1],
    12: [1, -2, 2, -1, 0, 0, 0, 0, 0, -1, 2, -2, 1],
}

for order in (8, 10, 12):
    a = second_quotient(ALPHA[order])
    print("order", order)
    print("echoes    ", row(a))
    b = kicks(a, order - 1)
    assert b == b[::-1]
    print("kicks     ", row(b))
    print("velocities ", row(velocities(order - 1)))

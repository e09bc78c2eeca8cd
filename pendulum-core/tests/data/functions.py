"""Prints the values and slopes that the tests of `real` expect (needs mpmath)."""

from mpmath import mp, mpf

mp.dps = 40
X, Y = mpf("1.25"), mpf("0.625")
VALUES = {
    "tan": mp.tan(X), "asin": mp.asin(Y), "acos": mp.acos(Y), "atan": mp.atan(X), "atan2": mp.atan2(1, -2),
    "sinh": mp.sinh(X), "cosh": mp.cosh(X), "tanh": mp.tanh(X), "sech": mp.sech(X), "exp": mp.exp(-X), "ln": mp.ln(X),
    "sqrt": mp.sqrt(X), "powf": X ** mpf("-2.5"),
}
for name, value in VALUES.items():
    print("value of", name, repr(float(value)))
for order in range(3):
    print("value of sinc", order, repr(float(mp.diff(mp.sinc, X, order))), "and", repr(float(mp.diff(mp.sinc, mpf("0.75"), order))))
for name in ["sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "sech", "exp", "ln"]:
    print("slope of", name, repr(float(mp.diff(getattr(mp, name), mpf("0.75")))))

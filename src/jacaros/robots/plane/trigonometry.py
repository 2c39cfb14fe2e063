"""Sine and cosine from IEEE additions and multiplications alone.

The sine of a C library, and numpy's, may differ in the last bit between processors, and a robot that turns by such a sine
takes a different path on another machine. The state of the world and the ranges of its laser therefore depend only on
``+ - * /`` and the square root, which IEEE 754 defines to the last bit.
"""

import math

_TWO_OVER_PI = float.fromhex("0x1.45f306dc9c883p-1")
# pi/2 in three parts; products of the first two with |n| < 2^20 are exact, so the reduction is exact.
_HALF_PI_1 = float.fromhex("0x1.921fb54400000p+0")
_HALF_PI_2 = float.fromhex("0x1.0b4611a600000p-34")
_HALF_PI_3 = float.fromhex("0x1.3198a2e037073p-69")

# Taylor coefficients: quotients of integers below 2^53, hence rounded once.
_S3, _S5, _S7 = -1 / 6, 1 / 120, -1 / 5040
_S9, _S11, _S13, _S15 = 1 / 362880, -1 / 39916800, 1 / 6227020800, -1 / 1307674368000
_C4, _C6, _C8 = 1 / 24, -1 / 720, 1 / 40320
_C10, _C12, _C14, _C16 = -1 / 3628800, 1 / 479001600, -1 / 87178291200, 1 / 20922789888000

PI = math.pi
TWO_PI = 2.0 * math.pi


def sine_cosine(angle: float) -> tuple[float, float]:
    """Return sine and cosine of *angle* (radians, magnitude below 1e6) to 2e-16, equal on every machine."""
    n = math.floor(angle * _TWO_OVER_PI + 0.5)
    r = ((angle - n * _HALF_PI_1) - n * _HALF_PI_2) - n * _HALF_PI_3
    z = r * r
    high_sine = _S3 + z * (_S5 + z * (_S7 + z * (_S9 + z * (_S11 + z * (_S13 + z * _S15)))))
    high_cosine = _C4 + z * (_C6 + z * (_C8 + z * (_C10 + z * (_C12 + z * (_C14 + z * _C16)))))
    sine = r + r * z * high_sine
    cosine = (1.0 - 0.5 * z) + z * z * high_cosine
    quarter = n % 4
    if quarter == 0:
        return sine, cosine
    if quarter == 1:
        return cosine, -sine
    if quarter == 2:
        return -sine, -cosine
    return -cosine, sine


def radians(degrees: float) -> float:
    """Convert degrees to radians, with one multiplication and one division."""
    return degrees * PI / 180.0

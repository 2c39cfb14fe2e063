"""The polynomial sine: accuracy against exact arithmetic, and ranges of the angles."""

import random
from fractions import Fraction

import pytest

from jacaros.robots.plane.trigonometry import PI, radians, sine_cosine

DIGITS = 10**70


def arctangent_of_inverse(number: int) -> Fraction:
    """Arctangent of 1/number to 70 digits."""
    total, term, index = 0, DIGITS // number, 0
    while term:
        total += (term // (2 * index + 1)) * (1 if index % 2 == 0 else -1)
        term //= number * number
        index += 1
    return Fraction(total, DIGITS)


EXACT_PI = 4 * (4 * arctangent_of_inverse(5) - arctangent_of_inverse(239))


def exact_sine(angle: Fraction) -> Fraction:
    """Sine by Taylor series on the remainder of a turn, in whole numbers of 70 digits."""
    turns = round(angle / (2 * EXACT_PI))
    scaled = int((angle - turns * 2 * EXACT_PI) * DIGITS)
    square = scaled * scaled // DIGITS
    total, term, index = 0, scaled, 1
    while term:
        total += term
        term = -term * square // DIGITS // ((index + 1) * (index + 2))
        if term == -1:
            break
        index += 2
    return Fraction(total, DIGITS)


@pytest.mark.parametrize("reach", [1.0, 10.0, 10_000.0])
def test_sine_and_cosine_are_exact_to_2e_16(reach: float) -> None:
    draw = random.Random(7)
    worst = Fraction(0)
    for _ in range(400):
        angle = draw.uniform(-reach, reach)
        sine, cosine = sine_cosine(angle)
        exact = Fraction(angle)
        worst = max(worst, abs(Fraction(sine) - exact_sine(exact)))
        worst = max(worst, abs(Fraction(cosine) - exact_sine(exact + EXACT_PI / 2)))
    assert worst <= Fraction(2, 10**16)


def test_quarter_turns_give_the_axes() -> None:
    for quarter, (sine, cosine) in enumerate([(0, 1), (1, 0), (0, -1), (-1, 0)]):
        assert sine_cosine(quarter * PI / 2) == pytest.approx((sine, cosine), abs=1e-15)


def test_the_same_angle_gives_the_same_bits() -> None:
    assert [value.hex() for value in sine_cosine(1.0)] == ["0x1.aed548f090ceep-1", "0x1.14a280fb5068cp-1"]


def test_degrees_become_radians() -> None:
    assert radians(180.0) == PI
    assert radians(-90.0) == -PI / 2

"""Java's ``String.format`` for numbers that are doubles."""

import re
from collections.abc import Sequence
from decimal import ROUND_HALF_UP, Context, Decimal, localcontext

from jacaros.agents.terms.text import double_text

_SPECIFIER = re.compile(
    r"%(?:(?P<index>\d+)\$)?(?P<flags>[-#+ 0,(]*)(?P<width>\d+)?(?:\.(?P<places>\d+))?(?P<conversion>[a-zA-Z%])"
)
_EXACT = Context(prec=2000, rounding=ROUND_HALF_UP)


def java_format(template: str, arguments: Sequence[float | str | bool]) -> str:
    """Insert the arguments into *template*.

    Supported conversions are ``%s %b %f %e %g``, their upper-case forms, ``%n`` and ``%%``, with flags, width, precision
    and argument number. Halves are rounded up, based on the shortest digits of the number.

    Raises:
        ValueError: another conversion, or an argument that is missing or does not fit.
    """
    result: list[str] = []
    position = following = 0
    for match in _SPECIFIER.finditer(template):
        result.append(_literal(template[position : match.start()]))
        position = match.end()
        flags, width = match["flags"], int(match["width"] or 0)
        if match["conversion"] in "n%":
            piece = "\n" if match["conversion"] == "n" else "%"
        else:
            following += match["index"] is None
            number = int(match["index"] or following)
            if not 1 <= number <= len(arguments):
                raise ValueError(f"missing argument for {match.group()}")
            places = None if match["places"] is None else int(match["places"])
            piece = _convert(arguments[number - 1], match["conversion"], flags, width, places)
        result.append(piece.ljust(width) if "-" in flags else piece.rjust(width))
    result.append(_literal(template[position:]))
    return "".join(result)


def _literal(text: str) -> str:
    if "%" in text:
        raise ValueError(f"invalid conversion '{text[text.index('%') :]}'")
    return text


def _convert(value: float | str | bool, conversion: str, flags: str, width: int, places: int | None) -> str:
    lower = conversion.lower()
    if lower == "s":
        piece = _plain(value)[:places]
    elif lower == "b":
        piece = (_plain(value) if isinstance(value, bool) else "true")[:places]
    elif lower in ("f", "e", "g"):
        if isinstance(value, str | bool):
            raise ValueError(f"%{conversion} expects a number, found {value}")
        piece = _signed(float(value), lower, flags, width, 6 if places is None else places)
    else:
        help = ": numbers are doubles, use %.0f" if lower in "dxo" else ""
        raise ValueError(f"unknown conversion %{conversion}{help}")
    return piece.upper() if conversion.isupper() else piece


def _plain(value: float | str | bool) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return double_text(value) if isinstance(value, float) else str(value)


def _signed(value: float, conversion: str, flags: str, width: int, places: int) -> str:
    before = after = ""
    if str(value).startswith("-"):
        before, after = ("(", ")") if "(" in flags else ("-", "")
    elif "+" in flags or " " in flags:
        before = "+" if "+" in flags else " "
    if value != value or value in (float("inf"), float("-inf")):
        return before + double_text(abs(value)) + after
    digits = _digits(Decimal(repr(abs(value))), conversion, places, "," if "," in flags else "")
    return before + (digits.rjust(width - len(before + after), "0") if "0" in flags else digits) + after


def _digits(value: Decimal, conversion: str, places: int, comma: str) -> str:
    with localcontext(_EXACT):
        if conversion == "g":
            significant = max(places, 1)
            rounded = Context(prec=significant, rounding=ROUND_HALF_UP).plus(value)
            if not rounded or Decimal("0.0001") <= rounded < Decimal(10) ** significant:
                conversion, places = "f", significant - (rounded.adjusted() if rounded else 0) - 1
            else:
                conversion, places = "e", significant - 1
        if conversion == "f":
            return f"{value:{comma}.{places}f}"
        # Java writes two digits of the exponent at least.
        digits, _, exponent = f"{value:.{places}e}".partition("e")
        return f"{digits}e{int(exponent) if value else 0:+03d}"

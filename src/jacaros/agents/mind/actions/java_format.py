"""Java's ``String.format`` for numbers that are doubles."""

import re
from collections.abc import Sequence
from decimal import ROUND_HALF_UP, Decimal
from decimal import Context as DecimalContext

from jacaros.agents.terms.text import double_text

_SPECIFIER = re.compile(r"%(?:(\d+)\$)?([-#+ 0,(]*)(\d+)?(?:\.(\d+))?([a-zA-Z%])")
_EXACT = DecimalContext(prec=2000, rounding=ROUND_HALF_UP)


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
        index, flags, width, precision, conversion = match.groups()
        if conversion in "n%":
            piece = "\n" if conversion == "n" else "%"
        else:
            if index is None:
                following += 1
            number = following if index is None else int(index)
            if not 1 <= number <= len(arguments):
                raise ValueError(f"missing argument for {match.group()}")
            places = None if precision is None else int(precision)
            piece = _convert(arguments[number - 1], conversion, flags, int(width or 0), places)
        result.append(piece.ljust(int(width or 0)) if "-" in flags else piece.rjust(int(width or 0)))
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
    negative = str(value).startswith("-")
    before = after = ""
    if negative:
        before, after = ("(", ")") if "(" in flags else ("-", "")
    elif "+" in flags or " " in flags:
        before = "+" if "+" in flags else " "
    if value != value or value in (float("inf"), float("-inf")):
        return before + double_text(abs(value)) + after
    digits = _digits(Decimal(repr(abs(value))), conversion, places)
    if "," in flags and "e" not in digits:
        whole, point, fraction = digits.partition(".")
        digits = f"{int(whole):,}{point}{fraction}"
    if "0" in flags:
        digits = digits.rjust(width - len(before) - len(after), "0")
    return before + digits + after


def _digits(value: Decimal, conversion: str, places: int) -> str:
    if conversion == "f":
        return _fixed(value, places)
    if conversion == "e":
        return _scientific(value, places)
    significant = max(places, 1)
    rounded = value and DecimalContext(prec=significant, rounding=ROUND_HALF_UP).plus(value)
    if rounded == 0:
        return _fixed(value, significant - 1)
    if Decimal("0.0001") <= rounded < Decimal(10) ** significant:
        return _fixed(value, significant - rounded.adjusted() - 1)
    return _scientific(value, significant - 1)


def _fixed(value: Decimal, places: int) -> str:
    return f"{value.quantize(Decimal(1).scaleb(-places), context=_EXACT):f}"


def _scientific(value: Decimal, places: int) -> str:
    if value == 0:
        return f"{_fixed(value, places)}e+00"
    rounded = DecimalContext(prec=places + 1, rounding=ROUND_HALF_UP).plus(value)
    digits = "".join(map(str, rounded.as_tuple().digits)).ljust(places + 1, "0")
    point = "." if places else ""
    return f"{digits[0]}{point}{digits[1:]}e{rounded.adjusted():+03d}"

"""Units and names of parameters inside lines."""

from edited import edited

from jacaros.editors.symbols.hints import hints
from jacaros.editors.symbols.model import Hint


def shown(text: str, **lines: int) -> str:
    """Return a text with its hints, in brackets."""
    index, file, _ = edited(text)
    rows = list(file.lines)
    found = hints(index, file, **lines)
    for each in reversed(found):
        row = rows[each.at.line - 1]
        rows[each.at.line - 1] = f"{row[: each.at.column - 1]}<{each.text}>{row[each.at.column - 1 :]}"
    return "\n".join(rows)


def test_arguments_have_names_and_units() -> None:
    assert shown("+!x <- drive(3, -1.5).") == "+!x <- drive(<length:>3<m>, <speed:>-1.5<m/s>)."


def test_a_variable_needs_no_name_of_a_parameter() -> None:
    assert shown("+!x(L) <- drive(L * 2, f(1, 2)).") == "+!x(L) <- drive(L * 2<m>, <speed:>f(1, 2)<m/s>)."


def test_properties_have_units() -> None:
    assert shown("+!x : pose(X, _, Yaw) & Yaw > 90.") == "+!x : pose(X<m>, _, Yaw<°>) & Yaw > 90."


def test_what_no_artifact_has_gets_no_hints() -> None:
    text = "+!x <- move(3, 4); !go(1); drive(3)."
    assert shown(text) == text


def test_hints_are_those_of_the_lines_that_are_shown() -> None:
    text = "+!x <- drive(3, 4);\n drive(5, 6).\n"
    assert shown(text, first=2, last=2).startswith("+!x <- drive(3, 4);\n drive(<length:>5")
    found: list[Hint] = hints(edited(text)[0], edited(text)[1])
    assert [each.tooltip for each in found if each.kind == "unit"] == ["metres", "metres per second"] * 2

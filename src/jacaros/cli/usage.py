"""Errors of wrong usage, and the examples at the end of help texts."""

from jacaros.errors import UsageError
from jacaros.excerpts import help_line, printable


def usage_error(what: str, help: str = "") -> UsageError:
    """Return the error for a wrong command line.

    Args:
        what: what is wrong, with names in backquotes.
        help: what to write instead; empty for no advice.
    """
    lines = [f"error: {printable(what)}"]
    if help:
        lines.append(help_line(help))
    return UsageError("\n".join(lines))


def did_you_mean(names: list[str]) -> str:
    """Return the help that names what may have been meant; empty without names."""
    return f"did you mean {' or '.join(f'`{name}`' for name in names)}?" if names else ""


def examples(*commands: str) -> str:
    """Return the end of a help text: commands to copy, one a line."""
    return "\n".join(["\b", "Examples:", *(f"  {command}" for command in commands)])

"""The commands of pages, by name; each gets a reply, even if it is invalid."""

import inspect
import math
from collections.abc import Awaitable, Callable, Mapping
from typing import Any

from jacaros.agents.language.diagnostics import TEXT, AslError
from jacaros.artifacts.env.errors import OperationFailed
from jacaros.errors import JacarosError
from jacaros.runtime.clock import of_run

LONGEST = 2_000
"""Maximum number of characters of a text in a command: parsing it takes about 10 ms."""

Given = Mapping[str, Any]
Command = Callable[[Given], Awaitable[Any] | Any]
"""Takes the fields of a command and returns the result; raises `Refused`, `JacarosError` or `OperationFailed`."""


class Refused(Exception):
    """Raised for a command that cannot be executed; the text says why, in one line."""


class Commands:
    """The commands available to pages.

    Args:
        note: called with a text for each command that changed something.
    """

    def __init__(self, note: Callable[[str], None] = lambda _: None) -> None:
        self._known: dict[str, Command] = {}
        self._note = note

    @property
    def names(self) -> list[str]:
        """Names of the available commands, sorted."""
        return sorted(self._known)

    def add(self, commands: Mapping[str, Command]) -> None:
        """Add commands."""
        self._known.update(commands)

    def add_changes(self, commands: Mapping[str, Command]) -> None:
        """Add commands that change the run; each success is recorded."""
        for name, command in commands.items():
            self._known[name] = self._noted(name, command)

    def _noted(self, name: str, command: Command) -> Command:
        async def noted(given: Given) -> Any:
            result = await _result(command, given)
            if name != "console" or not is_question(given):
                self._note(said(name, given))
            return result

        return noted

    async def answer(self, given: Given) -> dict[str, Any]:
        """Execute a command and return the reply."""
        reply: dict[str, Any] = {"kind": "reply", "id": given.get("id")}
        command = self._known.get(str(given.get("do")))
        if command is None:
            return {**reply, "ok": False, "error": f"unknown command here: `{str(given.get('do'))[:40]}`"}
        try:
            result = await _result(command, given)
        except (Refused, JacarosError, OperationFailed) as refused:
            return {**reply, "ok": False, "error": one_line(refused)}
        except Exception as error:  # a page must not end the run
            return {**reply, "ok": False, "error": f"{type(error).__name__}: {str(error)[:200]}"}
        return {**reply, "ok": True, "result": result}


async def _result(command: Command, given: Given) -> Any:
    with of_run():  # tasks started by a command pause with the run
        result = command(given)
    return await result if inspect.isawaitable(result) else result


def is_question(given: Given) -> bool:
    """Return whether a console line only queries."""
    return str(given.get("text", "")).lstrip().startswith("?")


_SAID = {
    "belief": "{agent}: {op}{text}",
    "goal": "{agent}: {op} {text}",
    "message": "{performative} to {agent}: {text}",
    "console": "{agent}: {text}",
    "operate": "{artifact}: {text}",
    "move_robot": "{robot} moved to ({x}, {y})",
    "battery": "battery of {robot}: {level} %",
    "door": "door {name} open: {open}",
    "fault": "fault {name} on: {on}",
}
"""How records name the change made by a command; other commands by name and fields."""


def said(name: str, given: Given) -> str:
    """Return a command as a line of text, such as ``bob: +ready``."""
    fields = {key: str(value)[:200] for key, value in given.items() if key not in ("id", "do")}
    try:
        return _SAID[name].format_map(fields)
    except KeyError:
        return f"{name} {' '.join(f'{key}={value}' for key, value in fields.items())}".strip()


def one_line(error: Exception) -> str:
    """Return the error without excerpt and help, with its location if it is in a file."""
    if isinstance(error, AslError) and error.diagnostics:
        wrong = error.diagnostics[0]
        in_file = wrong.span is not None and wrong.span.file.name != TEXT
        return f"{wrong.place()}{wrong.message}" if in_file else wrong.message
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return lines[0].removeprefix("error: ") if lines else type(error).__name__


# ---- fields of commands


def text_in(given: Given, name: str) -> str:
    """Return a field with a string.

    Raises:
        Refused: it is missing, empty, too long, or of another type.
    """
    value = given.get(name)
    if not isinstance(value, str) or not value.strip():
        raise Refused(f"`{name}` must be a text")
    if len(value) > LONGEST:
        raise Refused(f"`{name}` is longer than {LONGEST} characters")
    return value.strip()


def number_in(given: Given, name: str, default: float | None = None) -> float:
    """Return a field with a finite number.

    Raises:
        Refused: it is missing without a default, or not a finite number.
    """
    value = given.get(name, default)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise Refused(f"`{name}` must be a number")
    return float(value)


def choice_in(given: Given, name: str, choices: tuple[str, ...]) -> str:
    """Return a field with one of *choices*.

    Raises:
        Refused: it has another value.
    """
    value = given.get(name)
    if value not in choices:
        raise Refused(f"`{name}` must be one of {', '.join(choices)}")
    return str(value)


def flag_in(given: Given, name: str) -> bool:
    """Return a field that is true or false.

    Raises:
        Refused: it has another value.
    """
    value = given.get(name)
    if not isinstance(value, bool):
        raise Refused(f"`{name}` must be true or false")
    return value

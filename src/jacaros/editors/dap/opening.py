"""The beginning of a session, before there is a run: `initialize`, and `launch` or `attach`."""

from itertools import chain
from typing import Any

from jacaros.editors.dap.channel import Arguments, Channel
from jacaros.editors.dap.session import CAPABILITIES
from jacaros.editors.dap.wire import Wire
from jacaros.runtime.errors import UsageError


def opening(wire: Wire, channel: Channel) -> Arguments | None:
    """Answer requests until the editor launches a program or attaches to a run. Return this request, still unanswered.

    Returns:
        None if the editor leaves.
    """
    while (request := wire.read()) is not None:
        command = request.get("command")
        if command == "initialize":
            channel.respond(request, CAPABILITIES)
        elif command in ("launch", "attach"):
            return request
        else:
            channel.respond(request)
            if command in ("disconnect", "terminate"):
                return None
    return None


_OPTIONS = ("world", "seed", "clock", "mapping")
"""Arguments of `launch` that are options of ``jacaros run`` with the same names."""


def command_line(given: Arguments) -> list[str]:
    """Return the arguments of ``jacaros run`` for those of `launch`.

    Raises:
        UsageError: an argument is missing, or of the wrong type.
    """
    program, more = given.get("program"), given.get("args", [])
    if not isinstance(program, str) or not program.strip():
        raise UsageError("`program` is missing; name a .asl, .py, .mas2j or .jcm file")
    if not isinstance(more, list) or not all(isinstance(each, str) for each in more):
        raise UsageError(f"`args` must be a list of strings, found {more!r}")
    options = ((f"--{name}", value) for name in _OPTIONS for value in _values(name, given.get(name)))
    return [program, *chain.from_iterable(options), *more]


def _values(name: str, given: Any) -> list[str]:
    """Return a value as arguments; a list stands for a repeated option."""
    values = given if isinstance(given, list) else [] if given in (None, "") else [given]
    if not all(isinstance(each, str | int) and not isinstance(each, bool) for each in values):
        raise UsageError(f"`{name}` must be a string or a number, found {given!r}")
    return list(map(str, values))

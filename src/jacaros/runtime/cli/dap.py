"""``jacaros dap``."""

import io
import os
import re
from collections.abc import Mapping
from typing import Any

import click

from jacaros.runtime.cli import run
from jacaros.runtime.cli.options import variables
from jacaros.runtime.cli.usage import examples, in_our_form, usage_error
from jacaros.runtime.errors import JacarosError
from jacaros.runtime.mas.system import System
from jacaros.serving.stdio import claim

_ALARMING = re.compile(r"\b(warning|error): ")


@click.command("dap", epilog=examples("jacaros dap"))
def command() -> int:
    """Debug agents from an editor: the Debug Adapter Protocol on the standard input and output.

    Your editor starts this command. `launch` runs a program as `jacaros run` does; `attach` joins a run that was started
    with --serve. The run stops its robots and ends when the editor closes the standard input.
    """  # fmt: skip
    from jacaros.editors.dap.opening import opening  # here: it imports much
    from jacaros.editors.dap.session import Channel
    from jacaros.editors.dap.wire import Wire

    ends = claim()
    wire = Wire(ends.source, ends.sink)
    channel = Channel(wire.send)
    try:
        request = opening(wire, channel)
        if request is None:
            return 0
        try:
            return _launch(request, wire, channel)
        except click.ClickException as error:
            raise in_our_form(error) from None
    except JacarosError as error:
        channel.output(f"{error}\n", "stderr")
        raise
    finally:
        wire.close()


def _launch(request: Mapping[str, Any], wire: Any, channel: Any) -> int:
    from jacaros.editors.dap.opening import command_line
    from jacaros.editors.dap.points import first_line
    from jacaros.editors.dap.session import Session, Settings

    given = request.get("arguments") or {}
    begun = False

    def open_door(system: System) -> None:
        nonlocal begun
        begun = True
        channel.respond(request)
        session = Session(system, channel, Settings.of(given, launched=True))
        wire.listen(session.take, lambda why: session.leave(end_run=True))
        session.begin()

    try:
        if folder := given.get("cwd"):
            _change_to(str(folder))
        context = run.command.make_context("jacaros dap", command_line(given), obj=variables())
        context.params |= {"open_door": open_door, "streams": _Console.both(channel)}
        with context:
            code: int = run.command.invoke(context)
    except (JacarosError, click.ClickException) as error:
        if not begun:
            wrong = in_our_form(error) if isinstance(error, click.ClickException) else error
            channel.refuse(request, first_line(wrong))
        raise
    return code


def _change_to(folder: str) -> None:
    try:
        os.chdir(folder)
    except OSError as error:
        raise usage_error(f"cannot change to `{folder}`: {error.strerror}") from None


class _Console(io.TextIOBase):
    """A stream of a run that the editor shows in its console."""

    def __init__(self, channel: Any, category: str) -> None:
        self._channel, self._category = channel, category

    @classmethod
    def both(cls, channel: Any) -> "tuple[_Console, _Console]":
        """Return the streams for the output of agents, and for logs."""
        return cls(channel, "stdout"), cls(channel, "stderr")

    def writable(self) -> bool:
        """Return True."""
        return True

    def write(self, text: str) -> int:
        """Show *text*; the log in the colour of errors only if it is a warning or an error."""
        is_note = self._category == "stderr" and not _ALARMING.search(text)
        self._channel.output(text, "console" if is_note else self._category)
        return len(text)

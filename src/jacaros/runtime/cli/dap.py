"""``jacaros dap``."""

import io
import os
import re
from typing import TYPE_CHECKING

import click

from jacaros.agents.language.diagnostics import one_line
from jacaros.runtime.cli import run
from jacaros.runtime.cli.options import variables
from jacaros.runtime.cli.usage import examples, in_our_form, usage_error
from jacaros.runtime.errors import JacarosError
from jacaros.runtime.mas.system import System
from jacaros.serving.stdio import claim

if TYPE_CHECKING:
    from jacaros.editors.dap.channel import Channel
    from jacaros.editors.dap.wire import Message, Wire

_ALARMING = re.compile(r"\b(warning|error): ")


@click.command("dap", epilog=examples("jacaros dap"))
def command() -> int:
    """Debug agents from an editor: the Debug Adapter Protocol on the standard input and output.

    Your editor starts this command. `launch` runs a program as `jacaros run` does; `attach` joins a run that was started
    with --serve. The run stops its robots and ends when the editor closes the standard input.
    """  # fmt: skip
    from jacaros.editors.dap.channel import Channel
    from jacaros.editors.dap.opening import opening  # here: it imports much
    from jacaros.editors.dap.wire import Wire

    ends = claim()
    wire = Wire(ends.source, ends.sink)
    channel = Channel(wire.send)
    try:
        request = opening(wire, channel)
        if request is None:
            return 0
        if request["command"] == "attach":
            return _attach(request, wire, channel)
        return _launch(request, wire, channel)
    except JacarosError as error:
        channel.output(f"{error}\n", "stderr")
        raise
    finally:
        wire.close()


def _launch(request: "Message", wire: "Wire", channel: "Channel") -> int:
    from jacaros.editors.dap.opening import command_line
    from jacaros.editors.dap.session import Session, Settings

    given = request.get("arguments") or {}
    begun: list[Session] = []

    def open_door(system: System) -> None:
        channel.respond(request)
        session = Session(system, channel, Settings.of(given, launched=True))
        begun.append(session)
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
        wrong = in_our_form(error) if isinstance(error, click.ClickException) else error
        if not begun:
            channel.refuse(request, one_line(wrong))
        raise wrong from None
    return code


def _attach(request: "Message", wire: "Wire", channel: "Channel") -> int:
    from jacaros.editors.dap.relay import relay
    from jacaros.runtime.cli.talking import client_of
    from jacaros.serving.shell.wording import error_text

    given = request.get("arguments") or {}
    url, port, token = (given.get(each) for each in ("url", "port", "token"))
    try:
        if url is None and port is not None:
            url = f"http://127.0.0.1:{port}"
        client = client_of(None if url is None else str(url), None if token is None else str(token))
        relay(wire, client, request)
    except JacarosError as error:
        channel.refuse(request, one_line(error))
        raise JacarosError(error_text(error)) from None
    return 0


def _change_to(folder: str) -> None:
    try:
        os.chdir(folder)
    except OSError as error:
        raise usage_error(f"cannot change to `{folder}`: {error.strerror}") from None


class _Console(io.TextIOBase):
    """A stream of a run that the editor shows in its console."""

    def __init__(self, channel: "Channel", category: str) -> None:
        self._channel, self._category = channel, category

    @classmethod
    def both(cls, channel: "Channel") -> "tuple[_Console, _Console]":
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

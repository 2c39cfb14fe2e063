"""Debugger commands: pause, continue, step, speed, breakpoints, and reload of changed programs."""

from collections.abc import Mapping
from typing import cast

from jacaros.inspector.live.commands import Command, Given, Refused, choice_in, number_in, text_in
from jacaros.mas.debugging.debugger import STEPS, Debugger, Step


def debug_commands(debugger: Debugger) -> Mapping[str, Command]:
    """Return the commands of a debugger; the speed can be changed only in real time."""
    commands = _DebugCommands(debugger)
    found: dict[str, Command] = {
        "pause": commands.pause,
        "continue": commands.resume,
        "step": commands.step,
        "breakpoint": commands.breakpoint,
        "reload": commands.reload,
    }
    return {**found, "speed": commands.speed} if debugger.has_speed else found


class _DebugCommands:
    def __init__(self, debugger: Debugger) -> None:
        self._debugger = debugger

    def pause(self, given: Given) -> None:
        """Pause agents, timers and world."""
        del given
        self._debugger.pause()

    def resume(self, given: Given) -> None:
        """Continue."""
        del given
        self._debugger.resume()

    def step(self, given: Given) -> None:
        """Continue until the next cycle, step or event."""
        what = cast(Step, choice_in(given, "what", STEPS))
        self._debugger.step(what, text_in(given, "agent") if given.get("agent") is not None else None)

    def speed(self, given: Given) -> None:
        """Set the speed, in seconds of the run per second of real time."""
        self._debugger.speed = number_in(given, "factor")

    def breakpoint(self, given: Given) -> list[str]:
        """Add or remove a breakpoint; return all breakpoints as text."""
        at = given.get("at")
        if not isinstance(at, Mapping):
            raise Refused("`at` must describe a breakpoint")
        if choice_in(given, "op", ("add", "remove")) == "add":
            self._debugger.add_breakpoint(at)
        elif not self._debugger.remove_breakpoint(at):
            raise Refused("this breakpoint is not set")
        return [each.text for each in self._debugger.breakpoints]

    def reload(self, given: Given) -> str:
        """Reload changed programs; return lines about what was replaced, and what could not be."""
        del given
        return "\n".join(self._debugger.reload())

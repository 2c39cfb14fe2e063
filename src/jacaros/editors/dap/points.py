"""The breakpoints of an editor: on lines, for events and plans, and for failures."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Any

from jacaros.agents.language.diagnostics import one_line
from jacaros.runtime.errors import JacarosError
from jacaros.runtime.mas.debugging.breakpoints import FAILURES, Breakpoint, LineBreakpoint, breakpoint_at
from jacaros.runtime.mas.debugging.debugger import Debugger
from jacaros.runtime.mas.system import System

Given = Mapping[str, Any]


@dataclass
class _Line:
    """A breakpoint of the editor on a line.

    Attributes:
        id: its number, for the editor.
        given: what the editor sent.
        set: the breakpoint of the debugger, or None.
        verified, line, message: what the editor shows.
    """

    id: int
    given: Given
    set: Breakpoint | None = None
    verified: bool = False
    line: int = 0
    message: str = ""

    def data(self) -> dict[str, Any]:
        """Return the breakpoint for the editor."""
        shown = {"id": self.id, "verified": self.verified, "line": self.line}
        return shown | ({"message": self.message} if self.message else {})


class Points:
    """Sets the breakpoints of an editor, and removes those that it set before.

    Args:
        system: the run.
        changed: called with a breakpoint that an agent has made valid, as data.
    """

    def __init__(self, system: System, changed: Callable[[Given], None]) -> None:
        self._system, self._changed = system, changed
        self._lines: dict[str, list[_Line]] = {}
        self._others: dict[str, list[Breakpoint]] = {}
        self._numbers = count(1)
        self.end = system.directory.watch(self._agent_came)

    @property
    def _debugger(self) -> Debugger:
        return self._system.debugger

    def clear(self) -> None:
        """Remove all breakpoints of the editor."""
        self.end()
        for path in list(self._lines):
            self.set_lines(path, ())
        for group in list(self._others):
            self._set_group(group, ())

    # ---- lines

    def set_lines(self, path: str, given: Sequence[Given]) -> list[dict[str, Any]]:
        """Replace the breakpoints of a file. Return them as the editor shows them."""
        for each in self._lines.pop(path, ()):
            self._remove(each.set)
        if not given:
            return []
        lines = self._lines[path] = [_Line(next(self._numbers), each) for each in given]
        for each in lines:
            self._set(path, each)
        return [each.data() for each in lines]

    def _set(self, path: str, at: _Line) -> None:
        """Set a breakpoint; one on a line without a step moves to the next step."""
        file = self._name_of(path)
        at.line, possible = int(at.given["line"]), self._debugger.lines_of(file)
        line = min((line for line in possible if line >= at.line), default=None)
        at.verified = line is not None
        if line is None and possible:
            at.message = f"no step on line {at.line} or below"
            return
        at.line, at.message = line or at.line, "" if possible else "no agent runs this file yet"
        qualified = (str(at.given.get(each) or "") for each in ("condition", "hitCondition", "logMessage"))
        try:
            at.set = self._debugger.add_breakpoint(LineBreakpoint(file, at.line, *qualified))
        except JacarosError as error:
            at.verified, at.message = False, one_line(error)

    def _name_of(self, path: str) -> str:
        """Return the name by which agents know a file."""
        minds = (host.mind for host in self._system.directory if host.mind is not None)
        names = {plan.file for mind in minds for plan in mind.library.plans}
        wanted = Path(path).resolve()
        return next((name for name in names if Path(name).resolve() == wanted), path)

    def _agent_came(self, name: str, present: bool) -> None:
        """Check the breakpoints that were not valid: an agent may have a new program."""
        if not present:
            return
        for path, lines in self._lines.items():
            for each in lines:
                if not each.verified:
                    self._remove(each.set)
                    self._set(path, each)
                    if each.verified:
                        self._changed(each.data())

    def _remove(self, at: Breakpoint | None) -> None:
        if at is not None:
            self._debugger.remove_breakpoint(at)

    # ---- plans, events and failures

    def set_functions(self, names: Iterable[str]) -> list[dict[str, Any]]:
        """Replace the breakpoints for events, such as ``+!go(_)``, and plans, such as ``@dock``."""
        return self._set_group("functions", [_by_name(name.strip()) for name in names])

    def set_failures(self, kinds: Iterable[str]) -> list[dict[str, Any]]:
        """Replace the breakpoints for failures."""
        return self._set_group("failures", [{"failure": kind} for kind in kinds])

    def _set_group(self, group: str, given: Sequence[Given]) -> list[dict[str, Any]]:
        for each in self._others.pop(group, ()):
            self._remove(each)
        made = self._others[group] = []
        shown: list[dict[str, Any]] = []
        for data in given:
            try:
                made.append(self._debugger.add_breakpoint(breakpoint_at(data)))
                shown.append({"verified": True})
            except JacarosError as error:
                shown.append({"verified": False, "message": one_line(error)})
        return shown


FILTERS = [{"filter": kind, "label": text.capitalize()} for kind, text in FAILURES.items()]
"""The failures for which an editor offers to stop."""


def _by_name(name: str) -> Given:
    return {"event": name} if name[:1] in ("+", "-", "^") else {"plan": {"plan": name}}

"""The Python code of a project, imported when a program or the project file first names it."""

import ast
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from jacaros.agents.language.diagnostics import Diagnostic, SourceFile, Span
from jacaros.agents.mind.actions.internal_action import STANDARD, ActionError, InternalAction
from jacaros.agents.mind.rules.context import Context
from jacaros.agents.mind.state.circumstance import Circumstance, ProjectFunctions
from jacaros.agents.terms.values import Term
from jacaros.runtime.files.python_modules import ModuleUnreadable, ProjectModules
from jacaros.runtime.files.texts import file_text, shown_from

if TYPE_CHECKING:
    from jacaros.agents.python.declaring import Additions, ArityRange

_ASSERTIONS: Final = "jacaros.testing.assertions"
"""The module with the internal actions for assertion goals."""


class PythonCode:
    """What a project's Python modules add to its programs.

    The names in a program decide what is imported: when the parser meets ``my.norm(X)``, the module ``my`` is imported
    if the project has one. A project without Python code imports nothing.

    Args:
        modules: the project's modules.
        restricted: whether internal actions that read or write files, add programs or create Python objects fail.

    Attributes:
        actions: internal actions of the language and of the imported modules, shared by all agents.
        functions: arithmetic functions by name, with their least and greatest numbers of arguments, for the parser.
        evaluators: the implementations of these functions.
    """

    def __init__(self, modules: ProjectModules, restricted: bool = False) -> None:
        self.modules = modules
        self.restricted = restricted
        self.actions: dict[str, InternalAction] = dict(STANDARD)
        if restricted:
            self.actions.update(_refused(self.actions))
        self.functions: Mapping[str, ArityRange] = _Functions(self)
        self._additions: Additions | None = None
        self._read: dict[str, ModuleUnreadable | None] = {}
        self._met: dict[str, None] = {}
        self.evaluators: dict[str, Callable[..., Term]] = {}

    def name_met(self, name: str) -> None:
        """Import the module that a name with a dot in a program refers to, if it exists."""
        if name.startswith("cartago."):
            self._add_python_objects()
        elif name.startswith("jacaros."):
            self._add_assertions()
        parts = name.split(".")[:-1]
        for length in range(1, len(parts) + 1):
            module = ".".join(parts[:length])
            if module not in self._read:
                if not module or self.modules.place(module) is None:
                    return
                self._read_module(module)
            self._met[module] = None

    def _add_python_objects(self) -> None:
        # Imported on demand: most programs use no Python objects.
        from jacaros.runtime.mas.agents.python_objects import PACKAGE, actions

        if not any(known.startswith(PACKAGE) for known in self.actions):
            found = actions(self.modules)
            if self.restricted:
                found |= _refused(found)
            self.actions.update(found)

    def _add_assertions(self) -> None:
        # By name, like a project's own modules: a run imports nothing of the tests unless a program uses it.
        for name, action in import_module(_ASSERTIONS).UNTESTED.items():
            self.actions.setdefault(name, action)

    def _read_module(self, module: str) -> None:
        # Imported on demand: most projects have no Python code.
        from jacaros.agents.python.declaring import Additions

        if self._additions is None:
            self._additions = Additions()
        try:
            self._additions.collect(self.modules, module)
            self._read[module] = None
        except ModuleUnreadable as wrong:
            self._read[module] = wrong
        self.actions.update(self._additions.actions)
        self.evaluators.update(self._additions.functions)

    def is_unseen(self, name: str) -> bool:
        """Return whether a name may exist once the project's files are run, which this check does not do."""
        if self._additions is None or name in self.actions:
            return False
        for unseen, file in self._additions.unseen.items():
            if name == unseen or (unseen.endswith(".") and name.startswith(unseen)):
                if self.modules.unseen is not None:
                    self.modules.unseen.add(file)
                return True
        return False

    def take_errors(self) -> list[Diagnostic]:
        """Return the errors in the modules that programs have named since the last call."""
        wrong = [error for name in self._met if (error := self._read.get(name)) is not None]
        self._met.clear()
        help = "correct the module: programs that use it cannot run"
        return [Diagnostic("error", str(error), None, help) for error in wrong]

    def help(self, name: str) -> str | None:
        """Return the help for an unknown internal action, or None."""
        known = self._additions.help(name) if self._additions is not None else None
        if known is not None or name.startswith("."):
            return known
        module, _, function = name.rpartition(".")
        file = f"{module.replace('.', '/')}.py"
        if self.modules.place(module.partition(".")[0]) is not None:
            return f"add a function `{function}` with @internal_action to {file}"
        return f"write a function `{function}` with @internal_action in {file} beside the project file"

    def serve(self, agent: Circumstance) -> None:
        """Let an agent evaluate the functions of the project, also in run-time input."""
        agent.functions.project = ProjectFunctions(self.functions, self.evaluators)


def _refused(actions: Mapping[str, InternalAction]) -> dict[str, InternalAction]:
    """Return the internal actions that a restricted run forbids, in a form that fails."""
    return {
        name: _failing(action, action.restricted)
        for name, action in actions.items()
        if action.restricted is not None
    }


def _failing(action: InternalAction, fewest: int) -> InternalAction:
    def refuse(ctx: Context, *given: Term) -> Any:
        if len(given) >= fewest:
            raise ActionError(f"{action.name} is forbidden: this run is restricted (--restrict)")
        return action.function(ctx, *given)

    return replace(action, function=refuse, direct=None)


class _Functions(dict[str, Any]):
    """The arithmetic functions of a project. Looking one up imports the module that it names."""

    def __init__(self, code: PythonCode) -> None:
        super().__init__()
        self._code = code

    def get(self, name: str, default: Any = None) -> Any:
        self._code.name_met(name)
        additions = self._code._additions
        if additions is None:
            return default
        if name not in additions.arities and self._code.is_unseen(name):
            return (0, None)
        return additions.arities.get(name, default)


_NOW: Final = "self.clock.now()"
_DATE: Final = "datetime.fromtimestamp(self.clock.now(), UTC)"
_INSTEAD: Final = {
    "time.time": _NOW,
    "time.time_ns": _NOW,
    "time.monotonic": "self.clock.elapsed",
    "time.monotonic_ns": "self.clock.elapsed",
    "time.sleep": "await self.sleep(seconds)",
    "datetime.datetime.now": _DATE,
    "datetime.datetime.today": _DATE,
    "datetime.datetime.utcnow": _DATE,
    "datetime.date.today": f"{_DATE}.date()",
    "threading.Timer": "self.clock.call_later(seconds, function)",
}
"""Calls that follow the machine's time, and what artifacts and agents in Python have instead."""


def readings(files: Iterable[Path]) -> Iterator[Diagnostic]:
    """Yield a warning for the first such call in each file; installed packages may lie below the project's folder."""
    for file in files:
        if "site-packages" in file.parts:
            continue
        text = file_text(file)
        found = next(_calls(text), None) if "time" in text or "threading" in text else None
        if found is not None:
            place, name = found
            span = Span(
                SourceFile(shown_from(Path.cwd(), file), text),
                place.lineno,
                place.col_offset + 1,
                place.end_lineno or place.lineno,
                (place.end_col_offset or place.col_offset) + 1,
            )
            message = f"`{name}` follows the time of day, not the virtual clock of this run"
            yield Diagnostic("warning", message, span, f"use `{_INSTEAD[name]}`, or run with --clock real")


def _calls(text: str) -> Iterator[tuple[ast.expr, str]]:
    """Yield the calls that follow the machine's time, however imported, with their full names."""
    modules = {name.partition(".")[0] for name in _INSTEAD}
    names: dict[str, str] = {}
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            names |= {each.asname or each.name: each.name for each in node.names if each.name in modules}
        elif isinstance(node, ast.ImportFrom) and node.module in modules:
            names |= {each.asname or each.name: f"{node.module}.{each.name}" for each in node.names}
        elif isinstance(node, ast.Call):
            first, dot, rest = ast.unparse(node.func).partition(".")
            if (name := f"{names.get(first)}{dot}{rest}") in _INSTEAD:
                yield node.func, name

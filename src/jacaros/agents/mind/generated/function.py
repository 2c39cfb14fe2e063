"""Generated Python functions and their units: text, constants, and what is known of variables at the present point."""

import ast
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import groupby
from types import CodeType
from typing import Any

from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import SourceFile
from jacaros.agents.mind.actions.internal_action import InternalAction
from jacaros.agents.mind.generated import runtime
from jacaros.agents.mind.state.intention import FIRST_SLOT
from jacaros.agents.mind.state.plan import Plan
from jacaros.agents.mind.state.triggers import Trigger
from jacaros.agents.terms.values import Functor, String, Term

_READ = re.compile(r" +(v\d+) = deref\(\w+\)")
_SETTLED = re.compile(r"\bv\d+\b")


TOP = "NESTED"
"""The `FunctionBuilder.depth` of a function that no other search has called."""


class CodeUnit:
    """Collects functions and constants.

    Attributes:
        actions: the internal actions known at compile time.
        globals: the names that the functions use.
        functions: those that are written.
    """

    def __init__(self, filename: str, actions: Mapping[str, InternalAction]) -> None:
        self.filename = filename
        self.actions = actions
        self.globals: dict[str, Any] = dict(runtime.NAMES)
        self.functions: list[FunctionBuilder] = []
        self._constants: dict[Any, str] = {}
        self._count = 0

    def constant(self, value: Term) -> str:
        """A global name for a value; equal values share it."""
        key: Any = value if value.__class__ in (Functor, Trigger) else (value.__class__, id(value))
        if value.__class__ in (String, float, int):
            key = (value.__class__, value)
        name = self._constants.get(key)
        if name is None:
            name = self._constants[key] = f"{_prefix(value)}_{len(self._constants)}"
            self.globals[name] = value
        return name

    def fresh_function(self, prefix: str) -> str:
        """A name for another function."""
        self._count += 1
        return f"{prefix}{self._count}"

    def code(self) -> list[CodeType]:
        """Compile what has been written.  A code object has but one file, and plans may be included."""
        return [
            compile_all(functions, filename) for filename, functions in groupby(self.functions, self._file_of)
        ]

    def _file_of(self, function: "FunctionBuilder") -> str:
        file = function.files[0]
        return self.filename if file is None else file.name


def _prefix(value: Term) -> str:
    name = getattr(value, "name", None) or getattr(value, "__name__", None) or value.__class__.__name__
    text = "".join(c if c.isalnum() and c.isascii() else "_" for c in str(name))
    return f"K_{text}"


class FrameLayout:
    """The slots of a plan's variables, and what is known of them between two steps.

    Attributes:
        slots: index in the frame by variable name.
        states: ``set`` (has a value, perhaps a `Var`) or ``maybe`` (None when it was bound on another branch);
            names that are missing have no value yet.
        asked: variables that went into a call without a value, to have one afterwards: their slots hold a `Var`.
    """

    def __init__(self, plan: Plan) -> None:
        self.slots = plan.slots
        self.extra = 0
        self.states: dict[str, str] = {}
        self.asked: set[str] = set()

    def hidden_slot(self) -> int:
        """A slot for the compiler's own use."""
        self.extra += 1
        return FIRST_SLOT + len(self.slots) + self.extra - 1

    @property
    def size(self) -> int:
        """Number of slots behind the fixed ones."""
        return len(self.slots) + self.extra


class FunctionBuilder:
    """A function being written: its lines, indentation and fresh names, and what is known of variables at this point.

    Attributes:
        file, origin: file and line of the agent program that the next lines come from.
        files, origins: the same of each line that is written.
        loops: how many loops are open; Python allows 20 nested ones.
        values: Python expression (a local name) of each variable that has a value here.
        asked: variables that were given a `Var` in this function.
        fresh: variables that got their value in this function, in order.
        trampoline: the function is a generator that yields generators to have them run (see `conditions`).
        snapshot: answers are taken while beliefs may change in between, so tables are copied first.
        depth: expression for how many generators may be nested in those that the function asks (see `predicates`).
        quiet: an internal action that cannot be done does not hold; a step of its own fails with the reason.
    """

    def __init__(
        self, unit: CodeUnit, *, trampoline: bool = False, snapshot: bool = False, depth: str = TOP
    ) -> None:
        self.unit = unit
        self.lines: list[str] = []
        self.files: list[SourceFile | None] = []
        self.origins: list[int] = []
        self.file: SourceFile | None = None
        self.origin = 1
        self.indent = self.loops = self._count = 0
        self.values: dict[str, str] = {}
        self.fresh: list[str] = []
        self.asked: set[str] = set()
        self.trampoline = trampoline
        self.snapshot = snapshot
        self.depth = "0" if trampoline else depth
        self.quiet = True

    @contextmanager
    def function(self, name: str, *parameters: str) -> Iterator[None]:
        """Write the function itself, which becomes part of its unit."""
        with self.block(f"def {name}({', '.join(parameters)}):"):
            yield
        self._prune()
        self.unit.functions.append(self)

    def line(self, text: str) -> None:
        """Write a line."""
        self.lines.append("    " * self.indent + text)
        self.files.append(self.file)
        self.origins.append(self.origin)

    @contextmanager
    def block(self, head: str) -> Iterator[None]:
        """A compound statement; the lines written inside belong to it."""
        self.line(head)
        self.indent += 1
        loop = head.startswith(("for ", "while "))
        self.loops += loop
        before = len(self.lines)
        yield
        if len(self.lines) == before:
            self.line("pass")
        self.loops -= loop
        self.indent -= 1

    def _prune(self) -> None:
        """Remove the values of variables that are read and never used."""
        names = Counter(name for line in self.lines for name in _SETTLED.findall(line))
        kept = [
            index
            for index, line in enumerate(self.lines)
            if (read := _READ.fullmatch(line)) is None or names[read[1]] > 1
        ]
        self.lines = [self.lines[i] for i in kept]
        self.files = [self.files[i] for i in kept]
        self.origins = [self.origins[i] for i in kept]

    def at(self, node: nodes.Node) -> None:
        """The next lines stem from this node."""
        if node.span is not None:
            self.file, self.origin = node.span.file, node.span.line

    def constant(self, value: Term) -> str:
        """A global name for a value."""
        return self.unit.constant(value)

    def local(self, prefix: str = "t") -> str:
        """A local name that is used nowhere else."""
        self._count += 1
        return f"{prefix}{self._count}"

    def bind(self, name: str, expression: str | None = None) -> str:
        """Give a variable its value here; returns the local name."""
        target = f"v_{name}"
        if expression is not None and expression.startswith("Var("):
            # What `Var.__init__` does, without the call.
            self.line(f"{target} = new(Var); {target}.ref = None; {target}.name = {name!r}")
        elif expression is not None and expression != target:
            self.line(f"{target} = {expression}")
        self.values[name] = target
        if name not in self.fresh:
            self.fresh.append(name)
        if expression is not None and expression.startswith("Var("):
            self.asked.add(name)
        return target

    def inner(self, *, searching: bool = True) -> "FunctionBuilder":
        """A builder for a function that this one calls; *searching* the way this one does, or plainly and at once."""
        if not searching:
            return type(self)(self.unit, depth="d - 1")
        return type(self)(self.unit, trampoline=self.trampoline, snapshot=self.snapshot, depth="d - 1")

    @contextmanager
    def branch(self) -> Iterator[None]:
        """What is learnt inside is forgotten outside."""
        values, fresh = dict(self.values), list(self.fresh)
        yield
        self.values, self.fresh = values, fresh

    def load(self, frame: FrameLayout, names: list[str]) -> None:
        """Read the variables that have a value from the frame."""
        for name in names:
            state = frame.states.get(name)
            if state is None:
                continue
            slot = frame.slots[name]
            self.line(f"v_{name} = frame[{slot}]")
            if state == "maybe":
                self.line(f'if v_{name} is None: v_{name} = frame[{slot}] = Var("{name}")')
                frame.states[name] = "set"
            elif name in frame.asked:
                value = f"v_{name}.ref if v_{name}.ref.__class__ is float else deref(v_{name})"
                self.line(f"if v_{name}.__class__ is Var and v_{name}.ref is not None: v_{name} = {value}")
            self.values[name] = f"v_{name}"

    def store(self, frame: FrameLayout) -> None:
        """Write the variables that got a value here to the frame."""
        for name in self.fresh:
            if name in frame.slots:
                self.line(f"frame[{frame.slots[name]}] = {self.values[name]}")
        frame.asked |= self.asked


def compile_all(functions: "Iterable[FunctionBuilder]", filename: str) -> CodeType:
    """Python code of several functions, whose line numbers are those of the agent program *filename*."""
    lines: list[str] = []
    origins = [0]
    for function in functions:
        lines += function.lines
        origins += function.origins
    origins.append(origins[-1])
    return compile_text("\n".join(lines) + "\n", origins, filename)


def compile_text(text: str, origins: Sequence[int], filename: str) -> CodeType:
    """Compile *text*; its line n gets the number ``origins[n]`` of the file *filename*."""
    tree = ast.parse(text)
    _move(tree, origins)
    return compile(tree, filename, "exec")


def _move(tree: ast.AST, origins: Sequence[int]) -> None:
    """Give each node of a syntax tree the line that its own line comes from.

    Written without `ast.walk`, which takes longer than the compiler.
    """
    stack: list[ast.AST] = [tree]
    while stack:
        parts = stack.pop().__dict__
        if "lineno" in parts:
            parts["lineno"] = parts["end_lineno"] = origins[parts["lineno"]]
            parts["col_offset"] = parts["end_col_offset"] = 0
        for part in parts.values():
            if part.__class__ is list:
                stack += [item for item in part if isinstance(item, ast.AST)]
            elif isinstance(part, ast.AST):
                stack.append(part)

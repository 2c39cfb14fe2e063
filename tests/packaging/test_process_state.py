"""The state of a run is in the run: modules and classes hold constants.

What a process shares, and why, is in docs/decisions/0018-what-a-process-shares.md.
"""

import ast
import asyncio
import importlib
import itertools
import pkgutil
import sys
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextvars import ContextVar
from functools import _lru_cache_wrapper
from inspect import signature
from pathlib import Path
from typing import Any
from weakref import WeakKeyDictionary, WeakSet, WeakValueDictionary

import jacaros
from jacaros import Mas, PythonAgent
from jacaros.agents.terms.values import InternedRef

PACKAGES = (
    "agents",
    "mas",
    "artifacts.env",
    "artifacts.kernel",
    "artifacts.presence",
    "artifacts.streams",
)
WEAK = {
    "agents.terms.values._functors": "names that are in use",
    "agents.mind.state.triggers._triggers": "event kinds that are in use",
    "agents.body.values._references": "references that are in use, by their objects",
}
NUMBERS = {
    "agents.terms.order._variable_numbers": "variables in the order in which they were first compared",
    "agents.terms.values._reference_numbers": "names of opaque objects (cobj_N)",
}
VARIABLES = {
    "agents.terms.operators.RUNNING": "the agent whose turn it is, for each thread and task",
    "artifacts.kernel.steps.CURRENT": "what led to the operation that runs, for each task of a run that is watched",
}
CACHES = {
    "agents.checks.goals._goals_of_tests": "of a file of the package",
    "agents.mind.actions.terms._compile": "of a text",
    "agents.mind.rules.proc_msg._achieved": "of a name",
    "agents.mind.rules.proc_msg._only_from": "of a name",
    "agents.body.body.keys": "of nothing",
    "agents.body.values.symbol_of": "of a name",
    "mas.mappings.stored_interfaces": "of files of the package",
}
CONTAINERS = (dict, list, set, deque, bytearray, WeakKeyDictionary, WeakSet, WeakValueDictionary)


def attributes() -> Iterator[tuple[str, Any]]:
    """Yield what the modules of the mind and around it, and their classes, hold, by its full name."""
    for package in PACKAGES:
        found = importlib.import_module(f"jacaros.{package}")
        for each in pkgutil.walk_packages(getattr(found, "__path__", ()), f"{found.__name__}."):
            importlib.import_module(each.name)
    for name, module in sorted(sys.modules.items()):
        if not name.removeprefix("jacaros.").startswith(PACKAGES):
            continue
        for key, value in vars(module).items():
            if isinstance(value, type) and value.__module__ == name:
                yield from ((f"{name[8:]}.{key}.{inner}", held) for inner, held in vars(value).items())
            elif not key.startswith("__"):
                yield f"{name[8:]}.{key}", value


def others_than(expected: Iterable[str], is_meant: Callable[[Any], bool]) -> list[list[str]]:
    """Return the names of each object that is meant and has no expected name; modules that import it have one, too."""
    names: dict[int, list[str]] = {}
    for name, value in attributes():
        if is_meant(value):
            names.setdefault(id(value), []).append(name)
    return [each for each in names.values() if not set(expected) & set(each)]


def test_no_module_counts() -> None:
    assert others_than(NUMBERS, lambda value: isinstance(value, itertools.count)) == []


def test_only_what_runs_now_is_a_context_variable() -> None:
    assert others_than(VARIABLES, lambda value: isinstance(value, ContextVar)) == []


def test_only_tables_of_objects_in_use_use_weak_references() -> None:
    kinds = (WeakKeyDictionary, WeakSet, WeakValueDictionary, InternedRef)
    assert others_than(WEAK, lambda value: isinstance(value, kinds)) == []


def test_caches_are_bounded() -> None:
    assert others_than(CACHES, lambda value: isinstance(value, _lru_cache_wrapper)) == []
    for name, value in attributes():
        if isinstance(value, _lru_cache_wrapper):
            size = value.cache_parameters()["maxsize"]
            assert not signature(value).parameters or (size is not None and size <= 20_000), name


def test_no_function_assigns_to_a_global() -> None:
    folder = Path(jacaros.__file__).parent
    files = [file for package in PACKAGES for file in (folder / package.replace(".", "/")).rglob("*.py")]
    assert len(files) > 200
    trees = {file: ast.parse(file.read_text(encoding="utf-8")) for file in files}
    assert [
        file for file, tree in trees.items() if any(isinstance(node, ast.Global) for node in ast.walk(tree))
    ] == []


COUNTER = """
from jacaros.artifacts import Artifact, operation

class Counter(Artifact):
    def init(self, value: int) -> None:
        self.define_property("count", value)

    @operation
    def inc(self) -> None:
        self.update_property("count", self.value("count") + 1)
"""
ACTIONS = """
from jacaros import PythonAgent, arithmetic_function, internal_action

@internal_action
def twice(text: str) -> str:
    return text * 2

@arithmetic_function("my.half")
def half(x):
    return x / 2
"""
PROGRAM = """
{ register_function("your.double", 1, "double") }
double(X, 2 * X). name("x").
fits(X) :- double(X, Y) & Y > my.half(3).
+!go(N) : fits(N)
  <- makeArtifact("counter", "Counter", [N], Id); focus(Id); inc; .wait(count(_));
     my.twice("ab", S); .concat(S, 1, T); .term2string(U, T); +seen(U); -seen(U);
     .add_plan({ +!more(X) <- .print(X) }); !more(your.double(N));
     .send(bob, askOne, name(_), A); .send(bob, tell, said(U)); .broadcast(achieve, hear(N));
     ?name(V); W = V + 1;
     .findall(R, .range(R, 1, 5), L); .set.create(Q); .set.add(Q, L); .shuffle(L, M); .replace("a1", "[0-9]", "", P);
     !missing; .print(never).
-!go(N)[error(E)] <- .print(E).
+!hear(N) <- .print(N).
+said(X)[source(ann)] <- .print(X).
"""


class Asking(PythonAgent):
    """An agent in Python."""

    async def run(self) -> None:
        """Talk to the others, and use an artifact."""
        self.send("bob", "tell", "said(something)")
        await self.ask("bob", "name(_)")


def system(folder: Path, number: int) -> list[str]:
    """Run agents, artifacts and Python code; return what they print and log."""
    lines: list[str] = []

    async def main() -> None:
        def take(_: str, text: str) -> None:
            lines.append(text)

        async with Mas(folder=folder, on_print=take, on_log=lambda text, level: lines.append(text)) as mas:
            mas.add_agent("bob", PROGRAM)
            mas.add_agent("cleo", Asking)
            await mas.add_agent("ann", PROGRAM).achieve(f"go({number})")
            await asyncio.sleep(0.5)

    asyncio.run(main())
    return lines


def test_a_run_changes_no_module(tmp_path: Path) -> None:
    (tmp_path / "my.py").write_text(ACTIONS, encoding="utf-8")
    (tmp_path / "artifacts.py").write_text(COUNTER, encoding="utf-8")
    expected = WEAK.keys()
    held = {
        name: value for name, value in attributes() if isinstance(value, CONTAINERS) and name not in expected
    }
    before = {name: list(value.items() if isinstance(value, dict) else value) for name, value in held.items()}
    assert "agents.terms.operators.BINARY" in held
    lines = system(tmp_path, 7)
    assert {"abab1", "7", "14", "no_relevant"} <= set(lines)
    assert not [line for line in lines if "error" in line]
    after = {name: list(value.items() if isinstance(value, dict) else value) for name, value in held.items()}
    assert [name for name in held if before[name] != after[name]] == []

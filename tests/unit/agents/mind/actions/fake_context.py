"""A mind for internal actions under test: unification on a trail, and a host that remembers it all."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from random import Random
from types import SimpleNamespace

import jacaros.agents.mind.actions.standard  # noqa: F401 - fills STANDARD
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.agents.mind.state.budget import Options
from jacaros.agents.terms.substitution import resolve
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import String, Term, Var, atom, make_list, structure
from jacaros.runtime.errors import JacarosError


def term(value: object) -> Term:
    """Numbers, ``"atoms"``, ``("structures", ...)`` and ``[lists]`` as terms; other values as they are."""
    if isinstance(value, String):
        return value
    if isinstance(value, str):
        return atom(value)
    if isinstance(value, (int, float)):
        return float(value)
    if isinstance(value, list):
        return make_list([term(item) for item in value])
    if isinstance(value, tuple) and isinstance(value[0], str):
        return structure(value[0], *[term(argument) for argument in value[1:]])
    return value


@dataclass
class FakeArchitecture:
    """Keeps what an action does to the host."""

    random: Random = field(default_factory=lambda: Random(1))
    time: float = 0.0
    printed: list[str] = field(default_factory=list)
    logged: list[tuple[str, str]] = field(default_factory=list)
    stopped: tuple[float, int] | None = None
    created: list[tuple[str, str | None]] = field(default_factory=list)
    agents: list[str] = field(default_factory=lambda: ["bob", "carl"])
    timers: list[tuple[float, Callable[[], None]]] = field(default_factory=list)
    broken: bool = False
    delay: float = 0.0

    @property
    def system(self) -> "FakeArchitecture":
        return self

    def now(self) -> float:
        return self.time

    def print(self, shown: str) -> None:
        self.printed.append(shown)

    def log(self, level: str, shown: str) -> None:
        self.logged.append((level, shown))

    def stop_system(self, delay: float, exit_code: int) -> None:
        self.stopped = (delay, exit_code)

    def agent_names(self) -> list[str]:
        return self.agents

    def create_agent(self, name: str, source: str | None, classes: Mapping[str, str]) -> str | None:
        self.created.append((name, source, dict(classes)))
        return None if self.broken else f"{name}_1" if name in self.agents else name

    def kill_agent(self, name: str, delay: float, killer: str) -> bool:
        self.delay = delay
        known = name in self.agents
        self.agents = [other for other in self.agents if other != name]
        return known

    def set_timer(self, delay: float, callback: Callable[[], None]) -> None:
        self.timers.append((delay, callback))


class FakeContext:
    """Runs internal actions as a mind does: arguments resolved, bindings undone between the answers."""

    def __init__(self) -> None:
        self.agent = SimpleNamespace(name="bob", options=Options())
        self.architecture = FakeArchitecture()
        self.trail = Trail()
        self.intention: object = None
        self.readable: dict[str, Term] = {}
        self.facts: list[object] = []

    def unify(self, left: Term, right: Term) -> bool:
        mark = len(self.trail)
        if unify(left, right, self.trail):
            return True
        undo(self.trail, mark)
        return False

    def parse_term(self, written: str) -> Term:
        if written not in self.readable:
            raise JacarosError(f"not a term: {written}")
        return self.readable[written]

    def answers(self, formula: Term) -> Iterator[None]:
        """The facts that unify with a formula."""
        for fact in self.facts:
            mark = len(self.trail)
            if self.unify(formula, term(fact)):
                yield
            undo(self.trail, mark)

    def run(self, name: str, *arguments: object) -> Iterator[None]:
        """The answers of an action; its bindings hold until the next one is asked for."""
        action = STANDARD[name]
        values = [resolve(term(argument)) for argument in arguments]
        assert len(values) >= action.minimum
        assert action.maximum is None or len(values) <= action.maximum
        mark = len(self.trail)
        result = action.function(self, *values)
        for _ in result if action.backtracks else [True] * (result is not False):
            yield
            undo(self.trail, mark)

    def succeeds(self, name: str, *arguments: object) -> bool:
        """Whether there is an answer; the bindings of the first one stay."""
        return any(True for _ in self.run(name, *arguments))

    def instances(self, name: str, *arguments: object, of: object) -> list[str]:
        """The instances of a template, as text."""
        template = term(of)
        return [text(template) for _ in self.run(name, *arguments)]

    def result(self, name: str, *arguments: object) -> str:
        """The value, as text, that the action gives to an unbound last argument."""
        variable = Var("R")
        assert self.succeeds(name, *arguments, variable), f"{name} fails"
        return text(variable)

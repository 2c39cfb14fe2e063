"""An agent without a reasoner: tests act through its body and check what its mind receives."""

from collections.abc import Callable, Coroutine

from jacaros.agents.body.body import AgentBody
from jacaros.agents.body.values import PerceptWriter, References
from jacaros.agents.mind.state.act import Act, Completion, Percept
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import (
    Annotated,
    String,
    Term,
    Var,
    functor,
    functor_of,
    make_list,
    structure,
)
from jacaros.artifacts.env.artifact import Artifact, Out, operation
from jacaros.artifacts.env.environment import Environment
from jacaros.artifacts.env.errors import UnknownArtifactType
from jacaros.runtime.clock import VirtualClock, run


class Counter(Artifact):
    """Counts."""

    def init(self, start: int = 0) -> None:
        self.define_property("count", start)

    @operation
    def inc(self, by: int = 1) -> None:
        self.update_property("count", self.value("count") + by)
        self.signal("tick")

    @operation(name="read")
    def current_count(self, count: Out) -> None:
        count.set(self.value("count"))

    @operation
    def refuse(self) -> None:
        self.fail("no", "refused", 3)

    @operation(guard="positive")
    def take(self) -> None:
        self.update_property("count", self.value("count") - 1)

    def positive(self) -> bool:
        return bool(self.value("count") > 0)

    @operation(pausable=True)
    async def drive(self, seconds: float) -> None:
        while seconds > 0:
            await self.sleep(1)
            await self.pause_point()
            seconds -= 1


class Lamp(Artifact):
    """Has no operations."""


class Total(Artifact):
    """Offers ``inc`` with any number of arguments."""

    @operation
    def inc(self, *values: int) -> None:
        self.signal("total", sum(values))


TYPES = {cls.__name__: cls for cls in (Counter, Lamp, Total)}


def find_type(name: str) -> type[Artifact]:
    if name not in TYPES:
        raise UnknownArtifactType(name, TYPES)
    return TYPES[name]


class Activity:
    """Counts actions under way."""

    def __init__(self) -> None:
        self.pending = 0

    def begin(self) -> None:
        self.pending += 1

    def end(self) -> None:
        self.pending -= 1


class Robot:
    """An agent whose mind only takes notes.

    Attributes:
        log: what the mind received, in order.
        beliefs: percept beliefs as text, without annotations.
        lines: what the agent printed.
    """

    def __init__(self, name: str, environment: Environment, references: References) -> None:
        self.log: list[str] = []
        self.percepts: list[Percept] = []
        self.completions: dict[int, Completion] = {}
        self.lines: list[str] = []
        self.activity = Activity()
        writer = PerceptWriter(references, environment.workspace)
        self.body = AgentBody(name, self, environment, writer, self.lines.append, self.activity)
        self._acts = 0

    @property
    def beliefs(self) -> list[str]:
        held: list[str] = []
        for percept in self.percepts:
            if percept.kind == "add":
                held.append(text(percept.literal))
            elif percept.kind == "remove":
                held.remove(text(percept.literal))
        return [b for b in held if not b.startswith(("joinedWsp", "focusing"))]

    def perceive(self, percepts: list[Percept]) -> None:
        self.percepts.extend(percepts)
        self.log.extend(f"{p.kind} {text(p.literal)}" for p in percepts)

    def has_untaken(self, name: str) -> bool:
        return False

    def complete(self, act_id: int, completion: Completion) -> None:
        assert act_id not in self.completions
        self.completions[act_id] = completion
        self.log.append("done" if completion.success else "failed")

    def begin(self, term: Term, intention: int = 1) -> int:
        """Begin an action written as a term; the number of the act."""
        self._acts += 1
        annotations = term.annotations if isinstance(term, Annotated) else ()
        bare = term.term if isinstance(term, Annotated) else term
        symbol = functor_of(bare)
        assert symbol is not None
        arguments = bare[1:] if isinstance(bare, tuple) else ()
        self.body.act(Act(self._acts, symbol, arguments, annotations, intention))
        return self._acts

    def do(self, name: str, *arguments: object, intention: int = 1, **directions: object) -> Completion:
        """Do an action that ends at once."""
        act = self.begin(action(name, *arguments, **directions), intention)
        return self.completions[act]

    def ask(self, name: str, *arguments: object, **keywords: object) -> Term:
        """Do an action with one output more than the arguments given; the value of that output."""
        completion = self.do(name, *arguments, Var("X"), **keywords)  # type: ignore[arg-type]
        assert completion.success, text_of(completion)
        (output,) = completion.outputs
        return output[1]

    def make(self, name: str, type_name: str, *parameters: object) -> Term:
        """Make an artifact; its id."""
        return self.ask("makeArtifact", name, type_name, list(parameters))


def term_of(value: object) -> Term:
    """A term from what is handy in tests: texts are strings, lists are lists."""
    if isinstance(value, str) and not isinstance(value, String):
        return String(value)
    if isinstance(value, bool):
        raise TypeError("write TRUE or FALSE")
    if isinstance(value, int):
        return float(value)
    if isinstance(value, list):
        return make_list([term_of(item) for item in value])
    return value


def action(name: str, *arguments: object, **directions: object) -> Term:
    """The term of an action; keywords become annotations."""
    namespace, _, plain_name = name.rpartition("::")
    bare = structure(plain_name, *map(term_of, arguments), namespace=namespace or None)
    if not directions:
        return bare
    return Annotated(bare, tuple((functor(key, 1), term_of(value)) for key, value in directions.items()))


def text_of(completion: Completion) -> str:
    """How an action ended, for comparing."""
    if completion.success:
        return "ok"
    return " ".join(text(a) for a in completion.annotations)


def message_of(completion: Completion) -> str:
    """The message of a failed action."""
    assert not completion.success
    return str(completion.annotations[0][1])


def reason_of(completion: Completion) -> str | None:
    """The reason of a failed action as text; None when it has none."""
    assert not completion.success
    return text(completion.annotations[1][1]) if len(completion.annotations) > 1 else None


def detail_of(completion: Completion) -> str | None:
    """What we tell about a failed action beside its reason; None when there is nothing."""
    found = [a[1] for a in completion.annotations if a[0] is functor("env_failure_detail", 1)]
    return text(found[0]) if found else None


def among_artifacts(test: Callable[..., Coroutine[None, None, None]]) -> Callable[[], None]:
    """Run a test ``async def test(one, two, clock)`` with two agents in one environment, on virtual time."""

    def wrapper() -> None:
        clock = VirtualClock()

        async def main() -> None:
            references = References()
            environment = Environment(clock, {}, find_type)
            await test(Robot("one", environment, references), Robot("two", environment, references), clock)
            await environment.close()

        run(main, clock)

    wrapper.__name__ = test.__name__
    wrapper.__doc__ = test.__doc__
    return wrapper

"""A ported artifact does in Python what it does in Java."""

from collections.abc import Awaitable, Callable, Coroutine
from typing import Any

import pytest
from porting_lab import Loaded, ported

from jacaros.artifacts import Atom, Environment, OperationFailed, Out, Session, Structure
from jacaros.porting import port
from jacaros.runtime.clock import VirtualClock, run

Act = Callable[[Session], Coroutine[Any, Any, None]]
Use = Callable[..., None]


@pytest.fixture
def use(load: Loaded) -> Use:
    """Make the artifact of a Java file with some arguments, and use it."""

    def call(name: str, arguments: tuple[object, ...], act: Act) -> None:
        clock = VirtualClock()
        artifact_type = getattr(load(ported(f"{name}.java").text), name)

        async def main() -> None:
            session = Session(Environment(clock), "bob")
            session.focus(await session.make_artifact("it", artifact_type, arguments))
            await act(session)

        run(main, clock)

    return call


async def result(session: Session, operation: str, *arguments: object) -> object:
    """Return the output of an operation."""
    output: Out[object] = Out()
    await session.act(operation, *arguments, output)
    return output.value


async def reason(operation: Awaitable[object]) -> object:
    """Return the reason for which an operation fails."""
    with pytest.raises(OperationFailed) as failed:
        await operation
    return failed.value.reason


def test_operations_change_fields_and_properties(use: Use) -> None:
    async def act(session: Session) -> None:
        await session.act("put", "cup")
        await session.act("put", "jar")
        assert session.value("count") == 2
        assert await result(session, "get") == "cup"
        assert session.value("count") == 1

    use("Buffer", (3,), act)


def test_guards_hold_an_operation_back(use: Use) -> None:
    async def act(session: Session) -> None:
        await session.act("put", "cup")
        second = session.begin("put", "jar")
        await session.clock.sleep(1)
        assert not second.done
        await result(session, "get")
        await second
        assert session.value("count") == 1

    use("Buffer", (1,), act)


def test_a_property_of_several_values_keeps_the_others(use: Use) -> None:
    async def act(session: Session) -> None:
        await session.act("widen", 7)
        assert session.values("range") == (7, 13)

    use("Buffer", (1,), act)


def test_strings_and_loops(use: Use) -> None:
    async def act(session: Session) -> None:
        await session.act("put", "cup")
        await session.act("put", "cup")
        assert await result(session, "report", "shelf") == "shelf: cup=2, total 2 items"

    use("Buffer", (5,), act)


def test_internal_operations_wait_and_signal(use: Use) -> None:
    async def act(session: Session) -> None:
        signals = []
        session.on_signal(lambda signal: signals.append((signal.name, *signal.arguments)))
        await session.act("put", "cup")
        await session.act("put", "jar")
        began = session.clock.now()
        await session.act("flush")
        await session.act("waitUntilEmpty")
        assert session.clock.now() - began == pytest.approx(0.2)
        assert signals == [("dropped", 1), ("dropped", 0)]

    use("Buffer", (5,), act)


def test_failures_have_their_reasons(use: Use) -> None:
    async def act(session: Session) -> None:
        assert await reason(session.act("flush")) == Structure("empty", ("it",))
        assert await reason(session.act("write", "x")) == Structure("no_journal", ("x",))

    use("Buffer", (5,), act)


def test_integers_are_divided_as_in_java(use: Use) -> None:
    async def act(session: Session) -> None:
        signals = []
        session.on_signal(lambda signal: signals.append(signal.arguments))
        await session.act("start", 5)
        await session.act("start", -5)
        await session.act("start", 1, 2)
        await session.clock.sleep(1)
        assert signals == [(2, -2), (-2, 2), (1, 2)]

    use("Buffer", (5,), act)


@pytest.mark.parametrize(("points", "grade"), [(10, "good"), (9, "good"), (8, "fair"), (3, "poor")])
def test_switches(use: Use, points: int, grade: str) -> None:
    async def act(session: Session) -> None:
        assert await result(session, "grade", points) == grade

    use("Buffer", (5,), act)


def test_what_is_not_ported_fails_with_its_line(use: Use) -> None:
    async def act(session: Session) -> None:
        assert await reason(session.act("save", "x")) == Structure("not_ported", (100,))

    use("Buffer", (5,), act)


def test_an_environment_shows_its_percepts(use: Use) -> None:
    async def act(session: Session) -> None:
        assert session.value("brightness") == 30
        await session.act("press", Atom("on"))
        assert session.value("brightness") == 100
        assert session.has_property("lit")
        await session.act("dim", 100)
        assert session.value("brightness") == 0
        assert not session.has_property("lit")

    use("Lamp", ("30",), act)


def test_an_action_that_java_refuses_fails(use: Use) -> None:
    async def act(session: Session) -> None:
        assert await reason(session.act("dim", 1)) == Structure("action_failed", (Structure("dim", (1,)),))

    use("Lamp", (), act)


def test_an_action_takes_its_time(use: Use) -> None:
    async def act(session: Session) -> None:
        began = session.clock.now()
        await session.act("wait")
        assert session.clock.now() - began == pytest.approx(0.5)

    use("Lamp", (), act)


METERS = {
    "Meter.java": """import cartago.*; public class Meter extends Artifact {
        protected int n = 1;
        void init(int start) { n = start; later(); defineObsProperty("n", n); }
        @OPERATION void read() { n++; getObsProperty("n").updateValue(n); }
        void later() { await_time(10); } }""",
    "Double.java": """public class Double extends Meter {
        int factor = 2;
        void init(int start) { super.init(start + 1); n = n * factor; }
        @OPERATION void readTwice() { read(); later(); read(); } }""",
    "Steps.java": """public class Steps extends Meter {
        int step = 5;
        @OPERATION void jump() { n += step; read(); } }""",
    "Screen.java": """public class Screen extends GUIArtifact {
        public void setup() { defineObsProperty("n", 7); }
        @OPERATION void read() { getObsProperty("n").updateValue(8); } }""",
}


@pytest.mark.parametrize(
    ("name", "arguments", "operation", "value"),
    [
        ("Double", (3,), "readTwice", 10),
        ("Double", (3,), "read", 9),
        ("Steps", (3,), "jump", 9),
        ("Screen", (), "read", 8),
    ],
)
def test_an_artifact_keeps_what_it_inherits(
    load: Loaded, name: str, arguments: tuple[int, ...], operation: str, value: int
) -> None:
    clock = VirtualClock()
    done = port(f"{name}.java", METERS[f"{name}.java"], METERS.get)
    assert not done.left
    artifact_type = getattr(load(done.text), name)

    async def main() -> None:
        session = Session(Environment(clock), "bob")
        session.focus(await session.make_artifact("it", artifact_type, arguments))
        await session.act(operation)
        assert session.value("n") == value

    run(main, clock)

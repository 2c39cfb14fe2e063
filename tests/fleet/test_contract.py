"""Two systems of a fleet, over a simulated network and over Zenoh: a carrier is good enough if these tests pass."""

import asyncio
from collections.abc import Awaitable, Callable, Sequence
from secrets import token_hex

import pytest
from queues import SimulatedNetwork

import jacaros
from jacaros import GoalFailed, Mas
from jacaros.agents.mind.state.plan import Failure
from jacaros.artifacts import Artifact, Atom, OperationFailed, Out, Structure, link, operation
from jacaros.fleet import protocol
from jacaros.fleet.carrier import Carrier
from jacaros.fleet.joining import joining
from jacaros.fleet.member import Member
from jacaros.fleet.network import Network
from jacaros.fleet.on_zenoh import ZenohCarrier
from jacaros.runtime.clock import clock_of


class Counter(Artifact):
    """Counts, fails, waits, and passes on."""

    ports = ("next",)

    def init(self, start: int = 0) -> None:
        self.define_property("count", start)

    @operation
    def inc(self, by: int = 1) -> None:
        self.update_property("count", self.value("count") + by)
        self.signal("tick", Structure("by", (by,)))

    @operation
    def check(self, limit: int, left: Out, names: Out) -> None:
        if self.value("count") > limit:
            self.fail("too many", "too_many", self.value("count"))
        left.set(limit - self.value("count"))
        names.set(["a", Structure("p", (1, [2]))])

    @operation
    async def drive(self) -> None:
        try:
            self.define_property("driving")
            await self.sleep(1000)
        finally:
            self.remove_property("driving")

    @operation(name="pass")
    async def pass_on(self) -> None:
        await self.call_linked("next", "take", 5)

    @operation
    def opaque(self, made: Out) -> None:
        made.set(object())

    @operation
    def fill(self, made: Out) -> None:
        made.set("x" * protocol.LARGEST)

    @link
    def take(self, number: int) -> None:
        self.update_property("count", number)


Carriers = Callable[[str], Carrier]
"""Returns the access of a member to the network."""


def simulated() -> Carriers:
    """The network of the tests."""
    network = SimulatedNetwork(clock_of(asyncio.get_running_loop()))
    return lambda name: network.carrier()


def over_zenoh() -> Carriers:
    """Zenoh, on this computer alone."""
    fleet = f"contract-{token_hex(4)}"
    return lambda name: ZenohCarrier(Network(fleet, name))


class Joined:
    """Two members of a fleet."""

    def __init__(self, here: Mas, there: Mas) -> None:
        self.here, self.there = here, there
        self.lines: list[str] = []
        self.warnings: list[str] = []

    async def settled(self, holds: Callable[[], bool] = lambda: True) -> None:
        """Let everything arrive, until something holds."""
        for _ in range(200):
            await self.here.sleep(0.05)
            for mas in (self.here, self.there):
                await mas.until_idle(timeout=10)
            if holds():
                return
        raise AssertionError(f"it does not become true: {self.lines} {self.warnings}")

    async def shared(self) -> None:
        """Create a workspace with a counter *here*, and wait until *there* knows it."""
        self.here.add_artifact_types(Counter)
        lab = self.here.create_workspace("lab")
        await self.here.make_artifact("counter", Counter, [1], workspace=lab)
        await self.settled(lambda: "/main/lab" in [each.path for each in self.there.environment.workspaces()])


def joined(
    test: Callable[[Joined], Awaitable[None]], carriers: Callable[[], Carriers], prints: Sequence[str] | None
) -> None:
    """Run a test with two members of a fleet; their agents print some lines."""
    lines: list[str] = []
    warnings: list[str] = []

    def printed(agent: str, text: str) -> None:
        if not agent.startswith("[fleet]"):
            lines.append(f"[{agent}] {text}")
        elif text == "warning":
            warnings.append(agent.removeprefix("[fleet] "))

    def mas(name: str, seed: int, carrier: Carrier, members: list[Member]) -> Mas:
        join = joining(carrier, name, joined=members.append)
        return Mas(name=name, seed=seed, on_print=printed, on_log=printed, join=join)

    async def main() -> None:
        carrier = carriers()
        members: list[Member] = []
        async with (
            mas("here", 1, carrier("here"), members) as here,
            mas("there", 2, carrier("there"), members) as there,
        ):
            two = Joined(here, there)
            two.lines, two.warnings = lines, warnings
            await two.settled(
                lambda: all(any(peer.picture for peer in each.peers.values()) for each in members)
            )
            await test(two)

    jacaros.run(main(), clock="fast" if carriers is simulated else "real")
    assert prints is None or lines == prints


def on_both(
    prints: Sequence[str] | None = None,
) -> Callable[[Callable[[Joined], Awaitable[None]]], Callable[..., None]]:
    """Make a test of a coroutine function, for each carrier."""

    def as_test(scene: Callable[[Joined], Awaitable[None]]) -> Callable[..., None]:
        @pytest.mark.parametrize("carriers", [simulated, over_zenoh])
        def test(carriers: Callable[[], Carriers]) -> None:
            joined(scene, carriers, prints)

        test.__name__, test.__doc__ = scene.__name__, scene.__doc__
        return test

    return as_test


@on_both(["[ann] [ann,bob]", "[ann] weather(fine)[source(bob)]", "[bob] ann"])
async def test_agents_of_two_systems_talk(two) -> None:
    ann = two.here.add_agent(
        "ann",
        """
        +!go <- .all_names(L); .print(L); .send(bob, tell, color(box, "dark red", [1, p(X)]));
                .send(bob, askOne, weather(W), A); .print(A); .broadcast(tell, done).
        """,
    )
    bob = two.there.add_agent("bob", "weather(fine). +done[source(S)] <- .print(S).")
    await two.settled()
    await ann.achieve("go").wait(timeout=9)
    await bob.until("done[source(ann)]", timeout=1)
    assert bob.believes('color(box, "dark red", [1, p(_)])[source(ann)]')
    await two.settled()


@on_both(
    [
        "[ann] receiver_not_found",
        "[[ann] warning: message did not reach bob@there (receiver_not_found): hello] warning",
    ],
)
async def test_a_message_that_does_not_arrive_comes_back(two) -> None:
    program = """
        +!ask <- .send("bob@there", askOne, p(X), A); .print(A).
        -!ask[error(E)] <- .print(E).
        +!say <- .send("bob@there", tell, hello).
    """
    ann = two.here.add_agent("ann", program)
    await ann.achieve("ask").wait(timeout=9)
    await ann.achieve("say")
    await two.settled()


@on_both()
async def test_agents_that_come_and_go_are_known(two) -> None:
    bob = two.there.add_agent("bob", "")
    directory = two.here.system.directory
    await two.settled(lambda: directory.names() == ("bob",))
    assert directory.free_name("bob") == "bob_1"
    bob.kill()
    await two.settled(lambda: directory.names() == ())


@on_both(["[bob] both", "[bob] both"])
async def test_a_name_of_two_systems_is_reported_and_written_in_full(two) -> None:
    program = "+both <- .print(both)."
    two.here.add_agent("bob", program)
    two.there.add_agent("bob", program)
    ann = two.there.add_agent("ann", '+!go <- .send("bob@here", tell, both); .send(bob, tell, both).')
    await two.settled(lambda: len(two.here.system.directory.names()) == 3)
    assert sorted(two.here.system.directory.names()) == ["ann", "bob", "bob@there"]
    await ann.achieve("go").wait(timeout=9)
    await two.settled()
    clash = "the name of agent bob is not unique in the fleet: write bob@here and bob@there; here, `bob` is"
    assert sorted(two.warnings) == [f"{clash} bob@here", f"{clash} bob@there"]


@on_both(["[bob] [ann]"])
async def test_services_of_both_are_found(two) -> None:
    ann = two.here.add_agent("ann", "!go. +!go <- .df_subscribe(taxi); .df_register(cleaning).")
    await two.settled()
    bob = two.there.add_agent("bob", "+!go <- .df_register(taxi); .df_search(cleaning, L); .print(L).")
    await two.settled()
    await bob.achieve("go").wait(timeout=9)
    assert await ann.until('provider(A, "taxi")', timeout=1) == {"A": Atom("bob")}
    assert list(two.here.system.services.providers("taxi")) == ["bob"]
    await two.settled()
    assert list(two.there.system.services.providers("taxi")) == ["bob"]


@on_both(
    [
        *("[bob] focused 1", "[bob] by(1)counter/main/lab", "[bob] after inc 2", '[bob] 3["a",p(1,[2])]'),
        *("[bob] by(10)counter/main/lab", "[bob] too many: too_many(12)"),
    ],
)
async def test_an_agent_uses_an_artifact_of_the_other_system(two) -> None:
    await two.shared()
    bob = two.there.add_agent(
        "bob",
        """
        +!go <- joinWorkspace("/main/lab", W); lookupArtifact("counter", Id); focus(Id);
                ?count(N); .print("focused ", N);
                inc; ?count(M); .print("after inc ", M);
                check(5, Left, Names); .print(Left, Names);
                inc(10); check(5, _, _).
        -!go[error_msg(M), env_failure_reason(R)] <- .print(M, ": ", R).
        +tick(B)[artifact_name(A), workspace(W, _)] <- .print(B, A, W).
        """,
    )
    await bob.achieve("go").wait(timeout=9)
    assert await bob.until("count(X)") == {"X": 12}
    assert two.here.system.environment is not None
    there_seen = bob.ask("focusing(_, N, T, _, W, P)")
    assert there_seen == {"N": "counter", "T": "Counter", "W": "lab", "P": "/main/lab"}


@on_both()
async def test_both_sides_see_the_same_artifact(two) -> None:
    await two.shared()
    ann = two.here.add_agent("ann", "", focus=["lab/counter"])
    bob = two.there.add_agent("bob", "+!go <- inc(4).", join=["/main/lab"])
    await bob.achieve("go").wait(timeout=9)
    assert await ann.until("count(X) & X > 1", timeout=1) == {"X": 5}


@on_both(
    ["[bob] gone7", "[bob] 5", '[bob] makeArtifactFailure("init_failed","third")', "[bob] gone5"],
)
async def test_making_linking_and_disposing_reach_the_other_system(two) -> None:
    await two.shared()
    remote = two.there.environment.workspace("/main/lab")
    bob = two.there.add_agent(
        "bob",
        """
        +!make <- joinWorkspace("/main/lab"); makeArtifact("second", "Counter", [7], Id); focus(Id);
                  lookupArtifact("counter", First); linkArtifacts(First, "next", Id);
                  pass[artifact_id(First)]; ?count(N); .print(N).
        +!wrong <- makeArtifact("third", "Counter", [far]).
        -!wrong[env_failure_reason(R)] <- .print(R).
        +!drop <- lookupArtifact("second", Id); disposeArtifact(Id).
        -count(N) <- .print(gone, N).
        """,
    )
    await bob.achieve("make").wait(timeout=9)
    second = remote.lookup("second")
    assert (second.creator, second.workspace) == ("bob", "/main/lab")
    await bob.achieve("wrong").wait(timeout=9)
    await bob.achieve("drop").wait(timeout=9)
    await bob.until("not count(_)", timeout=1)
    assert not bob.believes("focusing(_, second, _, _, _, _)")
    with pytest.raises(OperationFailed):
        remote.lookup("second")


@on_both()
async def test_operations_of_the_other_system_are_cancelled(two) -> None:
    await two.shared()
    bob = two.there.add_agent("bob", "+!go <- drive.", join=["/main/lab"])
    ann = two.here.add_agent("ann", "", focus=["lab/counter"])
    goal = bob.achieve("go")
    await ann.until("driving", timeout=1)
    goal.drop()
    await ann.until("not driving", timeout=1)
    pending = bob.achieve("go")
    await ann.until("driving", timeout=1)
    environment = two.here.environment
    lab = environment.workspace("/main/lab")
    lab.dispose_artifact(lab.lookup("counter"))
    with pytest.raises(GoalFailed) as failed:
        await pending.wait(timeout=1)
    assert failed.value.reason("env_failure_reason").functor == "artifact_disposed"  # type: ignore[attr-defined]


@on_both()
async def test_stopping_to_focus_and_killing_reach_the_other_system(two) -> None:
    await two.shared()
    lab = two.here.environment.workspace("/main/lab")
    counter = lab.lookup("counter")
    bob = two.there.add_agent(
        "bob",
        '+!go <- joinWorkspace("/main/lab"); lookupArtifact("counter", Id); focus(Id). '
        '+!stop <- lookupArtifact("counter", Id); stopFocus(Id).',
    )
    await bob.achieve("go").wait(timeout=9)
    assert [observer.agent for observer in lab.observers(counter)] == ["bob"]  # type: ignore[attr-defined]
    await bob.achieve("stop").wait(timeout=9)
    await bob.until("not count(_)", timeout=1)
    await two.settled(lambda: lab.observers(counter) == ())  # type: ignore[attr-defined]
    assert lab.observers(counter) == ()  # type: ignore[attr-defined]
    await bob.achieve("go").wait(timeout=9)
    bob.kill()
    await two.settled()
    assert lab.observers(counter) == ()  # type: ignore[attr-defined]


@on_both()
async def test_python_code_uses_an_artifact_of_the_other_system(two) -> None:
    await two.shared()
    painter = two.there.session("painter", workspace="/main/lab")
    assert await painter.act("check", 3, Out(), Out()) == (2, ["a", Structure("p", (1, [2]))])
    painter.focus("counter")
    await painter.act("inc")
    assert painter.value("count") == 2
    with pytest.raises(OperationFailed, match="too many"):
        await painter.act("check", 0, Out(), Out())


_REFUSED = '[[ann] warning: message did not reach bob (not_permitted): "+!lesson <- .print(taught)."] warning'


@on_both(["[ann] timeout", "[ann] [weather(fine)[source(bob)]]", "[ann] learned", _REFUSED])
async def test_questions_and_plans_cross(two) -> None:
    ann = two.here.add_agent(
        "ann",
        """
        +!go <- .send(bob, askOne, never(X), A, 100); .print(A);
                .send(bob, askAll, weather(_), L); .print(L);
                .send(bob, askHow, {+!trick}, P); .add_plan(P); !trick;
                .send(bob, tellHow, "+!lesson <- .print(taught).").
        """,
    )
    two.there.add_agent("bob", "weather(fine). +!trick <- .print(learned). +?never(X) <- .wait(5000).")
    await two.settled(lambda: "bob" in two.here.system.directory.names())
    await ann.achieve("go").wait(timeout=9)
    await two.settled(lambda: len(two.lines) == 4)
    assert two.warnings == ["here: refused a message: it lacks the right `tell_how` (--fleet-allow)"]


_UNSENDABLE = (
    "a value of the class object cannot be sent to another system: send its parts (numbers, strings, atoms, "
)


@on_both([f"[ann] {_UNSENDABLE}structures, lists, maps)", '[bob] not_sendable("object")'])
async def test_what_cannot_cross_fails_with_its_class(two) -> None:
    await two.shared()
    ann = two.here.add_agent(
        "ann",
        """
        +!go <- joinWorkspace("/main/lab"); opaque(O); .send("bob@there", tell, got(O)).
        -!go[error(not_sendable), error_msg(M)] <- .print(M).
        """,
    )
    bob = two.there.add_agent(
        "bob", "+!go <- opaque(_). -!go[env_failure_reason(R)] <- .print(R).", join=["/main/lab"]
    )
    await ann.achieve("go").wait(timeout=9)
    await bob.achieve("go").wait(timeout=9)


@on_both()
async def test_what_is_too_large_fails_and_delays_nothing(two) -> None:
    await two.shared()
    bob = two.there.add_agent("bob", "")
    await two.settled()
    painter = two.there.session("painter", workspace="/main/lab")
    large = "x" * protocol.LARGEST
    with pytest.raises(OperationFailed, match="more than 32 MiB"):
        await painter.act("inc", large)
    with pytest.raises(OperationFailed, match="more than 32 MiB"):
        await painter.act("fill", Out())
    with pytest.raises(Failure):
        two.here.send("bob@there", "tell", Structure("picture", (large,)))
    two.here.send("bob@there", "tell", "small")
    await bob.until("small", timeout=5)


@on_both()
async def test_a_remote_workspace_gives_way_to_one_of_its_path(two) -> None:
    await two.shared()
    bob = two.there.add_agent(
        "bob",
        """
        +!go <- createWorkspace("/main/lab"); joinWorkspace("/main/lab", Lab); getCurrentArtifacts(Own); .print(Own).
        +!far <- joinWorkspace("/main/lab@here", _); lookupArtifact("counter", Id); focus(Id); inc[artifact_id(Id)].
        """,
    )
    await bob.achieve("go").wait(timeout=9)
    await two.settled(lambda: "/main/lab@here" in [each.path for each in two.there.environment.workspaces()])
    await bob.achieve("far").wait(timeout=9)
    assert await bob.until("count(X) & X > 1", timeout=9) == {"X": 2}
    assert not any("counter" in line for line in two.lines)

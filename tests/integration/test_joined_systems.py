"""Two systems that talk and share artifacts over a queue, as two processes would: the ports are enough for that."""

from collections.abc import Awaitable, Callable, Sequence

import pytest
from loopback import RemoteWorkspace, join, share

import jacaros
from jacaros import GoalFailed, Mas
from jacaros.artifacts import Artifact, Atom, OperationFailed, Out, Structure, link, operation
from played import played


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

    @link
    def take(self, number: int) -> None:
        self.update_property("count", number)


class Joined:
    """Two systems that are joined."""

    def __init__(self, here: Mas, there: Mas) -> None:
        self.here, self.there = here, there
        self.first, self.second = join(here.system, there.system)

    async def settled(self) -> None:
        """Let lines arrive."""
        for mas in (self.here, self.there):
            await mas.sleep(0.01)
            await mas.until_idle(timeout=10)

    async def shared(self) -> RemoteWorkspace:
        """A workspace of *here* with a counter, seen from *there* as /main/far."""
        self.here.add_artifact_types(Counter)
        lab = self.here.create_workspace("lab")
        await self.here.make_artifact("counter", Counter, [1], workspace=lab)
        remote = share(self.first, self.second, lab, "/main/far")
        await self.settled()
        return remote


def joined(test: Callable[[Joined], Awaitable[None]], prints: Sequence[str] | None = None) -> None:
    """Run a test with two systems that are joined; their agents print some lines."""
    lines: list[str] = []

    def printed(agent: str, text: str) -> None:
        lines.append(f"[{agent}] {text}")

    async def main() -> None:
        async with (
            Mas(name="here", seed=1, on_print=printed, on_log=printed) as here,
            Mas(name="there", seed=2, on_print=printed, on_log=printed) as there,
        ):
            await test(Joined(here, there))

    jacaros.run(main(), clock="fast")
    assert prints is None or lines == prints


@played(joined, prints=["[ann] [ann,bob]", "[ann] weather(fine)[source(bob)]", "[bob] ann"])
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


@played(
    joined,
    prints=[
        "[ann] receiver_not_found",
        "[[ann] warning: message did not reach bob: hello] warning",
        "[ann] receiver_not_found",
    ],
)
async def test_a_message_that_does_not_arrive_comes_back(two) -> None:
    program = """
        +!ask <- .send(bob, askOne, p(X), A); .print(A).
        -!ask[error(E)] <- .print(E).
        +!say <- .send(bob, tell, hello).
    """
    ann = two.here.add_agent("ann", program)
    two.first.agents.know("bob", True)  # outdated information
    await ann.achieve("ask").wait(timeout=9)
    await ann.achieve("say")
    await two.settled()
    two.first.agents.know("bob", False)
    await ann.achieve("ask").wait(timeout=9)


@played(joined)
async def test_agents_that_come_and_go_are_known(two) -> None:
    bob = two.there.add_agent("bob", "")
    await two.settled()
    with pytest.raises(jacaros.JacarosError, match="duplicate agent name `bob`"):
        two.here.add_agent("bob", "")
    assert two.here.system.directory.free_name("bob") == "bob_1"
    bob.kill()
    await two.settled()
    assert two.first.agents.names() == ()
    two.here.add_agent("bob", "")


@played(joined, prints=["[bob] [ann]"])
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


@played(
    joined,
    prints=[
        *("[bob] focused 1", "[bob] by(1)counter/main/far", "[bob] after inc 2", '[bob] 3["a",p(1,[2])]'),
        *("[bob] by(10)counter/main/far", "[bob] too many: too_many(12)"),
    ],
)
async def test_an_agent_uses_an_artifact_of_the_other_system(two) -> None:
    await two.shared()
    bob = two.there.add_agent(
        "bob",
        """
        +!go <- joinWorkspace("/main/far", W); lookupArtifact("counter", Id); focus(Id);
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
    assert there_seen == {"N": "counter", "T": "Counter", "W": "far", "P": "/main/far"}


@played(joined)
async def test_both_sides_see_the_same_artifact(two) -> None:
    await two.shared()
    ann = two.here.add_agent("ann", "", focus=["lab/counter"])
    bob = two.there.add_agent("bob", "+!go <- inc(4).", join=["/main/far"])
    await bob.achieve("go").wait(timeout=9)
    assert await ann.until("count(X) & X > 1", timeout=1) == {"X": 5}


@played(
    joined,
    prints=["[bob] gone7", "[bob] 5", '[bob] makeArtifactFailure("init_failed","third")', "[bob] gone5"],
)
async def test_making_linking_and_disposing_reach_the_other_system(two) -> None:
    remote = await two.shared()
    bob = two.there.add_agent(
        "bob",
        """
        +!make <- joinWorkspace("/main/far"); makeArtifact("second", "Counter", [7], Id); focus(Id);
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
    assert (second.creator, second.workspace) == ("bob", "/main/far")
    await bob.achieve("wrong").wait(timeout=9)
    await bob.achieve("drop").wait(timeout=9)
    await bob.until("not count(_)", timeout=1)
    assert not bob.believes("focusing(_, second, _, _, _, _)")
    with pytest.raises(OperationFailed):
        remote.lookup("second")


@played(joined)
async def test_operations_of_the_other_system_are_cancelled(two) -> None:
    await two.shared()
    bob = two.there.add_agent("bob", "+!go <- drive.", join=["/main/far"])
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


@played(joined)
async def test_stopping_to_focus_and_killing_reach_the_other_system(two) -> None:
    await two.shared()
    lab = two.here.environment.workspace("/main/lab")
    counter = lab.lookup("counter")
    bob = two.there.add_agent(
        "bob",
        '+!go <- joinWorkspace("/main/far"); lookupArtifact("counter", Id); focus(Id). '
        '+!stop <- lookupArtifact("counter", Id); stopFocus(Id).',
    )
    await bob.achieve("go").wait(timeout=9)
    assert [observer.agent for observer in lab.observers(counter)] == ["bob"]  # type: ignore[attr-defined]
    await bob.achieve("stop").wait(timeout=9)
    await bob.until("not count(_)", timeout=1)
    assert lab.observers(counter) == ()  # type: ignore[attr-defined]
    await bob.achieve("go").wait(timeout=9)
    bob.kill()
    await two.settled()
    assert lab.observers(counter) == ()  # type: ignore[attr-defined]


@played(joined)
async def test_python_code_uses_an_artifact_of_the_other_system(two) -> None:
    await two.shared()
    painter = two.there.session("painter", workspace="/main/far")
    assert await painter.act("check", 3, Out(), Out()) == (2, ["a", Structure("p", (1, [2]))])
    painter.focus("counter")
    await painter.act("inc")
    assert painter.value("count") == 2
    with pytest.raises(OperationFailed, match="too many"):
        await painter.act("check", 0, Out(), Out())

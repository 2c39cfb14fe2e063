"""A Python program exchanges messages with agents."""

import pytest
from embedding_lab import run

from jacaros import Atom, Mas, Structure
from jacaros.runtime.errors import UsageError
from jacaros.runtime.mas.embedding.mailbox import Mailbox
from jacaros.runtime.mas.embedding.waits import UnknownAgent
from played import played


def test_python_code_has_mailboxes() -> None:
    async def test(mas: Mas) -> None:
        me = mas.mailbox("me")
        assert mas.mailbox("me") is me
        bob = mas.add_agent(
            "bob",
            """
            +!report(X)[source(S)] <- .send(S, tell, done(X)); .broadcast(tell, bye).
            color(box, red). color(ball, blue).
            +?sum(A, B, C) <- C = A + B.
            +!ask <- .send(me, askOne, weather(W), Answer, 5000); .print(Answer).
            """,
        )
        me.send("bob", "achieve", Structure("report", ("x y",)))
        first, second = [await me.get(timeout=1) for _ in range(2)]
        assert (first.sender, first.performative, first.content.functor) == ("bob", "tell", "done")
        assert second.content.functor == "bye"
        assert await me.ask("bob", "color(ball, C)") == {"C": Atom("blue")}
        assert await me.ask_all("bob", "color(X, C)") == [
            {"X": Atom("box"), "C": Atom("red")},
            {"X": Atom("ball"), "C": Atom("blue")},
        ]
        assert await me.ask("bob", "sum(1, 2, X)") == {"X": 3}
        assert await me.ask("bob", "color(cup, C)") is None
        assert len(me) == 0
        asking = bob.achieve("ask")
        question = await me.get()
        me.send(question.sender, "tell", "weather(fine)", reply_to=question)
        await asking
        with pytest.raises(UnknownAgent, match="unknown agent `bobb`; did you mean `bob`"):
            me.send("bobb", "tell", "x")
        with pytest.raises(TimeoutError, match="no message for me within 1 s"):
            await me.get(timeout=1)
        with pytest.raises(
            UsageError, match="duplicate name `bob`: an agent has it; choose another name for the mailbox"
        ):
            mas.mailbox("bob")

    lines: list[str] = []
    run(test, lines)
    assert lines == ["[bob] weather(fine)[source(me)]"]


@played(run)
async def test_messages_are_iterated_as_they_arrive(mas: Mas) -> None:
    me = mas.mailbox("me")
    mas.add_agent(
        "bob", "!go. +!go <- for (.range(I, 1, 3)) { .wait(1000); .send(me, tell, n(I)) }; .stopMAS."
    )
    numbers = [message.content.arguments[0] async for message in me]
    assert numbers == [1, 2, 3]


@played(run)
async def test_the_names_of_mailboxes_are_known_to_agents(mas: Mas) -> None:
    box: Mailbox = mas.mailbox("me")
    bob = mas.add_agent("bob", "+!go <- .all_names(L); +names(L).")
    assert repr(box) == "<mailbox me, 0 messages>"
    await bob.achieve("go")
    assert bob.ask("names(L)") == {"L": [Atom("bob"), Atom("me")]}

"""A Python program exchanges messages with agents."""

import pytest

from jacaros import Atom, Mas, Structure
from jacaros.runtime.errors import UsageError
from jacaros.runtime.mas.embedding.mailbox import Mailbox
from jacaros.runtime.mas.embedding.waits import UnknownAgent


async def test_python_code_has_mailboxes(mas: Mas, lines: list[str]) -> None:
    me = mas.mailbox("me")
    assert mas.mailbox("me") is me
    program = """
        +!report(X)[source(S)] <- .send(S, tell, done(X)); .broadcast(tell, bye).
        color(box, red). color(ball, blue).
        +?sum(A, B, C) <- C = A + B.
        +!ask <- .send(me, askOne, weather(W), Answer, 5000); .print(Answer).
    """
    bob = mas.add_agent("bob", program)
    me.send("bob", "achieve", Structure("report", ("x y",)))
    first, second = [await me.get(timeout=1) for _ in range(2)]
    assert (first.sender, first.performative, first.content.functor) == ("bob", "tell", "done")
    assert second.content.functor == "bye"
    assert await me.ask("bob", "color(ball, C)") == {"C": Atom("blue")}
    assert await me.ask("bob", "sum(1, 2, X)") == {"X": 3}
    assert await me.ask("bob", "color(cup, C)") is None
    assert len(me) == 0
    asking = bob.achieve("ask")
    question = await me.get()
    me.send(question.sender, "tell", "weather(fine)", reply_to=question)
    await asking
    assert lines == ["[bob] weather(fine)[source(me)]"]
    with pytest.raises(UnknownAgent, match="unknown agent `bobb`; did you mean `bob`"):
        me.send("bobb", "tell", "x")
    with pytest.raises(TimeoutError, match="no message for me within 1 s"):
        await me.get(timeout=1)
    told = "duplicate name `bob`: an agent has it; choose another name for the mailbox"
    with pytest.raises(UsageError, match=told):
        mas.mailbox("bob")


async def test_the_names_of_mailboxes_are_known_to_agents(mas: Mas) -> None:
    box: Mailbox = mas.mailbox("me")
    bob = mas.add_agent("bob", "+!go <- .all_names(L); +names(L).")
    assert repr(box) == "<mailbox me, 0 messages>"
    await bob.achieve("go")
    assert bob.ask("names(L)") == {"L": [Atom("bob"), Atom("me")]}


async def test_messages_are_iterated_as_they_arrive(mas: Mas) -> None:
    me = mas.mailbox("me")
    program = "!go. +!go <- for (.range(I, 1, 3)) { .wait(1000); .send(me, tell, n(I)) }; .stopMAS."
    mas.add_agent("bob", program)
    numbers = [message.content.arguments[0] async for message in me]
    assert numbers == [1, 2, 3]

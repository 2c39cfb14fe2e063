"""Messages and the directory of agents."""

import pytest

from jacaros.bdi.speech_act import SpeechAct
from jacaros.mas.directory import Directory
from jacaros.mas.mailboxes import Mailboxes
from jacaros.terms.text import text
from jacaros.terms.values import Term, Var, atom, structure


def said(content: Term, receiver: str = "bob") -> SpeechAct:
    return SpeechAct("tell", "ann", receiver, content, "mid1")


def test_messages_arrive_in_order() -> None:
    inbox: list[SpeechAct] = []
    mailboxes = Mailboxes({"bob": inbox.append}.get)
    for name in ("one", "two", "three"):
        assert mailboxes.deliver(said(atom(name)))
    assert [text(message.content) for message in inbox] == ["one", "two", "three"]


def test_nobody_gets_a_message_for_an_unknown_agent() -> None:
    assert not Mailboxes(lambda name: None).deliver(said(atom("x"), "nobody"))


def test_variables_are_renamed_apart() -> None:
    inbox: list[SpeechAct] = []
    variable = Var("X")
    Mailboxes({"bob": inbox.append}.get).deliver(said(structure("p", variable, variable)))
    _, first, second = inbox[0].content
    assert first is second
    assert first is not variable


def test_agents_are_listed_in_the_order_of_their_making() -> None:
    directory: Directory[int] = Directory()
    for number, name in enumerate(("c", "a", "b")):
        directory.add(name, number)
    assert directory.remove("a") == 1
    assert directory.remove("a") is None
    assert list(directory.names()) == ["c", "b"]
    assert list(directory) == [0, 2]
    assert len(directory) == 2
    assert directory.find("c") == 0
    assert directory.find("a") is None


def test_a_taken_name_gets_a_number() -> None:
    directory: Directory[int] = Directory()
    directory.add("a", 1)
    assert directory.free_name("b") == "b"
    assert directory.free_name("a") == "a_1"
    directory.add("a_1", 2)
    assert directory.free_name("a") == "a_2"
    with pytest.raises(ValueError, match="there is an agent a already"):
        directory.add("a", 3)

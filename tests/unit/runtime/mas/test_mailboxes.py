"""Messages and the directory of agents."""

from typing import Any

import pytest

from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.mind.state.plan import Failure
from jacaros.agents.terms.collections import SetValue
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import Term, Var, atom, structure
from jacaros.runtime.mas.directory import Directory, Mailboxes


def said(content: Term, receiver: str = "bob") -> SpeechAct:
    return SpeechAct("tell", "ann", receiver, content, "mid1")


class Box:
    """Keeps what arrives."""

    def __init__(self) -> None:
        self.messages: list[SpeechAct] = []

    def receive(self, message: SpeechAct) -> None:
        self.messages.append(message)


def test_messages_arrive_in_order_and_only_at_known_agents() -> None:
    bob = Box()
    mailboxes = Mailboxes({"bob": bob}.get)
    for name in ("one", "two", "three"):
        assert mailboxes.deliver(said(atom(name)))
    assert [text(message.content) for message in bob.messages] == ["one", "two", "three"]
    assert not Mailboxes(lambda name: None).deliver(said(atom("x"), "unknown"))


def test_variables_are_renamed_apart_and_collections_copied_unless_a_content_is_flat() -> None:
    bob = Box()
    variable = Var("X")
    Mailboxes({"bob": bob}.get).deliver(said(structure("p", variable, variable)))
    _, first, second = bob.messages[0].content
    assert first is second
    assert first is not variable
    bob = Box()
    shared = SetValue()
    Mailboxes({"bob": bob}.get).deliver(said(structure("p", shared)))
    (message,) = bob.messages
    assert message.content[1] is not shared
    assert (message.performative, message.sender) == ("tell", "ann")
    assert (message.receiver, message.id) == ("bob", "mid1")
    bob = Box()
    message = SpeechAct("tell", "ann", "bob", structure("p", 1.0), 7, flat=True)
    Mailboxes({"bob": bob}.get).deliver(message)
    assert bob.messages == [message]


def test_the_id_of_a_message_names_its_sender() -> None:
    assert SpeechAct("tell", "ann", "bob", atom("x"), 7).id == "mid7_ann"
    assert SpeechAct("tell", "self", "bob", atom("x"), 7).id == "mid7_bob"
    assert SpeechAct("tell", "ann", "bob", atom("x"), "mid3").id == "mid3"


def test_agents_are_listed_in_the_order_of_creation() -> None:
    directory: Any = Directory()
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
    directory: Any = Directory()
    directory.add("a", 1)
    assert directory.free_name("b") == "b"
    assert directory.free_name("a") == "a_1"
    directory.add("a_1", 2)
    assert directory.free_name("a") == "a_2"
    with pytest.raises(ValueError, match="duplicate agent name `a`"):
        directory.add("a", 3)


def test_the_step_that_sends_to_a_full_mailbox_fails_and_a_report_to_one_is_dropped() -> None:
    class Full:
        def receive(self, message: SpeechAct) -> None:
            raise Failure((atom("mailbox_limit"),))

    mailboxes = Mailboxes({"ann": Full(), "bob": Full()}.get)
    with pytest.raises(Failure):
        mailboxes.deliver(said(atom("x")))
    mailboxes.returned(said(atom("x")))

"""The directory facilitator: who provides what, who hears of it, and how often."""

import pytest

from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.terms.text import text
from jacaros.runtime.mas.directory import ServiceDirectory
from jacaros.testing import AgentHarness


class Delivered(list[tuple[str, str]]):
    """The receiver and the content of each message."""

    def deliver(self, message: SpeechAct) -> bool:
        self.append((message.receiver, text(message.content)))
        return True


@pytest.fixture
def delivered() -> Delivered:
    return Delivered()


@pytest.fixture
def services(delivered: Delivered) -> ServiceDirectory:
    def make() -> Mind:
        return AgentHarness("", name="df").mind

    return ServiceDirectory(make, delivered.deliver)


def test_copies_of_the_directory_hear_of_each_beginning_and_end(services: ServiceDirectory) -> None:
    changes: list[tuple[str, str, bool]] = []
    end = services.watch(lambda *change: changes.append(change))
    services.register("bob", "lift")
    services.register("bob", "lift")
    assert changes == [("bob", "lift", True)]
    services.deregister("bob", "lift")
    assert changes[1:] == [("bob", "lift", False)]
    assert list(services.providers("lift")) == []
    end()
    services.register("bob", "lift")
    assert len(changes) == 2

"""A policy for what goes first is one class: it overrides a selection function, and nothing else knows of it."""

import pytest
from recording_host import RecordingHost, mind

from jacaros.agents.mind.rules.urgency import Fair
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.mind.state.circumstance import Selections
from jacaros.agents.mind.state.intention import Event, Intention
from jacaros.agents.terms.values import structure

GOALS = "!go(1). !go(2). !go(3). +!go(N) <- .print(N); .print(N)."


class NewestEventFirst(Fair):
    """Takes up the event that came last."""

    def select_event(self) -> Event | None:
        events = self.agent.events
        return events.pop() if events else None


class LongestFirst(Fair):
    """Continues the running intention until it is over."""

    def select_intention(self) -> Intention | None:
        intentions = self.agent.intentions
        if not intentions:
            return None
        chosen = min(intentions, key=lambda each: each.id)
        intentions.remove(chosen)
        return chosen


class AllMessagesAtOnce(Fair):
    """Reads all that has come in one cycle."""

    def select_messages(self) -> list[SpeechAct]:
        inbox = self.agent.incoming.messages
        return [inbox.popleft() for _ in range(len(inbox))]


def with_policy(program: str, policy: type[Fair]) -> RecordingHost:
    host = mind(program)
    selections: Selections = policy(host.agent)
    selections.plain = False
    host.agent.selections = selections
    host.agent.incoming.called = True
    return host


@pytest.mark.parametrize(
    ("policy", "printed"),
    [
        (Fair, ["1", "1", "2", "3", "2", "3"]),
        (NewestEventFirst, ["3", "3", "2", "1", "2", "1"]),
        (LongestFirst, ["1", "1", "2", "2", "3", "3"]),
    ],
)
def test_a_policy_decides_what_goes_first(policy, printed):
    host = with_policy(GOALS, policy)
    host.run()
    assert host.printed == printed


def test_a_policy_decides_how_many_messages_are_read_in_a_cycle():
    for policy, read in ((Fair, 1), (AllMessagesAtOnce, 3)):
        host = with_policy("+told(N) <- .print(N).", policy)
        host.run()
        for number in range(3):
            host.agent.receive(
                SpeechAct("tell", "friend", "tester", structure("told", float(number)), f"m{number}")
            )
        host.agent.run(1)
        assert 3 - len(host.agent.incoming.messages) == read


def test_a_plain_policy_is_not_asked_for_each_event():
    class Refusing(Fair):
        def select_event(self) -> Event | None:
            raise AssertionError

    host = mind(GOALS)
    host.agent.selections = Refusing(host.agent)
    host.run()
    assert len(host.printed) == 6

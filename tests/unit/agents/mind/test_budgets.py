"""Budgets of events, intentions and messages: an agent that never stops growing loses some goals, with a reason."""

from itertools import pairwise

import pytest
from recording_host import RecordingHost, mind

from jacaros.agents.mind.actions import internal_action
from jacaros.agents.mind.actions.internal_action import InternalAction
from jacaros.agents.mind.state.act import Percept, SpeechAct
from jacaros.agents.mind.state.budget import Options
from jacaros.agents.mind.state.plan import Failure
from jacaros.agents.terms.values import SOURCE_PERCEPT, atom, structure


def limited(program: str, **limits: int) -> RecordingHost:
    return mind(program, options=Options(**limits))


def test_what_goes_beyond_the_intention_limit_fails_its_step():
    host = limited(
        """
        !spawn(1).
        +!spawn(N) <- !!wait(N); !spawn(N + 1).
        -!spawn(N)[error(E), error_msg(M), code_line(L)] <- .print(N, " ", E, " in line ", L); .print(M).
        +!wait(N) <- .wait(1000).
        """,
        intention_limit=10,
    )
    while host.agent.run(100):
        pass
    assert host.printed == [
        "10 intention_limit in line 3",
        "there are 10 intentions (option intention_limit)",
    ]
    host = limited(
        """
        !g.
        +!g <- .wait(1) |&| .wait(1) |&| .wait(1).
        -!g[error(E)] <- .print(E).
        """,
        intention_limit=3,
    )
    host.run()
    assert host.printed == ["intention_limit"]


def test_an_event_beyond_the_limit_fails_its_step():
    host = limited(
        """
        !flood.
        @a[atomic] +!flood <- for (.range(I, 1, 100)) { !!later(I) }.
        -!flood[error(E), error_msg(M)] <- .print(E); .print(M).
        +!later(I) <- .print(I).
        """,
        event_limit=3,
    )
    host.run()
    assert sorted(host.printed) == [
        *("1", "2", "3"),
        "event_limit",
        "there are 3 events (option event_limit)",
    ]


def test_refused_events_from_outside_are_logged_occasionally():
    host = limited("+p(X) <- .print(X).", event_limit=2)
    for number in range(25):
        host.agent.perceive([Percept("add", structure("p", float(number)), (SOURCE_PERCEPT,))] * 1)
    host.run()
    refused = "refusing events from outside"
    assert [text for _, text in host.logged] == [
        f"{refused}: there are 2 events (option event_limit)",
        f"{refused} (10 so far): there are 2 events (option event_limit)",
    ]
    assert host.printed == ["0", "1"]


def test_sending_to_a_full_mailbox_fails():
    host = limited("+p(X) <- .print(X).", mailbox_limit=2)
    for number in range(2):
        host.agent.receive(SpeechAct("tell", "bob", "tester", structure("p", float(number)), f"m{number}"))
    with pytest.raises(Failure, match="mailbox_limit"):
        host.agent.receive(SpeechAct("tell", "bob", "tester", structure("p", 2.0), "m2"))
    host.run()
    assert host.printed == ["0", "1"]


FORK_BOMB = """
    !g. !other(0).
    +!g <- !!g; !!g.
    +!other(N) <- .print(N); !other(N + 1).
    +bump <- .print(bump).
"""


def test_endless_goals_leave_other_plans_their_turns():
    host = limited(FORK_BOMB, intention_limit=200)
    turns = []
    for _ in range(20):
        for _ in range(40):
            host.agent.run(50)
        turns.append(len(host.printed))
    assert len(host.agent.alive) >= 190
    gained = [later - sooner for sooner, later in pairwise(turns)]
    assert min(gained) >= 5, gained
    host.agent.perceive([Percept("add", atom("bump"), (SOURCE_PERCEPT,))])
    host.agent.run(500)
    assert "bump" in host.printed


def test_endless_goals_are_logged_occasionally():
    host = limited(FORK_BOMB, intention_limit=20)
    host.agent.run(5000)
    warnings = [text for _, text in host.logged]
    assert len(warnings) == 4
    assert "intention_limit" in warnings[0]
    assert warnings[-1].endswith("\n  1000 goals have failed for this reason")


def test_a_lack_of_memory_is_reported_to_the_host(monkeypatch):
    def explode(ctx: object) -> None:
        raise MemoryError

    monkeypatch.setitem(internal_action._declared, ".explode", InternalAction(".explode", explode))
    host = mind("!g. +!g <- .explode. -!g[error(E)] <- .print(E).")
    host.run()
    assert host.printed == ["no_memory"]
    assert host.memory_errors == 1

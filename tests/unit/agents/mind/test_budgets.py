"""Budgets of an agent that never stops growing, and names that it no longer uses."""

import gc
from collections.abc import Callable
from itertools import pairwise

import pytest
from recording_host import RecordingHost, mind

from jacaros.agents.mind.actions import internal_action
from jacaros.agents.mind.actions.internal_action import InternalAction
from jacaros.agents.mind.rules import proc_msg
from jacaros.agents.mind.state.act import Percept, SpeechAct
from jacaros.agents.mind.state.belief_base import MANY_NAMES, SELECT_OPTION, Table
from jacaros.agents.mind.state.budget import Options
from jacaros.agents.mind.state.plan import Failure
from jacaros.agents.mind.state.triggers import Trigger, trigger
from jacaros.agents.terms.values import SOURCE_PERCEPT, Functor, atom, functor, structure


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


def test_endless_goals_are_logged_occasionally_as_refused_events():
    host = limited(FORK_BOMB, intention_limit=20)
    host.agent.run(5000)
    warnings = [text for _, text in host.logged]
    assert len(warnings) == 4
    assert "intention_limit" in warnings[0]
    assert warnings[-1].endswith("\n  1000 goals have failed for this reason")
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


def test_a_lack_of_memory_is_reported_to_the_host(monkeypatch):
    def explode(ctx: object) -> None:
        raise MemoryError

    monkeypatch.setitem(internal_action._declared, ".explode", InternalAction(".explode", explode))
    host = mind("!g. +!g <- .explode. -!g[error(E)] <- .print(E).")
    host.run()
    assert host.printed == ["no_memory"]
    assert host.memory_errors == 1


NAMES = 8_000
KEPT = 5 * MANY_NAMES
"""What may be left: of each name the name itself, a table, two event kinds, and one copy in a cache of the mind."""


def live_names() -> int:
    """Count the names, event kinds and tables of this process."""
    gc.collect()
    return sum(issubclass(each.__class__, (Functor, Trigger, Table)) for each in gc.get_objects())


def count_left(use: Callable[[RecordingHost, int], None]) -> int:
    """Return how many names, event kinds and tables are left of NAMES names."""
    host = mind("")
    for number in range(100):
        use(host, number)
    before = live_names()
    for number in range(100, 100 + NAMES):
        use(host, number)
    proc_msg._only_from.cache_clear()  # these keep the names of some thousand senders and goals
    proc_msg._achieved.cache_clear()
    return live_names() - before


@pytest.mark.parametrize(
    "steps",
    [
        '.concat("seen_", I, S); .term2string(T, S); +seen(T); -seen(T)',
        '.concat("seen_", I, "(1)", S); .term2string(T, S); +T; -T',
        '.concat("seen_", I, "(1)", S); .term2string(T, S); -+T; .abolish(T)',
        '.concat("seen_", I, "(1)", S); .term2string(T, S); if (T) { .print(T) }',
    ],
    ids=["atoms", "beliefs", "replaced beliefs", "queries"],
)
def test_names_made_by_plans_are_freed(steps):
    host = mind(
        f"+!use(F, L) <- for (.range(I, F, L)) {{ {steps} }}. !use(1, 100). +!more <- !use(101, {NAMES})."
    )
    host.run()
    before = live_names()
    host.agent.post_goal(atom("more"))
    host.run()
    assert not host.agent.alive
    assert live_names() - before < KEPT


def test_names_of_percepts_are_freed():
    def perceive(host: RecordingHost, number: int) -> None:
        literal = (functor(f"seen_{number}", 1), 1.0)
        for kind in ("add", "remove"):
            host.agent.perceive([Percept(kind, literal, (atom("percept"),))])
            host.run()

    assert count_left(perceive) < KEPT


@pytest.mark.parametrize("performatives", [("tell", "untell"), ("achieve",), ("signal",), ("askOne",)])
def test_names_of_messages_and_their_senders_are_freed(performatives):
    def receive(host: RecordingHost, number: int) -> None:
        literal = (functor(f"said_{number}", 1), 1.0)
        for performative in performatives:
            host.agent.receive(SpeechAct(performative, f"sender_{number}", "bob", literal, number))
            host.run()
        host.sent.clear()
        host.logged.clear()

    assert count_left(receive) < KEPT


def test_event_kinds_that_only_a_plan_for_any_goal_handles_are_freed():
    host = mind(
        '!use. +!use <- for (.range(I, 1, 1200)) { .concat("do_", I, S); .term2string(T, S); !T }. +!G.'
    )
    selects = host.agent.library.program.selects
    host.run()
    assert len(selects) <= MANY_NAMES + 10
    named = trigger("+", "!", functor("use", 0))
    assert len({id(select) for kind, select in selects.items() if select and kind is not named}) == 1


def test_filters_and_tables_survive_many_names():
    names = '.concat("seen_", I, "(1)", S); .term2string(T, S); +T; -T'
    host = mind(f"""
        !go.
        @first +!go <- for (.range(I, 1, 3000)) {{ {names} }}; +select__option(_, _, _, _); !there.
        +!there <- .print(there).
    """)
    host.run()
    assert host.agent.selections.option_filter is host.agent.beliefs[SELECT_OPTION]
    assert host.printed == ["there"]
    # The order of the tables is the order of the answers to a query for anything.
    host = mind("""
        !go.
        +!go <- +a(1); +b(1); -a(1); !count(5000); +a(2); .findall(X, X[source(self)], L); .print(L).
        +!count(0).
        +!count(N) <- !count(N - 1).
    """)
    host.run()
    assert host.printed == ["[a(2),b(1)]"]

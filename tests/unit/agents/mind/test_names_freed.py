"""Names that an agent no longer uses are freed, whatever it used them for."""

import gc
from collections.abc import Callable

import pytest
from recording_host import RecordingHost, mind

from jacaros.agents.mind.rules import proc_msg
from jacaros.agents.mind.state.act import Percept, SpeechAct
from jacaros.agents.mind.state.belief_base import MANY_NAMES, SELECT_OPTION, Table
from jacaros.agents.mind.state.triggers import Trigger, trigger
from jacaros.agents.terms.values import Functor, atom, functor

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

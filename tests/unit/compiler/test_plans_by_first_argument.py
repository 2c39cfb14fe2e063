"""Many plans of one event kind are found by their first argument, in their order."""

import pytest
from recording_host import mind, printed

from jacaros.bdi.fast.generated import selection
from jacaros.bdi.fast.generated.unit import compile_select
from jacaros.bdi.state.triggers import trigger
from jacaros.terms.values import functor

PLANS = """
+!do(a, X) : X > 10 <- .print(a_large, X).
+!do(V, 3) <- .print(three, V).
+!do(b, X) <- .print(b, X).
+!do("s", X) <- .print(string, X).
+!do(1, X) <- .print(number, X).
+!do(f(Y), X) <- .print(f, Y, X).
+!do([], X) <- .print(empty, X).
+!do([H | T], X) <- .print(list, H, X).
+!do(a, X) <- .print(a, X).
+!do(~a, X) <- .print(not_a, X).
+!do(other::a, X) <- .print(other_a, X).
+!do(c[mark], X) <- .print(marked, X).
@any +!do(W, X) <- .print(any, W, X).
+!do(a, X) <- .print(never).
"""
GOALS = {
    "do(a, 11)": "a_large11",
    "do(a, 3)": "threea",
    "do(a, 1)": "a1",
    "do(b, 3)": "threeb",
    "do(b, 4)": "b4",
    'do("s", 1)': "string1",
    'do("t", 1)': "anyt1",
    "do(1, 1)": "number1",
    "do(2 - 1, 1)": "number1",
    "do(f(7), 1)": "f71",
    "do(f(7, 8), 1)": "anyf(7,8)1",
    "do([], 1)": "empty1",
    "do([x, y], 1)": "listx1",
    "do(~a, 1)": "not_a1",
    "do(other::a, 1)": "other_a1",
    "do(zzz, 1)": "anyzzz1",
    "do(a[note], 1)": "a1",
    "do(c[mark], 1)": "marked1",
    "do(c, 1)": "anyc1",
}


@pytest.mark.parametrize("limit", [1, 6, 1000])
@pytest.mark.parametrize("goal", GOALS)
def test_the_first_applicable_plan_is_the_same_with_and_without_a_table(
    goal: str, limit: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(selection, "_WORTH_A_TABLE", limit)
    assert printed(f"!start. +!start <- !{goal}. {PLANS}") == [GOALS[goal]]


@pytest.mark.parametrize("limit", [1, 1000])
def test_an_argument_without_value_takes_that_of_the_first_plan(
    limit: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(selection, "_WORTH_A_TABLE", limit)
    program = f"!start. +!start <- !do(Z, 1); .print(Z); W = Y + 1; Y = 0; !do(W, 2). {PLANS}"
    assert printed(program) == ["b1", "b", "number2"]


def test_a_table_is_made_for_many_plans_only() -> None:
    sources = []
    for count in (4, 40):
        host = mind(" ".join(f"+!do(k{i})." for i in range(count)))
        do = trigger("+", "!", functor("do", 1))
        library = host.agent.library
        sources.append(compile_select(do, library.relevant(do), library.actions)[1])
    assert "plans" not in sources[0]
    assert ".get(key" in sources[1]


def test_plans_that_come_and_go_at_run_time_find_their_place() -> None:
    plans = " ".join(f"@p{i} +!do(k{i}) <- .print(old, {i})." for i in range(9))
    program = f"""
    !start.
    +!start <-
      !do(k3);
      .add_plan({{ +!do(k3) <- .print(new, 3) }}); !do(k3);
      .remove_plan(p3); !do(k3);
      .add_plan({{ +!do(k5) <- .print(new, 5) }}, self, begin); !do(k5); !do(k4);
      .add_plan({{ +!do(V) <- .print(any, V) }}, self, begin); !do(k4).
    {plans}
    """
    assert printed(program) == ["old3", "old3", "new3", "new5", "old4", "anyk4"]


def test_the_functions_of_a_program_stay_with_its_other_agents() -> None:
    """Two agents of one program: what one adds concerns it alone."""
    plans = " ".join(f"+!do(k{i}) <- .print(old, {i})." for i in range(9))
    host = mind(
        f"+!add <- .add_plan({{ +!do(k3) <- .print(new) }}, self, begin). +!go <- !do(k3). {plans} !add. !go."
    )
    host.run()
    assert host.printed == ["new"]


def test_triggers_that_are_variables_keep_their_place_among_the_others() -> None:
    plans = " ".join(f"+!do(k{i}) <- .print({i})." for i in range(4))
    later = " ".join(f"+!do(k{i}) <- .print({i})." for i in range(4, 9))
    program = (
        f"!s. +!s <- !do(k1); !do(k7); !other::do(k8). {plans} +!G : not G = s <- .print(any, G). {later}"
    )
    assert printed(program) == ["1", "anydo(k7)[source(self)]", "anyother::do(k8)[source(self)]"]


def test_a_variable_namespace_in_a_trigger_keeps_its_place_too() -> None:
    plans = " ".join(f"+!do(k{i}) <- .print({i})." for i in range(9))
    program = f"""
    !s. +!s <- !do(k1); !other::do(k1); !other::do(k1, 2).
    +!N::do(k1, X) <- .print(two).
    {plans}
    +!N::do(X) <- .print(N, X).
    """
    assert printed(program) == ["1", "otherk1", "two"]


def test_a_plan_that_cannot_be_evaluated_does_not_hide_the_next_one() -> None:
    plans = " ".join(f"+!do(k{i}) <- .print({i})." for i in range(9))
    program = f"!s. +!s <- !do(k3). +!do(k3) : X = 1 div 0 & X > 0 <- .print(never). {plans}"
    host = mind(program)
    host.run()
    assert host.printed == ["3"]
    assert host.logged


def test_events_of_beliefs_and_failures_are_found_the_same_way() -> None:
    plans = " ".join(f"+b(k{i}) <- .print(b, {i}). -!g(k{i}) <- .print(failed, {i})." for i in range(9))
    program = f"!s. +!s <- +b(k2); +b(k8); !g(k4). +!g(X) <- .fail. {plans}"
    assert printed(program) == ["b2", "b8", "failed4"]

"""Arithmetic functions that need the agent: registered rules, counts, the clock, chance."""

import threading
from concurrent.futures import ThreadPoolExecutor

import pytest
from recording_host import mind

SUM = '{ register_function("my.sum", 2, "sum") } sum(X, Y, Z) :- Z = X + Y. '


def printed(program: str) -> list[str]:
    host = mind(program)
    host.run()
    return host.printed


def test_registered_rules_and_internal_actions_are_functions():
    assert printed(SUM + "!g. +!g <- X = my.sum(1, my.sum(2, 3)); .print(X); .print(my.sum(X, X) * 2).") == [
        "6",
        "24",
    ]
    program = (
        '{ register_function("my.size", 1, ".length") } !g. +!g <- .print(my.size([a, b]) + my.size("abc")).'
    )
    assert printed(program) == ["5"]
    assert printed(SUM + "!g. +!g <- X = my.sum(Q, 1); .print(X); Q = 4; .print(X).") == ["my.sum(Q,1)", "5"]


def test_functions_are_evaluated_wherever_they_are_written():
    program = """
        big(X) :- my.sum(X, 1) > 10.
        !g(9). !g(10).
        +!g(N) : big(N) & my.sum(N, N) == 20 <- +held(my.sum(N, 0)); ?held(V); !show(my.sum(V, 1)).
        +!g(N) <- .print(small).
        +!show(V) <- .print(V).
    """
    assert printed(SUM + program) == ["small", "11"]
    program = """
        !g. +!g <- .term2string(T, "f(my.sum(4, 5))"); .print(T);
            .add_plan("+!h(X) : my.sum(X, 1) > 3 <- .print(my.sum(X, 10))."); !h(3);
            .send(self, tellHow, "+!k <- .print(my.sum(1, 1))."); .wait(1); !k.
    """
    assert printed(SUM + program) == ["f(9)", "13", "2"]
    program = """
        p(1). p(2).
        !g. +!g <- +q(.count(p(X) & X > 1)); ?q(A); .term2string(B, "f(.count(p(_)))"); .print(A, B).
    """
    assert printed(program) == ["1f(2)"]
    program = """
        !g.
        +!g <- .relevant_plans({ +!h(_) }, [P]); .print(found); .intention(_, _, _, current); .print(seen); !h(1).
        +!h(X) <- .print(my.sum(X, 1)).
    """
    assert printed(SUM + program) == ["found", "seen", "2"]


@pytest.mark.parametrize(("rule", "why"), [("none", "does not hold"), ("word", "is not a number")])
def test_a_function_without_a_number_fails_the_step(rule, why):
    program = f"""{{ register_function("my.f", 1, "{rule}") }}
        word(_, a).
        !g. +!g <- X = my.f(1); .print(never). -!g[error(E), error_msg(M)] <- .print(E, " ", M).
    """
    (line,) = printed(program)
    assert line.startswith("arithmetic_error")
    assert why in line


def test_an_initial_belief_without_a_value_is_skipped_and_reported():
    host = mind(
        '{ register_function("my.f", 1, "none") } p(my.f(1)). p(2). !g(my.f(1)). !g(3). +!g(X) : p(Y) <- .print(X, Y).'
    )
    host.run()
    assert host.printed == ["32"]
    assert [level for level, _ in host.logged] == ["error", "error"]


def test_agents_in_two_threads_evaluate_their_own_functions():
    both = threading.Barrier(2, timeout=30)

    def run(number: int) -> list[str]:
        host = mind(f"""
{{ register_function("my.f", 1, "f") }}
f(_, {number}).
!go.
+!go <- T = [my.f(Z)]; .print(meet); Z = 1; .nth(0, T, W); .print(W); !add("a"); .print(meet).
+!add(Y) <- X = Y + 1; .print(X).
""")

        def show(line: str) -> None:
            host.printed.append(line)
            if line == "meet":
                both.wait()

        host.print = show  # type: ignore[method-assign]
        host.run()
        return [*host.printed, *(line for _, line in host.logged)]

    with ThreadPoolExecutor() as pool:
        found = list(pool.map(run, (1, 2)))
    assert found == [["meet", n, "NaN", "meet", """operand of `+` is not a number: "a\""""] for n in "12"]

"""Steps and goals that fail: logs, handlers, and what continues."""

import sys
from types import FrameType
from typing import Any

from recording_host import mind, printed, programs

from jacaros.agents.mind.rules import failure
from jacaros.agents.mind.rules.failure_reason import goal_text
from jacaros.agents.mind.rules.meta_events import observe_goals

PROGRAMS = """
an exception in an internal action fails that step only => internal_action | other_lives
    !other. !g.
    +!other <- .wait(10); .print(other_lives).
    +!g <- .nth(9, [a], _); .print(bad).
    -!g[error(E)] <- .print(E).
a handler that posts its goal again retries => try(3) | try(2) | try(1) | done
    n(3). !g.
    +!g : n(0) <- .print(done).
    +!g : n(N) <- -+n(N-1); .print(try(N)); .fail.
    -!g <- !g.
a wait sees a failure event although nothing else runs => h | seen
    !g. !k. +!g <- .wait({-!n}); .print(seen). +!k <- .wait(10); !n. -!n <- .print(h).
a failing internal action does not hold as a condition => no | internal_action | 7 | []
    !g. !h. r(X) :- .nth(5,[1],X). r(7).
    +!g : .nth(5,[1],X) <- .print(bad).
    +!g <- if (.nth(5,[1],X)) { .print(bad) } else { .print(no) };
      ?r(Y); .print(Y); .findall(Z, .nth(5,[1],Z), L); .print(L).
    +!h <- .nth(5,[1],_).
    -!h[error(E)] <- .print(E).
a goal can be failed before it is handled => k | failh(1) | after
    !g. !k. !x. !x. !x.
    +!g <- !h(1); .print(after).
    +!k <- .fail_goal(h(_)); .print(k).
    +!h(_) <- .print(no).
    -!h(X) <- .print(failh(X)).
    +!x.
a plan of too many terms is not added => wrong_arguments | []
    !g.
    +!g <- .findall(X, .range(X, 1, 50001), L); .add_plan({ @long +!h <- .print(L) }).
    -!g[error(E)] <- .print(E); .relevant_plans({ +!h }, L); .print(L).
a goal that another plan fails has a message, and no error => .fail_goal in the plan of !k ended it
    !g. !k.
    +!g <- .wait(1000).
    -!g[error(E)] <- .print(E).
    -!g[error_msg(Text)] <- .print(Text).
    +!k <- .fail_goal(g).
a goal that is not achieved by its deadline fails
=> deadline_reached | after | quick | k deadline_reached | end
    !g.
    +!g <- !h[hard_deadline(50)]; .print(after); !!k[hard_deadline(50)]; !quick[hard_deadline(50)]; .wait(200);
      .print(end).
    +!h <- .wait(200); .print(no).
    -!h[error(E)] <- .print(E).
    +!k <- !h2.
    +!h2 <- .wait(200); .print(no).
    -!k[error(E)] <- .print(k, " ", E).
    +!quick <- .print(quick).
a goal in a variable has a deadline too => latedeadline_reached | adeadline_reached
    !a. !b.
    +!a <- G = slow; !G[hard_deadline(100)].
    -!a[error(E)] <- .print(a, E).
    +!b <- G = late[hard_deadline(50)]; !!G.
    +!slow <- .wait(10000).
    +!late <- .wait(10000).
    -!late[error(E)] <- .print(late, E).
the message of a goal without plan has the values of its failure => no relevant plan for !sub(1)
    b(1). !try(_).
    +!try(X) <- ?b(X); !sub(X).
    -!try(X)[error_msg(M)] <- .print(M).
terms without value or of another kind fail with the reason
=> t body_var_not_literal | t body_var_not_literal | t body_var_not_literal
| u body_var_with_op | u body_var_not_literal | 3[k,q,source(self)] | e arithmetic_error (X = (1 div 0))
    !s. !e.
    +!s <- .wait(1); !t({ +!a }); !t(7); !t("a"); !u({ .print(a) }); !u(3); Y = h(3)[q]; !Y[k].
    +!t(X) <- X.
    +!u(X) <- !X.
    -!t(_)[error(E)] <- .print(t, " ", E).
    -!u(_)[error(E)] <- .print(u, " ", E).
    +!h(N)[|R] <- .print(N, R).
    +!e <- .wait(2); X = 1 div 0.
    -!e[error(E), code(C)] <- .print("e ", E, " ", C).
every failure of a step has a message
=> unknown receiver_not_found | empty body_var_without_value | number body_var_not_literal | body body_var_with_op
    !s.
    +!s <- for (.member(G, [unknown, empty, number, body])) { !!try(G) }.
    +!try(G) <- !G.
    -!try(G)[error(E), error_msg(M)] : .length(M, N) & N > 5 <- .print(G, " ", E).
    +!unknown <- .send(ghost, tell, p).
    +!empty <- !X.
    +!number <- X = 5; +X.
    +!body <- X = { a; b }; +X.
"""


@programs(PROGRAMS)
def test_what_a_program_prints(program, output):
    assert printed(program) == output


def test_a_lost_intention_and_a_context_that_cannot_be_evaluated_are_reported():
    host = mind("!g.\n+!g <-\n  ?nothing(1).", name="lost")
    host.run()
    assert host.logged == [
        (
            "warning",
            (
                "the goal !g failed and has no plan for its failure: "
                "test_goal_failed, a test found no answer (lost.asl:3)\n"
                "  step: ?nothing(1)\n"
                "  no belief `nothing`"
            ),
        )
    ]
    host = mind("!g(0). +!g(X) : 5 div X > 1 <- .print(bad). +!g(_) <- .print(second).")
    host.run()
    assert host.printed == ["second"]
    assert "cannot evaluate" in host.logged[0][1]


def test_an_observer_gets_the_reason_of_a_failure():
    host = mind('!a. +!a <- !b. +!b <- .fail(error_msg("no way")). -!b.')
    heard: list[tuple[str, str, str]] = []
    observe_goals(
        host.agent,
        lambda state, goal, number, intention, why: heard.append((state, f"!{goal_text(goal)}", why)),
    )
    host.run()
    assert [(goal, why) for state, goal, why in heard if state == "failed"] == [
        ("!b", "internal_action, no way (tester.asl:1)\nstep: .fail(...)")
    ]
    assert [state for state, goal, _ in heard if goal == "!b"][-2:] == ["recovered", "finished"]
    assert not [state for state, _, why in heard if why and state != "failed"]


def test_a_reason_is_worded_only_when_a_plan_asks_for_it(monkeypatch):
    worded = []
    monkeypatch.setattr(failure, "goal_text", lambda goal: worded.append(goal) or goal_text(goal))
    program = """
        !try(1). !ask(2).
        +!try(I) <- !sub(I).
        -!try(I).
        +!ask(I) <- !sub(I).
        -!ask(I)[error_msg(M)] <- .print(M).
        """
    assert printed(program) == ["no relevant plan for !sub(2)"]
    assert [arguments for _, *arguments in worded] == [[2.0]]


def test_a_step_that_fails_raises_no_exception():
    host = mind(
        "!g. +!g <- !a; !b; !c. +!a <- 1 > 2. +!b <- .fail. +!c <- ?d(_); .print(done). -!a. -!b. -!c <- .print(c)."
    )
    raised = []

    def note(frame: FrameType, event: str, argument: Any) -> Any:
        if event == "exception" and argument[0] is not StopIteration:
            raised.append(argument)
        return note

    before = sys.gettrace()
    sys.settrace(note)
    try:
        host.run()
    finally:
        sys.settrace(before)
    assert host.printed == ["c"]
    assert raised == []


def test_a_handler_runs_once_although_the_handler_of_an_inner_goal_failed():
    goals = "!a. +!a <- !x. +!x <- .fail. -!x <- !b; {}. +!b <- !f. +!f <- .fail. -!f <- .fail."
    outer = "-!a <- .print(a)."
    assert printed(f"{goals.format('.print(x)')} -!b <- .print(b); .fail. {outer}") == ["b", "a"]
    assert printed(f"{goals.format('.print(x)')} -!b <- .print(b). {outer}") == ["b", "x"]
    assert printed(f"{goals.format('.fail')} -!b <- .print(b). {outer}") == ["b", "a"]

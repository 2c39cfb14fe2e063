"""Goal control tells which goal it found; failures of waiting steps have a message; conditions do not wait."""

import pytest
from recording_host import mind, printed, programs

from jacaros.agents.mind.rules import goals
from jacaros.agents.mind.state.intention import Intention
from jacaros.agents.mind.state.triggers import trigger
from jacaros.agents.terms.values import functor

WAITING = (
    "!begin. +!w(X, Y) <- .wait(1000). -!w(X, Y) <- .print(failed(X)). +!begin <- !!w(1, a); .wait(10); "
)


@pytest.mark.parametrize(
    "action",
    [
        "suspend(w(X, a))",
        "succeed_goal(w(X, a))",
        "fail_goal(w(X, _))",
        "drop_intention(w(X, _))",
        "drop_desire(w(X, _))",
    ],
)
def test_the_variables_of_a_goal_are_bound(action):
    host = mind(f"{WAITING} .{action}; .print(X).")
    host.run(seconds=5)
    assert host.printed[0] == "1"


def test_goal_control_binds_what_it_finds():
    host = mind(
        f"{WAITING} .suspend(w(1, _)); .suspended(w(X, Y), _); .print(X, Y); .resume(w(Z, _)); .print(Z)."
    )
    host.run(seconds=5)
    assert host.printed == ["1a", "1"]
    host = mind(f"{WAITING} .drop_desire(other(X)); .print(X).")
    host.run(seconds=0.5)
    assert host.printed == ["X<no-value>"]
    host = mind(
        '!begin. !later. +!begin <- .wait(p(X), 5000, T); .print(X, " ", T). +!later <- .wait(300); +p(1).'
    )
    host.run(seconds=1)
    assert host.printed == ["1 300"]
    host = mind(
        "!own. +!own <- .suspend; .print(on). !resume. +!resume <- .wait(100); .print(before); .resume(own)."
    )
    host.run(seconds=1)
    assert host.printed == ["before", "on"]


PROGRAMS = """
a plan that ends its own goal continues after the goal => after
    !begin. +!begin <- !own(1); .print(after). +!own(X) <- .succeed_goal(own(_)); .print(never).
a failed formula that holds a shared variable is shown => .nth(5,[a],X) internal_action | X<no-value>
    !begin. +!begin <- !do({ .nth(5, [a], X) }); .print(X).
    +!do(B) <- B.
    -!do(B)[code(C), error(E)] <- .print(C, " ", E).
rules and plans are removed whatever their variables are called => [] | 1
    r(X, Y) :- p(X, Y). p(1, 2).
    !begin. +!begin <- -{ r(A, B) :- p(A, B) }; .findall(Q, r(Q, _), L); .print(L);
        .add_plan({ +!more(A) : A > 1 <- .print(A) }); .add_plan({ +!more(B) : B > 1 <- .print(B) });
        .relevant_plans({ +!more(_) }, Ps); .length(Ps, N); .print(N).
the reason of a wait names what it waits for => 1 30012300
    !a. !b. !c. !look.
    +!a <- .wait(300).
    +!b <- .wait({+e(1)}, 300, _).
    +!c <- .wait(p(2), 300, _).
    +!look <- .wait(50); .suspended(a, wait(I)[time(T)]); .suspended(b, wait(_)[e(N)]); .suspended(c, wait(_)[p(M)]);
       .suspend(a); .suspended(a, wait(_)[time(U)]); .print(I, " ", T, N, M, U).
"""


@programs(PROGRAMS)
def test_what_a_program_prints(program, output):
    assert printed(program) == output


@pytest.mark.parametrize(
    ("step", "error"),
    [
        (".wait({ +never }, 10)", "wait_timeout the wait is over without what it waited for"),
        (".send(self, askOne, p(_), q(_))", "ask_failed the answer does not match"),
        ("act", "action_failed the action failed"),
    ],
)
def test_the_failure_of_a_waiting_step_has_a_message(step, error):
    from jacaros.agents.mind.state.act import Completion

    host = mind(
        f'p(1). !begin. +!begin <- {step}. -!begin[error(E), error_msg(M)] <- .print(E, " ", M).',
        complete=lambda act: Completion(False, (), ()),
    )
    host.run()
    assert host.printed == [error]


@pytest.mark.parametrize("action", [".wait(1)", ".send(self, tell, hi)", ".broadcast(tell, hi)", ".stopMAS"])
def test_actions_that_wait_or_act_on_others_are_not_conditions(action):
    host = mind(
        f"r :- {action}. !begin. +!begin <- if (r) {{ .print(holds) }}; !known({action}). "
        "+!known(F) : F <- .print(holds). +!known(F) <- .print(end). +hi <- .print(hi)."
    )
    host.run()
    assert host.printed == ["end"]
    assert len(host.logged) == 2


@pytest.mark.parametrize(
    ("action", "lines"), [("drop_all_intentions", ["b"]), ("drop_all_events", ["a", "b"])]
)
def test_dropping_all_intentions_cancels_scheduled_events(action, lines):
    host = mind(
        f"""!begin. +!begin <- .at("now +20", {{ +!x(a) }}); .{action}; .at("now +30", {{ +!x(b) }}).
        +!x(N) <- .print(N)."""
    )
    host.run()
    assert host.printed == lines


@pytest.mark.parametrize("action", [".suspend", ".suspend(own)"])
def test_a_goal_that_suspends_itself_at_its_end_is_not_over(action):
    host = mind(
        f"!caller. +!caller <- !own; .print(after). +!own <- {action}."
        " !resume. +!resume <- .wait(100); .print(before); .resume(own)."
    )
    host.run(seconds=1)
    assert host.printed == ["before", "after"]


@pytest.mark.parametrize(
    ("steps", "states"),
    [
        (
            ".suspend(g(1)); .wait(10); .resume(g(1)); .wait(10)",
            "pending suspended resumed pending executing achieved finished",
        ),
        (".succeed_goal(g(1)); .wait(10)", "pending achieved finished"),
        (".drop_event(g(1)); .wait(10)", "pending dropped finished"),
    ],
)
def test_the_states_of_a_goal_that_is_still_an_event_are_reported(steps, states):
    program = f"!s. +!s <- !!g(1); {steps}; .print(end). +!g(X). ^!g(X)[state(S)] <- .print(S)."
    assert [line for line in printed(program) if line != "end"] == states.split()


def test_the_body_of_a_plan_that_waits_for_a_goal_begins_with_it():
    program = """
        !g.
        +!g <- if (true) { !h(X, 3) } else { !h(1, Y) }; .print(end).
        +!h(A, B) <- ?k(A); .print(A).
        +?k(7)
          <- .current_intention(intention(_, L));
             .findall(at(N, Body), .member(im(_[code_line(N)], _, Body, _), L), Found);
             .nth(1, Found, Inner); .print(Inner); .nth(2, Found, Outer); .print(Outer).
        """
    assert printed(program)[:2] == ["at(4,{ ?k(7); .print(7) })", "at(3,{ !h(X,3); .print(end) })"]


@pytest.mark.parametrize("action", ["drop_event(b)", "drop_all_events"])
def test_dropping_the_event_of_a_suspended_intention_drops_the_intention(action):
    host = mind(f"!s. +!s <- .{action}; .print(dropped). +!b <- .print(b).")
    agent = host.agent
    intention = Intention(agent)
    agent.queue(((trigger("+", "!", functor("b", 0)),), intention, (), None))
    goals.suspend_intention(agent, intention)
    host.run(seconds=1)
    assert host.printed == ["dropped"]
    assert intention.dropped

"""External actions: waiting, outputs, failure, suspension, dropping."""

from recording_host import RecordingHost, mind

from jacaros.bdi.act import Act, Completion
from jacaros.terms.values import String, structure

MOVE = "!g. !other. +!g <- move(1, X); .print(moved(X)). +!other <- .wait(5); .print(other). -!g[R] <- .print(bad)."


def begun(program: str) -> RecordingHost:
    host = mind(program)
    host.run(seconds=0.001)
    return host


def test_an_action_suspends_only_its_intention() -> None:
    host = mind(MOVE)
    host.run()
    assert host.printed == ["other"]
    assert [(a.functor.name, a.arguments[0]) for a in host.acts] == [("move", 1.0)]


def test_outputs_are_bound_when_the_action_ends() -> None:
    host = begun(MOVE)
    act = host.acts[0]
    host.agent.complete(act.id, Completion(True, ((act.arguments[1], 7.0),)))
    host.run()
    assert host.printed == ["moved(7)", "other"]


def test_an_action_that_ends_at_once_goes_on_in_the_next_cycle() -> None:
    host = mind("!g. +!g <- a; .print(1); b; .print(2).", complete=lambda act: Completion(True))
    host.run()
    assert host.printed == ["1", "2"]


def test_a_failure_reaches_the_plan_with_its_reason() -> None:
    def refuse(act: Act) -> Completion:
        del act
        reason = (
            structure("error_msg", String("too far")),
            structure("env_failure_reason", structure("limit", 3.0)),
        )
        return Completion(False, (), reason)

    host = mind(
        """
        !g.
        +!g <- .print(go);
          move(9).
        -!g[error(E), error_msg(M), env_failure_reason(R), code(C), code_line(L)] <-
          .print(E, " ", M, " ", R, " ", C, " ", L).
        """,
        complete=refuse,
    )
    host.run()
    assert host.printed == ["go", "action_failed too far limit(3) move(9) 4"]


def test_dropping_the_intention_cancels_the_action() -> None:
    host = begun("!g. !d. +!g <- move. +!d <- .wait(10); .drop_intention(g).")
    host.run()
    assert host.cancelled == [host.acts[0].id]
    host.agent.complete(host.acts[0].id, Completion(True))
    host.run()
    assert host.printed == []


def test_suspending_the_intention_suspends_the_action_and_resuming_resumes_it() -> None:
    host = begun("!g. !d. +!g <- move; .print(done). +!d <- .wait(10); .suspend(g); .wait(10); .resume(g).")
    host.run()
    number = host.acts[0].id
    assert (host.suspended, host.resumed, host.printed) == ([number], [number], [])
    host.agent.complete(number, Completion(True))
    host.run()
    assert host.printed == ["done"]


def test_an_action_that_ends_while_its_intention_is_suspended_counts_after_resume() -> None:
    host = begun("!g. +!g <- move; .print(done). +!r <- .resume(g).")
    from jacaros.terms.values import atom

    host.agent.post_goal(atom("s"))
    host.agent.add_plan(String("+!s <- .suspend(g)."))
    host.run()
    host.agent.complete(host.acts[0].id, Completion(True))
    host.run()
    assert host.printed == []
    host.agent.post_goal(atom("r"))
    host.run()
    assert host.printed == ["done"]


def test_every_act_gets_one_completion_even_if_two_come() -> None:
    host = begun("!g. +!g <- move; .print(done).")
    for _ in range(2):
        host.agent.complete(host.acts[0].id, Completion(True))
    host.run()
    assert host.printed == ["done"]

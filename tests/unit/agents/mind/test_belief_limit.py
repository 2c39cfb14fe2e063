"""The agent option ``belief_limit``: an endlessly growing belief base costs an agent only some of its goals."""

from recording_host import RecordingHost, believed, mind

from jacaros.agents.mind.state.act import Percept, SpeechAct
from jacaros.agents.mind.state.budget import Options
from jacaros.agents.terms.values import SOURCE_PERCEPT, structure

GROW = """
known(1). known(2).
!fill(1).
+!fill(N)
  <- +grown(N);
     !fill(N + 1).
-!fill(N)[error(E), error_msg(M), code_line(L)] <- .print(N, " ", E, " in line ", L); .print(M).
"""


def limited(program: str, limit: int) -> RecordingHost:
    host = mind(program, options=Options(belief_limit=limit))
    host.run()
    return host


def test_a_step_that_exceeds_the_limit_fails_with_the_reason():
    host = limited(GROW, 10)
    assert host.printed == [
        "9 belief_limit in line 5",
        "there are 10 beliefs (option belief_limit), most of them grown/1 (8)",
    ]
    assert len(believed(host, "grown")) == 8
    host = limited(GROW.replace("+grown(N)", "-+now(N); if (N mod 2 == 0) { +grown(N) }"), 3_000)
    assert host.printed == [
        "5996 belief_limit in line 5",
        "there are 3000 beliefs (option belief_limit), most of them grown/1 (2997)",
    ]
    program = """
    a. b.
    !s.
    +!s <- .asserta(c); .print(never).
    -!s[error(E)] <- .print(E).
    """
    assert limited(program, 2).printed == ["belief_limit"]


def test_rules_count_and_replaced_or_deleted_beliefs_make_room():
    program = """
    a(0). b(0).
    !s.
    +!s <- -+a(1); -+a(2); +a(2); -b(0); +c(X); -c(_); +c(f(Y)); .abolish(c(_)); +b(1); .print(full); +b(2).
    -!s[error(E)] <- .print(E).
    """
    assert limited(program, 2).printed == ["full", "belief_limit"]
    program = """
    a :- b.
    !s.
    +!s <- +c; +d.
    -!s[error(E)] <- .print(E).
    """
    host = limited(program, 2)
    assert host.printed == ["belief_limit"]
    assert believed(host, "c") == ["c[source(self)]"]


def test_refused_beliefs_from_outside_are_logged_once():
    host = mind("+p(X) <- .print(X).", options=Options(belief_limit=3))
    host.run()
    percepts = [Percept("add", structure("p", float(n)), (SOURCE_PERCEPT,)) for n in range(4)]
    host.agent.perceive(percepts)
    for n in range(4, 6):
        host.agent.receive(SpeechAct("tell", "bob", "tester", structure("p", float(n)), f"m{n}"))
    host.run()
    assert host.printed == ["0", "1", "2"]
    assert host.logged == [
        (
            "error",
            "refusing beliefs from outside: there are 3 beliefs (option belief_limit), most of them p/1 (3)",
        )
    ]
    host.agent.perceive([Percept("remove", structure("p", 0.0), (SOURCE_PERCEPT,))])
    host.agent.perceive([Percept("remove", structure("p", 3.0), (SOURCE_PERCEPT,))])
    host.agent.perceive([Percept("add", structure("p", 7.0), (SOURCE_PERCEPT,))])
    host.run()
    assert host.printed[3:] == ["7"]
    assert len(believed(host, "p")) == 3

"""A mind that is stored as JSON in one process continues in another as if nothing had happened."""

import json
import os
import subprocess
import sys

import pytest
from recording_host import RecordingHost, mind, plans_of

from jacaros.agents.language.loader import load_program, parse_term
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.state.act import Percept, SpeechAct
from jacaros.agents.mind.storage import restore, stored
from jacaros.agents.terms.values import SOURCE, atom

PROGRAM = r"""
open(_, _).  p(1). p(2). p(3).  limit(5).
r(X) :- p(X) & X > 1.

!time. !event. !timeout. !condition. !suspended. !others. !at. !deadline. !fork. !race. !ask.
+!time <- .wait(1000); .print(time).
+!event <- .wait({+e(X)}, 2000, T); .print(event, X, " ", T).
+!timeout <- .wait({+never}, 900).
-!timeout[error(E), error_msg(M), code(C), code_line(L)] <- .print(E, " ", M, " ", C, " ", L).
+!condition <- .wait(q(X) & X > 1); .print(condition, X).
+!suspended <- .suspend; .print(resumed).
+!others <- .wait(800); .resume(suspended); +e(7); +q(1); .wait(100); +q(2).
+!at <- .at("now +1 s", {+!later(4)}).
+!later(X) <- .print(later, X).
+!deadline <- !slow[hard_deadline(700)]; .print(never).
+!slow <- .wait(5000).
-!slow[error(E)] <- .print(slow, E); .fail.
-!deadline[error(E)] <- .print(deadline, E).
+!fork <- { .wait(900); .print(a) |&| .wait(600); .print(b) }; .print(joined).
+!race <- { .wait(900); .print(never) ||| .wait(600); .print(first) }; .print(raced).
+!ask <- .send(friend, askOne, t(X), A, 1500); .print(answer, A).

!each. !loop. !nested. !body. !inner. !condition_of_goal.
+!each <- for (p(X) & Y = Z) { .wait(300); .print(each, X); Z = 1 }; .print(after_each).
+!loop <- while (limit(N) & N > 0) { .wait(200); -+limit(N - 1) }; .print(after_loop).
+!nested <- for (p(X)) { for (p(Y) & Y < X) { .wait(100); .print(pair, X, Y) } }; .print(nested).
+!body <- B = { .wait(600); .print(body) }; B; .print(after_body).
+!inner <- !outer(1).
+!outer(X) <- .wait(900); ++seen_inside(2); .wait(100); .print(outer). {
  +seen_inside(Y) <- .print(inside, X, Y).
}
+!condition_of_goal <- !reached(2); .print(reached).
+!reached(X) <: limit(X) <- .wait(100).

!rules. !plans. !names. !collections. !bindings. !order. !failing.
+!rules <- +{small(X) :- p(X) & X < 3}; +>{small(X) :- X = 9}; .wait(600);
  .findall(X, small(X), L); .print(L); .findall(X, r(X), M); .print(M); ?open(1, A); .print(A).
+!plans <- .add_plan("@own[x(1)] +!n(X) : X > 0 <- .wait(100); .print(n, X); !m.");
  .add_plan("-!m[code_line(C), code_src(S)] <- .print(C, S).");
  .add_plan({+!k(X) : X > 0 <- .wait(700); .print(k, X)}); !!k(5); .wait(600); !n(2);
  .findall(L, .plan_label(_, L), Ls); .print(Ls); .add_plan({+!z <- .print(z)}); .relevant_plans({+!z}, _, Z); .print(Z).
+!names <- .wait(1200); .send(friend, tell, hi); .intention(I, _, _, current); .print(I).
+!collections <- .set.create(S1); .set.add(S1, 1); .set.create(S2); .set.add(S2, 2); .set.create(S); .set.add(S, S1);
  .set.add(S, S2); .map.create(M); .map.put(M, S1, one); .map.put(M, f(S2), two); .queue.create(Q, priority);
  .queue.add(Q, 3); .queue.add(Q, 1); +held(S, M); .wait(500); .print(S, M, Q); .set.add(S1, 8);
  ?held(HS, HM); .print(HS, HM); .map.get(M, S1, V); .print(V).
+!bindings <- !bind(X, Y, Z); .print(X, Y).
+!bind(X, Y, Z) <- X = f(Y, Z); .wait(600); Y = 3.
+!order <- .sort([A, B, A, C], L); .wait(600); .union([A, B], [C, D], U); .length(U, N); .print(N); .random(R); .print(R).
+!failing <- .wait(400); !failing(1).
+!failing(X) <- .wait(200); ?nothing(X).
-!failing(X)[error(E), error_msg(M), code(C), code_line(L)] <- .wait(200); .print(E, " ", M, " ", C, " ", L, X).

+told(X)[source(S)] <- .print(told, X, S).
+!asked(X)[source(S)] <- .print(asked, X, S).
+noticed(X)[source(S)] <- .print(noticed, X, S).
"""


def begun(milliseconds: int) -> RecordingHost:
    """An agent some time after its start, with messages and a percept that it has not looked at."""
    host = mind(PROGRAM)
    end = host.time + milliseconds / 1000
    while host.agent.run(1) or host.ring_next(end):
        pass
    host.time = end
    for performative, content in (("tell", "told(1)"), ("achieve", "asked(f(X,X))")):
        term = lower_value(parse_term(content))
        host.agent.receive(SpeechAct(performative, "bob", "tester", term, f"id_{performative}"))
    host.agent.perceive(
        [Percept("signal", lower_value(parse_term("noticed(3)")), ((SOURCE, atom("percept")),))]
    )
    return host


def outcome(host: RecordingHost) -> list[object]:
    return [host.printed, [list(line) for line in host.logged], [message.id for message in host.sent]]


def continued(host: RecordingHost, program: str, plain: bool) -> object:
    """What a mind does in another process that is given nothing but its text."""
    text = json.dumps({"program": program, "time": host.time, "mind": stored(host.agent)})
    environment = {
        **os.environ,
        "JACAROS_PLAIN": "1" if plain else "",
        "PYTHONPATH": os.pathsep.join(sys.path),
    }
    done = subprocess.run(
        [sys.executable, __file__], check=False, input=text, capture_output=True, text=True, env=environment
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.parametrize("plain", [(False, False), (True, True), (True, False), (False, True)], ids=str)
@pytest.mark.parametrize("milliseconds", [0, 450, 650, 1000])
def test_a_mind_continues_in_another_process(milliseconds, plain, monkeypatch):
    monkeypatch.setenv("JACAROS_PLAIN", "1" if plain[0] else "")
    whole = begun(milliseconds)
    for past in (whole.printed, whole.logged, whole.sent):
        past.clear()
    whole.run()
    assert len(whole.printed) > 5
    assert continued(begun(milliseconds), PROGRAM, plain[1]) == outcome(whole)


def test_a_running_action_fails_when_its_host_is_gone():
    program = """
        !go. !others. +!go <- drive(kitchen); .print(never).
        -!go[error(E), env_failure_reason(R), error_msg(M)] <- .print(E, " ", R, " ", M).
        +!others <- .wait(1000); .print(others_go_on).
        """
    host = mind(program)
    host.agent.run(20)
    assert [act.functor.name for act in host.acts] == ["drive"]
    printed, _, _ = continued(host, program, plain=False)
    assert printed == [
        "action_failed interrupted the agent was stored and restored while the action was under way",
        "others_go_on",
    ]


def test_a_mind_continues_with_a_program_in_which_its_plans_have_moved():
    program = "r(X) :- X > 1. !go. +!go <- .wait(1000); ?r(2); .print(done)."
    host = mind(program)
    host.agent.run(20)
    printed, _, _ = continued(
        host, "q(X) :- X > 2. r(X) :- X > 1. +!other. +!go <- .wait(1000); ?r(2); .print(done).", False
    )
    assert printed == ["done"]


def test_a_program_that_lacks_a_plan_of_the_stored_mind_is_refused():
    host = mind("!go. +!go <- .wait(1000); .print(done).")
    host.agent.run(20)
    with pytest.raises(ValueError, match="it lacks a plan or belief that the stored mind uses"):
        restore(mind("+!go <- .wait(1000); .print(changed).").agent, stored(host.agent))


def _continue() -> None:
    given = json.load(sys.stdin)
    host = RecordingHost()
    host.time = given["time"]
    program, _ = load_program("tester.asl", given["program"], None)
    host.agent = Mind("tester", program, host, plans=plans_of(program))
    restore(host.agent, given["mind"])
    host.run()
    json.dump(outcome(host), sys.stdout)


if __name__ == "__main__":
    _continue()

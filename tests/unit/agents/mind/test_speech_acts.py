"""Messages: what each performative does at the receiver, and synchronous questions."""

import pytest
from recording_host import RecordingHost, believed, mind, printed, programs

from jacaros.agents.language.loader import parse_term
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.mind.state.budget import Options
from jacaros.agents.mind.state.triggers import trigger
from jacaros.agents.terms.substitution import is_flat
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import BY_SELF, functor


def message(performative: str, content: str, reply: str | None = None) -> SpeechAct:
    return SpeechAct(performative, "ann", "tester", lower_value(parse_term(content)), "m1", reply)


def after(program: str, *messages: SpeechAct) -> RecordingHost:
    host = mind(program)
    for one in messages:
        host.agent.receive(one)
    host.run()
    return host


def test_tell_and_untell_change_beliefs_of_their_sender_and_achieve_posts_a_goal():
    assert believed(after("", message("tell", "p(1)[at(2)]")), "p") == ["p(1)[at(2),source(ann)]"]
    assert believed(after("", message("tell", "p[source(bob)]")), "p") == ["p[source(ann)[source(bob)]]"]
    assert believed(after("p.", message("tell", "p"), message("untell", "p")), "p") == ["p[source(self)]"]
    assert after("+!g(X)[source(S)] <- .print(X, S).", message("achieve", "g(1)")).printed == ["1ann"]
    host = after("+!g <- .wait(100); .print(bad).", message("achieve", "g"))
    host = after("!g. +!g <- .wait(100); .print(bad).", message("unachieve", "g"))
    assert host.printed == []


@pytest.mark.parametrize("flat", [False, True])
@pytest.mark.parametrize(
    ("content", "done"),
    [
        ("g", ["gann"]),
        ("g(1)", ["1ann"]),
        ('g(x, "y")', ["xyann"]),
        ("[g, g(2)]", ["gann", "2ann"]),
        ("[]", []),
    ],
)
def test_a_flat_content_is_taken_as_any_other(content, done, flat):
    said = message("achieve", content)
    said.flat = flat and is_flat(said.content)
    plans = "+!g[source(S)] <- .print(g, S). +!g(X)[source(S)] <- .print(X, S). +!g(X, Y)[source(S)] <- .print(X, Y, S)."
    assert after(plans, said).printed == done


@pytest.mark.parametrize("flat", [False, True])
@pytest.mark.parametrize("content", ["p", "p(1)", 'p(x, "y")', "[p, p(2)]", "[]"])
def test_a_flat_content_is_believed_as_any_other(content, flat):
    said = message("tell", content)
    said.flat = flat and is_flat(said.content)
    host = after(
        "+p[source(S)] <- .print(S). +p(X)[source(S)] <- .print(X, S). +p(X, Y) <- .print(X, Y).", said, said
    )
    held = {
        "p": (["p[source(ann)]"], ["ann"]),
        "p(1)": (["p(1)[source(ann)]"], ["1ann"]),
        'p(x, "y")': (['p(x,"y")[source(ann)]'], ["xy"]),
        "[p, p(2)]": (["p[source(ann)]", "p(2)[source(ann)]"], ["ann", "2ann"]),
        "[]": ([], []),
    }
    assert (believed(host, "p"), host.printed) == held[content]


@pytest.mark.parametrize("flat", [False, True])
def test_a_requested_goal_is_reported_and_awaited(flat):
    said = message("achieve", "g(1)")
    said.flat = flat
    assert after("+!g(_). ^!g(X)[state(pending)] <- .print(X).", said).printed == ["1"]
    host = mind("!w. +!w <- .wait({+!g(X)}); .print(X). +!g(_).")
    host.agent.run(10)
    host.agent.receive(said)
    host.run()
    assert host.printed == ["1"]


@pytest.mark.parametrize("flat", [False, True])
def test_a_plan_of_the_program_for_messages_comes_first(flat):
    said = message("achieve", "g(1)")
    said.flat = flat
    program = "+!kqml_received(S, P, C, M) : .ground(C) <- .print(S, P, C, M). +!g(X) <- .print(no)."
    assert after(program, said).printed == ["annachieveg(1)m1"]


def test_questions_wait_for_events_and_atomic_plans_before_them():
    host = mind("v(0). +!set(X) <- -+v(X). +e <- +seen.")
    host.agent.receive(message("signal", "e"))
    host.agent.receive(message("signal", "e"))
    host.agent.receive(message("achieve", "set(1)"))
    host.agent.receive(message("askOne", "v(_)"))
    host.agent.post(((trigger("+", "", functor("e", 0)),), None, BY_SELF, None))
    host.run()
    assert [text(answer.content) for answer in host.sent] == ["v(1)"]
    host = mind("!work. v(old). @w[atomic] +!work <- -+v(half); .wait(10); -+v(new).")
    host.agent.run(10)
    host.agent.receive(message("askOne", "v(_)"))
    host.agent.run(10)
    assert host.sent == []
    host.run()
    assert [text(answer.content) for answer in host.sent] == ["v(new)"]
    host = mind("+e <- +seen.")
    host.agent.post(((trigger("+", "", functor("e", 0)),), None, BY_SELF, None))
    host.agent.receive(message("askHow", "5"))
    host.run()
    assert [answer.performative for answer in host.sent] == ["untell"]


def test_a_question_is_answered_and_a_synchronous_one_waits():
    host = after("p(1). +?q(X) <- X = 2. +?r(_) <- .fail.", *(message("askOne", f"{f}(X)") for f in "pqrs"))
    answers = {text(a.content)[0]: (a.performative, text(a.content), a.in_reply_to) for a in host.sent}
    assert answers == {
        "p": ("tell", "p(1)", "m1"),
        "q": ("tell", "q(2)", "m1"),
        "r": ("untell", "r(X)", "m1"),
        "s": ("untell", "s(X)", "m1"),
    }
    host = mind("!g. +!g <- .send(friend, askOne, p(_), A); .print(A).")
    host.run(seconds=0.1)
    question = host.sent[0]
    host.agent.receive(
        SpeechAct("tell", "friend", "tester", lower_value(parse_term("p(3)")), "x", question.id)
    )
    host.run()
    assert host.printed == ["p(3)[source(friend)]"]


PROGRAMS = """
a question without answer times out => timeout
    !g. +!g <- .send(friend, askOne, p(_), A, 100); .print(A).
an unknown receiver fails the step => receiver_not_found
    !g. +!g <- .send(ghost, tell, p). -!g[error(E)] <- .print(E).
a rule held by a variable is added with its sources => 2[bob,self]1
    r(X) :- X > 1.
    !go.
    +!go
      <- .relevant_rules(_, [R]);
         +R[source(bob)];
         .count(r(2), N);
         .findall(S, r(2)[source(S)], L);
         -R[source(bob)];
         .count(r(2), M);
         .print(N, L, M).
relevant plans unify with the event => 214
    !go.
    +!g(1) <- .print(one).
    +!g(2)[source(bob)] <- .print(two).
    +!g(X)[critical] <- .print(X).
    +!g(X) : X > 2 <- .print(X).
    +!go
      <- .relevant_plans({+!g(2)}, L); .length(L, N);
         .relevant_plans({+!g(2)[source(ann)]}, M); .length(M, O);
         .relevant_plans({+!g(_)[critical]}, P); .length(P, Q);
         .print(N, O, Q).
"""


@programs(PROGRAMS)
def test_what_a_program_prints(program, output):
    assert printed(program) == output


@pytest.mark.parametrize("performative", ["tellHow", "tell-how"])
def test_plans_can_be_sent(performative):
    host = after("", message(performative, '"+!h <- .print(told)."'), message("achieve", "h"))
    assert host.printed == ["told"]


def test_a_plan_of_the_program_comes_before_what_a_message_does():
    host = after("+!kqml_received(S, tell, C, _) <- .print(S, C).", message("tell", "p(1)"))
    assert host.printed == ["annp(1)"]
    assert believed(host, "p") == []
    program = """
+?limit(X)[source(ann)] <- X = 100.
+?limit(X)[source(self)] <- X = 0.
+?limit(X)[urgent] <- X = 10.
"""
    host = after(program, message("askOne", "limit(_)"), message("askOne", "limit(_)[urgent]"))
    assert [text(sent.content) for sent in host.sent] == ["limit(100)", "limit(100)[urgent]"]


LATE = "!ask. +?late(X) <- .wait(300); X = 3. "


def test_a_late_answer_is_discarded_and_one_without_a_wait_believed():
    asking = "+!ask <- .send(self, askOne, late(X), A, 100); .print(A); .wait(1000); .count(late(_), N); .print(N)."
    assert after(LATE + asking).printed == ["timeout", "0"]
    asking = "+!ask <- .send(self, askOne, late(X)); .wait(1000); ?late(Y)[source(S)]; .print(Y, S)."
    assert after(LATE + asking).printed == ["3self"]


def test_requested_plans_are_sent_and_added_unless_the_agent_is_restricted():
    host = after("+!goto(X) <- .print(going, X). +!goto(a) <- .print(a).", message("askHow", "{+!goto(b)}"))
    [answer] = host.sent
    assert (answer.performative, answer.in_reply_to) == ("tellHow", "m1")
    asker = mind("")
    asker.agent.receive(answer)
    asker.agent.receive(message("achieve", "goto(7)"))
    asker.run()
    assert asker.printed == ["going7"]
    assert len(asker.agent.library.plans) == 1
    host = after("+!goto(X) <- .print(X).", message("askHow", "{+!goto(_)}"))
    asker = mind("", options=Options(plans_from_others=False))
    asker.agent.receive(host.sent[0])
    asker.run()
    assert asker.agent.library.plans == []


@pytest.mark.parametrize("receivers", ["[]", "None"])
def test_a_message_to_an_empty_list_is_not_sent(receivers):
    host = mind(
        f"!g. +!g <- None = []; .send({receivers}, tell, p); .send({receivers}, askOne, p, A); .print(A)."
    )
    host.run()
    assert (host.sent, host.printed) == ([], ["[]"])


def test_a_plan_held_by_a_variable_is_added_for_its_sources():
    program = """
!go.
+!go
  <- P = {+!h <- .print(h)};
     +P[source(bob)];
     .relevant_plans({+!h}, _, [Label]);
     .print(Label);
     !h;
     -P[source(bob)];
     !h.
-!go[error(E)] <- .print(E).
"""
    host = mind(program)
    host.run()
    assert host.printed[1:] == ["h", "no_relevant"]
    assert host.printed[0].endswith("[source(bob)]")

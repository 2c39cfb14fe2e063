"""Internal actions that use the host: agents, output, messages and explanations."""

import pytest
from action_answers import answers, calls
from recording_host import RecordingHost, mind, programs

from jacaros.agents.language.loader import parse_term
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.actions.agents import written_question
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.agents.mind.actions.java_format import java_format
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import Var, atom, functor

SYSTEM = """
.create_agent(dora) => yes: ('create', 'dora', None, {})
.create_agent("emil", "x.asl") => yes: ('create', 'emil', 'x.asl', {})
.create_agent(friend, "x.asl") => yes: ('create', 'friend', 'x.asl', {})
.create_agent(X, "x.asl") => "x": ('create', 'x', 'x.asl', {})
.create_agent(Friend, "x.asl") & .concat(Friend, "", X) => "friend_1": ('create', 'friend', 'x.asl', {})
.create_agent(d, "x.asl", [agentClass("a.B(1)")]) => yes: ('create', 'd', 'x.asl', {'agentClass': 'a.B(1)'})
.create_agent(d, "x.asl", [beliefBaseClass(c)]) => yes: ('create', 'd', 'x.asl', {'beliefBaseClass': 'c'})
.create_agent(broken, "x.asl") => error: .create_agent: agent broken could not be created: ('create', 'broken', 'x.asl', {})
.create_agent(dora, x) => wrong: the second argument of .create_agent must be a string, not x: -
.create_agent(dora, "x.asl", a) => wrong: the third argument of .create_agent must be a list, not a: -
.create_agent(dora, "x.asl", [color(red)]) => wrong: .create_agent: unknown option color(red): -
.kill_agent(friend, 1500) => yes: ('kill', 'friend', 1.5)
.kill_agent("friend") => yes: ('kill', 'friend', 0.0)
.kill_agent(carl) => no: ('kill', 'carl', 0.0)
.kill_agent(friend, soon) => wrong: the second argument of .kill_agent must be a number, not soon: -
.stopMAS => yes: ('stop', 0.0, 0)
.stopMAS(2000) => yes: ('stop', 2.0, 0)
.stopMAS(0, 3) => yes: ('stop', 0.0, 3)
.stopMAS(500, false) => yes: ('stop', 0.5, 0)
.stopMAS(-1) => yes: ('stop', 0.0, 0)
.stopMAS(now) => wrong: the first argument of .stopMAS must be a number, not now: -
.stopMAS(0, code) => wrong: the second argument of .stopMAS must be a number, not code: -
.log(severe, "n=", 2) => yes: ('error', 'n=2')
.log(warning, "n=", 2) => yes: ('warning', 'n=2')
.log(info, "n=", 2) => yes: ('info', 'n=2')
.log(fine, "n=", 2) => yes: ('debug', 'n=2')
.log(finest, "n=", 2) => yes: ('debug', 'n=2')
.log(x, "n=", 2) => yes: ('info', 'n=2')
.log(1) => wrong: the first argument of .log must be a level such as info, not 1: -
.log("info") => wrong: the first argument of .log must be a level such as info, not "info": -
.log(f(1)) => wrong: the first argument of .log must be a level such as info, not f(1): -
"""


@calls(SYSTEM)
def test_what_the_host_is_asked_for(formula, wanted):
    host, asked = mind(""), []

    def create(name, source, classes):
        asked.append(("create", name, source, dict(classes)))
        return None if name == "broken" else f"{name}_1" if name == "friend" else name

    def kill(name, delay, killer):
        asked.append(("kill", name, delay))
        return name in host.agent_names()

    host.create_agent, host.kill_agent = create, kill
    host.stop_system = lambda delay, code: asked.append(("stop", delay, code))
    answer = answers(formula, host)
    assert f"{answer}: {', '.join(map(str, asked + host.logged)) or '-'}" == wanted


PRINTED = """
print joins its arguments without separators => a1 x["y",f(2.5)] | a1 x["y",f(2.5)]
    !g. +!g <- .print(a, 1, " x", ["y", f(2.5)]); .println(a, 1, " x", ["y", f(2.5)]).
unbound variables are marked at the top => X<no-value> f(Y)
    !g. +!g <- .print(X, " ", f(Y)).
printf shows what the format makes of fitting values => 2.3 text [1,a] false
    !g. +!g <- .printf("%.1f %s %s %b", 2.25, "text", [1, a], false).
printf refuses other formats => internal_action use %.0f | wrong_arguments
    !g. +!g <- !t("%d"); !t(a).
    +!t(F) <- .printf(F, 1).
    -!t("%d")[error(E), error_msg(M)] : .substring("use %.0f", M) <- .print(E, " use %.0f").
    -!t(a)[error(E)] <- .print(E).
puts prints a text with values and fills a variable => a b, 3, a b; #{?} | aa b | x=1
    !g. +!g <- X = "a b"; Y = 2; .puts("#{X}, #{Y+1}, #{X}; #{?}"); .puts("a", "#{X}"); !h.
    +!h <- X = 1; .puts("x=#{X}", R); .print(R).
print unifier shows the variables that have values => X=1 | Y="s" | done | done
    !g. +!g <- X = 1; Y = "s"; .print_unifier; Z = W; !h. +!h <- .print_unifier.
"""


@programs(PRINTED)
def test_what_a_program_prints(program, output):
    host = mind(program)
    host.run()
    assert host.printed == output


def test_print_keeps_line_breaks():
    host = mind(r'!g. +!g <- .print; .print("one\ntwo").')
    host.run()
    assert host.printed == ["", "one\ntwo"]
    assert answers(".puts(1)").startswith("wrong: ")


@pytest.mark.parametrize(
    ("template", "arguments", "shown"),
    [
        ("plain", [], "plain"),
        ("%s and %s", ["a", 3.0], "a and 3.0"),
        ("%2$s %1$s", ["a", "b"], "b a"),
        ("[%5s|%-5s|%.2s]", ["a", "b", "word"], "[    a|b    |wo]"),
        ("%f", [3.14159], "3.141590"),
        ("%10.3f|", [3.14159], "     3.142|"),
        ("%08.0f", [461012.0], "00461012"),
        ("%.1f %.2f %.0f", [0.25, 1.005, 2.5], "0.3 1.01 3"),
        ("%+.1f % .1f %(.1f", [1.0, 1.0, -1.0], "+1.0  1.0 (1.0)"),
        ("%,.2f", [1234567.891], "1,234,567.89"),
        ("%06.1f", [-2.5], "-002.5"),
        ("%e %.2E %.0e", [12345.678, 0.00123, 5.0], "1.234568e+04 1.23E-03 5e+00"),
        ("%e", [0.0], "0.000000e+00"),
        ("%g %g %g", [0.0001, 123456.0, 1234567.0], "0.000100000 123456 1.23457e+06"),
        ("%g %.3g", [0.00001, 0.0], "1.00000e-05 0.00"),
        ("%b %b %S", [True, "x", "loud"], "true true LOUD"),
        ("100%%%n", [], "100%\n"),
        ("%f %5.1f", [float("inf"), float("nan")], "Infinity   NaN"),
        ("%f", [float("-inf")], "-Infinity"),
        ("%s", [1e10], "1.0E10"),
    ],
)
def test_formats_are_read_as_java_reads_them(template, arguments, shown):
    assert java_format(template, arguments) == shown


@pytest.mark.parametrize(
    ("template", "arguments"),
    [("%d", [1.0]), ("%s", []), ("%q", [1.0]), ("%.f", [1.0]), ("50%", []), ("%f", ["a"])],
)
def test_wrong_formats_are_refused(template, arguments):
    with pytest.raises(ValueError, match="%"):
        java_format(template, arguments)


@pytest.mark.parametrize(
    ("term", "question"),
    [
        ("stopped", "stopped"),
        ('"why did it stop"', "why did it stop"),
        ("{ +alarm(_) }", "+alarm(_)"),
        ("{ !go(dock) }", "!go(dock)"),
        ("belief(battery(12))", "belief battery(12)"),
        ("plan(low)", "plan @low"),
        ('plan("robot.asl:14")', "plan robot.asl:14"),
        ('command("/cmd_vel")', "command /cmd_vel"),
        ("operation(dock)", "operation dock"),
    ],
)
def test_questions_are_terms(term, question):
    assert written_question(lower_value(parse_term(term))) == question


def sent(program: str) -> RecordingHost:
    host = mind(f'!g. +!g <- {program}. -!g[error(E), code(C)] <- .print(E, " ", C).')
    host.run()
    return host


def told(message: SpeechAct) -> str:
    return f"{message.sender} {message.receiver} {message.performative} {text(message.content)}"


@pytest.mark.parametrize(
    ("body", "receivers"),
    [
        (".send(friend, tell, p)", 1),
        ('.send("friend", "tell", p)', 1),
        ("F = friend; .send(F, tell, p)", 1),
        ('F = "friend"; T = tell; .send(F, T, p)', 1),
        (".send([friend, friend], tell, p)", 2),
        ("L = [friend, friend]; .send(L, tell, p)", 2),
        ("L = []; .send(L, tell, p)", 0),
        ("T = tell; .send(friend, T, p)", 1),
        (".send('friend', tell, p)", 1),
        (".broadcast(tell, p)", 1),
    ],
)
def test_a_message_goes_to_all_that_are_named(body, receivers):
    host = sent(body)
    assert [told(message) for message in host.sent] == ["tester friend tell p"] * receivers
    assert host.printed == []


@pytest.mark.parametrize("to", ["self", "tester", "M"])
def test_a_message_to_oneself_is_from_self(to):
    host = mind(
        f"me(tester). !g. +!g : me(M) <- .send({to}, achieve, h(1)). +!h(X)[source(S)] <- .print(X, S)."
    )
    host.run()
    assert [told(message) for message in host.sent] == ["self tester achieve h(1)"]
    assert host.printed == ["1self"]


def test_bindings_are_applied_to_a_content_and_variables_are_new():
    host = sent("X = 2; .send(friend, tell, p(X, X + 1, Y, Y)); Y = 7; Z = q(X); .send(friend, tell, Z)")
    first, second = (message.content for message in host.sent)
    assert first[1:3] == (2.0, 3.0)
    assert first[3] is first[4]
    assert first[3].__class__ is Var
    assert first[3].ref is None
    assert second == (functor("q", 1), 2.0)


@pytest.mark.parametrize(
    ("body", "failure"),
    [
        (".send(ghost, tell, p)", "receiver_not_found .send(ghost,tell,p)"),
        ("N = ghost; .send(N, tell, p)", "receiver_not_found .send(ghost,tell,p)"),
        (".send(X, tell, p)", "wrong_arguments .send(X,tell,p)"),
        (".send(1, tell, p)", "wrong_arguments .send(1,tell,p)"),
        (".send(friend, 1, p)", "wrong_arguments .send(friend,1,p)"),
        (".send(friend, X, p)", "wrong_arguments .send(friend,X,p)"),
        ("L = [friend, 1]; .send(L, tell, p)", "wrong_arguments .send([friend,1],tell,p)"),
        (".send(friend, tell, p, 1)", "wrong_arguments .send(friend,tell,p,1)"),
    ],
)
def test_a_message_that_cannot_be_sent_fails_the_step(body, failure):
    host = sent(f"{body}; .print(never)")
    assert host.printed == [failure]
    assert [message.receiver for message in host.sent] == (["ghost"] if "ghost" in body else [])


def test_messages_are_numbered_and_answers_name_their_question():
    host = sent(".send(friend, tell, p); F = friend; .send(F, tell, q); .send(friend, askOne, r, A, 10)")
    assert [message.id for message in host.sent] == ["mid1_tester", "mid2_tester", "mid3_tester"]
    assert [message.flat for message in host.sent] == [True, True, True]
    host = sent(".send(friend, tell, p(3), mid5_friend)")
    assert host.sent[0].in_reply_to == "mid5_friend"


def test_only_constant_arguments_are_specialised():
    direct = STANDARD[".send"].direct
    assert direct is not None
    bob, tell = atom("bob"), atom("tell")
    assert None not in (direct((bob, tell, None)), direct((None, tell, None)))
    for other in ((bob, None, None), (1.0, tell, None), (bob, 1.0, None), (bob, atom("askOne"), None, None)):
        assert direct(other) is None

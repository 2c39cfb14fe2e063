"""The registry of internal actions, and the actions that send messages or explain."""

import pytest
from recording_host import RecordingHost, mind

from jacaros.agents.language.loader import parse_term
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.actions.agents import written_question
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import Var, atom, functor

ARITIES = {
    (0, None): ".print .println",
    (1, None): ".printf .log",
    (2, None): ".concat",
    (0, 0): ".print_unifier",
    (0, 2): ".stopMAS",
    (
        1,
        1,
    ): ".empty .string .list .number .atom .literal .structure .ground .internal_action .verbose .my_name"
    " .all_names .version .nano_time .set_random_seed",
    (1, 2): ".puts .kill_agent .queue.create",
    (1, 3): ".random .create_agent",
    (2, 2): ".length .member .reverse .sort .shuffle .sublist .prefix .suffix .upper_case .lower_case"
    " .term2string .type .copy_term .rename_apart .remove_source_annot",
    (2, 3): ".max .min",
    (2, 4): ".substring",
    (3, 3): ".nth .union .intersection .difference .add_annot .add_nested_source .date .map.put",
    (3, 4): ".delete .range .time .map.get",
    (4, 4): ".replace",
}
CASES = [(name, arity) for arity, names in ARITIES.items() for name in names.split()]


@pytest.mark.parametrize(("name", "arity"), CASES)
def test_each_action_takes_its_number_of_arguments(name, arity):
    action = STANDARD[name]
    assert (action.minimum, action.maximum) == arity


def test_actions_of_the_language_can_be_called_with_the_fewest_arguments(mind):
    assert mind.succeeds(".print")
    assert mind.succeeds(".stopMAS")
    assert [name for name in STANDARD if not name.startswith(".")] == []


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
    host = mind(f"!g. +!g <- {program}. -!g[error(E)] <- .print(E).")
    host.run()
    return host


def told(message: SpeechAct) -> tuple[str, str, str, str]:
    return message.sender, message.receiver, message.performative, text(message.content)


@pytest.mark.parametrize(
    ("body", "receivers"),
    [
        ('.send(friend, tell, p)', ["friend"]),
        ('.send("friend", "tell", p)', ["friend"]),
        ("F = friend; .send(F, tell, p)", ["friend"]),
        ("F = \"friend\"; T = tell; .send(F, T, p)", ["friend"]),
        (".send([friend, friend], tell, p)", ["friend", "friend"]),
        ("L = [friend, friend]; .send(L, tell, p)", ["friend", "friend"]),
        ("L = []; .send(L, tell, p)", []),
        ("T = tell; .send(friend, T, p)", ["friend"]),
        (".send('friend', tell, p)", ["friend"]),
        (".broadcast(tell, p)", ["friend"]),
    ],
)  # fmt: skip
def test_a_message_goes_to_all_that_are_named(body, receivers):
    host = sent(body)
    assert [told(message) for message in host.sent] == [("tester", name, "tell", "p") for name in receivers]
    assert host.printed == []


@pytest.mark.parametrize("to", ["self", "tester", "me"])
def test_a_message_to_oneself_is_from_self(to):
    host = mind(f"me(tester). !g. +!g : me(M) <- .send({to if to != 'me' else 'M'}, achieve, h(1)). "
                "+!h(X)[source(S)] <- .print(X, S).")  # fmt: skip
    host.run()
    assert [told(message) for message in host.sent] == [("self", "tester", "achieve", "h(1)")]
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
    ("body", "error"),
    [
        (".send(ghost, tell, p)", "receiver_not_found"),
        ("N = ghost; .send(N, tell, p)", "receiver_not_found"),
        (".send(_, tell, p)", "wrong_arguments"),
        (".send(1, tell, p)", "wrong_arguments"),
        (".send(friend, 1, p)", "wrong_arguments"),
        (".send(friend, _, p)", "wrong_arguments"),
        ("L = [friend, 1]; .send(L, tell, p)", "wrong_arguments"),
        (".send(friend, tell, p, 1)", "wrong_arguments"),
    ],
)
def test_a_message_that_cannot_be_sent_fails_the_step(body, error):
    host = sent(body)
    assert host.printed == [error]
    assert [message.receiver for message in host.sent] == (["ghost"] if "ghost" in body else [])


def test_a_failed_message_leaves_the_intention_at_its_step():
    host = mind("!g. +!g <- .send(ghost, tell, p); .print(never). -!g[code(C)] <- .print(C).")
    host.run()
    assert host.printed == [".send(ghost,tell,p)"]


def test_messages_are_numbered_and_answers_name_their_question():
    host = sent(".send(friend, tell, p); F = friend; .send(F, tell, q); .send(friend, askOne, r, A, 10)")
    assert [message.id for message in host.sent] == ["mid1_tester", "mid2_tester", "mid3_tester"]
    assert [message.flat for message in host.sent] == [True, True, True]
    host = sent(".send(friend, tell, p(3), mid5_friend)")
    assert host.sent[0].in_reply_to == "mid5_friend"


def test_only_constant_arguments_are_specialised():
    direct = STANDARD[".send"].direct
    assert direct is not None
    assert direct((atom("bob"), atom("tell"), None)) is not None
    assert direct((None, atom("tell"), None)) is not None
    assert direct((atom("bob"), None, None)) is None
    assert direct((1.0, atom("tell"), None)) is None
    assert direct((atom("bob"), 1.0, None)) is None
    assert direct((atom("bob"), atom("askOne"), None, None)) is None

"""Questions of agents to a person: answers by agents, over ROS and from lines; refusals, time-outs, withdrawal."""

import json
from collections.abc import Callable
from typing import Any

import pytest
from robot_lab import Lab, Run, Watcher, made

from jacaros.artifacts import ArtifactId, Atom, Out, Structure
from jacaros.artifacts.env.values import text
from jacaros.robots.artifacts.operator_artifact import Operator
from jacaros.robots.ros.qos import LATCHED

STRING, TRIGGER = "std_msgs/msg/String", "std_srvs/srv/Trigger"
ROOMS = [Atom("kitchen"), Atom("hall")]

pytestmark = made(Operator, Structure("timeout", (60,)))


class Questions:
    """What another node sees of the questions, and its answers."""

    def __init__(self, node: Any, name: str) -> None:
        self.node, self.name = node, name
        self.shown: list[list[dict[str, Any]]] = []
        self._answers = node.publisher(f"/{name}/answer", STRING)
        node.subscription(f"/{name}/questions", STRING, self._see, LATCHED)

    def _see(self, sample: Any) -> None:
        self.shown.append(json.loads(sample.message.data))

    def publish(self, data: str) -> None:
        self._answers.publish({"data": data})

    async def press(self, service: str) -> Any:
        return await self.node.client(f"/{self.name}/{service}", TRIGGER).call({}, 5.0)


async def asked(
    lab: Lab, artifact: ArtifactId, text: str = "Where?", options: Any = ROOMS
) -> tuple[Run, Out]:
    answer: Out = Out()
    return await lab.begun(0.1, artifact, "ask", text, options, answer), answer


@pytest.mark.parametrize(
    ("options", "given", "answer"),
    [
        (ROOMS, "kitchen", Atom("kitchen")),
        (ROOMS, Atom("hall"), Atom("hall")),
        (ROOMS, 2, Atom("hall")),
        (ROOMS, " 1 ", Atom("kitchen")),
        ([3, 1], 1, 1),
        ([3, 1], Structure("option", (1,)), 3),
        (["no ", "yes"], "no", "no "),
        ([Structure("go", (1, 2))], "go(1,2)", Structure("go", (1, 2))),
        ([], "in the shed", "in the shed"),
    ],
)
async def test_an_answer_is_an_option_by_text_or_number(
    lab: Lab, artifact: ArtifactId, watcher: Watcher, options: Any, given: Any, answer: Any
) -> None:
    run, out = await asked(lab, artifact, options=options)
    assert watcher.holds("question") == [(1, "Where?", options)]
    await lab.do(artifact, "answer", 1, given)
    await lab.sleep(0.1)
    assert (run.ok, out.value, type(out.value)) == (True, answer, type(answer))
    assert watcher.holds("question") == []
    assert watcher.signals == [("answered", (1, answer, "tester"))]


@pytest.mark.parametrize(
    ("number", "given", "reason"),
    [
        (1, "garage", 'no_option("garage")'),
        (1, 3, "no_option(3)"),
        (1, 0, "no_option(0)"),
        (2, "hall", "no_question(2)"),
    ],
)
async def test_a_refused_answer_leaves_the_question_open(
    lab: Lab, artifact: ArtifactId, watcher: Watcher, number: int, given: Any, reason: str
) -> None:
    run, _ = await asked(lab, artifact)
    refused = await lab.call(artifact, "answer", number, given)
    assert refused.reason == reason
    assert (run.outcome, watcher.signals, len(watcher.holds("question"))) == (None, [], 1)


@pytest.mark.parametrize(
    ("options", "reason", "message"),
    [
        (["yes", " "], 'invalid_option(" ")', "cannot ask `Where?`: option 2 has no text"),
        (["no ", Atom("no")], "invalid_option(no)", "cannot ask `Where?`: two options have the text `no`"),
    ],
)
async def test_options_that_no_text_selects_are_refused(
    lab: Lab, artifact: ArtifactId, watcher: Watcher, options: Any, reason: str, message: str
) -> None:
    run, _ = await asked(lab, artifact, options=options)
    assert (run.reason, run.message, watcher.changes) == (reason, message, [])


async def test_no_answer_in_time_fails_the_operation(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    run, _ = await asked(lab, artifact)
    await lab.sleep(59.8)
    assert run.outcome is None
    await lab.sleep(0.2)
    assert (run.reason, run.message) == ("no_answer(60)", "no answer within 60 s: Where?")
    assert watcher.holds("question") == []


@made(Operator, Structure("timeout", (60,)), Structure("default", (Atom("hall"),)))
async def test_the_default_answers_questions_that_have_it(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    first, where = await asked(lab, artifact)
    second, _ = await asked(lab, artifact, "Again?", [Atom("yes"), Atom("no")])
    await lab.sleep(60)
    assert (first.ok, where.value, second.reason) == (True, "hall", "no_answer(60)")
    assert watcher.signals == [("answered", (1, "hall", "default"))]


async def test_a_dropped_question_is_withdrawn_everywhere(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    seen = Questions(await lab.node("panel"), artifact.name)
    run, _ = await asked(lab, artifact)
    await asked(lab, artifact, "And where is the box?")
    await run.drop(0.1)
    assert watcher.holds("question") == [(2, "And where is the box?", ROOMS)]
    assert [each["question"] for each in seen.shown[-1]] == [2]


async def test_disposing_the_artifact_ends_its_questions(lab: Lab, artifact: ArtifactId) -> None:
    seen = Questions(await lab.node("panel"), artifact.name)
    run, _ = await asked(lab, artifact)
    lab.workspace.dispose_artifact(artifact)
    await lab.sleep(0.1)
    assert (run.ok, seen.shown[-1], lab.logged[1:]) == (False, [], [])  # the first line is the question
    assert not [name for name in (await lab.backend.contents()).services if "question" in name]


async def test_a_node_that_comes_late_sees_and_answers(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    run, out = await asked(lab, artifact)
    seen = Questions(await lab.node("panel"), artifact.name)
    await lab.sleep(0.1)
    services = [f"/{artifact.name}/question_1/option_{place}" for place in (1, 2)]
    question = {"question": 1, "agent": "tester", "text": "Where?", "options": ["kitchen", "hall"]}
    assert seen.shown == [[{**question, "services": services}]]
    seen.publish('{"question": 1, "answer": "garage"}')
    await lab.sleep(0.1)
    assert seen.shown[-1][0]["refused"] == "`garage` is not an answer to question 1: expected kitchen, hall"
    seen.publish('{"question": 1, "answer": "kitchen"}')
    await lab.sleep(0.1)
    assert (run.ok, out.value, seen.shown[-1]) == (True, "kitchen", [])
    assert watcher.signals[1:] == [("answered", (1, "kitchen", "ros"))]


async def test_a_service_answers_and_then_refuses(lab: Lab, artifact: ArtifactId) -> None:
    run, out = await asked(lab, artifact)
    seen = Questions(await lab.node("panel"), artifact.name)
    reply = await seen.press("question_1/option_2")
    assert (reply.success, reply.message, run.ok, out.value) == (True, "hall", True, "hall")
    late = await seen.press("question_1/option_1")
    assert (late.success, late.message) == (False, "question 1 is not open")
    await asked(lab, artifact)
    await lab.sleep(0.5)
    await seen.press("question_2/option_1")
    await lab.sleep(0.5)  # the services of the first one are closed, not those of the second one
    late = await seen.press("question_2/option_1")
    assert (late.success, late.message) == (False, "question 2 is not open")
    await lab.sleep(2)
    assert not [name for name in (await lab.backend.contents()).services if "question" in name]


async def test_each_artifact_has_its_own_topics(lab: Lab, artifact: ArtifactId) -> None:
    others = await lab.make(Operator, name="2nd operator"), await lab.make(Operator, "r1", name="operator")
    runs = [(await asked(lab, each))[0] for each in (artifact, *others)]
    for number, name in enumerate(("_2nd_operator", "r1/operator"), 1):
        seen = Questions(await lab.node(f"panel_{number}"), name)
        seen.publish('{"question": 1, "answer": "hall"}')
        await lab.sleep(0.1)
        assert [run.outcome is not None for run in runs] == [False, True, number == 2]


@pytest.mark.parametrize(
    "data",
    [
        "",
        "[]",
        "{}",
        '{"question": null, "answer": "hall"}',
        '{"question": 1e999, "answer": ""}',
        "[" * 100_000,
    ],
)
async def test_an_unreadable_message_is_logged(lab: Lab, artifact: ArtifactId, data: str) -> None:
    run, _ = await asked(lab, artifact)
    Questions(await lab.node("panel"), artifact.name).publish(data)
    await lab.sleep(0.1)
    assert run.outcome is None
    assert "answer refused: expected JSON" in lab.logged[-1]


@pytest.mark.parametrize(
    ("data", "why"),
    [
        ("yes", 'unreadable("yes")'),
        ('{"question": 1, "answer": "garage"}', 'refused("garage")'),
        ('{"question": 2, "answer": "hall"}', 'refused("hall")'),
    ],
)
async def test_a_flood_of_refused_messages_does_not_fill_the_log(
    lab: Lab, artifact: ArtifactId, watcher: Watcher, data: str, why: str
) -> None:
    run, _ = await asked(lab, artifact)
    seen = Questions(await lab.node("panel"), artifact.name)
    for _ in range(30):
        seen.publish(data)
        await lab.sleep(0.1)
    assert [line for line in lab.logged if "(10 times so far)" in line] == lab.logged[2:]
    assert [(name, text(values[1])) for name, values in watcher.signals] == [("bad_message", why)] * 2
    seen.publish('{"question": 1, "answer": "hall"}')
    await lab.sleep(0.1)
    assert run.ok


class Typed:
    """Lines as a terminal has them."""

    def __init__(self, *lines: str | None) -> None:
        self.lines = list(lines)
        self.waiting: list[Callable[[str | None], None]] = []

    def next_line(self, callback: Callable[[str | None], None]) -> None:
        self.waiting.append(callback)

    async def type(self, lab: Lab, line: str | None) -> None:
        self.waiting.pop(0)(line)
        await lab.sleep(0.1)


async def test_a_line_answers_the_oldest_question(lab: Lab, artifact: ArtifactId, watcher: Watcher) -> None:
    typed = Typed()
    lab.environment.resources["input"] = typed  # type: ignore[index]  # a dict in this laboratory
    (first, where), (second, again) = await asked(lab, artifact), await asked(lab, artifact, "Again?")
    for line in ("", "garage", "2", "kitchen"):
        assert len(typed.waiting) == 1
        await typed.type(lab, line)
    assert (first.ok, where.value, second.ok, again.value) == (True, "hall", True, "kitchen")
    assert watcher.signals[0] == ("answered", (1, "hall", "terminal"))
    assert typed.waiting == []
    third, _ = await asked(lab, artifact)
    await typed.type(lab, None)
    await asked(lab, artifact)
    assert (typed.waiting, third.outcome) == ([], None)  # the end of the input: nothing more is read


async def test_operators_of_one_name_in_two_workspaces_have_topics_of_their_own(
    lab: Lab, artifact: ArtifactId
) -> None:
    lab.workspace = lab.environment.create_workspace("/main/lab")
    there = await lab.make(Operator, name=artifact.name)
    node = await lab.node("panel")
    here, theirs = Questions(node, artifact.name), Questions(node, f"lab/{artifact.name}")
    await asked(lab, there)
    assert (here.shown, len(theirs.shown[-1])) == ([], 1)

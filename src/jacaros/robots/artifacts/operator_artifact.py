"""``Operator``: questions of agents to a person, who answers on the live page, in the terminal or over ROS."""

import asyncio
import json
import re
from dataclasses import dataclass, field
from functools import partial
from typing import Any, ClassVar

from jacaros.artifacts.env.artifact import Out, internal_operation, operation
from jacaros.artifacts.env.environment import write_line
from jacaros.artifacts.env.errors import OperationFailed
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.artifacts.env.values import text as text_of
from jacaros.robots.kit.options import positive
from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.robots.ros.backend import Sample
from jacaros.robots.ros.errors import RosError
from jacaros.robots.ros.qos import LATCHED
from jacaros.robots.ros.services import Service

PATIENCE = 300.0
"""Default of the option ``timeout``, in seconds: a question must not block a goal forever."""
LINGER = 1.0
"""Seconds that the services of an answered question still reply: the response to the answer itself, and to late ones."""
TEXT, TRIGGER = "std_msgs/msg/String", "std_srvs/srv/Trigger"


@dataclass(eq=False)
class _Question:
    number: int
    agent: str
    text: str
    options: list[object]
    answer: asyncio.Future[object]
    services: list[Service] = field(default_factory=list)
    refused: str = ""

    def chosen(self, answer: object) -> object:
        """Return the option that *answer* means by its text or number, or the text itself; None for neither."""
        written = text_of(answer).strip()
        if not self.options:
            return written or None
        for option in self.options:
            if text_of(option).strip() == written:
                return option
        if isinstance(answer, Structure) and answer.functor == "option" and len(answer.arguments) == 1:
            written = text_of(answer.arguments[0])
        place = int(written) if written.isdecimal() and len(written) < 4 else 0
        return self.options[place - 1] if 0 < place <= len(self.options) else None

    def line(self) -> str:
        """Return the question for a terminal."""
        options = " ".join(f"{place}) {text_of(each)}" for place, each in enumerate(self.options, 1))
        return f"question {self.number}: {self.text} {options or '(type an answer)'}"

    def data(self) -> dict[str, object]:
        """Return the question for the topic."""
        found = {"question": self.number, "agent": self.agent, "text": self.text}
        more = {"options": [*map(text_of, self.options)], "services": [each.name for each in self.services]}
        return {**found, **more, **({"refused": self.refused} if self.refused else {})}


class Operator(RosArtifact):
    """Lets agents ask a person.

    A question appears on the live page, in the terminal of ``jacaros run`` and on a ROS topic, and can be answered in
    each of them. Several questions can be open at the same time; a line of the terminal answers the oldest one. An
    answer means an option by its text or its number, from 1; a question without options accepts any text. An answer
    that is not an option is refused with the reason, and the question stays open.

    ROS, below the artifact's name (each character that ROS does not allow is ``_``), such as ``operator/``, or
    ``lab/operator/`` in a workspace ``/main/lab``; in a program without robots only if its project names a world:
    ``questions`` has the open questions (``std_msgs/msg/String``, latched), a list in JSON of objects with ``question``
    (its number), ``agent``, ``text``, ``options``, ``services``, and ``refused`` (why the last answer from ROS was
    refused). Publish ``{"question": 1, "answer": "kitchen"}`` on ``answer``, or call the service
    ``question_1/option_2`` (``std_srvs/srv/Trigger``).

    Options:
        timeout(S): seconds that a question stays open (300).
        default(A): answer to a question that was not answered in time, if it is one of its options or it has none.

    Properties:
        question(Id, Text, Options): an open question; one for each.

    Signals:
        answered(Id, Answer, By): a question has been answered. By is ``page``, ``terminal``, ``ros``, ``default``, or
            the agent that called ``answer``.
        bad_message(Topic, Why): an answer from ROS was refused. Why is ``refused(Answer)`` or ``unreadable(Text)``.
    """

    known_options: ClassVar = {"timeout": positive, "default": lambda value: value}
    _reading = False

    def open(self) -> None:
        """Open the topics."""
        self._patience = self.option("timeout", PATIENCE)
        self._last = 0
        self._open: dict[int, _Question] = {}
        self._lingering: list[Service] = []
        self.at_dispose(self._close_services)
        names = self.id.path.removeprefix("/main/").strip("/").split("/")
        self._ros_name = "/".join(re.sub(r"^(?=\d)|[^A-Za-z0-9_]", "_", each) for each in names)
        self._topic = None
        # Without an open graph, no node listens: do not open the default world for a question.
        if not self.resources.get("graph_unused") and self.resources.get("ros") is not None:
            self._topic = self.publisher(f"{self._ros_name}/questions", TEXT, LATCHED)
            heard = f"{self._ros_name}/answer"
            self.kept(self.ros.subscription(self.robot_topic(heard), TEXT, self._take_message))
            self._faults = self.faults_of(heard)

    @operation
    async def ask(self, question: str, options: list[object], answer: Out) -> None:
        """Ask a person, and give the answer: one of *options*, or any text if the list is empty.

        Fails with ``no_answer(Seconds)`` after `timeout` without an answer and a `default`, and with
        ``invalid_option(Option)`` if the text of an option is empty or that of another one. The question is withdrawn
        when its intention is dropped.
        """
        texts = [text_of(each).strip() for each in options]
        for place, (each, written) in enumerate(zip(options, texts, strict=True)):
            if not written or written in texts[:place]:
                wrong = (
                    f"two options have the text `{written}`" if written else f"option {place + 1} has no text"
                )
                self.fail(f"cannot ask `{question}`: {wrong}", "invalid_option", each)
        asked = self._ask(question, options)
        timer = self.clock.call_later(self._patience, partial(self.start, self.expire, asked.number))
        try:
            answer.set(await self.step(asked.answer))
        except TimeoutError:
            self._withdraw(asked)
            self.commit()
            self.fail(f"no answer within {self._patience:g} s: {question}", "no_answer", self._patience)
        finally:
            timer.cancel()
            self._withdraw(asked)

    @operation(name="answer")
    def take_answer(self, question: int, answer: object) -> None:
        """Answer the open question with this number.

        ``option(N)`` means option N even if another option has the text N. Fails with ``no_question(Id)`` if it is not
        open, and with ``no_option(Answer)``.
        """
        self._settle(question, answer, self.caller or Atom("unknown"))

    @internal_operation
    def expire(self, number: int) -> None:
        """Answer a question with the default, or let it fail."""
        asked, default = self._open.get(number), self.option("default", None)
        if asked is None:
            return
        if default is not None and asked.chosen(default) is not None:
            self._settle(number, default, Atom("default"))
        elif not asked.answer.done():
            asked.answer.set_exception(TimeoutError())

    @internal_operation
    def hear(self, number: int, answer: object, by: Atom) -> None:
        """Take an answer of a person; if it is refused, log why."""
        try:
            self._settle(number, answer, by)
        except OperationFailed as refused:
            if by != "ros":
                self.log(f"answer refused: {refused.message}")
                return
            self._faults.add(Structure("refused", (answer,)), f"answer refused: {refused.message}")
            if number in self._open:
                self._open[number].refused = refused.message
                self._publish()

    @internal_operation
    def hear_line(self, line: str) -> None:
        """Take a line of the terminal as the answer to the oldest question."""
        if line.strip() and not self._open:
            self.log("answer refused: no question is open")
        elif line.strip():
            self.hear(next(iter(self._open)), line, Atom("terminal"))
        self._read()

    # ---- one question

    def _ask(self, text: str, options: list[object]) -> _Question:
        self._last += 1
        answer: asyncio.Future[object] = asyncio.get_running_loop().create_future()
        asked = _Question(self._last, str(self.caller or ""), str(text), list(options), answer)
        self._open[asked.number] = asked
        self.define_property("question", asked.number, asked.text, asked.options)
        if self._topic is not None:
            asked.services += self._services(asked)
        self._publish()
        write_line(self, asked.line())
        self._read()
        return asked

    def _settle(self, number: int, answer: object, by: Atom) -> None:
        asked = self._open.get(number)
        if asked is None:
            self.fail(f"question {number} is not open", "no_question", number)
        chosen = asked.chosen(answer)
        if chosen is None:
            options = ", ".join(map(text_of, asked.options)) or "a text"
            self.fail(
                f"`{text_of(answer):.100}` is not an answer to question {number}: expected {options}",
                "no_option",
                answer,
            )
        self._withdraw(asked)
        self.signal("answered", number, chosen, by)
        self.log(f"question {number} answered by {by}: {text_of(chosen):.200}")
        asked.answer.set_result(chosen)

    def _withdraw(self, asked: _Question) -> None:
        """Remove an open question."""
        if self._open.pop(asked.number, None) is not None:
            self.remove_property("question", asked.number, None, None)
            self._lingering += asked.services
            self.clock.call_later(LINGER, partial(self._close_services, len(asked.services)))
            self._publish()

    # ---- where people answer

    def _read(self) -> None:
        """Read a line of the terminal while a question is open."""
        lines = self.resources.get("input")
        if lines is not None and self._open and not self._reading:
            self._reading = True
            lines.next_line(self._take_line)  # type: ignore[attr-defined]  # resources are untyped

    def _take_line(self, line: str | None) -> None:
        self._reading = line is None  # the end of the input: do not read again
        if line is not None:
            self.start(self.hear_line, line)

    def _take_message(self, sample: Sample) -> None:
        try:
            given = json.loads(sample.message.data)
            number, answer = int(given["question"]), str(given["answer"])
        except (ValueError, OverflowError, TypeError, KeyError, RecursionError):
            told = 'answer refused: expected JSON such as {"question": 1, "answer": "yes"}'
            self._faults.add(Structure("unreadable", (sample.message.data[:100],)), told)
            return
        self.start(self.hear, number, answer, Atom("ros"), cause=sample.cause)

    def _services(self, asked: _Question) -> list[Service]:
        """Offer a service for each option. A question can be answered without them, so an error is only logged."""

        def press(option: object, _: object) -> dict[str, Any]:
            if asked.number not in self._open:
                return {"success": False, "message": f"question {asked.number} is not open"}
            self.start(self.hear, asked.number, option, Atom("ros"))
            return {"success": True, "message": text_of(option)}

        try:
            return [
                self.ros.service(
                    self.robot_topic(f"{self._ros_name}/question_{asked.number}/option_{place}"),
                    TRIGGER,
                    partial(press, option),
                )
                for place, option in enumerate(asked.options, 1)
            ]
        except RosError as error:
            self.log(f"warning: no services for question {asked.number}: {error}")
            return []

    def _close_services(self, oldest: int | None = None) -> None:
        for each in self._lingering[:oldest]:
            each.close()
        del self._lingering[:oldest]

    def _publish(self) -> None:
        if self._topic is not None:
            shown = json.dumps([each.data() for each in self._open.values()], ensure_ascii=False)
            self._topic.publish({"data": shown})

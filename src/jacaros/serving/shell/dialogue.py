"""The lines of a console, and what each of them does."""

import re
from collections.abc import Callable, Sequence
from itertools import groupby

from jacaros.runtime.errors import JacarosError, UsageError
from jacaros.runtime.files.texts import suggestion
from jacaros.serving.client import Client, Json, Offered, ServiceError
from jacaros.serving.shell.choice import GOALS, QUESTIONS, TELLS, chosen, noun
from jacaros.serving.shell.wording import answer_lines, error_text, event_text, state_text

HELP = """\
!deliver("p1", kitchen)  give a goal to the agent that offers it
?battery(Level)          ask a question, or for a belief
+closed(kitchen)         tell a belief
-closed(kitchen)         take it back
bob !deliver("p1", lab)  the same of one agent, if several offer it
agents                   list the agents and what they offer
beliefs                  list the beliefs that agents offer
goals                    list the newest goals
cancel N                 cancel goal N
why EVENT                explain the run, such as: why +battery(50)
questions                list open questions of agents to a person
answer ID TEXT           answer one
quit                     leave (or press Ctrl+D)"""
SIGNS = {"goal": "!", "question": "?", "belief": "?", "tell": "+"}
"""What a line begins with, by the kind of the offer."""
KEPT = 1_000
"""Number of goals whose numbers are known."""
_NOTHING = "no agent offers anything to you"
_KINDS = {"!": GOALS, "?": QUESTIONS, "+": TELLS, "-": TELLS}
_REQUEST = re.compile(r"(?:(?P<agent>[\w.]+)\s+)?(?P<sign>[!?+-])\s*(?P<text>.+?)\.?", re.DOTALL)


def written(kind: str, agent: str, text: str) -> str:
    """Return a request as a line of the console."""
    return f"{agent} {SIGNS[kind]}{text}".strip()


class Dialogue:
    """Executes lines.

    Args:
        client: the system.
        show: prints a line.
        waits: wait for the end of each goal, as in a script. Otherwise the caller shows `event`.
    """

    def __init__(self, client: Client, show: Callable[[str], None], waits: bool) -> None:
        self._client, self._show, self._waits = client, show, waits
        self._numbers: dict[str, int] = {}
        self._newest = 0
        self._told: dict[str, str] = {}
        self.offers: Sequence[Offered] = ()
        self.commands: dict[str, Callable[[str], object]] = {
            "agents": self._list_agents,
            "answer": self._answer,
            "beliefs": self._list_beliefs,
            "cancel": self._cancel,
            "goals": self._list_goals,
            "help": lambda _: self._show(HELP),
            "questions": self._list_questions,
            "why": lambda text: self._show(client.why(text)),
            "quit": lambda _: None,
        }

    def greet(self) -> None:
        """Show which agents offer something."""
        names = ", ".join(dict.fromkeys(each.agent for each in self.offers))
        told = f"agents: {names}" if names else _NOTHING
        self._show(f"{told}; `help` lists what you can write")

    def refresh(self) -> None:
        """Read what the agents offer now."""
        self.offers = self._client.offers()

    def execute(self, line: str) -> bool:
        """Execute a line. Return False if it fails."""
        try:
            return self._execute(line.strip())
        except JacarosError as error:
            self._show(error_text(error))
        return False

    def _execute(self, line: str) -> bool:
        if not line or line.startswith("//"):
            return True
        name, _, rest = line.partition(" ")
        command = self.commands.get(name)
        if command is not None:
            command(rest.strip())
            return True
        if found := _REQUEST.fullmatch(line):
            return self._request(found["agent"] or "", found["sign"], found["text"])
        help = suggestion(name, self.commands, "`!goal`, `?question`, `+belief`, `-belief`, or `help`")
        raise UsageError(f"error: unknown command: `{name}`\n  = help: {help}")

    def _request(self, agent: str, sign: str, text: str) -> bool:
        self.refresh()
        offer = chosen(self.offers, _KINDS[sign], text, agent, written)
        try:
            if sign == "!":
                return self._achieve(offer.agent, text)
            if sign == "?":
                self._show("\n".join(answer_lines(self._client.ask(offer.agent, text))))
            else:
                self._client.tell(offer.agent, text, untell=sign == "-")
        except ServiceError as error:
            self._show(error_text(error))
            return False
        return True

    # ---- goals

    def _achieve(self, agent: str, text: str) -> bool:
        if not self._waits:
            self._client.achieve(agent, text)
            return True
        state = ""
        for goal in self._client.follow(lambda: self._client.achieve(agent, text)):
            state = goal["state"]
            if told := self.event({"event": "goal", **goal}):
                self._show(told)
        return state == "achieved"

    def event(self, event: Json) -> str:
        """Return an event as a line; empty if it brings nothing new."""
        if event["event"] != "goal":
            return event_text(event)
        id, told = event["id"], event_text(event, f"goal {self._number(event['id'])}")
        is_news = event["state"] != "pending" and told != self._told.get(id)
        self._told[id] = told
        return told if is_news else ""

    def _number(self, id: str) -> int:
        if id not in self._numbers:
            self._newest += 1
            self._numbers[id] = self._newest
            if len(self._numbers) > KEPT:
                oldest = next(iter(self._numbers))
                del self._numbers[oldest]
                self._told.pop(oldest, None)
        return self._numbers[id]

    def _list_goals(self, _: str) -> None:
        lines = (
            f"{self._number(each['id']):3}  [{each['agent']}] !{each['written']} for {each['caller']}: {state_text(each)}"
            for each in self._client.goals()
        )
        self._show("\n".join(lines) or "no goals")

    def _cancel(self, text: str) -> None:
        id = next((id for id, number in self._numbers.items() if str(number) == text), None)
        if id is None:
            known = "`goals` lists their numbers" if self._numbers else "no goal has been given"
            raise UsageError(f"error: unknown goal: `{text}`\n  = help: {known}")
        self._client.cancel(id)

    # ---- what there is

    def _list_agents(self, _: str) -> None:
        self.refresh()
        lines: list[str] = []
        for agent, offers in groupby(self.offers, lambda each: each.agent):
            lines.append(agent)
            lines += [
                f"  {noun(each.kind):14} {SIGNS.get(each.kind, '')}{each.form}  {each.doc}".rstrip()
                for each in offers
            ]
        self._show("\n".join(lines) or _NOTHING)

    def _list_beliefs(self, _: str) -> None:
        self.refresh()
        lines = [
            f"[{each.agent}] {each.name}: {line}"
            for each in self.offers
            if each.kind == "belief"
            for line in answer_lines(self._client.beliefs(each.agent, each.name))
        ]
        self._show("\n".join(lines) or "no agent offers beliefs to you")

    # ---- questions to a person

    def _list_questions(self, _: str) -> None:
        lines = [
            f"{each['id']}: {each['text']}"
            + "".join(f" {number}) {text}" for number, text in enumerate(each["options"], 1))
            for each in self._client.questions()
        ]
        self._show("\n".join(lines) or "no open questions")

    def _answer(self, text: str) -> None:
        id, _, given = text.partition(" ")
        asked = next((each for each in self._client.questions() if each["id"] == id), None)
        is_option = asked is not None and asked["options"] and given.isdecimal()
        self._client.answer(id, int(given) if is_option else given)

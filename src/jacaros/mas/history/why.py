"""Answers to questions about a run, from its records."""

from collections.abc import Iterable

from jacaros.errors import UsageError
from jacaros.mas.history.about_beliefs import explain_belief
from jacaros.mas.history.about_events import explain_event, known_names
from jacaros.mas.history.about_motion import explain_command, explain_operation, explain_stop
from jacaros.mas.history.about_plans import explain_plan
from jacaros.mas.history.about_waiting import explain_idleness, explain_waiting
from jacaros.mas.history.chains import is_written
from jacaros.mas.history.explanation import Explanation
from jacaros.mas.history.past import Past, Record
from jacaros.mas.history.patterns import Pattern, name_of
from jacaros.mas.history.questions import Question, read_question, unknown_question


def explain(
    records: Iterable[Record], question: str, at: float | None = None, agent: str = "", robot: str = ""
) -> Explanation:
    """Answer a question about a run.

    Args:
        records: (t, event, data), as described in docs/reference/recordings.md, the oldest first.
        question: see `jacaros.mas.history.questions`.
        at: seconds since the run began; later records are ignored. None: the end of the records.
        agent: only goals, plans and beliefs of this agent; empty for all.
        robot: only commands to this robot; empty for all.

    Raises:
        UsageError: the question is not understood, or names an unknown plan or agent.
    """
    past = Past.of(records, at)
    asked = read_question(question, known_names(past))
    words = question.strip(" ?").split()
    if agent and agent not in past.agents:
        known = ", ".join(past.agents) or "none"
        raise UsageError(f"error: unknown agent: `{agent}`\n  = help: agents until {past.end:.3f} s: {known}")
    agent = agent or next((word for word in words if word in past.agents), "")
    robot = robot or next((word for word in words if word in past.robots), "")
    if asked.kind == "name":
        asked = _named(past, asked, agent)
    return _answer(past, asked, agent, robot)


def _answer(past: Past, asked: Question, agent: str, robot: str) -> Explanation:
    question, about = asked.written, asked.about
    if asked.kind == "stopped":
        return explain_stop(past, question, agent, robot)
    if asked.kind == "command":
        return explain_command(past, question, about, robot)
    if asked.kind == "operation":
        return explain_operation(past, question, about, agent)
    if asked.kind == "waiting":
        return explain_waiting(past, question, agent)
    if asked.kind == "idle":
        return explain_idleness(past, question, agent)
    explain_it = {"plan": explain_plan, "belief": explain_belief}.get(asked.kind, explain_event)
    return explain_it(past, question, about, agent)


def _named(past: Past, asked: Question, agent: str) -> Question:
    """Resolve a lone word: a belief, a goal or the label of a plan.

    Raises:
        UsageError: it is unknown.
    """
    pattern, name = Pattern(asked.about), asked.about
    if any(pattern.fits_literal(str(data.get("belief", ""))) for _, data in past.beliefs):
        return Question(asked.written, "belief", name)
    if any(name_of(str(data.get("goal", ""))) == name for _, data in past.goals):
        return Question(asked.written, "event", f"!{name}")
    if any(
        str(each.data.get("operation", "")).partition("(")[0] == name for each in past.operations.values()
    ):
        return Question(asked.written, "operation", name)
    labels = {str(plan.get("label") or "") for _, plan in past.plans(agent)}
    if name in labels:
        return Question(asked.written, "plan", f"@{name}")
    if any(name_of(str(plan.get("trigger", ""))) == name for _, plan in past.plans(agent)):
        trigger = next(
            str(p["trigger"]) for _, p in past.plans(agent) if name_of(str(p.get("trigger", ""))) == name
        )
        return Question(asked.written, "event", trigger.partition("(")[0])
    raise unknown_question(asked.written, known_names(past) | set(filter(is_written, labels)))

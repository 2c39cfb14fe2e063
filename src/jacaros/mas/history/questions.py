"""Questions about a run: a small grammar that ignores filler words.

======================================  ==================================================================
``stopped``                             why the robot stopped
``command``, ``command /cmd_vel``       what led to the last command (on a topic)
``operation``, ``operation dock``       what led to the last operation (of a name), and how it ended
``+alarm(_)``, ``-door(open)``          why an event of a belief was handled as it was, or was not handled
``!go(dock)``, ``+!go(_)``, ``-!go(_)``  the same for a goal, or its failure
``?level(X)``, ``+?level(_)``           the same for a test goal, or a question of another agent
``plan @label``, ``plan robot.asl:14``  when a plan was chosen, and why it was not
``belief battery(_)``                   what last changed a belief
``waiting``                             what each intention waits for
``nothing``, ``idle``                   why nothing happens
======================================  ==================================================================
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass

from jacaros.errors import UsageError
from jacaros.files.texts import help_line, suggestion
from jacaros.mas.history.patterns import Pattern

FORMS = (
    ("stopped", "why the robot stopped"),
    ("command [TOPIC]", "what led to the last command"),
    ("operation [NAME]", "what led to the last operation"),
    ("+EVENT, -EVENT", "how an event of a belief was handled, such as `+alarm(_)`"),
    ("!GOAL, ?TEST, -!GOAL", "the same for a goal, a test goal or a failure"),
    ("plan @LABEL, plan FILE:LINE", "when a plan was chosen, and why it was not"),
    ("belief BELIEF", "what last changed a belief, such as `battery(_)`"),
    ("waiting", "what each intention waits for"),
    ("nothing", "why nothing happens"),
)
"""The forms of questions, with their meanings."""

MOST_NAMES = 12
"""Number of names that the error for an unknown question lists."""

_PLAN = re.compile(r"@\w+|[\w./\\-]+\.asl:\d+")
_EVENT = re.compile(r"(?:^|(?<=[\s`'\"]))(?:[+\-]?[!?]|[+\-^])(?=~?[a-z_'])")
_LITERAL = re.compile(r"~?[a-z]\w*(?=\()|(?:(?<=belief\s)|(?<=changed\s))~?[a-z]\w*")
_NAME = re.compile(r"~?(?:\w+::)?(?:'[^']*'|\w+)")
_WORDS = {
    "stopped": (
        "stop",
        "stopped",
        "stops",
        "stopping",
        "stand",
        "stands",
        "standing",
        "still",
        "halt",
        "halted",
    ),
    "command": ("command", "commands", "commanded", "drive", "drives", "driving", "move", "moves", "moving"),
    "operation": ("operation", "operations"),
    "waiting": ("wait", "waits", "waiting"),
    "idle": ("nothing", "idle", "stuck", "hang", "hangs", "silent"),
}
_FILLERS = frozenset(
    re.findall(
        r"\w+",
        "why what did do does is was were are the a an it its this that not no there robot agent agents happen "
        "happens happened last of on for by from about because led caused event goal then",
    )
)
_STARTS_NAME = re.compile(r"[~a-z]\w*$")


@dataclass(frozen=True, slots=True)
class Question:
    """A parsed question.

    Attributes:
        written: as it was asked.
        kind: ``stopped``, ``command``, ``operation``, ``event``, ``plan``, ``belief``, ``waiting``, ``idle`` or ``name``
            (a lone word, which may be a belief, a goal or a label).
        about: its subject: a literal, a plan, a topic; empty without one.
    """

    written: str
    kind: str
    about: str = ""


def read_question(written: str, known: Iterable[str] = ()) -> Question:
    """Parse a question. *known* names are suggested if it is not understood.

    Raises:
        UsageError: it has none of the `FORMS`. The text lists them.
    """
    asked = written.strip(" ?.`'\"\n") if written.strip(" `'\"?") else written
    asked = f"?{asked}" if written.lstrip(" `'\"").startswith("?") else asked
    found = _PLAN.search(asked)
    if found is not None:
        return Question(written, "plan", found[0])
    found = _EVENT.search(asked)
    if found is not None:
        of_plan = "plan" in asked[: found.start()].split()
        event = found[0] + literal_at(asked, found.end())
        Pattern(event)  # raises if it is not a literal
        return Question(written, "plan" if of_plan else "event", event)
    words = asked.split()
    if words[:1] == ["plan"] and len(words) > 1:
        return Question(written, "plan", " ".join(words[1:]))
    if asked.startswith("belief(") and asked.endswith(")"):
        asked = f"belief {asked.removeprefix('belief(')[:-1]}"
    found = _LITERAL.search(asked)
    if found is not None:
        return Question(written, "belief", literal_at(asked, found.start()))
    question = _of_words(written, words)
    if question is None:
        raise unknown_question(written, known)
    return question


def literal_at(text: str, start: int) -> str:
    """Return the literal at a position of a text, without what follows its name and arguments."""
    name = _NAME.match(text, start)
    if name is None:
        return text[start:]
    if text[name.end() : name.end() + 1] != "(":
        return name[0]
    depth, quoted = 0, False
    for at in range(name.end(), len(text)):
        quoted ^= text[at] == '"'
        depth += 0 if quoted else (text[at] in "([{") - (text[at] in ")]}")
        if depth == 0:
            return text[start : at + 1]
    return text[start:]


def _of_words(written: str, words: list[str]) -> Question | None:
    low = [word.lower().strip(",;:") for word in words]
    for kind, known in _WORDS.items():
        at = next((index for index, word in enumerate(low) if word in known), None)
        if at is not None:
            rest = [word for word in words[at + 1 :] if word.lower() not in _FILLERS]
            return Question(written, kind, rest[0] if rest and kind in ("command", "operation") else "")
    left = [word for word in words if word.lower() not in _FILLERS]
    if len(left) == 1 and _STARTS_NAME.match(left[0]):
        return Question(written, "name", left[0])
    return None


def unknown_question(written: str, known: Iterable[str] = ()) -> UsageError:
    """Return the error for a question that is not understood. *known* are names for suggestions."""
    words = {word for each in _WORDS.values() for word in each}
    names = sorted(set(known))
    last = written.strip(" ?`'\"").split()[-1:] or [""]
    help = suggestion(last[0].lstrip("+-!?"), sorted({*words, *names}))
    lines = [f"error: unknown question: `{written}`"]
    if help:
        lines.append(help_line(help))
    if names:
        more = ", ..." if len(names) > MOST_NAMES else ""
        lines.append(
            f"  = help: events, goals and beliefs of this run: {', '.join(names[:MOST_NAMES])}{more}"
        )
    lines.append("  = help: ask one of")
    width = max(len(form) for form, _ in FORMS)
    lines += [f"      {form:{width}}  {what}" for form, what in FORMS]
    return UsageError("\n".join(lines))

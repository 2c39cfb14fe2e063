"""Judge how a run ended, from the ground truth and from what its program said; and the damage on the way."""

import re
from typing import NamedTuple

from jacaros.robots.world import GroundTruth
from jacaros.testing import RunResult

DONE, TOLD, SILENT = "done", "told", "silent"
ENDS = (DONE, TOLD, SILENT)
"""The outcomes of runs."""

CALL = re.compile(r"(?<!= )\bhelp\b|\bwhat shall I do\?|\bfailed\b", re.IGNORECASE)
"""A call for help, a question to a person, or a logged goal that failed; not the suggested fix of an error in a file."""


class Damage(NamedTuple):
    """What went wrong in the world after the disturbance.

    Attributes:
        bumps: contacts with walls, robots and people.
        empty: whether the battery ran empty.
        elsewhere: tasks that were done in another room than their own.
    """

    bumps: int
    empty: bool
    elsewhere: int


def effect_at(result: RunResult) -> float | None:
    """Return when the disturbance first had an effect, in seconds; None if the program ended before."""
    effects = (event for event in result.ground_truth.events_of("fault") if event.data["state"] == "acts")
    return next((each.time for each in effects if each.time <= result.seconds), None)


def told_at(result: RunResult, effect: float) -> float | None:
    """Return when the program first said that it failed, in seconds of the run's clock; None if it did not.

    It says so by a call for help, by a goal that is logged as failed, or by an exit status other than 0.  A word before
    the *effect* is about something else.
    """
    calls = (time for time, text in result.timed if time >= effect and CALL.search(text))
    return next(calls, result.seconds if result.exit_code else None)


def end_of(told: float | None, done: bool) -> str:
    """Return how a run ended: one of `ENDS`."""
    if done:
        return DONE
    return SILENT if told is None else TOLD


def damage(truth: GroundTruth, effect: float) -> Damage:
    """Return the damage from the *effect* on."""
    events = [event for event in truth.events if event.time >= effect]
    tasks = (event.data for event in events if event.kind == "task")
    return Damage(
        sum(event.kind in ("bump", "collision") for event in events),
        any(event.kind == "battery_empty" for event in events),
        sum(not data["task"].endswith(data["room"] or "nowhere") for data in tasks),
    )

"""How a run ended, judged from the ground truth and from what its program said; and the damage on the way."""

import re
from typing import NamedTuple

from jacaros.robots.world import GroundTruth
from jacaros.testing import RunResult

DONE, TOLD, AS_IF_DONE, HUNG = "done", "failed and told", "ended as if done", "hung in silence"
ENDS = (DONE, TOLD, AS_IF_DONE, HUNG)
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


def told_at(result: RunResult) -> float | None:
    """Return when the program first said that it failed: seconds of the run's clock; None if it did not.

    It says so by a call for help, by a goal that is logged as failed, or by an exit status other than 0.
    """
    calls = (time for time, text in result.timed if CALL.search(text))
    return next(calls, result.seconds if result.exit_code else None)


def end_of(result: RunResult, passed: bool, limit: float) -> str:
    """Return how a run ended that was stopped after *limit* seconds: one of `ENDS`."""
    if passed:
        return DONE
    if told_at(result) is not None:
        return TOLD
    return HUNG if result.seconds >= limit else AS_IF_DONE


def disturbed_at(truth: GroundTruth) -> float | None:
    """Return when the first disturbance began, in seconds; None if the program had ended before."""
    begins = (event.time for event in truth.events_of("fault") if event.data["state"] == "begins")
    return next(begins, None)


def damage(truth: GroundTruth) -> Damage:
    """Return the damage after the first disturbance."""
    begin = disturbed_at(truth)
    events = [event for event in truth.events if begin is not None and event.time >= begin]
    tasks = (event.data for event in events if event.kind == "task")
    return Damage(
        sum(event.kind in ("bump", "collision") for event in events),
        any(event.kind == "battery_empty" for event in events),
        sum(not data["task"].endswith(data["room"] or "nowhere") for data in tasks),
    )

"""The values that conditions of programs compare a belief with, as series: numbers, or other beliefs."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

from jacaros.look.out.series import Series
from jacaros.look.records.recording import Recording

_GENERATED_LABEL = re.compile(r"p__\d+")


def limits(recording: Recording, series: Series, known: Sequence[Series]) -> list[tuple[str, Series]]:
    """Return the limits of a belief or property, labelled with their values and the plans that compare them.

    Args:
        recording: the recording, whose `program` records name the comparisons.
        series: the belief or property.
        known: the series of the recording.
    """
    labels: dict[tuple[str, str], dict[str, None]] = {}
    found: dict[tuple[str, str], Series] = {}
    programs = {data["agent"]: data for _, kind, data in recording.events if kind == "program"}
    for agent, program in programs.items():
        if series.source == "robot" or (series.source == "belief" and series.owner != agent):
            continue
        for each in program.get("thresholds", ()):
            if (each["belief"], each["argument"] + 1) != (series.name, int(series.field)):
                continue
            limit = _limit(agent, each, known)
            if limit is not None:
                key = limit.owner, f"{limit.name}.{limit.field}"
                found[key] = limit
                labels.setdefault(key, {})[each.get("rule") or _plan(program, each.get("plan"))] = None
    return [(f"{limit.name}: {', '.join(labels[key])}", limit) for key, limit in found.items()]


def _limit(agent: str, threshold: Mapping[str, Any], known: Sequence[Series]) -> Series | None:
    if threshold.get("value") is not None:
        value = float(threshold["value"])
        return Series("limit", "", f"{value:g}", "", [(0.0, value)])
    wanted = "belief", agent, threshold.get("other"), str(threshold.get("other_argument", 0) + 1)
    return next((each for each in known if (each.source, each.owner, each.name, each.field) == wanted), None)


def _plan(program: Mapping[str, Any], number: Any) -> str:
    """Return the label of a plan, or its trigger if the label is generated."""
    for plan in program["plans"] or ():
        if plan["id"] == number:
            label = plan.get("label") or "p__1"
            return str(plan["trigger"]) if _GENERATED_LABEL.fullmatch(label) else f"@{label}"
    return "a plan"

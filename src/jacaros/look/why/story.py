"""The story of a run in at most ten lines: its goals, failures, breakdowns, faults and interventions, and how it ended."""

from collections.abc import Iterable

from jacaros.look.records.records import Record
from jacaros.look.why.explanation import seconds
from jacaros.look.why.past import Past
from jacaros.look.why.tales import Rank, StoryLine, Teller

MOST = 10
"""Maximum number of lines."""
_OF_END = frozenset({"program", "source", "intention", "ended"})
"""Records that say why a run ended."""


def story_of(happened: Iterable[Record], is_over: bool = True) -> list[StoryLine]:
    """Return the lines of a run, the oldest first. The last one says how it ended, and what was still wanted.

    Args:
        happened: (t, event, data), as described in docs/reference/recordings.md, the oldest first.
        is_over: whether no records follow; otherwise, the last line says that the run continues.
    """
    teller, needed, end = Teller(), [], 0.0
    for record in happened:
        t, event, data = record
        end = max(end, t)
        teller.take(t, event, data)
        if event in _OF_END:  # a Past of all records would take ten times as long
            needed.append(record)
    past = Past.of(needed)
    past.end = end
    kept = sorted(((each.weight, each) for each in teller.tales(past, is_over)), key=lambda each: each[0])[
        :MOST
    ]
    # At the same moment, what happened to a robot comes before what its agent made of it.
    kept.sort(key=lambda each: (each[1].rank == Rank.END, each[1].t, not each[1].robot))
    return [each.line() for _, each in kept]


def story_text(lines: Iterable[StoryLine]) -> str:
    """Return a story as lines of text with the moments, in the form that ``--at`` takes."""
    rows = [(seconds(each.t), "" if each.level == "note" else each.level, _written(each)) for each in lines]
    times, levels = (max((len(row[column]) for row in rows), default=0) for column in (0, 1))
    return "\n".join(f"{t:>{times}}  {level:{levels}}  {text}" for t, level, text in rows)


def _written(line: StoryLine) -> str:
    until = f"until {seconds(line.until)}" if line.until is not None else ""
    folded = ", ".join(filter(None, (f"{line.count} times" if line.count > 1 else "", until)))
    return f"{line.text} ({folded})" if folded else line.text

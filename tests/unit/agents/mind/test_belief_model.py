"""Beliefs as a program changes them, beside a model that is a plain list.

Additions merge annotations, deletions take sources away, the newest answers first: each rule of the language's belief
base is written down here a second time, as simply as possible.
"""

from collections import Counter
from dataclasses import dataclass, field

from hypothesis import given, settings
from hypothesis import strategies as st
from recording_host import mind

from jacaros.agents.terms.text import text

SELF, BOB = "source(self)", "source(bob)"


@dataclass
class Change:
    """One step of a program: an operator, the argument of p (None: a variable), and annotations."""

    operator: str
    value: int | None
    annotations: tuple[str, ...]

    def __str__(self) -> str:
        argument = "_" if self.value is None else str(self.value)
        marks = f"[{','.join(self.annotations)}]" if self.annotations else ""
        if self.operator == "abolish":
            return f".abolish(p({argument}){marks})"
        return f"{self.operator}p({argument}){marks}"

    def with_source(self) -> set[str]:
        """The annotations; who names no source means himself."""
        own = set(self.annotations)
        return own if own & {SELF, BOB} else own | {SELF}


@dataclass
class Model:
    """The beliefs, the first to answer first, and how often each was added and deleted."""

    beliefs: list[tuple[int, set[str]]] = field(default_factory=list)
    events: Counter[str] = field(default_factory=Counter)

    def apply(self, change: Change) -> None:
        """Make a step."""
        if change.operator == "abolish":
            for value, held in list(self.beliefs):
                if change.value in (None, value) and set(change.annotations) <= held:
                    self.beliefs.remove((value, held))
                    self.events[f"minus {value}"] += 1
        elif change.operator == "-":
            self.delete(change.value, change.with_source())
        elif change.operator == "-+":
            self.delete(None, change.with_source())
            self.add(change, last=False)
        else:
            self.add(change, last=change.operator == "+>")

    def add(self, change: Change, *, last: bool) -> None:
        """New annotations are merged; without any there is no event."""
        assert change.value is not None
        wanted = change.with_source()
        for value, held in self.beliefs:
            if value == change.value:
                if not wanted <= held:
                    held |= wanted
                    self.events[f"plus {value}"] += 1
                return
        self.beliefs.insert(len(self.beliefs) if last else 0, (change.value, set(wanted)))
        self.events[f"plus {change.value}"] += 1

    def delete(self, wanted: int | None, annotations: set[str]) -> None:
        """The first that has all annotations loses them; without a source it is gone."""
        for entry in self.beliefs:
            value, held = entry
            if wanted in (None, value) and annotations <= held:
                held -= annotations
                if not held & {SELF, BOB}:
                    self.beliefs.remove(entry)
                self.events[f"minus {value}"] += 1
                return


ANNOTATIONS = st.lists(st.sampled_from(["a", "b", BOB, SELF]), unique=True, max_size=3).map(tuple)
ADDITIONS = st.builds(Change, st.sampled_from(["+", "+>", "+<", "-+"]), st.integers(1, 3), ANNOTATIONS)
DELETIONS = st.builds(
    Change, st.sampled_from(["-", "-", "abolish"]), st.none() | st.integers(1, 3), ANNOTATIONS
)


@settings(max_examples=150)
@given(st.lists(ADDITIONS | DELETIONS, max_size=14))
def test_the_beliefs_equal_those_of_the_model(changes):
    model = Model()
    for change in changes:
        model.apply(change)
    steps = "".join(f"{change}; " for change in changes)
    host = mind(
        f"!s. +!s <- {steps} true. +p(X) <- .print(plus, ' ', X). -p(X) <- .print(minus, ' ', X).".replace(
            "' '", '" "'
        )
    )
    host.run()
    shown = [f"p({value})[{','.join(sorted(held))}]" for value, held in model.beliefs]
    assert [
        text(literal) for literal in host.agent.beliefs.literals() if text(literal).startswith("p(")
    ] == shown
    assert Counter(host.printed) == model.events

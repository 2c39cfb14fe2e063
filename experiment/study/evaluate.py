"""Evaluate the tables of a study: python evaluate.py changes.csv explanations.csv

README.md of this folder describes the columns. Tables that begin with ``# made up`` are evaluated, and labelled as such.
"""

import csv
import itertools
import math
import random
import sys
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from statistics import mean
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).parents[1]))

from intervals import holm

WAYS = 2**14
"""All ways to swap the sides are counted if there are at most this many; otherwise, this many are drawn."""
SAMPLES = 10_000
MADE_UP = "# made up"

Row = dict[str, str]
Value = Callable[[Row], float]


class Result(NamedTuple):
    """The mean difference of participants between two conditions.

    Attributes:
        participants: number of participants who have both conditions.
        difference: mean, of the first condition minus the second.
        low, high: its interval, 95 %, by the bootstrap over participants.
        p: of an exact permutation test, two-sided, that swaps the conditions within participants.
    """

    participants: int
    difference: float
    low: float
    high: float
    p: float


def read(path: Path) -> tuple[list[Row], bool]:
    """Return the rows of a table, and whether its data are made up."""
    text = path.read_text(encoding="utf-8")
    rows = csv.DictReader(line for line in text.splitlines() if not line.startswith("#"))
    return list(rows), text.startswith(MADE_UP)


def compared(rows: Iterable[Row], column: str, first: str, second: str, value: Value) -> Result:
    """Compare two conditions, which *column* names, within participants.

    Raises:
        ValueError: no participant has both conditions.
    """
    found: dict[str, dict[str, list[float]]] = defaultdict(lambda: {first: [], second: []})
    for row in rows:
        found[row["participant"]][row[column]].append(value(row))
    pairs = [each for each in found.values() if each[first] and each[second]]
    differences = [mean(each[first]) - mean(each[second]) for each in pairs]
    if not differences:
        raise ValueError(f"no participant has both '{first}' and '{second}' in the column '{column}'")
    return Result(len(differences), mean(differences), *bootstrapped(differences), permutation(differences))


def bootstrapped(differences: Sequence[float], seed: int = 1) -> tuple[float, float]:
    """Return the interval of a mean, 95 %, from samples of participants."""
    draw = random.Random(seed)
    means = sorted(mean(draw.choices(differences, k=len(differences))) for _ in range(SAMPLES))
    return means[SAMPLES // 40], means[-SAMPLES // 40 - 1]


def permutation(differences: Sequence[float], seed: int = 1) -> float:
    """Return the probability of such a mean, or a more extreme one, if the sign of each difference is chance."""
    observed = abs(sum(differences))
    sums = [abs(sum(map(float.__mul__, signs, differences))) for signs in _signs(len(differences), seed)]
    return sum(each >= observed - 1e-9 for each in sums) / len(sums)


def _signs(number: int, seed: int) -> Iterator[tuple[float, ...]]:
    if 2**number <= WAYS:
        yield from itertools.product((1.0, -1.0), repeat=number)
        return
    draw = random.Random(seed)
    yield (1.0,) * number  # the observed one
    for _ in range(WAYS - 1):
        yield tuple(draw.choice((1.0, -1.0)) for _ in range(number))


def is_yes(column: str) -> Value:
    """Return a function that gives 1 for "yes" in a column, and 0 otherwise."""
    return lambda row: float(row[column].strip().lower() == "yes")


def log_minutes(row: Row) -> float:
    """Return the logarithm of the minutes of a request."""
    return math.log(float(row["minutes"]))


def report(changes: Sequence[Row], explanations: Sequence[Row]) -> Iterator[str]:
    """Yield the lines of the report."""

    def by_side(value: Value, rows: Sequence[Row] = changes) -> Result:
        return compared(rows, "side", "agents", "tree", value)

    time, accepted = by_side(log_minutes), by_side(is_yes("accepted"))
    explained = compared(explanations, "why", "yes", "no", is_yes("correct"))
    adjusted = holm([time.p, accepted.p, explained.p])
    ratio = [math.exp(each) for each in time[1:4]]
    yield f"{time.participants} participants changed both sides, {explained.participants} explained with and without `why`."
    yield f"Time, agents / tree: {ratio[0]:.2f} (95 %: {ratio[1]:.2f} to {ratio[2]:.2f}), p = {adjusted[0]:.3f} (Holm)"
    yield f"Accepted, agents - tree: {_points(accepted)}, p = {adjusted[1]:.3f} (Holm)"
    yield f"Explained correctly, with - without `why`: {_points(explained)}, p = {adjusted[2]:.3f} (Holm)"
    errors = by_side(lambda row: float(row["errors"]))
    yield f"Errors for each request, agents - tree: {errors.difference:+.2f} ({errors.low:+.2f} to {errors.high:+.2f})"
    order = compared(changes, "part", "1", "2", log_minutes)
    low, middle, high = (math.exp(each) for each in (order.low, order.difference, order.high))
    yield f"Time, first / second part: {middle:.2f} ({low:.2f} to {high:.2f})"


def _points(result: Result) -> str:
    difference, low, high = (100 * each for each in result[1:4])
    return f"{difference:+.0f} points (95 %: {low:+.0f} to {high:+.0f})"


def main() -> None:
    """Print the report."""
    (changes, some), (explanations, others) = (read(Path(name)) for name in sys.argv[1:3])
    if some or others:
        print("THESE DATA ARE MADE UP: they try the evaluation, and show nothing about users.")
    print(*report(changes, explanations), sep="\n")


if __name__ == "__main__":
    main()

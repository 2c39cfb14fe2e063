"""Judge from the output of a run whether fair guesses broke the code: python check.py OUTPUT_FILE"""

import re
import sys
from collections.abc import Iterable
from pathlib import Path

from jacaros.testing import Verdict


def answer(code: list[str], guess: list[str]) -> tuple[int, int]:
    """Count the pegs of a guess that are right, and those with only the right colour."""
    right = sum(one == other for one, other in zip(code, guess, strict=True))
    common = sum(min(code.count(colour), guess.count(colour)) for colour in set(guess))
    return right, common - right


def check(output: Iterable[str]) -> Verdict:
    """Judge the lines of the output."""
    verdict = Verdict()
    text = "\n".join(output)
    guesses = [pegs.split(",") for pegs in re.findall(r"^\[breaker\] I try \[(.*)\],", text, re.MULTILINE)]
    reported = re.findall(r"^\[breaker\] (\d) right, (\d) misplaced$", text, re.MULTILINE)
    answers = [(int(right), int(misplaced)) for right, misplaced in reported]
    left = [int(number) for number in re.findall(r"one of (\d+)$", text, re.MULTILINE)]
    found = re.search(r"^\[breaker\] the code is \[(.*)\]$", text, re.MULTILINE)
    verdict.measure("guesses", len(guesses))
    verdict.expect(found is not None, "the code was not found")
    verdict.expect("[peeper] the keeper says: timeout" in text, "the keeper answered the peeper")
    if found is None:
        return verdict
    code = found.group(1).split(",")
    wanted = [answer(code, guess) for guess in guesses]
    verdict.expect(answers == wanted, f"the answers are {answers}, not {wanted}")
    for number, guess in enumerate(guesses):
        fair = all(answer(guess, before) == wanted[place] for place, before in enumerate(guesses[:number]))
        verdict.expect(fair, f"guess {number + 1} does not fit the previous answers")
    verdict.expect(left[:1] == [1296], "the first guess was not one of 1296 codes")
    verdict.expect(
        sorted(set(left), reverse=True) == left, f"the number of codes left does not decrease: {left}"
    )
    return verdict


def main(arguments: list[str]) -> int:
    """Judge the file named on the command line; return the exit code."""
    if len(arguments) != 1:
        print(__doc__)
        return 2
    verdict = check(Path(arguments[0]).read_text(encoding="utf-8").splitlines())
    print("\n".join(verdict.lines()))
    return 0 if verdict.passed else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""Give damaged files to their readers, which must accept or reject each with a message of limited length in limited time.

fuzz.py [KIND ...] [--seed N] [--minutes M] [--files N] [--first N] [--findings DIR]

The kind ``program`` covers texts: random tokens, mutated conformance programs, and programs generated from the grammar;
valid programs are also checked, formatted and run. The other kinds are in `fuzzed_files.py`. Without KIND all kinds are
examined, each for M minutes. A file is determined by its kind, seed and number, so that a finding can be reproduced:
`program --seed 1 --first 4711 --files 1`. Each finding is written to DIR (default runs/fuzz), the file next to the
traceback. The exit code is 1 if there are findings.
"""

import argparse
import os
import re
import resource
import signal
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from random import Random

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests" / "unit" / "agents" / "mind")]

from fuzzed_files import KINDS  # noqa: E402
from program_grammar import Grammar  # noqa: E402
from recording_host import RecordingHost  # noqa: E402

from jacaros.agents.checks.checker import check  # noqa: E402
from jacaros.agents.checks.goals import KnownActions  # noqa: E402
from jacaros.agents.language.diagnostics import Diagnostic, SourceFile  # noqa: E402
from jacaros.agents.language.loader import read_program  # noqa: E402
from jacaros.agents.language.lowering import format_plan, format_term  # noqa: E402
from jacaros.agents.language.nodes import Program  # noqa: E402
from jacaros.agents.mind.actions.internal_action import STANDARD  # noqa: E402
from jacaros.agents.mind.mind import Mind  # noqa: E402
from jacaros.agents.mind.state.act import Act, Completion  # noqa: E402

CORPUS = [
    path.read_text(encoding="utf-8")
    for folder in ("conformance", "conformance_environment", "compatibility")
    for path in sorted((ROOT / "tests" / folder).rglob("*.asl"))
]
_PIECE = re.compile(r"\"[^\"\n]*\"|'[^'\n]*'|[A-Za-z_.][\w.]*|\d+|[-+!?<>=|&:.*\\]+|\s+|.", re.DOTALL)
PIECES = sorted({piece for text in CORPUS for piece in _PIECE.findall(text) if len(piece) < 30})
ODD = (
    *(
        "\0",
        "\x07",
        "\r",
        "\u2028",
        "\u200f",
        "\ufeff",
        "é",
        "日",
        "𝄞",
        "\ud800",
        "ß",
        "ǅ",
        "\\",
        '"',
        "'",
        "`",
        "#",
    ),
    *(
        "/*",
        "*/",
        "//",
        "|&|",
        "|||",
        "<:",
        "::",
        "=..",
        "\\==",
        "!!",
        "{ end }",
        "{ begin ",
        "{ include(",
        "$",
    ),
    *(
        "x" * 5000,
        "9" * 400,
        "1e999999",
        "(" * 40,
        "[" * 40,
        "{" * 40,
        "-" * 40,
        "not " * 40,
        "a." * 40,
        '"' * 3,
    ),
)
_DEFECT = re.compile(r"is given up|\b(?!Arithmetic)[A-Z][A-Za-z]+(Error|Fault): ")
"""Log lines of an agent when something happened that no rule of the language covers."""
PROGRAM = "program"
"""The kind of program texts."""
CYCLES = 600
CROWD = 300
"""Number of intentions at which an agent has run long enough."""
SECONDS = 20.0
MEMORY = 6 * 2**30


class TooLong(BaseException):
    """Raised when a text exceeds its time; not an Exception, so that no handler catches it."""


# texts


def text_of(seed: int, number: int) -> tuple[str, str]:
    """Return how the text with a number is made, and the text."""
    random = Random(f"{seed} {number}")
    how = random.choice(("soup", "changed", "changed", "made", "made", "made and changed"))
    if how == "soup":
        return how, soup(random)
    if how == "changed":
        return how, changed(random.choice(CORPUS), random)
    text = Grammar(random, random.randint(1, 4)).program()
    return how, changed(text, random) if how == "made and changed" else text


def soup(random: Random) -> str:
    """Return tokens in any order."""
    pieces = [piece(random) for _ in range(random.randint(1, 120))]
    return random.choice(("", " ", "")).join(pieces)


def piece(random: Random) -> str:
    """Return a token, or something that is not one."""
    return random.choice(ODD) if random.random() < 0.1 else random.choice(PIECES)


def changed(text: str, random: Random) -> str:
    """Return a program with some tokens or characters changed."""
    for _ in range(random.choice((1, 1, 2, 3, 8))):
        text = random.choice((_tokens_changed, _tokens_changed, _spliced, _characters_changed))(text, random)
    return text


def _tokens_changed(text: str, random: Random) -> str:
    tokens = _PIECE.findall(text) or [""]
    at, other = random.randrange(len(tokens)), random.randrange(len(tokens))
    length = random.choice((1, 1, 2, 5, 20))
    kind = random.randrange(5)
    if kind == 0:
        del tokens[at : at + length]
    elif kind == 1:
        tokens[other:other] = tokens[at : at + length]
    elif kind == 2:
        tokens[at], tokens[other] = tokens[other], tokens[at]
    elif kind == 3:
        tokens.insert(at, piece(random))
    else:
        tokens[at] = piece(random)
    return "".join(tokens)


def _spliced(text: str, random: Random) -> str:
    other = random.choice(CORPUS)
    return text[: random.randint(0, len(text))] + other[random.randint(0, len(other)) :]


def _characters_changed(text: str, random: Random) -> str:
    at = random.randint(0, len(text))
    inserted = random.choice((random.choice(ODD), chr(random.randint(0, 0x2FF)), text[at : at + 9] * 2))
    return text[:at] + inserted + text[at + random.randint(0, 3) :]


# checks


def examine(text: str) -> str:
    """Load, check, format and run a text; return ``refused`` or ``program``. An exception is a finding."""
    program, diagnostics = read_program(SourceFile("fuzz.asl", text), _read)
    errors = [diagnostic for diagnostic in diagnostics if diagnostic.severity == "error"]
    _show((*diagnostics, *check(program, KnownActions(STANDARD), errors)), text)
    for clause in program.beliefs:
        format_term(clause)
    for plan in program.plans:
        format_plan(plan)
    if errors:
        return "refused"
    live(program)
    return "program"


def _show(diagnostics: Sequence[Diagnostic], text: str) -> None:
    """Check that diagnostics have a location inside the text, and can be shown."""
    for diagnostic in diagnostics:
        assert diagnostic.span is not None
        if diagnostic.span.file.name == "fuzz.asl":
            assert 1 <= diagnostic.span.line <= text.count("\n") + 1
        assert diagnostic.render()


def _read(path: str, including: str) -> tuple[str, str]:
    del including
    if path == "x":
        return "x", 'p. +!g <- a. {include("y")}'
    raise FileNotFoundError(path)


def live(program: Program) -> None:
    """Run an agent with the program for a while."""
    host = RecordingHost(_done)
    host.agent = agent = Mind("fuzz", program, host)
    agent.start()
    end = host.time + 1000.0
    for _ in range(CYCLES // 50):
        if host.stopped or len(agent.alive) > CROWD or not (agent.run(50) or host.ring_next(end)):
            break
    for _, told in host.logged:
        if _DEFECT.search(told):
            raise AssertionError(told)


def _done(act: Act) -> Completion | None:
    """Answer actions: some succeed, some fail, some never end."""
    return (Completion(True), Completion(False), None)[(act.id + act.functor.arity) % 3]


@contextmanager
def limited(seconds: float) -> Iterator[None]:
    """Raise `TooLong` in the current step after more processor time."""

    def ring(number: int, frame: object) -> None:
        raise TooLong

    before = signal.signal(signal.SIGVTALRM, ring)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)


# the run


@dataclass
class Tally:
    """Results so far."""

    outcomes: Counter[str] = field(default_factory=Counter)
    findings: Counter[str] = field(default_factory=Counter)

    def __str__(self) -> str:
        return f"{self.outcomes.total()} texts: {dict(self.outcomes)}; findings: {self.findings.total()}"


def fuzz(kind: str, seed: int, numbers: Iterable[int], seconds: float, findings: Path) -> Tally:
    """Examine files of a kind until their number or the time is reached, in the current folder, where they may write."""
    tally = Tally()
    began = told = time.monotonic()
    suffix = ".asl" if kind == PROGRAM else KINDS[kind].suffix
    current = findings / f"current{suffix}"
    for number in numbers:
        how, data = made(kind, seed, number)
        current.write_bytes(data)
        try:
            with limited(SECONDS):
                outcome = examined(kind, data)
            if how == "made" and outcome == "refused":
                raise AssertionError("a valid program is rejected")
        except (Exception, TooLong) as fault:
            outcome = "finding"
            _keep(tally, findings / f"{kind}-{seed}-{number}{suffix}", data, fault)
        tally.outcomes[f"{how}, {outcome}"] += 1
        now = time.monotonic()
        if now - told > 60:
            told = now
            print(f"{number}: {tally}", flush=True)
        if now - began > seconds:
            break
    current.unlink(missing_ok=True)
    return tally


def made(kind: str, seed: int, number: int) -> tuple[str, bytes]:
    """Return how the file with a number is made, and the file."""
    if kind == PROGRAM:
        how, text = text_of(seed, number)
        return how, text.encode("utf-8", "surrogatepass")
    return KINDS[kind].made(Random(f"{kind} {seed} {number}"))


def examined(kind: str, data: bytes) -> str:
    """Return ``program``, ``taken`` or ``refused``. An exception is a finding."""
    if kind == PROGRAM:
        return examine(data.decode("utf-8", "surrogatepass"))
    return KINDS[kind].examine(data, Path())


def _keep(tally: Tally, file: Path, data: bytes, fault: BaseException) -> None:
    """Write a finding, unless there are enough of its kind."""
    where = traceback.extract_tb(fault.__traceback__)[-1]
    kind = f"{type(fault).__name__} at {Path(where.filename).name}:{where.lineno}"
    tally.findings[kind] += 1
    if tally.findings[kind] > 5:
        return
    print(f"finding {file.stem}: {kind}: {str(fault)[:200]!r}", flush=True)
    file.write_bytes(data)
    with file.with_suffix(".txt").open("w", encoding="utf-8", errors="surrogatepass") as told:
        traceback.print_exception(fault, file=told, limit=-30)


def main(arguments: list[str]) -> int:
    """Run the fuzzer; return the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument(
        "kinds", nargs="*", metavar="KIND", help=f"{PROGRAM}, {', '.join(KINDS)} (default: all)"
    )
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, default=1.0, help="minutes for each kind")
    parser.add_argument("--files", type=int, default=sys.maxsize, help="maximum number of files of each kind")
    parser.add_argument("--first", type=int, default=1, help="number of the first file")
    parser.add_argument("--findings", type=Path, default=ROOT / "runs" / "fuzz", help="folder for findings")
    options = parser.parse_args(arguments)
    kinds = options.kinds or [PROGRAM, *KINDS]
    if unknown := [each for each in kinds if each not in (PROGRAM, *KINDS)]:
        parser.error(f"unknown kind: {', '.join(unknown)}")
    findings = options.findings.resolve()
    findings.mkdir(parents=True, exist_ok=True)
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    wrong: Counter[str] = Counter()
    for kind in kinds:
        numbers = range(options.first, min(options.first + options.files, sys.maxsize))
        with tempfile.TemporaryDirectory() as scratch:
            os.chdir(scratch)  # programs may save files
            tally = fuzz(kind, options.seed, numbers, options.minutes * 60, findings)
            os.chdir(ROOT)
        print(f"{kind}: {tally}")
        wrong.update({f"{kind}: {what}": count for what, count in tally.findings.items()})
    for what, count in wrong.most_common():
        print(f"{count:6}  {what}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

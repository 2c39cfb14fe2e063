"""The table of mistakes, and the programs with one of them."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import astuple, fields
from pathlib import Path

from mutations import Mistake
from programs import PROGRAMS, Program

CORPUS = Path(__file__).with_name("corpus.tsv")
EQUAL = Path(__file__).with_name("no_mistakes.tsv")
"""Changes that change nothing, with the rule of `mutations` by which they do not: a sample."""

BY_NAME = {program.name: program for program in PROGRAMS}


def write(path: Path, mistakes: list[Mistake]) -> None:
    """Write a table."""
    head = [field.name for field in fields(Mistake)]
    rows = [head, *([str(cell) for cell in astuple(each)] for each in mistakes)]
    path.write_text("".join("\t".join(row).rstrip("\t") + "\n" for row in rows), encoding="utf-8")


def read(path: Path = CORPUS) -> list[Mistake]:
    """Return the mistakes of a table."""
    rows = [line.split("\t") for line in path.read_text(encoding="utf-8").splitlines()[1:]]
    return [
        Mistake(program, file, kind, int(line), before, *rest)
        for program, file, kind, line, before, *rest in (row + [""] * (6 - len(row)) for row in rows)
    ]


@contextmanager
def written(program: Program, folder: Path) -> Iterator[dict[str, str]]:
    """Write the files of a program into *folder*, and go there."""
    home = Path.cwd()
    files = program.write(folder)
    os.chdir(folder)
    try:
        yield files
    finally:
        os.chdir(home)


def with_mistake(text: str, mistake: Mistake) -> tuple[str, int]:
    """Return the mutated text and the number of the line, which is the nearest one that reads as before.

    Raises:
        LookupError: the program has changed, and no such line is left.
    """
    lines = text.split("\n")
    same = [number for number, line in enumerate(lines, 1) if line.strip() == mistake.before]
    if not same:
        raise LookupError(
            f"{mistake.program}: no line `{mistake.before}` is left; run `python tests/mistakes/make_corpus.py`"
        )
    number = min(same, key=lambda each: abs(each - mistake.line))
    line = lines[number - 1]
    lines[number - 1] = line[: len(line) - len(line.lstrip())] + mistake.after
    return "\n".join(lines), number

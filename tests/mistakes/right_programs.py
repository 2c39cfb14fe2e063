"""Every program that is right: what `jacaros check` says about it is a false alarm, or a true one with a reason.

Examples and the listings of the thesis are checked as folders, recorded programs as they were run, and the programs
of a page with the mappings that its commands name.
"""

import re
import shlex
import sys
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

from examples import examples
from pages import PAGES, ROOT, blocks, is_file

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.runtime.mas.checks.files import check_files

sys.path.insert(0, str(ROOT / "tests/conformance"))
from check import find_cases

SHIPPED = ROOT / "src/jacaros/robots/mappings"

Alarm = tuple[str, str, str]
"""Where, of which code, and the message; the line is left out, because pages and programs grow."""


def alarms_in_files() -> Iterator[Alarm]:
    """Yield the alarms about programs that are files of the repository."""
    for folder in ("examples", "tests/compatibility", "src/jacaros/runtime/cli/patrol.asl"):
        yield from _alarms([ROOT / folder])
    for folder in ("tests/conformance", "tests/conformance_environment"):
        for case in find_cases(str(ROOT / folder))[0]:
            yield from _alarms([Path(case.project)])


def alarms_of_pages(folder: Path) -> Iterator[Alarm]:
    """Yield the alarms about the programs of pages, which are written into *folder*, the current one."""
    for number, page in enumerate(PAGES):
        name = page.relative_to(ROOT).as_posix()
        for example in examples(page):
            below = folder / f"{number}_{example.line}"
            yield from _of_page(name, below, example.files, [(example.file, ())])
        files = {block.purpose: block.text for block in blocks(page) if is_file(block)}
        yield from _of_page(name, folder / str(number), files, list(_commands(page, files)))


def _commands(page: Path, files: dict[str, str]) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the programs that commands of a page run, with their mappings."""
    for block in blocks(page):
        for line in re.findall(r"^\$ jacaros (?:run|test|check) (.*)", block.text, re.MULTILINE):
            words = shlex.split(line, comments=True)
            if words and words[0] in files and words[0].endswith((".asl", ".jcm", ".mas2j")):
                mappings = [value for word, value in pairwise(words) if word == "--mapping"]
                # The mapping of a robot of the reader's own is not there.
                if all(each in files or (SHIPPED / each).is_file() for each in mappings):
                    yield words[0], tuple(mappings)


def _of_page(
    name: str, folder: Path, files: dict[str, str], runs: list[tuple[str, tuple[str, ...]]]
) -> Iterator[Alarm]:
    for file, text in files.items() if runs else ():
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        (folder / file).write_text(text, encoding="utf-8")
    for file, mappings in dict.fromkeys(runs):
        for place, code, message in _alarms([folder / file], mappings):
            path = Path(place)
            within = path.relative_to(folder).as_posix() if path.is_relative_to(folder) else file
            yield f"{name}:{within}", code, message.replace(f"{folder.name}/", "")


def _alarms(paths: list[Path], mappings: tuple[str, ...] = ()) -> Iterator[Alarm]:
    for each in check_files(paths, mappings).diagnostics:
        if each.severity != "note":
            yield _alarm(each)


def _alarm(found: Diagnostic) -> Alarm:
    path = Path("" if found.span is None else found.span.file.name)
    place = path.relative_to(ROOT).as_posix() if path.is_relative_to(ROOT) else str(path)
    return place, found.code, found.message.replace(f"{ROOT}/", "")

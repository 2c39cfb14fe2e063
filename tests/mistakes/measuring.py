"""Which mistakes of the table `jacaros check` reports, and at which place."""

import re
from collections import Counter, defaultdict
from collections.abc import Iterable
from itertools import takewhile
from pathlib import Path

from corpus import BY_NAME, with_mistake, written
from mutations import Mistake, shown_by
from programs import Program

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.runtime.mas.checks.files import check_files


def unreported(mistakes: Iterable[Mistake], folder: Path) -> list[Mistake]:
    """Return the mistakes that no new diagnostic of `jacaros check` reports at the right place."""
    programs: dict[str, list[Mistake]] = defaultdict(list)
    for each in mistakes:
        programs[each.program].append(each)
    return [
        each
        for number, (name, own) in enumerate(programs.items())
        for each in _unreported_in(BY_NAME[name], own, folder / str(number))
    ]


def _unreported_in(program: Program, mistakes: list[Mistake], folder: Path) -> list[Mistake]:
    missed = []
    with written(program, folder) as files:
        right = Counter(map(_said, _checked(program)))
        for each in mistakes:
            text, line = with_mistake(files[each.file], each)
            Path(each.file).write_text(text, encoding="utf-8")
            new = [found for found in _checked(program) if _said(found) not in right]
            Path(each.file).write_text(files[each.file], encoding="utf-8")
            if not any(is_at_the_place(found, each, line, files) for found in new):
                missed.append(each)
    return missed


def _checked(program: Program) -> list[Diagnostic]:
    return check_files([Path(program.entry)], program.mappings).diagnostics


def _said(found: Diagnostic) -> tuple[str, str]:
    return found.place(), found.message


def is_at_the_place(found: Diagnostic, mistake: Mistake, line: int, files: dict[str, str]) -> bool:
    """Return whether a diagnostic is at the line of the mistake, or names what the mistake has changed."""
    span = found.span
    if span is not None and span.line == line and Path(span.file.name).name == Path(mistake.file).name:
        return True
    words = set(re.findall(r"\w+", f"{found.message} {found.help or ''}"))
    return not words.isdisjoint(names_of(mistake, files))


def names_of(mistake: Mistake, files: dict[str, str]) -> set[str]:
    """Return what names a mistake: the words that it removes and adds.

    For a focus that is left out, these are also the names that the artifact shows; for a wait, the goal of its plan; for
    a number of arguments, the name that has them.
    """
    before, after = (Counter(re.findall(r"[A-Za-z_]\w*", text)) for text in (mistake.before, mistake.after))
    names = set(before - after) | set(after - before)
    if mistake.kind == "drop-bang":
        names |= set(re.findall(r"!(\w+)", mistake.before))
    elif mistake.kind == "arity":
        names.add(_with_arguments(mistake))
    elif mistake.kind == "drop-focus":
        kinds = re.findall(r"artifact +\w+ *: *\"?([\w.]+)|\"(\w+)\"", "\n".join(files.values()))
        for kind in {name for pair in kinds for name in pair if name}:
            names |= shown_by(kind, files) if _is_of(kind, mistake, files) else set()
    elif mistake.kind == "drop-wait":
        names |= {_goal_above(files[mistake.file], mistake.line)}
    return names - {"focus", "by", "unit"}


def _with_arguments(mistake: Mistake) -> str:
    """Return the name whose arguments change: the one before the change, or before the bracket that is still open."""
    pairs = zip(mistake.before, mistake.after, strict=False)
    end = sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], pairs))
    is_whole_list = "(" in (mistake.before[end : end + 1], mistake.after[end : end + 1])
    text = mistake.before[:end] if is_whole_list else _up_to_open(mistake.before[:end])
    name = re.search(r"\w+$", text)
    return name[0] if name else ""


def _up_to_open(text: str) -> str:
    """Return the text before its last round bracket that is not closed."""
    closed = 0
    for at in range(len(text) - 1, -1, -1):
        closed += (text[at] == ")") - (text[at] == "(")
        if closed < 0:
            return text[:at]
    return ""


def _is_of(kind: str, mistake: Mistake, files: dict[str, str]) -> bool:
    """Return whether the dropped focus may be one of an artifact of this type: it names it, or its declaration does."""
    words = set(re.findall(r"\w+", mistake.before))
    lines = "\n".join(files.values()).split("\n")
    return kind.partition(".")[0] in words or any(
        kind in line and words & set(re.findall(r"\w+", line.partition(":")[0].partition("artifact")[2]))
        for line in lines
    )


def _goal_above(text: str, line: int) -> str:
    heads = [re.match(r"\+!(\w+)", each) for each in text.split("\n")[:line]]
    return next((head[1] for head in reversed(heads) if head), "")


def table(mistakes: Iterable[Mistake], missed: Iterable[Mistake]) -> str:
    """Return how many mistakes of each kind are found, and a list of those that are not."""
    mistakes, missed = list(mistakes), list(missed)
    totals, lost = Counter(each.kind for each in mistakes), Counter(each.kind for each in missed)
    rows = [f"{kind:16} {total - lost[kind]:3} of {total:3}" for kind, total in sorted(totals.items())]
    rows.append(f"{'in all':16} {len(mistakes) - len(missed):3} of {len(mistakes):3}")
    rows += [f"{each.kind}: {each.program} {each.file}:{each.line}: {each.after}" for each in missed]
    return "\n".join(rows)

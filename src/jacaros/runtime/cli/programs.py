"""``jacaros check`` and ``jacaros fmt``: commands about the text of programs."""

import difflib
import json
import shutil
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from tempfile import NamedTemporaryFile
from typing import Any

import click

from jacaros.agents.language.diagnostics import LEVELS, AslError, Diagnostic, Severity, bounded
from jacaros.agents.language.formatting import format_program
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.runtime.cli.options import PATH, imports_option, option
from jacaros.runtime.cli.usage import (
    counted,
    examples,
    existing,
    has_colours,
    listed,
    no_programs,
    usage_error,
)
from jacaros.runtime.errors import InternalError
from jacaros.runtime.files import texts
from jacaros.runtime.files.texts import files_below, is_file, printable, suggestion
from jacaros.runtime.mas.agents.programs import text_of
from jacaros.runtime.output import beneath

_KINDS = (".asl", ".mas2j", ".jcm", ".py", ".yaml", ".yml")
_COLOURS: dict[Severity, str] = {"error": "red", "warning": "yellow", "note": "cyan"}
_STANDARD_INPUT = Path("-")


@click.command(
    "check",
    epilog=examples(
        "jacaros check robot.asl",
        "jacaros check . --strict",
        "jacaros check robot.asl --mapping robot.yaml",
    ),
)
@click.argument("files", metavar="FILE...", type=PATH, nargs=-1, required=True)
@option(
    "--format",
    "Output format.",
    click.Choice(["text", "json"]),
    name="style",
    default="text",
)
@option("--strict", "Exit with status 1 on warnings, too.")
@option("--ignore CODE...", "Do not report warnings of this kind. Repeatable.")
@option(
    "--mapping FILE...",
    "Also check that programs use only what this mapping file provides. Repeatable.",
    name="mappings",
)
@imports_option
def check(
    files: tuple[Path, ...],
    style: str,
    strict: bool,
    ignore: tuple[str, ...],
    mappings: tuple[str, ...],
    imports: bool,
) -> int:
    """Report problems in each FILE: an agent program (.asl, or .py for an agent in Python), a project (.mas2j, .jcm)
    with the programs of its agents, a mapping file or a world file (.yaml), or a folder with any of them.

    Every problem is reported in one pass, with its location and a suggested fix. Each kind has a code, explained on the
    reference page "Diagnostics". The comment `// jacaros: ignore CODE` suppresses a warning: for its own line, or, on a
    separate line, for the clause below. `// jacaros: ignore-file CODE` suppresses it for the whole file.

    Python code of the project is read, not run, unless you give --import. The exit code is 1 if there is an error.
    """  # fmt: skip
    from jacaros.runtime.mas.checks.files import check_files  # here: `fmt` reads no projects

    unknown = [code for code in ignore if code not in LEVELS]
    if unknown:
        raise usage_error(
            f"unknown code: `{unknown[0]}`",
            suggestion(unknown[0], LEVELS, 'the reference page "Diagnostics" lists the codes'),
        )
    supported = _supported(files)
    findings = check_files([existing(file, _KINDS) for file in supported], mappings, imports)
    if not findings.files and not findings.diagnostics:
        raise no_programs(files)
    findings.diagnostics = bounded(
        [each for each in findings.diagnostics if each.severity == "error" or each.code not in ignore]
    )
    if style == "text":
        report(findings.diagnostics, len(findings.files))
    else:
        click.echo(as_json(findings.diagnostics, len(findings.files)))
    counts = Counter(each.severity for each in findings.diagnostics)
    return 1 if counts["error"] or (strict and counts["warning"]) else 0


def _supported(files: Sequence[Path]) -> Sequence[Path]:
    """Skip files of other types, which a shell's ``*`` also matches, unless there are no others."""
    foreign = [file for file in files if is_file(file) and file.suffix not in _KINDS]
    if not foreign or len(foreign) == len(files):
        return files
    click.echo(f"note: skipped unsupported file types: {listed(foreign)}", err=True)
    return [file for file in files if file not in foreign]


def report(diagnostics: Sequence[Diagnostic], files: int) -> None:
    """Print the diagnostics, and their number on the standard error output."""
    coloured = has_colours()
    for diagnostic in diagnostics:
        if coloured:  # its text is escaped
            click.echo(_coloured(diagnostic), beneath(sys.stdout), color=True)
        else:
            click.echo(diagnostic.render(with_code=True))
        click.echo()
    click.echo(_summary(diagnostics, files), err=True)


def _coloured(diagnostic: Diagnostic) -> str:
    head, newline, rest = diagnostic.render(with_code=True).partition("\n")
    where = diagnostic.place()
    colour = _COLOURS[diagnostic.severity]
    level = click.style(diagnostic.severity, fg=colour, bold=True)
    return f"{click.style(where, bold=True)}{level}{head[len(where) + len(diagnostic.severity) :]}{newline}{rest}"


def _summary(diagnostics: Sequence[Diagnostic], files: int) -> str:
    counts = Counter(each.severity for each in diagnostics)
    found = [counted(counts[level], level) for level in _COLOURS if counts[level]]
    return f"{', '.join(found) or 'nothing wrong'} in {counted(files, 'file')}"


def as_json(diagnostics: Sequence[Diagnostic], files: int) -> str:
    """Return the findings as one JSON object; lines and columns count from 1, and the end column is exclusive."""
    found = [_plain(diagnostic) for diagnostic in diagnostics]
    document = {"version": 1, "files": files, "diagnostics": found}
    return json.dumps(document, indent=2, ensure_ascii=False)


def _plain(diagnostic: Diagnostic) -> dict[str, Any]:
    span = diagnostic.span
    return {
        "file": None if span is None else span.file.name,
        **{place: getattr(span, place, None) for place in ("line", "column", "end_line", "end_column")},
        "level": diagnostic.severity,
        "code": diagnostic.code,
        "message": printable(diagnostic.message),
        "help": None if diagnostic.help is None else printable(diagnostic.help),
        "opened": None if diagnostic.opened is None else [diagnostic.opened.line, diagnostic.opened.column],
    }


# Formatting.


@click.command(
    "fmt",
    epilog=examples("jacaros fmt robot.asl", "jacaros fmt . --check"),
)
@click.argument("files", metavar="FILE...", type=PATH, nargs=-1, required=True)
@option(
    "--check", "Write nothing; print the changes, and exit with status 1 if there are any.", name="only_check"
)
def fmt(files: tuple[Path, ...], only_check: bool) -> int:
    """Format each FILE in one style: an agent program (.asl), or all programs in a folder. `-` formats the standard
    input to the standard output.

    Formatting keeps the meaning of programs, and all comments. A program with errors is reported and not changed, and
    the exit code is 1. The page "The layout of programs" shows the style.
    """  # fmt: skip
    if _STANDARD_INPUT in files and len(files) > 1:
        raise usage_error("`-` cannot be combined with files")
    code = 0
    changed = 0
    programs = list(_programs(files))
    if not programs:
        raise no_programs(files)
    for path in programs:
        try:
            before = _standard_input() if path == _STANDARD_INPUT else text_of(path)
            after = format_program(
                "<stdin>" if path == _STANDARD_INPUT else path.as_posix(), before, STANDARD
            )
        except (AslError, InternalError) as fault:
            is_defect = isinstance(fault, InternalError)
            text = f"internal error: {fault}; please file an issue with this program" if is_defect else fault
            click.echo(text, err=True)
            code = 1
            continue
        changed += before != after
        if only_check:
            click.echo("".join(_difference(path, before, after)), nl=False)
        elif path == _STANDARD_INPUT:
            # Another program gets the text as it is, in UTF-8; a terminal obeys no character of it.
            is_shown = sys.stdout.isatty()
            click.echo(
                after if is_shown else after.encode(), None if is_shown else beneath(sys.stdout), nl=False
            )
        elif before != after:
            try:
                _replace(path, after)
            except OSError as fault:
                click.echo(f"error: cannot write `{path}`: {fault.strerror}", err=True)
                code = 1
    if _STANDARD_INPUT not in files:
        what = "would change" if only_check else "changed"
        click.echo(f"{changed} of {counted(len(programs), 'file')} {what}", err=True)
    return 1 if only_check and changed else code


def _standard_input() -> str:
    """The standard input, as the text of a file: UTF-8 on every system."""
    try:
        return texts.text_of(sys.stdin.buffer.read())
    except UnicodeError as fault:
        wrong = Diagnostic("error", f"cannot read <stdin>: {fault}", code="unreadable-file")
        raise AslError([wrong]) from fault


def _replace(path: Path, text: str) -> None:
    """Replace a program atomically: after a crash, the file is the old or the new one, complete."""
    path = path.resolve()
    with NamedTemporaryFile("w", dir=path.parent, encoding="utf-8", newline="\n", delete=False) as file:
        beside = Path(file.name)
        try:
            file.write(text)
            file.close()  # Windows neither removes nor replaces an open file
            shutil.copymode(path, beside)
            beside.replace(path)
        except BaseException:
            file.close()
            beside.unlink()
            raise


def _programs(files: Sequence[Path]) -> Iterator[Path]:
    for file in files:
        if file == _STANDARD_INPUT:
            yield file
        elif existing(file, (".asl",)).is_dir():
            yield from files_below(file, (".asl",))
        else:
            yield file


def _difference(path: Path, before: str, after: str) -> Iterator[str]:
    lines = difflib.unified_diff(
        before.splitlines(keepends=True), after.splitlines(keepends=True), path.as_posix(), path.as_posix()
    )
    for line in lines:
        yield line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n"

"""``jacaros check FILE|FOLDER...``."""

import os
import sys
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import click

from jacaros.agents.language.diagnostics import LEVELS, Diagnostic, Severity, bounded
from jacaros.cli.files import existing, no_programs
from jacaros.cli.reports import as_json, as_sarif
from jacaros.cli.usage import examples, usage_error
from jacaros.files.texts import is_file, suggestion
from jacaros.mas.checks.files import Findings, check_files
from jacaros.runtime.output import beneath

_KINDS = (".asl", ".mas2j", ".jcm", ".py", ".yaml", ".yml")
MOST_NAMES = 8
"""Number of skipped files listed in the note."""
_COLOURS: dict[Severity, str] = {"error": "red", "warning": "yellow", "note": "cyan"}


@click.command(
    "check",
    short_help="Report problems in programs, projects and mapping files.",
    epilog=examples(
        "jacaros check robot.asl",
        "jacaros check . --strict",
        "jacaros check robot.asl --mapping robot.yaml",
        "jacaros check . --format sarif > problems.sarif",
    ),
)
@click.argument("files", metavar="FILE...", type=click.Path(path_type=Path), nargs=-1, required=True)
@click.option(
    "--format",
    "style",
    type=click.Choice(["text", "json", "sarif"]),
    default="text",
    show_default=True,
    help="Output format: text, json, or sarif (SARIF 2.1.0, for editors and code hosts).",
)
@click.option("--strict", is_flag=True, help="Exit with status 1 on warnings, too.")
@click.option(
    "--ignore",
    metavar="CODE",
    multiple=True,
    help="Do not report warnings of this kind. Repeatable.",
)
@click.option(
    "--mapping",
    "mappings",
    metavar="FILE",
    multiple=True,
    help="Also check that programs use only what this mapping file provides. Repeatable.",
)
@click.option(
    "--import",
    "imports",
    is_flag=True,
    help="Run the Python files of the project to find all their declarations (default: read them only).",
)
def command(
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
        report(findings)
    else:
        click.echo((as_json if style == "json" else as_sarif)(findings))
    counts = Counter(each.severity for each in findings.diagnostics)
    return 1 if counts["error"] or (strict and counts["warning"]) else 0


def _supported(files: Sequence[Path]) -> Sequence[Path]:
    """Skip files of other types, which a shell's ``*`` also matches, unless there are no others."""
    foreign = [file for file in files if is_file(file) and file.suffix not in _KINDS]
    if not foreign or len(foreign) == len(files):
        return files
    names = ", ".join(map(str, foreign[:MOST_NAMES])) + (", ..." if len(foreign) > MOST_NAMES else "")
    click.echo(f"note: skipped unsupported file types: {names}", err=True)
    return [file for file in files if file not in foreign]


def report(findings: Findings) -> None:
    """Print the diagnostics, and their number on the standard error output."""
    coloured = has_colours()
    for diagnostic in findings.diagnostics:
        if coloured:  # its text is escaped
            click.echo(_coloured(diagnostic), beneath(sys.stdout), color=True)
        else:
            click.echo(diagnostic.render(with_code=True))
        click.echo()
    click.echo(_summary(findings.diagnostics, len(findings.files)), err=True)


def has_colours() -> bool:
    """Return whether to colour the output: it is a terminal, and NO_COLOR is not set."""
    return sys.stdout.isatty() and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"


def _coloured(diagnostic: Diagnostic) -> str:
    head, newline, rest = diagnostic.render(with_code=True).partition("\n")
    where = diagnostic.place()
    colour = _COLOURS[diagnostic.severity]
    level = click.style(diagnostic.severity, fg=colour, bold=True)
    return f"{click.style(where, bold=True)}{level}{head[len(where) + len(diagnostic.severity) :]}{newline}{rest}"


def _summary(diagnostics: Sequence[Diagnostic], files: int) -> str:
    counts = Counter(each.severity for each in diagnostics)
    found = [
        f"{counts[level]} {level}{'' if counts[level] == 1 else 's'}" for level in _COLOURS if counts[level]
    ]
    return f"{', '.join(found) or 'nothing wrong'} in {files} file{'' if files == 1 else 's'}"

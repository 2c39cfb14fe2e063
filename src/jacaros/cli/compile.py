"""``jacaros compile FILE``."""

import re
from collections.abc import Sequence
from pathlib import Path

import click

import jacaros.agents.mind.actions.standard  # noqa: F401 - fills the table of internal actions
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import bounded
from jacaros.agents.mind.generated.unit import Piece, listing, pieces
from jacaros.agents.mind.mind import new_engine
from jacaros.agents.mind.state.plan import Plan
from jacaros.agents.mind.state.plan_library import ProgramPlans
from jacaros.agents.terms.text import text
from jacaros.cli.check import report
from jacaros.cli.files import existing
from jacaros.cli.usage import examples, usage_error
from jacaros.files.python_modules import ProjectModules
from jacaros.mas.checking import check_files
from jacaros.mas.programs import Programs
from jacaros.mas.python_code import PythonCode

MOST_EVENTS = 8
"""Number of events listed when a plan is unknown."""


@click.command(
    "compile",
    short_help="Show the Python code generated for a program.",
    epilog=examples("jacaros compile robot.asl", "jacaros compile robot.asl --show --plan '+!go/2'"),
)
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--show", is_flag=True, help="Print the generated code, each part below its source lines.")
@click.option(
    "--plan",
    "wanted",
    metavar="LABEL|TRIGGER",
    help="Show only the plan with this label, or the plans for this event, such as `+!go` or `+!go/2`.",
)
@click.option(
    "--import",
    "imports",
    is_flag=True,
    help="Run the Python files of the project to find all their declarations (default: read them only).",
)
def command(file: Path, show: bool, wanted: str | None, imports: bool) -> int:
    """Compile all plans and rules of FILE, an agent program (.asl), and print the size of the generated code.

    You need not compile a program to run it: agents compile their plans when idle, or on the first event of a plan. Errors
    in the program are reported as by `jacaros check`, with exit code 1. Python code of the project is read, not run,
    unless you give --import.
    """  # fmt: skip
    program, code = _read(existing(file, (".asl",)), imports)
    if program is None:
        return 1
    plans = ProgramPlans(program.plans, new_engine(code.actions)).plans
    rules = [each for each in program.beliefs if isinstance(each, nodes.Rule)]
    all_ = list(pieces(plans, rules, code.actions))
    chosen = [(piece, None) for piece in all_] if wanted is None else _chosen(all_, wanted)
    texts = [listing(piece, only) for piece, only in chosen]
    too_large = [line for piece in all_ if (line := _fault(piece)) is not None]
    if show:
        click.echo("\n".join(texts), nl=False)
    else:
        functions = sum(len(re.findall("^def ", text, re.MULTILINE)) for text in texts)
        lines = sum(
            1 for text in texts for line in text.splitlines() if line and not line.lstrip().startswith("#")
        )
        click.echo(
            f"{file}: {_count(plans, 'plan')} and {_count(rules, 'rule')}: {functions} functions, {lines} lines"
        )
    for line in too_large:
        click.echo(f"{file}: error: {line}", err=True)
    return 1 if too_large else 0


def _read(file: Path, imports: bool) -> tuple[nodes.Program | None, PythonCode]:
    """Return the program, or None after reporting its errors."""
    findings = check_files([file], imports=imports)
    errors = [each for each in findings.diagnostics if each.severity == "error"]
    code = PythonCode(ProjectModules(file.parent, unseen=None if imports else set()))
    if errors:
        findings.diagnostics = bounded(errors)
        report(findings)
        return None, code
    return Programs((file.parent,), lambda _: None, code).read(file), code


def _fault(piece: Piece) -> str | None:
    """Return why Python cannot compile a piece; None if it can."""
    try:
        piece.unit.code()
    except (SyntaxError, RecursionError) as fault:
        return f"{piece.title} are too large to be compiled: {fault}"
    return None


def _chosen(all_: Sequence[Piece], wanted: str) -> list[tuple[Piece, Plan | None]]:
    """Return the pieces that `--plan` selects.

    Raises:
        UsageError: no plan matches.
    """
    label = wanted.removeprefix("@")
    labelled = [(piece, plan) for piece in all_ for plan in piece.plans if text(plan.label) == label]
    if labelled:
        return list(labelled)
    name = re.sub(r"\(.*", "", wanted).strip()
    found = [(piece, None) for piece in all_ if piece.plans and name in _names(piece)]
    if not found:
        events = sorted({_names(piece)[0] for piece in all_ if piece.plans})
        shown = ", ".join(events[:MOST_EVENTS]) + (", ..." if len(events) > MOST_EVENTS else "")
        raise usage_error(f"unknown plan: `{wanted}`", f"the program has plans for {shown or 'no event'}")
    return list(found)


def _names(piece: Piece) -> list[str]:
    """Return the names of a piece's event: with the number of its arguments, and without."""
    whole = piece.title.removeprefix("the plans for ").partition(" ")[0]
    return [whole, whole.partition("/")[0]]


def _count(things: Sequence[object], word: str) -> str:
    return f"{len(things)} {word}{'' if len(things) == 1 else 's'}"

"""``jacaros fmt FILE|FOLDER...``."""

import difflib
import shutil
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from tempfile import NamedTemporaryFile

import click

from jacaros.agents.language.diagnostics import AslError, Diagnostic
from jacaros.agents.language.formatting import format_program
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.cli.options import PATH
from jacaros.cli.usage import counted, examples, existing, no_programs, usage_error
from jacaros.errors import InternalError
from jacaros.files import texts
from jacaros.mas.checking import files_below
from jacaros.mas.programs import text_of

_STANDARD_INPUT = Path("-")


@click.command(
    "fmt",
    epilog=examples("jacaros fmt robot.asl", "jacaros fmt . --check"),
)
@click.argument("files", metavar="FILE...", type=PATH, nargs=-1, required=True)
@click.option(
    "--check",
    "only_check",
    is_flag=True,
    help="Write nothing; print the changes, and exit with status 1 if there are any.",
)
@click.option("--diff", "only_show", is_flag=True, help="Write nothing; print the changes.")
def command(files: tuple[Path, ...], only_check: bool, only_show: bool) -> int:
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
        if only_check or only_show:
            click.echo("".join(_difference(path, before, after)), nl=False)
        elif path == _STANDARD_INPUT:
            click.echo(after.encode(), nl=False)
        elif before != after:
            try:
                _replace(path, after)
            except OSError as fault:
                click.echo(f"error: cannot write `{path}`: {fault.strerror}", err=True)
                code = 1
    if _STANDARD_INPUT not in files:
        what = "would change" if only_check or only_show else "changed"
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

"""``jacaros metrics FOLDER...``."""

from pathlib import Path

import click

from jacaros.cli.outputs import check_output, wrong_output
from jacaros.errors import UsageError
from jacaros.metrics import (
    MEASURES,
    ProgramMetrics,
    Table,
    as_csv,
    as_markdown,
    as_text,
    file_table,
    group_table,
    measure,
    measure_chart,
    measure_table,
)
from jacaros.metrics.library import DEFAULT


@click.command("metrics", short_help="Count identifiers, lines and compressed bytes of programs.")
@click.argument("folders", metavar="FOLDER...", type=click.Path(path_type=Path), nargs=-1, required=True)
@click.option(
    "--baseline",
    "baselines",
    metavar="PATH",
    type=click.Path(path_type=Path),
    multiple=True,
    help="Folder or file of a Python program to compare with; one for each FOLDER, in their order. Repeatable.",
)
@click.option(
    "--library",
    "libraries",
    metavar="PACKAGE",
    multiple=True,
    help="Installed Python package to count as library code where it is imported (default: py_trees). Repeatable.",
)
@click.option(
    "--format",
    "style",
    type=click.Choice(["text", "markdown", "csv"]),
    default="text",
    show_default=True,
    help="Text for reading, Markdown for pages, or CSV for programs.",
)
@click.option("--files", is_flag=True, help="Show each file that was counted.")
@click.option(
    "--charts",
    metavar="FOLDER",
    type=click.Path(path_type=Path),
    help="Write a bar chart of each measure into FOLDER, as SVG.",
)
def command(
    folders: tuple[Path, ...],
    baselines: tuple[Path, ...],
    libraries: tuple[str, ...],
    style: str,
    files: bool,
    charts: Path | None,
) -> None:
    """Count the program in each FOLDER: identifiers, physical lines, code lines, and bytes compressed by gzip.

    Agents, artifacts, project files, world files and library code are counted apart. The total is that of agents and
    artifacts. Tests are left out, and no code is run. The page "Metrics" has the rules.
    """  # fmt: skip
    if baselines and len(baselines) != len(folders):
        raise UsageError(
            f"error: expected {len(folders)} baselines, found {len(baselines)}\n"
            "  = help: give --baseline PATH once for each folder, in the order of the folders"
        )
    pictures = {name: charts / f"{name}.svg" for name in MEASURES} if charts is not None else {}
    for path in pictures.values():
        check_output(path, "picture", make_folder=True)
    programs = measure(folders, [[path] for path in baselines], libraries or DEFAULT)
    click.echo(_shown(programs, style, files))
    for name, path in pictures.items():
        _write(path, measure_chart(programs, name))


def _shown(programs: list[ProgramMetrics], style: str, files: bool) -> str:
    if style == "csv":
        return as_csv((file_table if files else group_table)(programs)).rstrip("\n")
    tables = [file_table(programs)] if files else [measure_table(programs, name) for name in MEASURES]
    return "\n\n".join(map(as_text if style == "text" else _titled, tables))


def _titled(table: Table) -> str:
    return f"**{table.title}**\n\n{as_markdown(table)}"


def _write(path: Path, svg: str) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(svg, encoding="utf-8", newline="\n")
    except OSError as error:
        raise wrong_output(f"cannot write `{path}`: {error.strerror}", "name another folder") from error

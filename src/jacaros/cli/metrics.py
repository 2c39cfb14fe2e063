"""``jacaros metrics FOLDER...``."""

from pathlib import Path

import click

from jacaros.cli.outputs import check_output
from jacaros.cli.usage import examples, usage_error
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
from jacaros.metrics.programs import DEFAULT


@click.command(
    "metrics",
    short_help="Count identifiers, lines and compressed bytes of programs.",
    epilog=examples("jacaros metrics .", "jacaros metrics agents --baseline baseline.py --charts charts"),
)
@click.argument("folders", metavar="FOLDER...", type=click.Path(path_type=Path), nargs=-1, required=True)
@click.option(
    "--baseline",
    "baselines",
    metavar="PATH",
    type=click.Path(path_type=Path),
    multiple=True,
    help="Python program (file or folder) to compare with; give one for each FOLDER, in the same order. Repeatable.",
)
@click.option(
    "--library",
    "libraries",
    metavar="PACKAGE",
    multiple=True,
    help="Installed Python package whose imported modules count as library code (default: py_trees). Repeatable.",
)
@click.option(
    "--format",
    "style",
    type=click.Choice(["text", "markdown", "csv"]),
    default="text",
    show_default=True,
    help="Output format.",
)
@click.option("--files", is_flag=True, help="List every counted file.")
@click.option(
    "--charts",
    metavar="FOLDER",
    type=click.Path(path_type=Path),
    help="Write a bar chart of each measure to FOLDER, as SVG.",
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

    Agents, artifacts, project files, world files and library code are counted separately; the total covers agents and
    artifacts. Tests are not counted, and no code is run. The reference page "Metrics" gives the rules.
    """  # fmt: skip
    if baselines and len(baselines) != len(folders):
        raise usage_error(
            f"expected {len(folders)} baselines, found {len(baselines)}",
            "give --baseline PATH once for each folder, in the order of the folders",
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
        raise usage_error(f"cannot write `{path}`: {error.strerror}", "name another folder") from error

"""``jacaros metrics FOLDER...``."""

from contextlib import suppress
from pathlib import Path

import click

from jacaros.look import metrics
from jacaros.look.metrics.programs import DEFAULT
from jacaros.runtime.cli.options import PATH, option
from jacaros.runtime.cli.outputs import check_output, write_output
from jacaros.runtime.cli.usage import examples


@click.command(
    "metrics",
    epilog=examples("jacaros metrics .", "jacaros metrics agents --charts charts"),
)
@click.argument("folders", metavar="FOLDER...", type=PATH, nargs=-1, required=True)
@option(
    "--library PACKAGE...",
    "Installed Python package whose imported modules count as library code (default: py_trees). Repeatable.",
    name="libraries",
)
@option("--format", "Output format.", click.Choice(["text", "markdown", "csv"]), name="style", default="text")
@option("--files", "List every counted file.")
@option("--charts FOLDER", "Write a bar chart of each measure to FOLDER, as SVG.", PATH)
def command(
    folders: tuple[Path, ...],
    libraries: tuple[str, ...],
    style: str,
    files: bool,
    charts: Path | None,
) -> None:
    """Count the program in each FOLDER: identifiers, physical lines, code lines, and bytes compressed by gzip.

    Agents, artifacts, project files, world files and library code are counted separately; the total covers agents and
    artifacts. Tests are not counted, and no code is run. The reference page "Metrics" gives the rules.
    """  # fmt: skip
    pictures = {name: charts / f"{name}.svg" for name in metrics.MEASURES} if charts is not None else {}
    for path in pictures.values():
        check_output(path, "picture", make_folder=True)
    programs = metrics.measure(folders, libraries or DEFAULT)
    click.echo(_shown(programs, style, files))
    for name, path in pictures.items():
        with suppress(OSError):  # what writing will report
            path.parent.mkdir(parents=True, exist_ok=True)
        write_output(path, metrics.measure_chart(programs, name), "name another folder")


def _shown(programs: list[metrics.ProgramMetrics], style: str, files: bool) -> str:
    if style == "csv":
        table = (metrics.file_table if files else metrics.group_table)(programs)
        return metrics.as_csv(table).rstrip("\n")
    tables = [metrics.measure_table(programs, name) for name in metrics.MEASURES]
    if files:
        tables = [metrics.file_table(programs)]
    if style == "text":
        return "\n\n".join(map(metrics.as_text, tables))
    return "\n\n".join(f"**{table.title}**\n\n{metrics.as_markdown(table)}" for table in tables)

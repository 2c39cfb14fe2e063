"""``jacaros metrics FOLDER...``."""

from pathlib import Path

import click

from jacaros.look import metrics
from jacaros.runtime.cli.options import PATH, option
from jacaros.runtime.cli.usage import examples


@click.command("metrics", epilog=examples("jacaros metrics ."))
@click.argument("folders", metavar="FOLDER...", type=PATH, nargs=-1, required=True)
@option("--files", "List every counted file.")
def command(folders: tuple[Path, ...], files: bool) -> None:
    """Count the program in each FOLDER: identifiers, physical lines, code lines, and bytes compressed by gzip.

    Agents, artifacts, project files, world files and library code are counted separately; the total covers agents and
    artifacts. Tests are not counted, and no code is run. The reference page "Metrics" gives the rules.
    """  # fmt: skip
    programs = metrics.measure(folders)
    tables = [metrics.measure_table(programs, name) for name in metrics.MEASURES]
    if files:
        tables = [metrics.file_table(programs)]
    click.echo("\n\n".join(map(metrics.as_text, tables)))

"""``jacaros replay RUN --against FILE.asl``."""

import json
from pathlib import Path

import click

from jacaros.cli.files import existing, read_recording
from jacaros.errors import UsageError


@click.command("replay", short_help="Give a recorded run to a changed program, and compare its decisions.")
@click.argument("run", type=click.Path(path_type=Path))
@click.option(
    "--against",
    type=click.Path(path_type=Path),
    required=True,
    metavar="FILE.asl",
    help="The changed program.",
)
@click.option(
    "--agent",
    default="",
    metavar="A",
    help="Agent whose percepts and messages FILE.asl gets (default: the only one).",
)
@click.option("--json", "as_json", is_flag=True, help="Print the comparison as JSON.")
def command(run: Path, against: Path, agent: str, as_json: bool) -> int:
    """Run FILE.asl with the percepts and messages that an agent got in RUN, and report where it decides differently.

    RUN is a recording (`jacaros run FILE --record RUN`). Nothing moves and nothing is published: time is virtual, and an
    action takes as long, and ends, as the same action did in RUN. An action that RUN does not have waits. The exit code is
    1 if a decision differs.
    """  # fmt: skip
    from jacaros.mas.replaying import replay_against

    program = existing(against, (".asl",))
    if program.is_dir():
        raise UsageError(f"error: `{against}` is a folder\n  = help: name a program in it")
    comparison = replay_against(read_recording(run).events, program, agent)
    text = json.dumps(comparison.data(), ensure_ascii=False) if as_json else comparison.text()
    click.echo(text)
    return 1 if comparison.decisions else 0

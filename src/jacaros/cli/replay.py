"""``jacaros replay RUN --against FILE.asl``."""

import json
from pathlib import Path

import click

from jacaros.cli.files import existing, read_recording
from jacaros.cli.usage import examples, usage_error


@click.command(
    "replay",
    short_help="Replay a recorded run against a changed program.",
    epilog=examples("jacaros replay run.jsonl --against robot.asl"),
)
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
    help="Agent whose percepts and messages FILE.asl receives (default: the only one).",
)
@click.option("--json", "as_json", is_flag=True, help="Print the comparison as JSON.")
def command(run: Path, against: Path, agent: str, as_json: bool) -> int:
    """Run FILE.asl with the percepts and messages that an agent received in RUN, and report each different decision.

    RUN is a recording (`jacaros run FILE --record RUN`). No robot moves and nothing is published. Time is virtual, and
    each action takes the same time and has the same outcome as in RUN; an action that does not occur in RUN never ends.
    The exit code is 1 if a decision differs.
    """  # fmt: skip
    from jacaros.mas.replaying import replay_against

    program = existing(against, (".asl",))
    if program.is_dir():
        raise usage_error(f"`{against}` is a folder", "name a program in it")
    comparison = replay_against(read_recording(run).events, program, agent)
    text = json.dumps(comparison.data(), ensure_ascii=False) if as_json else comparison.text()
    click.echo(text)
    return 1 if comparison.decisions else 0

"""``jacaros why RUN.jsonl QUESTION``."""

import json
from pathlib import Path

import click

from jacaros.cli.files import read_recording
from jacaros.errors import UsageError
from jacaros.mas.history.why import explain

# An event such as `-hidden(_)` must not be read as options, not even as -h.
_CONTEXT = {"ignore_unknown_options": True, "help_option_names": ["--help"]}


@click.command(
    "why",
    context_settings=_CONTEXT,
    short_help="Explain why something happened in a recorded run, or did not.",
)
@click.argument("run", type=click.Path(path_type=Path))
@click.argument("question", nargs=-1, required=True)
@click.option(
    "--at",
    type=float,
    metavar="T",
    help="Answer for the moment T, in seconds since the run began (default: the end of the recording).",
)
@click.option("--agent", default="", metavar="A", help="Look at this agent only.")
@click.option("--robot", default="", metavar="R", help="Look at this robot only.")
@click.option("--json", "as_json", is_flag=True, help="Print the answer as JSON.")
def command(
    run: Path, question: tuple[str, ...], at: float | None, agent: str, robot: str, as_json: bool
) -> None:
    """Answer a QUESTION about RUN, a recording (`jacaros run FILE --record RUN`).

    \b
    stopped                       why the robot stopped
    command [TOPIC]               what led to the last command
    operation [NAME]              what led to the last operation
    +EVENT, -EVENT                how an event of a belief was handled, such as '+alarm(_)'
    !GOAL, ?TEST, -!GOAL          the same for a goal, a test goal or a failure
    plan @LABEL, plan FILE:LINE   when a plan was chosen, and why it was not
    belief BELIEF                 what last changed a belief, such as 'battery(_)'
    waiting                       what each intention waits for
    nothing                       why nothing happens

    Words around these are ignored: 'why did the robot stop?' asks `stopped`. Variables fit anything. Put the question in
    single quotes, since shells treat `!` and brackets specially.
    """  # fmt: skip
    recording = read_recording(run)
    if robot and robot not in recording.robots:
        known = ", ".join(recording.robots) or "none"
        raise UsageError(f"error: unknown robot: `{robot}`\n  = help: robots of the recording: {known}")
    answer = explain(recording.events, " ".join(question), at, agent, robot)
    click.echo(json.dumps(answer.data(), ensure_ascii=False) if as_json else answer.text())

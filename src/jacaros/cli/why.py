"""``jacaros why RUN.jsonl QUESTION``."""

import json
from pathlib import Path

import click

from jacaros.cli.files import read_recording
from jacaros.cli.usage import examples, usage_error
from jacaros.mas.history.why import explain

# An event such as `-hidden(_)` must not be read as options, not even as -h.
_CONTEXT = {"ignore_unknown_options": True, "help_option_names": ["--help"]}


@click.command(
    "why",
    context_settings=_CONTEXT,
    short_help="Explain why something did or did not happen in a recorded run.",
    epilog=examples("jacaros why run.jsonl stopped", "jacaros why run.jsonl '+alarm(_)' --at 12.5"),
)
@click.argument("run", type=click.Path(path_type=Path))
@click.argument("question", nargs=-1, required=True)
@click.option(
    "--at",
    type=float,
    metavar="T",
    help="Answer for time T, in seconds since the start of the run (default: the end of the recording).",
)
@click.option("--agent", default="", metavar="A", help="Consider only this agent.")
@click.option("--robot", default="", metavar="R", help="Consider only this robot.")
@click.option("--json", "as_json", is_flag=True, help="Print the answer as JSON.")
def command(
    run: Path, question: tuple[str, ...], at: float | None, agent: str, robot: str, as_json: bool
) -> None:
    """Answer a QUESTION about RUN, a recording (`jacaros run FILE --record RUN`).

    \b
    stopped                       why the robot stopped
    command [TOPIC]               what led to the last command
    operation [NAME]              what led to the last operation
    +EVENT, -EVENT                how a belief event was handled, such as '+alarm(_)'
    !GOAL, ?TEST, -!GOAL          the same for a goal, a test goal or a failure
    plan @LABEL, plan FILE:LINE   when a plan was selected, or why it was not
    belief BELIEF                 what last changed a belief, such as 'battery(_)'
    waiting                       what each intention waits for
    nothing                       why nothing happens

    Words around these are ignored: 'why did the robot stop?' asks `stopped`. Variables match anything. Quote the question
    with single quotes, because shells interpret `!` and brackets.
    """  # fmt: skip
    recording = read_recording(run)
    if robot and robot not in recording.robots:
        known = ", ".join(recording.robots) or "none"
        raise usage_error(f"unknown robot: `{robot}`", f"robots in the recording: {known}")
    answer = explain(recording.events, " ".join(question), at, agent, robot)
    click.echo(json.dumps(answer.data(), ensure_ascii=False) if as_json else answer.text())

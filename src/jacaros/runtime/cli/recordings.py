"""``jacaros view``, ``jacaros why`` and ``jacaros replay``: commands about recorded runs."""

import asyncio
import json
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import click

from jacaros.runtime.cli.options import PATH, option, place_options
from jacaros.runtime.cli.outputs import check_output, check_view
from jacaros.runtime.cli.usage import (
    examples,
    existing,
    no_gc,
    read_recording,
    recorded_events,
    usage_error,
)

if TYPE_CHECKING:
    from jacaros.look.why.past import Happened

# An event such as `-hidden(_)` must not be read as options, not even as -h.
_QUESTIONS = {"ignore_unknown_options": True, "help_option_names": ["--help"]}


@click.command(
    "view",
    epilog=examples("jacaros view run.jsonl", "jacaros view run.jsonl --output run.html"),
)
@click.argument("run", type=PATH)
@option("--output FILE.html", "Write the page to a file that needs no server, and exit.", PATH)
@place_options
def view(run: Path, output: Path | None, view_port: int, view_address: str, view_token: str | None) -> None:
    """Show RUN, a recording (`jacaros run FILE --record RUN`), on the same page as a live run, until you press Ctrl+C.

    The address of the page is printed to the standard error output.
    """  # fmt: skip
    if output is not None:
        check_output(output, "replay page")
    else:
        check_view(view_address, view_token)
    recording = read_recording(run)
    if output is not None:
        from jacaros.look.page.page import write_replay

        try:
            write_replay(recording, output)
        except OSError as error:
            raise usage_error(f"cannot write `{output}`: {error.strerror}", "name another file") from error
        click.echo(f"wrote {output}")
        return
    from jacaros.look.page.live.access import Access
    from jacaros.look.page.live.live_view import LiveView
    from jacaros.look.page.live.server import LiveServer, bound_socket
    from jacaros.runtime.cli.watching import log_address, open_page

    access = Access(view_address, view_token)
    server = LiveServer(bound_socket(view_address, view_port), access, LiveView.of_recording(recording))

    async def serve() -> None:
        await server.start()
        log_address(server.address, view_address, lambda text, _: click.echo(text, err=True))
        click.echo("press Ctrl+C to stop", err=True)
        open_page(server.address)
        try:
            await asyncio.get_running_loop().create_future()
        finally:
            await server.close()

    try:
        asyncio.run(serve())
    except KeyboardInterrupt:
        click.echo(err=True)


@click.command(
    "why",
    context_settings=_QUESTIONS,
    epilog=examples(
        "jacaros why run.jsonl --story",
        "jacaros why run.jsonl did it dock",
        "jacaros why run.jsonl '+alarm(_)' --at 12.5",
    ),
)
@click.argument("run", type=PATH)
@click.argument("question", nargs=-1)
@option("--story", "Print the story of the run in at most ten lines instead of an answer.")
@option(
    "--at T",
    "Answer for time T, in seconds since the start of the run (default: the end of the recording).",
    float,
)
@option("--agent A", "Consider only this agent.", default="", show_default=False)
@option("--robot R", "Consider only this robot.", default="", show_default=False)
@option("--json", "Print the answer as JSON.", name="as_json")
def why(
    run: Path,
    question: tuple[str, ...],
    story: bool,
    at: float | None,
    agent: str,
    robot: str,
    as_json: bool,
) -> None:
    """Answer a QUESTION about RUN, a recording (`jacaros run FILE --record RUN`), or tell its story.

    \b
    why did it VERB ...                    what led to it: 'why did it go to the dock'
    did it VERB ..., did it achieve GOAL   whether it succeeded, and if not, why
    when did it ..., how often did it ...  the times
    why is it standing still               what it waits for, or why the run ended
    why did it fail                        what failed last, with the reason
    stopped                                why the robot stopped
    command [TOPIC]                        what led to the last command
    operation [NAME]                       what led to the last operation
    +EVENT, !GOAL, ?TEST, -!GOAL           how an event, a goal, a test goal or a failure was handled
    plan @LABEL, plan FILE:LINE            when a plan was selected, or why it was not
    belief BELIEF                          what last changed a belief, such as 'battery(_)'

    The words of a question are compared with the names of what happened in the run: 'recharge' finds operationRecharge, and
    'go to the dock' finds !go_to(dock) and driveTo(1,1), if the agent believes place(dock,1,1,0). An unknown question is an
    error, which lists the operations, goals and events of the run. Variables match anything. Quote the question with single
    quotes, because shells interpret `!` and brackets.
    """  # fmt: skip
    from jacaros.look.records.recording import Recording
    from jacaros.look.why.past import UNASKED
    from jacaros.look.why.story import story_of, story_text
    from jacaros.look.why.why import explain

    if story and (question or agent or robot):
        raise usage_error("--story takes no question, agent or robot", "pass only --at and --json with it")
    if not story and not question:
        raise usage_error("missing question", "ask one, such as `did it dock`, or pass --story")
    recording = Recording()
    if story:
        with no_gc():
            told = recorded_events(run, recording, UNASKED - {"property"})
            lines = story_of(each for each in told if at is None or each[0] <= at)
        plain = [asdict(each) for each in lines]
        click.echo(json.dumps(plain, ensure_ascii=False) if as_json else story_text(lines))
        return

    def happened() -> Iterator["Happened"]:
        yield from recorded_events(run, recording, UNASKED, is_plain=False)
        if robot and robot not in recording.robots:
            known = ", ".join(recording.robots) or "none"
            raise usage_error(f"unknown robot: `{robot}`", f"robots in the recording: {known}")

    with no_gc():
        answer = explain(happened(), " ".join(question), at, agent, robot)
    click.echo(json.dumps(answer.data(), ensure_ascii=False) if as_json else answer.text())


@click.command(
    "replay",
    epilog=examples("jacaros replay run.jsonl --against robot.asl"),
)
@click.argument("run", type=PATH)
@option("--against FILE.asl", "The changed program.", PATH, required=True)
@option(
    "--agent A",
    "Agent whose percepts and messages FILE.asl receives (default: the only one).",
    default="",
    show_default=False,
)
@option("--json", "Print the comparison as JSON.", name="as_json")
def replay(run: Path, against: Path, agent: str, as_json: bool) -> int:
    """Run FILE.asl with the percepts and messages that an agent received in RUN, and report each different decision.

    RUN is a recording (`jacaros run FILE --record RUN`). No robot moves and nothing is published. Time is virtual, and
    each action takes the same time and has the same outcome as in RUN; an action that does not occur in RUN never ends.
    The exit code is 1 if a decision differs.
    """  # fmt: skip
    from jacaros.runtime.mas.replaying import replay_against

    program = existing(against, (".asl",))
    if program.is_dir():
        raise usage_error(f"`{against}` is a folder", "name a program in it")
    comparison = replay_against(read_recording(run).events, program, agent)
    text = json.dumps(comparison.data(), ensure_ascii=False) if as_json else comparison.text()
    click.echo(text)
    return 1 if comparison.decisions else 0

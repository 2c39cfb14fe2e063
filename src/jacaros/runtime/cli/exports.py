"""``jacaros plot`` and ``jacaros export``: a recorded run outside of the page."""

import json
from pathlib import Path

import click

from jacaros.runtime.cli.options import PATH, option
from jacaros.runtime.cli.outputs import check_output, write_output
from jacaros.runtime.cli.usage import examples, read_recording, usage_error


@click.command(
    "plot",
    epilog=examples(
        "jacaros plot run.jsonl battery turtlebot.x,turtlebot.y -o run.svg",
        "jacaros plot run.jsonl robot_1:battery,robot_2:battery -o batteries.svg",
    ),
)
@click.argument("run", type=PATH)
@click.argument("names", metavar="NAME[,NAME]...", nargs=-1, required=True)
@option("-o --output FILE.svg", "Write the plot to FILE.svg.", PATH, required=True)
@option(
    "--from T", "Begin at time T, in seconds since the start of the run.", float, name="start", default=0.0
)
@option("--to T", "End at time T (default: the end of the recording).", float, name="end")
def plot(run: Path, names: tuple[str, ...], output: Path, start: float, end: float | None) -> None:
    """Draw numbers of RUN, a recording (`jacaros run FILE --record RUN`), over time, for papers.

    Each argument is a panel; names joined by commas share one.

    \b
    battery             the first number of a belief, or of a property that no agent believes
    odom.2              its second argument
    odom.x              its first (x), second (y) or third (yaw) argument
    robot_1:battery     the same of one agent, or of one artifact
    turtlebot.battery   of a robot: x, y, yaw, battery, speed, laser (distance of the nearest echo)

    Dashed lines are the values that conditions of programs compare a belief with.
    Triangles on the time axis mark goals that failed, hollow ones if a plan handled the failure. For a list of the
    names in the recording, give an unknown one.
    """  # fmt: skip
    from jacaros.look.out.series import all_series
    from jacaros.look.out.svg_plot import failures, panel_of, plot_svg

    check_output(output, "picture")
    recording = read_recording(run)
    known = all_series(recording)
    panels = [panel_of(recording, known, each.split(",")) for each in names]
    end = recording.duration if end is None else end
    if not start < end:
        raise usage_error(f"--from {start:g} is not before the end, {end:g}", "name a part of the recording")
    write_output(output, plot_svg(panels, failures(recording.events), (start, end), run.name))
    click.echo(f"wrote {output}")


@click.command("export", epilog=examples("jacaros export run.jsonl -o run.mcap"))
@click.argument("run", type=PATH)
@option(
    "-o --output FILE.mcap",
    "Write the messages to FILE.mcap, and the layout to FILE.json.",
    PATH,
    required=True,
)
def export(run: Path, output: Path) -> None:
    """Convert RUN, a recording (`jacaros run FILE --record RUN`), for Foxglove: an MCAP file, and a layout that shows it.

    The file has intentions and operations as states, beliefs and other numbers for plots, the output of agents as a log,
    and the poses and laser scans of robots. In Foxglove, open the MCAP file, and import the layout from its file.
    """  # fmt: skip
    from jacaros.look.out.foxglove import layout, write_mcap

    if output.suffix != ".mcap":
        raise usage_error(
            f"expected a file name with the suffix .mcap, found `{output}`",
            f"-o {output.with_suffix('.mcap')}",
        )
    shown = output.with_suffix(".json")
    check_output(output, "MCAP file")
    check_output(shown, "layout")
    recording = read_recording(run)
    try:
        with output.open("wb") as file:
            topics = write_mcap(recording, file)
    except OSError as error:
        raise usage_error(f"cannot write `{output}`: {error.strerror}", "name another file") from error
    write_output(shown, json.dumps(layout(recording, topics), indent=1))
    click.echo(f"wrote {output} and its layout {shown}")

"""``jacaros sim WORLD``."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from jacaros.robots.ros.open import GraphAddress
from jacaros.robots.world.data.robot import BatterySettings
from jacaros.robots.world.data.world import WorldDescription
from jacaros.runtime.cli.graph_options import (
    faults_option,
    noise_option,
    read_remaps,
    ros_option,
    world_options,
)
from jacaros.runtime.cli.options import ground_truth_option, option
from jacaros.runtime.cli.outputs import check_output
from jacaros.runtime.cli.usage import examples, usage_error
from jacaros.runtime.clock import Clock, VirtualClock, WallClock, run
from jacaros.runtime.files.texts import is_file


@click.command(
    "sim",
    epilog=examples(
        "jacaros sim house --ros ros2",
        "jacaros sim world.yaml --ros ros2 --speed 5",
    ),
)
@click.argument("world")
@ros_option("ROS graph to join.", required=True)
@world_options
@option("--for S", "Exit after S seconds.", float, name="seconds")
@ground_truth_option
@option("--seed", "Seed for the noise of the sensors.", int)
@noise_option
@faults_option
@option("--full-battery", "Keep all batteries full.")
@option(
    "--clock",
    "Clock to run on: real, or fast (virtual time; with --ros memory only).",
    click.Choice(["real", "fast"]),
    default="real",
)
@option(
    "--publish-clock",
    "Publish the world's time on /clock, for nodes with use_sim_time (agents: --clock ros).",
)
@option(
    "--speed X",
    "Run X times as fast as real time; includes --publish-clock.",
    click.FloatRange(0.0, 100.0, min_open=True),
)
def command(
    world: str,
    ros: str,
    remap: tuple[str, ...],
    seconds: float | None,
    ground_truth: Path | None,
    seed: int | None,
    noise: float | None,
    faults: Path | None,
    full_battery: bool,
    clock: str,
    publish_clock: bool,
    speed: float | None,
    **graph: Any,
) -> None:
    """Run WORLD (a world file, or the name of a shipped world) as a ROS node, until you press Ctrl+C."""  # fmt: skip
    from jacaros.robots.world import World

    loaded = World.load(Path(world) if is_file(Path(world)) else world, seed, faults, noise)
    if full_battery:
        loaded = World(with_full_batteries(loaded.description), faults=loaded.faults.by_name.values())
    from jacaros.robots.ros.node import to_stderr
    from jacaros.robots.world import serve

    if clock == "fast" and (ros != "memory" or seconds is None):
        raise usage_error("--clock fast needs --ros memory and --for S", "a real ROS graph runs in real time")
    if clock == "fast" and speed is not None:
        help = "--clock fast already runs as fast as the machine can"
        raise usage_error("--speed needs --clock real", help)
    time: Clock = VirtualClock() if clock == "fast" else WallClock(speed or 1.0)
    address = GraphAddress(ros, remap=read_remaps(remap), **graph)
    address.check()
    if ground_truth is not None:
        check_output(ground_truth, "ground truth")
    loaded.ground_truth.keep = 1000
    loaded.ground_truth.listen(battery_warnings(lambda line: click.echo(line, err=True)))

    def tell() -> None:
        names = ", ".join(robot.name for robot in loaded.description.robots)
        click.echo(f"running the world {loaded.description.name} with {names}; press Ctrl+C to stop")

    async def main() -> None:
        backend = address.open(time, "world", to_stderr)
        clock_too = publish_clock or speed is not None
        await serve(loaded, backend, time, seconds, ground_truth, clock_too, tell)

    run(main, time)


LOW = 20
"""Battery level in percent at which a warning is logged, once for each discharge."""


def with_full_batteries(world: WorldDescription) -> WorldDescription:
    """Return the same world with batteries that never discharge."""
    full = BatterySettings(level=100.0, drain_per_second=0.0, drain_per_metre=0.0, drain_per_radian=0.0)
    return replace(world, robots=tuple(replace(robot, battery=full) for robot in world.robots))


def battery_warnings(log: Callable[[str], None]) -> Callable[[dict[str, Any]], None]:
    """Return a listener for `GroundTruth.listen` that logs batteries that run low or are empty.

    Args:
        log: takes a line.
    """
    low: set[str] = set()

    def listen(record: dict[str, Any]) -> None:
        if record.get("event") == "battery_empty":
            log(
                f"warning: the battery of `{record['robot']}` is empty, so it cannot drive\n"
                "  = help: restart the world, with --full-battery to keep batteries full"
            )
        elif record.get("event") == "battery":
            robot, level = record["robot"], record["data"]["level"]
            if level > LOW:
                low.discard(robot)
            elif robot not in low:
                low.add(robot)
                log(f"warning: the battery of `{robot}` is at {level} %")

    return listen

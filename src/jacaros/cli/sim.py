"""``jacaros sim WORLD``."""

from pathlib import Path

import click

from jacaros.clock import Clock, VirtualClock, WallClock, run
from jacaros.errors import UsageError
from jacaros.mas.options import ROS_KINDS


@click.command("sim", short_help="Run a robot world as a ROS node of its own.")
@click.argument("world")
@click.option("--ros", type=click.Choice(ROS_KINDS), required=True, help="The ROS graph to join.")
@click.option("--bridge", metavar="URL", help="Address of the rosbridge server, with --ros rosbridge.")
@click.option("--for", "seconds", type=float, metavar="S", help="End after S seconds.")
@click.option(
    "--ground-truth",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Write what truly happens as JSON lines.",
)
@click.option("--seed", type=int, help="Makes the noise of the sensors repeatable.")
@click.option(
    "--clock",
    type=click.Choice(["real", "fast"]),
    default="real",
    show_default=True,
    help="In real time, or as fast as the machine can (only with --ros memory).",
)
@click.option(
    "--publish-clock",
    is_flag=True,
    help="Publish the world's time on /clock, for nodes with use_sim_time (agents: --clock ros).",
)
@click.option(
    "--speed",
    type=click.FloatRange(0.0, 100.0, min_open=True),
    metavar="X",
    help="Let the world run X times as fast as real time; includes --publish-clock.",
)
def command(
    world: str,
    ros: str,
    bridge: str | None,
    seconds: float | None,
    ground_truth: Path | None,
    seed: int | None,
    clock: str,
    publish_clock: bool,
    speed: float | None,
) -> None:
    """Run WORLD (a world file, or the name of a world that comes with jacaros) until Ctrl-C."""  # fmt: skip
    from jacaros.ros.open import open_backend
    from jacaros.sim import World, serve
    from jacaros.sim.scaled_clock import ScaledClock

    if clock == "fast" and (ros != "memory" or seconds is None):
        raise UsageError(
            "--clock fast goes with --ros memory and --for S; a real ROS graph lives in real time"
        )
    if clock == "fast" and speed is not None:
        raise UsageError("--speed goes with --clock real; --clock fast is as fast as the machine can")
    time: Clock = VirtualClock() if clock == "fast" else WallClock() if speed is None else ScaledClock(speed)
    loaded = World.load(Path(world) if Path(world).is_file() else world, seed)
    loaded.ground_truth.keep = 1000

    def tell() -> None:
        names = ", ".join(robot.name for robot in loaded.description.robots)
        click.echo(f"the world {loaded.description.name} with {names} runs; Ctrl-C ends it")

    async def main() -> None:
        backend = open_backend(ros, time, "world", url=bridge)
        clock_too = publish_clock or speed is not None
        await serve(loaded, backend, time, seconds, ground_truth, clock_too, tell)

    run(main, time)

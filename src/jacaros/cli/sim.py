"""``jacaros sim WORLD``."""

from pathlib import Path

import click

from jacaros.clock import Clock, VirtualClock, WallClock, run
from jacaros.errors import UsageError
from jacaros.mas.options import ROS_KINDS


@click.command("sim", short_help="Run a robot world as a ROS node of its own.")
@click.argument("world")
@click.option("--ros", type=click.Choice(ROS_KINDS), required=True, help="The ROS graph to join.")
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
def command(
    world: str, ros: str, seconds: float | None, ground_truth: Path | None, seed: int | None, clock: str
) -> None:
    """Run WORLD (a world file, or the name of a world that comes with jacaros) until Ctrl-C."""  # fmt: skip
    from jacaros.ros.open import open_backend
    from jacaros.sim import World, serve

    if clock == "fast" and (ros != "memory" or seconds is None):
        raise UsageError(
            "--clock fast goes with --ros memory and --for S; a real ROS graph lives in real time"
        )
    time: Clock = VirtualClock() if clock == "fast" else WallClock()
    loaded = World.load(Path(world) if Path(world).is_file() else world, seed)
    loaded.ground_truth.keep = 1000

    async def main() -> None:
        await serve(loaded, open_backend(ros, time, "world"), time, seconds, ground_truth)

    run(main, time)

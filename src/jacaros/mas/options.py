"""How a project is run: what the command line or a Python program decides."""

from dataclasses import dataclass
from pathlib import Path

from jacaros.errors import UsageError

ROS_KINDS = ("memory", "ros1", "ros2")


@dataclass(frozen=True, slots=True)
class RunOptions:
    """How to run a project.

    Attributes:
        fast: on the virtual clock, as fast as the machine can; else in real time.
        seed: of all random numbers, the world's too; None for other numbers in each run.
        ros: kind of the ROS graph: ``memory`` (inside the process), ``ros1`` or ``ros2``.
        world: world file, or name of a world of JaCaROS, in place of the project's own.
        show_world: make the world at the start, even when nobody asks for a robot yet.
        namespace: put before relative ROS names.
        until_idle: end when no agent has anything to do and no operation is under way.
        seconds: end after so many seconds of the run's clock.
    """

    fast: bool = False
    seed: int | None = None
    ros: str = "memory"
    world: str | Path | None = None
    show_world: bool = False
    namespace: str = ""
    until_idle: bool = False
    seconds: float | None = None

    def check(self) -> None:
        """Refuse what cannot go together.

        Raises:
            UsageError: with what to do instead.
        """
        if self.ros not in ROS_KINDS:
            raise UsageError(f"there is no ROS backend {self.ros!r}; there are {', '.join(ROS_KINDS)}")
        if self.fast and self.ros != "memory":
            raise UsageError(
                f"the virtual clock (--clock fast) cannot run with a real ROS graph (--ros {self.ros}): its "
                "nodes live in real time; use --clock real"
            )
        if self.seconds is not None and self.seconds < 0:
            raise UsageError("--for wants a number of seconds that is not negative")

"""How a project is run: what the command line or a Python program decides."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from jacaros.errors import UsageError
from jacaros.ros.address import GraphAddress
from jacaros.ros.middleware import MIDDLEWARES, middleware

if TYPE_CHECKING:
    from jacaros.ros.orphans import OrphanPolicy


@dataclass(frozen=True, slots=True)
class RunOptions(GraphAddress):
    """How to run a project, and in which ROS graph: the attributes of `GraphAddress`, and these.

    Attributes:
        fast: on the virtual clock, as fast as the machine can; else in real time.
        seed: of all random numbers, the world's too; None for other numbers in each run.
        world: world file, or name of a world of JaCaROS, in place of the project's own.
        faults: fault file: what goes wrong in the embedded world, and when.
        keep_ground_truth: keep in memory all that happens in the embedded world, not only the last minutes.
        show_world: make the world at the start, even when nobody asks for a robot yet.
        until_idle: end when no agent has anything to do and no operation is under way.
        fail_on_lost_goal: the exit code is 1 instead of 0 if a goal failed and no plan took over.
        seconds: end after so many seconds of the run's clock.
        ros_clock: time is that of the graph's ``/clock``, as a simulator publishes it.
        rosout: write what agents print, and logs, to the graph's ``/rosout``; None: on real graphs.
        mappings: mapping files whose artifacts are made at the start.
        guard: have a process of its own stop the robot when this one no longer can.
        restricted: agents take no plans from others (``tellHow``), read and write no files, and make no Python objects; see
            docs/explanation/trust.md.
        explain: keep the history of the run from its start on, for `Mas.explain` and ``.why``.
        diagnostics: publish the state of agents and connection on ``/diagnostics``; None: on real graphs.
    """

    fast: bool = False
    seed: int | None = None
    world: str | Path | None = None
    faults: str | Path | None = None
    show_world: bool = False
    keep_ground_truth: bool = False
    until_idle: bool = False
    fail_on_lost_goal: bool = False
    seconds: float | None = None
    ros_clock: bool = False
    orphans: "OrphanPolicy" = "cancel"
    rosout: bool | None = None
    diagnostics: bool | None = None
    mappings: Sequence[str | Path] = ()
    guard: bool = False
    restricted: bool = False
    explain: bool = False

    @property
    def real_graph(self) -> bool:
        """Whether the graph is one outside of the process."""
        return self.ros != "memory"

    @property
    def wants_rosout(self) -> bool:
        """Whether lines go to ``/rosout``."""
        return self.real_graph if self.rosout is None else self.rosout

    @property
    def wants_diagnostics(self) -> bool:
        """Whether ``/diagnostics`` is published."""
        return self.real_graph if self.diagnostics is None else self.diagnostics

    def check(self) -> None:
        """Refuse what cannot go together.

        Raises:
            UsageError: with what to do instead.
        """
        middleware(self.ros)
        if self.fast and self.ros != "memory":
            raise UsageError(
                f"the virtual clock (--clock fast) cannot run with a real ROS graph (--ros {self.ros}): its "
                "nodes live in real time; use --clock real"
            )
        if self.ros_clock and not self.real_graph:
            raise UsageError(
                "--clock ros follows the /clock of a real ROS graph (--ros ros1 or ros2); in the graph inside the "
                "process time is virtual with --clock fast"
            )
        if self.guard and not self.real_graph:
            raise UsageError(
                "--guard needs a real ROS graph (--ros ros1, ros2 or rosbridge): in the graph inside the process, agents "
                "and robot end together"
            )
        if self.real_graph or self._names_the_graph():
            GraphAddress.check(self)  # with slots, super() knows an older class
        if self.seconds is not None and self.seconds < 0:
            raise UsageError("--for must be a non-negative number of seconds")

    def _names_the_graph(self) -> bool:
        options = (self.node_name, *(self._given(kind) for kind in MIDDLEWARES.values()))
        names = self.namespace or self.remap or self.parameters
        return bool(names or any(option is not None for option in options))

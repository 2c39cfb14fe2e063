"""Run options, from the command line or a Python program."""

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from jacaros.robots.ros.middleware import MIDDLEWARES, middleware
from jacaros.robots.ros.open import GraphAddress
from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.texts import help_line

if TYPE_CHECKING:
    from jacaros.robots.ros.action_client import OrphanPolicy


@dataclass(frozen=True, slots=True)
class RunOptions(GraphAddress):
    """How to run a project, and in which ROS graph: the attributes of `GraphAddress`, and these.

    Attributes:
        fast: whether to use the virtual clock, as fast as possible, instead of real time.
        seed: seed of all random numbers, including the world's. None for different numbers in each run.
        world: world file, or name of a world of JaCaROS, instead of the project's own.
        noise: factor for the noise of the world's odometry and lasers: 0 for exact ones. None: that in the world file, or
            0 if no world is named.
        faults: fault file: faults in the embedded world, and their times.
        keep_ground_truth: keep everything that happens in the embedded world in memory, not only the last minutes.
        show_world: create the world at the start, even if no artifact needs it yet.
        until_idle: end when no agent has anything to do and no operation is running.
        fail_on_lost_goal: return exit code 1 instead of 0 if a goal failed without a plan for its failure.
        seconds: end after this time on the run's clock.
        ros_clock: follow ``/clock`` of the graph, as a simulator publishes it.
        rosout: publish output of agents and logs on ``/rosout``. None: on real graphs only.
        mappings: mapping files whose artifacts are created at the start.
        guard: let a separate process stop the robot when this one cannot.
        restricted: agents accept no plans from others (``tellHow``), read and write no files, and create no Python objects;
            see docs/explanation/trust.md.
        fleet: the fleet to join; None for none.
        member: name of this system in the fleet. None: the name of the project.
        fleet_keys: folder with the keys of this member. None: the fleet is limited to this computer.
        fleet_routers: addresses of routers of the fleet, such as ``192.168.1.5:7447``.
        fleet_lease: seconds without a sign of life after which another member is lost.
        fleet_allow: what other members may do here, such as ``lab=send,see``.
        explain: keep the history of the run from its start, for `Mas.explain` and ``.why``.
        plain: run plans and rules as the language defines them, without generated code. The default is what
            ``JACAROS_PLAIN`` in the environment says.
    """

    fast: bool = False
    seed: int | None = None
    world: str | Path | None = None
    noise: float | None = None
    faults: str | Path | None = None
    show_world: bool = False
    keep_ground_truth: bool = False
    until_idle: bool = False
    fail_on_lost_goal: bool = False
    seconds: float | None = None
    ros_clock: bool = False
    orphans: "OrphanPolicy" = "cancel"
    rosout: bool | None = None
    mappings: Sequence[str | Path] = ()
    guard: bool = False
    restricted: bool = False
    fleet: str | None = None
    member: str | None = None
    fleet_keys: Path | None = None
    fleet_routers: Sequence[str] = ()
    fleet_allow: Sequence[str] = ()
    fleet_lease: float = 2.0
    explain: bool = False
    plain: bool = field(default_factory=lambda: os.environ.get("JACAROS_PLAIN", "0") not in ("", "0"))

    @property
    def real_graph(self) -> bool:
        """Whether the graph is outside of the process."""
        return self.ros != "memory"

    @property
    def wants_rosout(self) -> bool:
        """Whether to publish on ``/rosout``."""
        return self.real_graph if self.rosout is None else self.rosout

    def check(self) -> None:
        """Check for options that exclude each other.

        Raises:
            UsageError: some do. The text says what to do instead.
        """
        middleware(self.ros)
        if self.fast and self.ros != "memory":
            raise UsageError(
                f"--clock fast excludes a real ROS graph (--ros {self.ros}), whose nodes run in real time; use "
                "--clock real"
            )
        if self.ros_clock and not self.real_graph:
            raise UsageError(
                "--clock ros needs a real ROS graph (--ros ros1 or ros2), whose /clock it follows; for the in-process "
                "graph, use --clock fast"
            )
        if self.guard and not self.real_graph:
            raise UsageError(
                "--guard needs a real ROS graph (--ros ros1, ros2 or rosbridge): in the in-process graph, agents and "
                "robot end together"
            )
        self._check_fleet()
        given = (self.node_name, *(self._given(kind) for kind in MIDDLEWARES.values()))
        names = self.namespace or self.remap or self.parameters or any(each is not None for each in given)
        if self.real_graph or names:
            GraphAddress.check(self)  # with slots, super() refers to an older class
        if self.seconds is not None and self.seconds < 0:
            raise UsageError("expected a non-negative number of seconds as --for")

    def _check_fleet(self) -> None:
        if self.fleet is None:
            named = {
                "--member": self.member,
                "--fleet-keys": self.fleet_keys,
                "--router": self.fleet_routers or None,
                "--fleet-allow": self.fleet_allow or None,
            }
            for option, value in named.items():
                if value is not None:
                    raise UsageError(f"{option} needs --fleet NAME")
            return
        if self.fast:
            raise UsageError(
                f"--clock fast excludes the fleet `{self.fleet}`, whose members run in real time; use --clock real"
            )
        from importlib.util import find_spec  # here: few runs join a fleet

        if find_spec("zenoh") is None:
            help = help_line('pip install "jacaros[fleet]"')
            raise UsageError(f"a fleet needs eclipse-zenoh, which is not installed\n{help}")

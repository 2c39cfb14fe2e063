"""What a pause of the run does not stop, and the command that stops robots on a real graph."""

from jacaros.agents.mind.mind import Mind
from jacaros.mas.agent_host import AgentHost
from jacaros.mas.directory import Directory
from jacaros.mas.options import RunOptions
from jacaros.mas.ros_graph import RosGraph
from jacaros.ros.guarded import guarded_by
from jacaros.runtime.clock import Clock


def command_standstill(ros: RosGraph, options: RunOptions) -> None:
    """Command zero velocity to the robots that our artifacts drive on a real graph.

    The embedded world is itself paused: its robots then continue as if nothing had happened.
    """
    if options.ros != "memory" and ros.joined is not None:
        guarded_by(ros.joined).stand_still()


def not_paused(
    directory: Directory[AgentHost], ros: RosGraph, options: RunOptions, clock: Clock
) -> tuple[str, ...]:
    """Return what continues during a pause, one line each."""
    lines = []
    if not clock.virtual:
        lines += [
            f"agent {host.name} (Python): it continues until it waits for the run's clock or for an operation"
            for host in directory
            if not isinstance(host.mind, Mind)
        ]
    if options.ros != "memory" and ros.joined is not None:
        lines.append(f"the ROS graph ({options.ros}): other nodes and real robots continue")
        lines += [
            f"action {name}: a goal that its server has accepted continues"
            for name, _ in guarded_by(ros.joined).actions
        ]
    if options.ros_clock:
        lines.append("/clock: the simulator continues")
    return tuple(lines)

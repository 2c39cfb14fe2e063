"""The agents' process dies, freezes or hangs: their guard stops the robot, however it is driven."""

import os
import re
import signal
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from judging import stands, standstill
from processes import JACAROS, Agents, Program, WorldProcess, wait_until

STATIONARY = 0.6
"""Seconds from the death of the agents to a robot that stands: 0.3 to notice, 0.2 to brake, the rest for the way."""
BRAKING = 2.5
"""Metres per second squared by which the robot of this world brakes."""
OVER_THE_GRAPH = 0.9
"""The same if the guard hears the agents over the graph: 0.5 to notice, 0.2 to brake, the rest for the way."""
WORLDS = Path(__file__).parent / "worlds"
MAPPINGS = {"ros1": "move_base.yaml", "ros2": "nav2.yaml"}
DRIVEN = ("velocity", "action")


class Guarded:
    """Agents with a guard, and the world that their robot drives in."""

    def __init__(self, world: WorldProcess, agents: Agents) -> None:
        self.world, self.agents = world, agents

    def until_driving(self) -> None:
        """Wait until the robot is well on its way."""
        self.world.until_truth(lambda truth: truth.odometer() > 1.0, "the robot drives")

    def stood_after(self, moment: float) -> float:
        """Wait until the robot stands; the seconds that it took from a *moment*."""
        since = self.world.time_of(moment)
        self.world.until_truth(lambda truth: stands(truth, since), "the robot stands")
        return standstill(self.world.truth, BRAKING) - since

    @property
    def guard(self) -> int:
        """The process id of the guard, once it has stopped the robot."""
        self.agents.until_error("[guard ")
        [found] = {re.findall(r"\[guard (\d+)\]", line)[0] for line in self.agents.errors if "[guard" in line}
        return int(found)


def is_running(process: int) -> bool:
    """Whether there is a process."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


@pytest.fixture
def guarded(
    kind: str, run_world: Callable[..., WorldProcess], run_agents: Callable[..., Agents]
) -> Iterator[Callable[..., Guarded]]:
    """Runs a program of the folder `guarded` with a guard; ends the guard if the agents could not."""
    made: list[Guarded] = []

    def run(program: str, driven: str) -> Guarded:
        world = run_world(WORLDS / "runway.yaml") if not made else made[0].world
        mapping = ("--mapping", MAPPINGS[kind]) if driven == "action" else ()
        made.append(Guarded(world, run_agents(f"guarded/{program}.asl", "--guard", *mapping)))
        return made[-1]

    yield run
    for each in made:
        if not each.agents.over:
            each.agents.signal(signal.SIGCONT)
        if any("[guard" in line for line in each.agents.errors):
            each.agents.signal(signal.SIGKILL)
            if is_running(each.guard):
                os.kill(each.guard, signal.SIGTERM)


@pytest.mark.parametrize("driven", DRIVEN)
def test_the_robot_stands_after_its_agents_are_killed(guarded: Callable[..., Guarded], driven: str) -> None:
    run = guarded(driven, driven)
    run.until_driving()
    took = run.stood_after(run.agents.signal(signal.SIGKILL))
    assert run.agents.end() == -signal.SIGKILL, "a guard does not keep the output of dead agents open"
    print(f"SIGKILL, {driven}: standing after {took:.2f} s")
    assert took <= STATIONARY

    again = guarded(driven, driven)
    before = run.world.truth.odometer()
    run.world.until_truth(lambda truth: truth.odometer() > before + 0.5, "new agents drive the robot")
    again.agents.signal(signal.SIGTERM)
    assert again.agents.end() == 128 + signal.SIGTERM
    wait_until(lambda: not is_running(run.guard), "the guard ends with the agents")


def test_the_robot_stands_after_its_agents_are_killed_at_their_first_command(guarded) -> None:
    run = guarded("velocity", "velocity")
    run.world.until_truth(lambda truth: truth.odometer() > 0.0, "the robot moves")
    took = run.stood_after(run.agents.signal(signal.SIGKILL))
    print(f"SIGKILL, first command: standing after {took:.2f} s")
    assert took <= STATIONARY


@pytest.mark.parametrize("driven", DRIVEN)
def test_the_robot_stands_while_its_agents_are_frozen(guarded: Callable[..., Guarded], driven: str) -> None:
    run = guarded(driven, driven)
    run.until_driving()
    took = run.stood_after(run.agents.signal(signal.SIGSTOP))
    print(f"SIGSTOP, {driven}: standing after {took:.2f} s")
    assert took <= STATIONARY

    before = run.world.truth.odometer()
    run.agents.signal(signal.SIGCONT)
    if driven == "action":
        run.agents.until_line("failed canceled")
    else:
        run.agents.until_line("interrupted guard_tripped")
        run.world.until_truth(lambda truth: truth.odometer() > before + 0.5, "the motion continues")


@pytest.mark.parametrize("driven", DRIVEN)
def test_the_robot_stands_while_its_agents_are_stuck(guarded: Callable[..., Guarded], driven: str) -> None:
    run = guarded(f"stuck_{driven}", driven)
    run.until_driving()
    run.agents.until_line("hangs")
    began = float(next(line for line in run.agents.lines if "hangs" in line).split()[-1])
    took = run.stood_after(began)
    print(f"stuck, {driven}: standing after {took:.2f} s")
    assert took <= STATIONARY


@pytest.fixture
def on_the_robot(
    kind: str, environment: dict[str, str], tmp_path: Path
) -> Iterator[Callable[[str], Program]]:
    """Starts ``jacaros guard`` as on another computer: it shares the graph with the agents, but no socket."""
    started: list[Program] = []

    def run(agents: str) -> Program:
        command = [JACAROS, "guard", agents, "--ros", kind, "--timeout", "0.5"]
        started.append(Program(command, environment | {"TMPDIR": str(tmp_path)}))
        return started[-1]

    yield run
    for each in started:
        each.stop()


def children(process: int) -> list[int]:
    """The processes that a process has started."""
    listed = subprocess.run(
        ["ps", "-o", "pid=", "--ppid", str(process)], capture_output=True, text=True, check=False
    )
    return [int(number) for number in listed.stdout.split()]


def test_a_guard_on_the_robot_stops_it_when_the_agents_computer_is_gone(
    guarded: Callable[..., Guarded], on_the_robot: Callable[[str], Program], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("JACAROS_GUARD_TIMEOUT", "30")  # the guard beside the agents has no false alarms
    guard = on_the_robot("velocity")
    run = guarded("velocity", "velocity")
    run.agents.until_error("the guard /velocity_guard watches over the graph")
    run.until_driving()
    for beside in children(run.agents.process):
        os.kill(beside, signal.SIGKILL)
    took = run.stood_after(run.agents.signal(signal.SIGKILL))
    print(f"SIGKILL of agents and their guard: standing after {took:.2f} s")
    assert 0.0 < took <= OVER_THE_GRAPH
    guard.until_error("no heartbeat from the agents")

    before = run.world.truth.odometer()
    again = guarded("velocity", "velocity")
    guard.until_error("released the robot")
    run.world.until_truth(lambda truth: truth.odometer() > before + 0.5, "new agents drive the robot")
    again.agents.signal(signal.SIGTERM)
    assert again.agents.end() == 128 + signal.SIGTERM

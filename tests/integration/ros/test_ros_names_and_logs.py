"""A run as a node among others: its names, its log, and the clock of a simulator."""

from collections.abc import Callable

import pytest
from graphs import ProcessPeer
from processes import Agents, wait_until

LOG = {"ros1": "rosgraph_msgs/msg/Log", "ros2": "rcl_interfaces/msg/Log"}
LEVELS = {"ros1": {"info": 2, "warn": 4, "error": 8}, "ros2": {"info": 20, "warn": 30, "error": 40}}


def test_lines_go_to_rosout_under_our_name(kind: str, run_agents, peer) -> None:
    monitor = peer("monitor")
    monitor.subscribe("/rosout", LOG[kind], depth=1000)
    run_agents("talker.asl", "--node-name", "speaker")

    def logged(level: str, text: str) -> bool:
        return any(
            each["name"].strip("/") == "speaker"
            and each["level"] == LEVELS[kind][level]
            and text in each["msg"]
            for each in monitor.received("/rosout")
        )

    wait_until(lambda: logged("info", "[talker] hello graph"), "what the agent prints")
    wait_until(lambda: logged("error", "by the artifact"), "what the artifact writes")
    wait_until(lambda: logged("warn", "impossible"), "the goal that failed")


def test_names_are_remapped(run_agents: Callable[..., Agents], peer: Callable[[str], ProcessPeer]) -> None:
    agents = run_agents("talker.asl", "--remap", "/odom:=/elsewhere/odom", "--no-rosout")
    robot = peer("robot")
    robot.advertise("/elsewhere/odom", "nav_msgs/msg/Odometry")
    agents.until_line("hears /elsewhere/odom")


@pytest.mark.only("ros1", "ros2")
def test_time_is_that_of_the_simulator(kind: str, run_agents: Callable[..., Agents], peer) -> None:
    agents = run_agents("minute.asl", "--clock", "ros", "--node-name", "follower")
    agents.until_error("[ros] waiting for /clock")
    agents.until_line("[minute] waits")
    agents.until_error("no publisher on /clock")
    simulator = peer("simulator")
    if kind == "ros2":
        assert simulator.get_parameter("use_sim_time", "/follower", timeout=20) is True
    simulator.advertise("/clock", "rosgraph_msgs/msg/Clock")
    wait_until(lambda: simulator.subscription_count("/clock") > 0, "a subscriber of the clock")

    def show(time: float, text: str) -> None:
        """Publish a time until standard error shows what it brings about: the topic is not reliable."""

        def shown() -> bool:
            simulator.publish("/clock", {"clock": time})
            return any(text in line for line in agents.errors)

        wait_until(shown, f"{text!r} at {time:g} s")

    show(100.0, "/clock found: the time is 100.000 s")
    show(106.0, "/clock stopped at 106.000 s")
    show(3.0, "jumped back by 103.000 s")
    agents.until_line("[minute] jumped 103")
    show(6.0, "/clock stopped at 6.000 s")
    assert not any("has waited" in line for line in agents.lines), "9 of 10 seconds have passed"
    wait_until(lambda: simulator.publish("/clock", {"clock": 7.5}) or agents.over, "the tenth second")
    assert agents.end() == 0
    assert agents.lines[-1] == "[minute] has waited"


@pytest.mark.only("ros1", "ros2")
def test_a_node_without_simulated_time_is_logged_once(run_agents: Callable[..., Agents], peer) -> None:
    agents = run_agents("minute.asl")
    simulator = peer("simulator")
    simulator.advertise("/clock", "rosgraph_msgs/msg/Clock")

    def help() -> bool:
        simulator.publish("/clock", {"clock": 5.0})
        return any("to follow the simulator, run with --clock ros" in line for line in agents.errors)

    wait_until(help, "the help at the simulator's clock")
    wait_until(lambda: simulator.subscription_count("/clock") == 0, "no subscription is left")
    assert sum("--clock ros" in line for line in agents.errors) == 1

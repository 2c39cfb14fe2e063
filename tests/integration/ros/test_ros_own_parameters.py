"""Parameters of our node on real graphs: a launch file gives them, other nodes see and change them, agents follow."""

from collections.abc import Callable
from pathlib import Path

import pytest
from processes import Agents, wait_until

from jacaros.robots.ros.errors import ParameterRefused

MAPPING = str(Path(__file__).parent / "programs" / "tuned.yaml")
NODE = "/r1/guard"


def test_what_is_given_at_the_start_is_followed(kind: str, run_agents, peer, tmp_path: Path) -> None:
    other = peer("operator")
    if kind == "ros1":
        # As roslaunch does with <param>, which reads 1 as a whole number; _places:=... is on the command line.
        given, places = ["_spede:=1", "_patrol/places:=[attic, cellar]", "__name:=guard"], "patrol/places"
        other.set_parameter("speed", 1, NODE, timeout=20)
    else:
        file = tmp_path / "launch_params"
        file.write_text("/r1/guard:\n  ros__parameters: {patrol: {places: [attic, cellar]}, speed: 0.9}\n")
        given = ["--ros-args", "-r", "__node:=guard", "--params-file", str(file), "-p", "spede:=1"]
        places = "patrol.places"
    agents = run_agents("tuned.asl", "--mapping", MAPPING, "--namespace", "r1", *given)
    first = "1" if kind == "ros1" else "0.9"
    agents.until_line(f"begins with {first} [attic,cellar] 2")
    if kind == "ros2":
        agents.until_error("parameter spede has no effect: nothing declares it; did you mean `speed`?")
        with pytest.raises(ParameterRefused):
            other.set_parameter("speed", 7.0, NODE, timeout=20)
        with pytest.raises(ParameterRefused):
            other.set_parameter("pace", 3, NODE, timeout=20)
    else:
        other.set_parameter("speed", 7.0, NODE, timeout=20)
        agents.until_error("was set to 7.0; value ignored: it is from 0.1 to 1, not 7.0")
        other.set_parameter("pace", 3, NODE, timeout=20)
        agents.until_error("was set to 3; value ignored: it is read-only")
    other.set_parameter("speed", 0.75, NODE, timeout=20)
    agents.until_line("slower")
    wait_until(lambda: other.get_parameter("speed", NODE, timeout=20) == 0.1, "the agent's value is there")
    other.set_parameter(places, ["kitchen", "hall"], NODE, timeout=20)
    agents.until_line("elsewhere")
    other.set_parameter("speed", 0.5, NODE, timeout=20)
    assert agents.end() == 0


def test_a_value_that_does_not_match_is_reported(kind: str, run_agents: Callable[..., Agents]) -> None:
    given = ["_speed:=fast"] if kind == "ros1" else ["--ros-args", "-p", "speed:=1"]
    agents = run_agents("tuned.asl", "--mapping", MAPPING, *given)
    if kind == "ros1":  # the master takes anything
        agents.until_error("/tuned/speed` was set to 'fast'; value ignored: it is of type float")
        agents.until_line("begins with 0.4 [hall] 2")
    else:
        assert agents.end() == 1
        assert any("of type float; 1 is of type int; write 1.0" in line for line in agents.errors)

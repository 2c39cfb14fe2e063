"""Options of a run."""

from dataclasses import fields

import click
import pytest

from jacaros import Mas
from jacaros.runtime.cli.run import command
from jacaros.runtime.errors import UsageError
from jacaros.runtime.mas.options import RunOptions
from jacaros.testing import run_project
from jacaros.testing.trial import TrialOptions


def test_the_default_options_are_valid() -> None:
    RunOptions().check()


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (RunOptions(fast=True, ros="ros1"), "use --clock real"),
        (RunOptions(fast=True, ros="ros2"), "use --clock real"),
        (RunOptions(ros="ros3"), "expected memory, ros1, ros2"),
        (RunOptions(seconds=-1), "non-negative"),
        (RunOptions(ros_clock=True), "--clock fast"),
        (RunOptions(domain_id=3), "--domain-id needs --ros ros2, found --ros memory"),
        (RunOptions(ros="ros1", domain_id=3), "found --ros ros1"),
        (RunOptions(ros="ros2", domain_id=233), "from 0 to 232, found 233"),
        (RunOptions(ros="ros2", master="http://robot.lab.example:11311"), "--master needs --ros ros1"),
        (RunOptions(ros="ros1", master="robot:11311"), "such as http://robot.lab.example:11311"),
        (
            RunOptions(ros="ros1", master="http://robot.lab.example:port"),
            "found 'http://robot.lab.example:port'",
        ),
        (RunOptions(node_name="3x"), "'3x' is not a node name"),
        (RunOptions(remap={"odom": "/a b"}), "'/a b' is not a ROS name"),
    ],
)
def test_options_that_exclude_each_other_are_refused(options: RunOptions, text: str) -> None:
    with pytest.raises(UsageError, match=text):
        options.check()


def test_an_address_for_its_kind_of_graph_is_accepted() -> None:
    RunOptions(
        ros="ros2", domain_id=0, node_name="agents", namespace="robot_1", remap={"odom": "/odom"}
    ).check()
    RunOptions(ros="ros1", master="http://127.0.0.1:11311", ros_clock=True).check()


def test_logs_go_to_real_graphs_by_default() -> None:
    assert not RunOptions().wants_rosout
    assert RunOptions(ros="ros2").wants_rosout
    assert not RunOptions(ros="ros1", rosout=False).wants_rosout
    assert RunOptions(rosout=True).wants_rosout


def test_a_keyword_replaces_a_field_of_the_options() -> None:
    with pytest.raises(UsageError, match="unknown ROS backend 'ros3'"):
        Mas(options=RunOptions(ros="memory"), ros="ros3")
    with pytest.raises(UsageError, match="unknown ROS backend 'ros4'"):
        Mas(options=RunOptions(ros="ros4"))


def test_an_option_that_does_not_exist_is_refused() -> None:
    with pytest.raises(TypeError, match="unexpected keyword argument 'sed'"):
        Mas(sed=1)
    with pytest.raises(TypeError, match="unexpected keyword argument 'sed'"):
        run_project("nothing.asl", sed=1)


def test_tests_run_on_the_virtual_clock_with_a_seed_by_default() -> None:
    assert (TrialOptions().fast, TrialOptions().seed) == (True, 0)
    assert (TrialOptions(fast=False).fast, TrialOptions(world="empty").world) == (False, "empty")


def test_the_command_has_no_option_of_a_run_under_another_name() -> None:
    outputs = {"record", "record_limit", "replay", "ground_truth", "quiet", "explained"}
    outputs |= {"view", "view_port", "view_address", "view_token", "view_role", "view_in_frame"}
    outputs |= {"serve", "tokens", "tls_cert", "tls_key", "offer", "lifecycle", "console"}
    combined = {"file", "clock", "param", "params_file", "node", "all_nodes"}
    given = {each.name for each in command.params if isinstance(each, click.Parameter)}
    assert given - outputs - combined <= {field.name for field in fields(RunOptions)}

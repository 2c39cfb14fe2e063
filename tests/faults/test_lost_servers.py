"""An action server, a robot or the whole graph that disappears during a motion, and returns."""

from faults_lab import Lab, in_lab

LOST = [
    *("connected /odom", "lost /odom", "my pose is unknown", "action_failed server_lost", "connected /odom"),
    *("at 2 0", "at 0 0"),
]

MISSING = [
    "[ros] waiting for the action /navigate_to_pose (nav2_msgs/action/NavigateToPose)",
    (
        "[ros] the action /navigate_to_pose (nav2_msgs/action/NavigateToPose) is missing; still trying; "
        "is the node that offers it running?"
    ),
    "[ros] found the action /navigate_to_pose (nav2_msgs/action/NavigateToPose)",
]


def robot_dies(lab: Lab) -> None:
    lab.at(3, lab.kill_robot)
    lab.at(10, lab.start_robot)


def graph_goes(lab: Lab) -> None:
    lab.at(3, lab.graph.interrupt)
    lab.at(10, lab.graph.restore)


def assert_arrived(lab: Lab) -> None:
    assert lab.exit_code == 0
    assert lab.safe
    assert abs(lab.place[0]) <= 0.05


def test_when_an_action_server_dies_the_robot_stops_and_the_plan_gets_a_reason() -> None:
    def faults(lab: Lab) -> None:
        lab.at(3, lambda: lab.graph.vanish("/navigate_to_pose"))
        lab.at(10, lambda: (lab.sim.close(), lab.sim.start()))

    lab = in_lab("navigating.asl", faults, mapping="robot.yaml")
    assert [line for line in lab.lines if "/odom" not in line] == [
        "action_failed server_lost",
        "at 2 0",
        "at 0 0",
    ]
    assert 6.0 <= lab.when("action_failed") <= 6.1, "three seconds without a sign of life"
    assert lab.stands(3.5, 10.0)
    assert lab.errors == MISSING
    assert_arrived(lab)


def test_navigation_continues_after_a_restart_of_the_robot() -> None:
    lab = in_lab("navigating.asl", robot_dies, mapping="robot.yaml")
    assert lab.lines == LOST
    assert lab.stands(3.5, 10.0)
    assert lab.errors == MISSING, "odometry was heard before, so its topic is not reported"
    assert_arrived(lab)


def test_driving_continues_after_a_restart_of_the_robot() -> None:
    lab = in_lab("driving.asl", robot_dies)
    assert lab.lines == [
        *("connected /odom", "lost /odom", "action_failed no_odometry(5)", "connected /odom", "at 2 0"),
        "at 0 0",
    ]
    assert lab.stands(3.5, 10.0)
    (unheard,) = lab.errors
    assert "/cmd_vel" in unheard
    assert "publishing anyway" in unheard, "the robot is away when the next command is due"
    assert_arrived(lab)


def test_a_reconnected_graph_needs_no_restart() -> None:
    for program, mapping in (("navigating.asl", "robot.yaml"), ("driving.asl", None)):
        lab = in_lab(program, graph_goes, mapping=mapping)
        expected = LOST if mapping else [*LOST[:2], "action_failed no_odometry(5)", *LOST[4:]]
        assert lab.lines == expected
        assert lab.when("lost /odom") <= 3.1
        assert lab.when("connected /odom") <= 0.1
        assert lab.stands(3.7, 10.0), "the wheels stop for want of commands"
        assert lab.errors == (MISSING if mapping else [])
        assert_arrived(lab)


def test_a_graph_that_disconnects_often_is_rejoined_each_time() -> None:
    def faults(lab: Lab) -> None:
        for number in range(6):
            lab.at(1 + 2 * number, lab.graph.interrupt)
            lab.at(1.5 + 2 * number, lab.graph.restore)

    lab = in_lab("driving.asl", faults)
    assert lab.lines.count("lost /odom") == 6
    assert lab.lines.count("connected /odom") == 7
    assert [line for line in lab.lines if "/odom" not in line] == ["at 2 0", "at 0 0"]
    assert_arrived(lab)


def test_the_plan_library_recovers_from_a_restart_of_the_robot() -> None:
    lab = in_lab("going.asl", robot_dies, mapping="nav2.yaml")
    assert lab.lines == ["far", "home"]
    assert lab.stands(3.5, 10.0)
    assert_arrived(lab)

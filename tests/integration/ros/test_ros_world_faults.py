"""Faults of the world on real graphs: any node begins and ends them, and any node suffers them."""

import math
from pathlib import Path

from processes import wait_until

from jacaros.robots.world.data.ground_truth import GroundTruth

ODOMETRY, SCAN, SET = "nav_msgs/msg/Odometry", "sensor_msgs/msg/LaserScan", "std_srvs/srv/SetBool"
FAULTS = """
faults:
  silence: {kind: dead, topic: /odom}
  nonsense: {kind: nan, topic: /scan, at: 0}
"""


def told(truth: GroundTruth) -> list[tuple[str, str]]:
    return [(event.data["fault"], event.data["state"]) for event in truth.events_of("fault")]


def test_faults_have_services_and_concern_messages_to_all(run_world, peer, tmp_path: Path) -> None:
    file = tmp_path / "faults.yaml"
    file.write_text(FAULTS, encoding="utf-8")
    world = run_world("patrol", "--faults", str(file))
    listener = peer("listener")
    listener.subscribe("/odom", ODOMETRY)
    listener.subscribe("/scan", SCAN)
    wait_until(lambda: listener.received("/odom"), "odometry comes")
    wait_until(lambda: listener.received("/scan"), "scans come")
    scan = listener.received("/scan")[0]
    assert all(math.isnan(float(each)) for each in scan["ranges"])
    assert math.isfinite(scan["range_max"])

    assert listener.call("/faults/silence", {"data": True}, 30.0, SET)["success"]
    world.until_truth(lambda truth: ("silence", "acts") in told(truth), "it is silent")
    count = len(listener.received("/odom"))
    wait_until(lambda: len(listener.received("/scan")) >= 10, "two more seconds pass")
    assert len(listener.received("/odom")) <= count + 2, "what was on its way"

    assert listener.call("/faults/silence", {"data": False}, 30.0, SET)["success"]
    wait_until(lambda: len(listener.received("/odom")) > count + 5, "odometry is back")
    states = ["begins", "acts"]
    assert told(world.truth) == [
        *(("nonsense", state) for state in states),
        *(("silence", state) for state in [*states, "ends"]),
    ]

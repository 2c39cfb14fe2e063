"""A sensor that is faster than its agent: reactions stay fast, and nothing piles up."""

from pathlib import Path

from jacaros.runtime.mas.system import System
from jacaros.testing import RunResult, run_project

RATE = 0.001
"""Seconds between two messages."""

PROGRAM = """
!start.
+!start <- makeArtifact("odom", "ArtOdometry", ["fast", latest_only({latest})], Id); focus(Id).
+odom(Stamp,_,_) : Stamp > 0
  <- for (.range(I,1,6000)) {{ X = I }};       // longer than the time between two messages
     .print(Stamp, " ", system.time - 1577836800000).
"""


def lags(folder: Path, latest: str) -> tuple[list[float], RunResult]:
    """Run the program at 1 kHz; seconds from each message that it handled to the end of its plan."""
    file = folder / "slow.asl"
    file.write_text(PROGRAM.format(latest=latest), encoding="utf-8")

    def flood(mas: System) -> None:
        begin = mas.clock.now()
        publisher = mas.ros.backend().publisher("/fast/odom", "nav_msgs/msg/Odometry")

        def tick() -> None:
            now = mas.clock.now() - begin
            publisher.publish(publisher.message(pose={"pose": {"position": {"x": now}}}))
            if now < 0.2:
                mas.clock.call_later(RATE, tick)

        mas.clock.call_later(0.1, tick)

    result = run_project(file, seconds=30, when_started=flood)
    assert result.errors == []
    pairs = [line.split() for line in result.of("slow")]
    return [float(done) / 1000 - float(stamp) for stamp, done in pairs], result


def test_an_agent_that_is_slower_than_its_sensor_reacts_to_what_is_now(tmp_path: Path) -> None:
    fresh, _ = lags(tmp_path, "true")
    late, _ = lags(tmp_path, "false")
    assert len(fresh) > 20
    assert max(fresh) < 0.005
    assert max(late) > 0.02

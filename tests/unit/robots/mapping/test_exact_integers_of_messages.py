"""Integers of 64 bits, from a message to an agent and back."""

from pathlib import Path

import jacaros
from jacaros import Mas

MAPPING = """
properties:
  track: {topic: track, type: std_msgs/msg/Int64, fields: [data]}
  stamps: {topic: stamps, type: std_msgs/msg/UInt64MultiArray, fields: [data]}
operations:
  say: {parameters: [n], publish: said, type: std_msgs/msg/Int64, fields: {data: $n}}
  mark: {parameters: [n], publish: marked, type: std_msgs/msg/UInt64, fields: {data: $n}}
"""
PROGRAM = """
+track(X) <- say(X).
+stamps([A, B]) <- mark(A); mark(B); mark(A - B).
+full <- !overflow.
+!overflow <- say(9223372036854775807 + 1).
-!overflow[error_msg(Text)] <- +refused(Text).
"""


def test_identifiers_and_nanoseconds_come_back_unchanged(tmp_path: Path) -> None:
    (tmp_path / "ids.yaml").write_text(MAPPING)
    ids, stamps = [2**53 + 1, -(2**63), 2**63 - 1], [2**64 - 1, 1_795_904_057_976_399_127]
    sent: list[int] = []
    refused: list[str] = []

    async def main() -> None:
        async with Mas(world="none", mappings=[str(tmp_path / "ids.yaml")], seed=1) as mas:
            bob = mas.add_agent("bob", PROGRAM, focus=["ids"])
            for topic, kind in (("/said", "Int64"), ("/marked", "UInt64")):
                mas.ros.subscription(
                    topic, f"std_msgs/msg/{kind}", lambda sample: sent.append(sample.message.data)
                )
            track = mas.ros.publisher("/track", "std_msgs/msg/Int64")
            several = mas.ros.publisher("/stamps", "std_msgs/msg/UInt64MultiArray")
            await mas.sleep(0.5)
            for each in ids:
                track.publish(track.message(data=each))
                await mas.sleep(0.5)
                assert bob.ask("track(X)")["X"] == each
            several.publish(several.message(data=stamps))
            await mas.sleep(0.5)
            bob.add_belief("full")
            await mas.sleep(0.5)
            refused.append(bob.ask("refused(Text)")["Text"])

    jacaros.run(main(), clock="fast")
    assert sent == [*ids, *stamps, stamps[0] - stamps[1]]
    limits = "from -9223372036854775808 to 9223372036854775807"
    assert refused == [f"std_msgs/msg/Int64: field data is int64, but {2**63} is given; it must be {limits}"]

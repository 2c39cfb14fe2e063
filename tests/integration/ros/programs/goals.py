"""A client of the world's actions, plain Python over the port: sends goals in turn, prints their outcomes.

Arguments: the kind of graph.
"""

import asyncio
import json
import sys
from typing import Any

from jacaros.robots.ros.open import open_backend
from jacaros.runtime.clock import WallClock, run

PATIENCE = 100.0


def pose(x: float, y: float, frame: str = "map") -> dict[str, Any]:
    return {"header": {"frame_id": frame}, "pose": {"position": {"x": x, "y": y}, "orientation": {"w": 1.0}}}


async def main() -> None:
    kind, clock = sys.argv[1], WallClock()
    backend = open_backend(kind, clock, "client")
    await backend.start()

    async def do(name: str, type_name: str, goal: dict[str, Any], cancel_after: int | None = None) -> None:
        """Send a goal; cancel it after so many feedback messages."""
        told = asyncio.Event()
        feedback = []

        def take(message: Any) -> None:
            feedback.append(message)
            if cancel_after is not None and len(feedback) >= cancel_after:
                told.set()

        client = backend.action_client(name, type_name)
        handle = await client.send(goal, take, timeout=PATIENCE)
        if cancel_after is not None:
            await asyncio.wait_for(told.wait(), PATIENCE)
            await handle.cancel(timeout=PATIENCE)
        outcome = await handle.outcome(timeout=PATIENCE)
        code = getattr(outcome.result, "error_code", 0)
        line = {"action": name, "status": str(outcome.status), "code": code, "text": outcome.text}
        print(json.dumps({**line, "feedback": len(feedback)}), flush=True)

    if kind == "ros2":
        navigate, part = ("/navigate_to_pose", "nav2_msgs/action/NavigateToPose"), "pose"
    else:
        navigate, part = ("/move_base", "move_base_msgs/action/MoveBase"), "target_pose"
    await do(*navigate, {part: pose(0.8, 0.8)})
    await do(*navigate, {part: pose(9, 9)})
    await do(*navigate, {part: pose(1, 0, "moon")})
    await do(*navigate, {part: pose(3.5, 1.5)}, cancel_after=5)
    if kind == "ros2":
        await do("/dock_robot", "nav2_msgs/action/DockRobot", {"dock_id": "dock"})
        await do("/undock", "irobot_create_msgs/action/Undock", {})
    else:
        await do("/dock_drive_action", "kobuki_msgs/action/AutoDocking", {})
    found = await backend.tf_wait("map", "base_scan", timeout=PATIENCE)
    print(json.dumps({"tf": list(found.translation)}), flush=True)
    await backend.close()


run(main, WallClock())

"""A robot driven from a Python program, judged from the world's ground truth."""

from pathlib import Path

import jacaros
from jacaros import Mas

PROJECT = Path(__file__).parents[2] / "examples" / "01_out_and_back" / "out_and_back.jcm"


def test_an_example_runs_inside_a_program() -> None:
    async def main() -> None:
        lines: list[str] = []
        async with Mas(PROJECT, seed=1, on_print=lambda agent, text: lines.append(text)) as mas:
            assert await mas.ended() == 0
            assert mas.world is not None
            path = mas.world.ground_truth.path(mas.world.ground_truth.robots[0])
            assert max(sample.x for sample in path) > 1.0
            assert abs(path[-1].x - path[0].x) < 0.1
        assert lines[0] == "driving out"

    jacaros.run(main(), clock="fast")


def test_the_robot_stands_still_when_the_block_ends() -> None:
    async def main() -> None:
        speeds: list[float] = []
        async with Mas(PROJECT, seed=1, on_print=lambda agent, text: None) as mas:
            world = mas.world
            assert world is not None
            await mas.sleep(2)
            speeds.append(world.robot().speed)
        speeds.append(world.robot().wanted_speed)
        assert speeds[0] > 0.1
        assert speeds[1] == 0.0

    jacaros.run(main(), clock="fast")


def test_python_code_drives_beside_an_agent_that_watches() -> None:
    async def main() -> None:
        async with Mas(seed=1, world="empty", on_print=lambda agent, text: None) as mas:
            await mas.make_artifact("base", "ArtCmdVelAndOdometry")
            watcher = mas.add_agent("watcher", "", focus=["base"])
            driver = mas.session("driver")
            driving = driver.begin("moveForward", 1)
            assert await watcher.until("moving(How) & How \\== stopped", timeout=1)
            await driving
            await watcher.until("moving(stopped)", timeout=1)
            world = mas.world
            assert world is not None
            assert world.robot().pose.x > 0.9

    jacaros.run(main(), clock="fast")

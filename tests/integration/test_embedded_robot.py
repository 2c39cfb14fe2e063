"""A robot driven from a Python program, judged from the world's ground truth."""

from pathlib import Path

import jacaros
from jacaros import Mas

PROJECT = Path(__file__).parents[2] / "examples" / "01_out_and_back" / "out_and_back.jcm"


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

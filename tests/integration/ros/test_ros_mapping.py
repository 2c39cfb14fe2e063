"""The robot of another process is driven by a mapping file and a program, without Python."""

from pathlib import Path

FOLDER = Path(__file__).parent / "programs" / "mapped"


def test_a_mapping_drives_the_robot_of_another_process(kind: str, run_world, run_agents) -> None:
    world = run_world("house")
    files = [str(FOLDER / name) for name in ("house.yaml", f"navigation_{kind}.yaml")]
    agents = run_agents("mapped/house.asl", "--mapping", files[0], "--mapping", files[1])
    assert agents.end() == 0
    assert agents.lines == [
        f"[house] {text}" for text in ("driven", "seen", "on the way", "back", "out of reach")
    ]
    assert [line for line in agents.complaints if "to find its type" not in line] == []
    assert world.errors == []

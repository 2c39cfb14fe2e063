"""A world that runs for days does not fill the memory."""

from jacaros.robots.world import World


def test_a_limited_ground_truth_keeps_the_newest_part_of_a_path() -> None:
    world = World.load("empty")
    world.ground_truth.keep = 50
    heard: list[object] = []
    world.ground_truth.listen(heard.append)
    for _ in range(40):
        world.command("turtlebot", 0.2, 0.3)
        world.run(0.4)
    assert 50 <= len(world.ground_truth.path()) < 100
    assert len(heard) > 100
    assert world.ground_truth.path()[-1].time > 15.0

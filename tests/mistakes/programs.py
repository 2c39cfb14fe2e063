"""The correct programs of the repository that `mutations` changes: examples, pages, the package, listings of the thesis.

Each is copied with the files beside it, and checked and run as a user would: a project by its project file, a single
program with the mappings and the world that its page gives it.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from pages import ROOT, blocks, is_file

TEXTS = (".asl", ".jcm", ".mas2j", ".yaml", ".py")
PROJECTS = (".jcm", ".mas2j")


@dataclass(frozen=True)
class Program:
    """A project or a program, with what its run needs.

    Attributes:
        place: the folder or page in the repository that has its files.
        entry: the file that is checked and run.
        mappings: those of the run.
        world: that of the run; empty for the default one.
    """

    place: str
    entry: str
    mappings: tuple[str, ...] = ()
    world: str = ""

    @property
    def name(self) -> str:
        """How the table of mistakes calls it."""
        return f"{self.place}:{self.entry}"

    def files(self) -> dict[str, str]:
        """Return the texts of its folder, or of the blocks of its page up to the last one of that name."""
        place = ROOT / self.place
        if place.is_dir():
            found = (path for path in sorted(place.iterdir()) if path.suffix in TEXTS)
            return {path.name: path.read_text(encoding="utf-8") for path in found}
        if place.suffix in TEXTS:
            return {self.entry: place.read_text(encoding="utf-8")}
        return {block.purpose: block.text for block in blocks(place) if is_file(block)}

    def mutable(self, files: dict[str, str]) -> Iterator[str]:
        """Yield the files to change: programs and project file of a project, or the program, and its own mappings."""
        if self.entry.endswith(PROJECTS):
            yield from (name for name in files if name.endswith(".asl") and _stem(name) in files[self.entry])
        yield self.entry
        yield from (name for name in self.mappings if name in files)

    def write(self, folder: Path) -> dict[str, str]:
        """Write its files into *folder*; return their texts."""
        files = self.files()
        for name, text in files.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return files


def _stem(name: str) -> str:
    return Path(name).stem


NAV2 = ("nav2.yaml",)
TURTLEBOT4 = ("nav2.yaml", "turtlebot4.yaml")

PROGRAMS = [
    Program("examples/01_out_and_back", "out_and_back.jcm"),
    Program("examples/02_square", "turtlebot4.jcm"),
    Program("examples/03_fake_battery", "robot_battery.jcm"),
    Program("examples/04_patrol", "patrol.jcm"),
    Program("examples/05_house_cleaning", "house_cleaning.jcm"),
    Program("examples/07_shared_robot", "shared_robot.jcm"),
    Program("examples/08_parcels", "parcels.jcm"),
    Program("examples/09_three_robots", "robot_1.jcm"),
    Program("examples/10_explore", "explore.jcm"),
    Program("examples/12_fleet", "fleet.jcm"),
    Program("src/jacaros/runtime/cli/patrol.asl", "patrol.asl", TURTLEBOT4, "patrol"),
    Program("README.md", "patrol.asl", TURTLEBOT4, "patrol"),
    Program("docs/tutorial/first_agent.md", "gardener.asl"),
    Program("docs/tutorial/first_agent.md", "water.asl"),
    Program("docs/tutorial/first_agent.md", "rules.asl"),
    Program("docs/tutorial/first_agent.md", "events.asl"),
    Program("docs/tutorial/first_agent.md", "cactus.asl"),
    Program("docs/tutorial/first_agent.md", "busy.asl"),
    Program("docs/tutorial/first_robot.md", "square.asl"),
    Program("docs/tutorial/first_robot.md", "line.asl"),
    Program("docs/tutorial/first_robot.md", "explore.asl", world="patrol"),
    Program("docs/tutorial/first_robot.md", "tour.asl", NAV2, "house"),
    Program("docs/tutorial/first_robot.md", "rooms.asl", NAV2, "house"),
    Program("docs/tutorial/many_robots.md", "guards.jcm"),
    Program("docs/tutorial/many_robots.md", "shop.jcm"),
    Program("docs/tutorial/own_robot.md", "circle.asl", ("rover.yaml",), "lab.yaml"),
    Program("docs/tutorial/own_robot.md", "wander.asl", ("rover.yaml",), "lab.yaml"),
    Program("docs/tutorial/why.md", "watch.jcm"),
    Program("docs/explanation/what-robots-need.md", "bumper.asl", ("base.yaml",)),
    Program("docs/explanation/what-robots-need.md", "stuck.jcm"),
    Program("docs/how-to/come_from_cartago.md", "shop.jcm"),
    Program("docs/how-to/come_from_jason.md", "soup.jcm"),
    Program("docs/how-to/come_from_ros.md", "guard.asl", (*TURTLEBOT4, "guard.yaml"), "house"),
    Program("docs/how-to/map_the_ground.md", "scout.asl", world="house"),
    Program("docs/how-to/share_a_robot.md", "patrol.asl"),
    Program("docs/how-to/share_a_robot.md", "robot.asl"),
    Program("docs/how-to/when_things_go_wrong.md", "lookout.jcm"),
    Program("docs/how-to/write_an_artifact.md", "courier/courier.asl"),
    Program("docs/how-to/write_an_artifact.md", "desk/desk.jcm"),
    Program("docs/reference/mapping.md", "careful.asl", ("careful.yaml",), "patrol"),
    Program("docs/reference/navigation.md", "guard.asl", TURTLEBOT4, "patrol"),
    Program("docs/reference/navigation.md", "tour.asl", TURTLEBOT4, "patrol"),
    Program("docs/reference/worlds.md", "scout.asl", world="corridor.yaml"),
    Program("docs/reference/worlds.md", "waiter.asl", ("gripper.yaml",), "kitchen.yaml"),
    Program("tests/compatibility", "battery.mas2j"),
    Program("tests/compatibility", "house.mas2j"),
    Program("tests/compatibility", "odometry.mas2j"),
    Program("tests/compatibility", "patrol.mas2j"),
    Program("tests/compatibility", "square.mas2j"),
]

"""The driver: a py_trees behaviour tree that patrols while it has the robot."""

from itertools import cycle
from typing import NamedTuple

from py_trees.behaviour import Behaviour
from py_trees.behaviours import Running
from py_trees.common import Access, Status
from py_trees.composites import Selector, Sequence
from py_trees.decorators import Inverter
from py_trees.trees import BehaviourTree

from jacaros import PythonAgent
from jacaros.artifacts.behaviour_trees import Act, FromBlackboard, HasProperty, PropertyCheck, TreeRunner

CLEAR = 0.7
"""Free distance required in front of the robot, in metres."""


class Corner(NamedTuple):
    """A corner of the route, in metres."""

    x: float
    y: float


ROUTE = (Corner(2, 0), Corner(2, 2), Corner(0, 2), Corner(0, 0))


class NextCorner(Behaviour):
    """Write the next corner of the route to the blackboard; always SUCCESS."""

    def __init__(self) -> None:
        super().__init__("next corner")
        self._corners = cycle(ROUTE)
        self._board = self.attach_blackboard_client()
        self._board.register_key("corner", Access.WRITE)
        self.update()

    def update(self) -> Status:
        self._board.corner = next(self._corners)
        return Status.SUCCESS


def driver() -> Selector:
    """Return the tree: each tick runs the first of its four branches that applies."""
    wanted = HasProperty("wanted_by", "supervisor")
    not_mine = Inverter("not mine", HasProperty("on_duty", "driver"))
    not_clear = Inverter("not clear", PropertyCheck("ahead", lambda metres: metres >= CLEAR))
    drive = Act("driveTo", FromBlackboard("corner.x"), FromBlackboard("corner.y"), artifact="wheels")
    return Selector(
        "driver",
        memory=False,
        children=[
            when("hands the robot over", wanted, Act("hand_over")),
            when("asks for the robot", not_mine, Act("take_over")),
            when("waits for a clear way", not_clear, Running("stand")),
            # With memory, a completed step is not restarted while the next one runs.
            Sequence("patrols", memory=True, children=[drive, Act("visited"), NextCorner()]),
        ],
    )


def when(name: str, condition: Behaviour, action: Behaviour) -> Sequence:
    """Return an action that is interrupted as soon as its condition no longer holds."""
    return Sequence(name, memory=False, children=[condition, action])


class Driver(PythonAgent):
    """An agent controlled by the tree; it prints the active branch."""

    branch = ""

    async def run(self) -> None:
        runner = TreeRunner(driver(), self.session)
        runner.tree.add_post_tick_handler(self.report)
        await runner.run(forever=True)

    def report(self, tree: BehaviourTree) -> None:
        branch = tree.root.current_child.name
        if branch != self.branch:
            self.branch = branch
            self.print(branch)

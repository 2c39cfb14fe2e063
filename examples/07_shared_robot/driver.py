"""The driver: a behaviour tree of py_trees that patrols with the robot, as long as it has it."""

from itertools import cycle
from typing import NamedTuple

from py_trees.behaviour import Behaviour
from py_trees.behaviours import Running
from py_trees.common import Access, Status
from py_trees.composites import Selector, Sequence
from py_trees.decorators import Inverter
from py_trees.trees import BehaviourTree

from jacaros import PythonAgent
from jacaros.behaviour_trees import Act, FromBlackboard, HasProperty, PropertyCheck, TreeRunner

CLEAR = 0.7
"""Metres that must be free in front of the robot."""


class Corner(NamedTuple):
    """A place of the route, in metres."""

    x: float
    y: float


ROUTE = (Corner(2, 0), Corner(2, 2), Corner(0, 2), Corner(0, 0))


class NextCorner(Behaviour):
    """Puts the next corner of the route on the blackboard; SUCCESS."""

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
    """The tree: at every tick the first of its four branches that has something to do."""
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
            # With memory: a step that is done is not begun anew while the next one has its turn.
            Sequence("patrols", memory=True, children=[drive, Act("visited"), NextCorner()]),
        ],
    )


def when(name: str, condition: Behaviour, action: Behaviour) -> Sequence:
    """An action that is interrupted as soon as its condition no longer holds."""
    return Sequence(name, memory=False, children=[condition, action])


class Driver(PythonAgent):
    """An agent whose mind is the tree; it prints which branch of it is at work."""

    branch = ""

    async def run(self) -> None:
        runner = TreeRunner(driver(), self.session)
        runner.tree.add_post_tick_handler(self.tell)
        await runner.run(forever=True)

    def tell(self, tree: BehaviourTree) -> None:
        branch = tree.root.current_child.name
        if branch != self.branch:
            self.branch = branch
            self.print(branch)

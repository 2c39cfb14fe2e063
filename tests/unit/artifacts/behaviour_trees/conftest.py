"""A cart on rails: an environment on the virtual clock in which trees can drive, stop, bump and fail."""

import asyncio
import inspect

import py_trees
import pytest
from py_trees.composites import Selector, Sequence

from jacaros.artifacts import Artifact, Atom, Environment, Out, Session, operation
from jacaros.artifacts.behaviour_trees import TreeRunner
from jacaros.runtime.clock import VirtualClock, run


class Cart(Artifact):
    """Drives a metre a second; its property ``at`` shows whole metres."""

    def init(self, battery: int = 100) -> None:
        self.define_property("at", 0)
        self.define_property("battery", battery)
        self.define_property("moving", Atom("stopped"))

    @operation
    async def drive(self, metres: int) -> None:
        """Drive; ``aborted(Metres)`` when it hits the wall at 10."""
        self.update_property("moving", Atom("driving"))
        try:
            for done in range(metres):
                await self.sleep(1.0)
                self.update_property("at", self.value("at") + 1)
                if self.value("at") == 10:
                    self.commit()
                    self.fail("a wall", "aborted", done + 1)
        finally:
            self.update_property("moving", Atom("stopped"))
            self.commit()

    @operation
    def drain(self, level: int) -> None:
        self.update_property("battery", level)

    @operation
    def bump(self, side: str) -> None:
        self.signal("bump", side)

    @operation
    def where(self, at: Out) -> None:
        at.set(self.value("at"))

    @operation
    def paint(self, colour: str) -> None:
        self.define_property("colour", colour)

    @operation
    def break_down(self) -> None:
        raise ZeroDivisionError("no wheels")

    @operation(guard="never")
    def wait_for_ever(self) -> None:
        """Never begins."""

    def never(self) -> bool:
        return False


class Rails:
    """The environment of a test; *work* does what others do, as an agent would.

    Attributes:
        told: what was logged.
    """

    def __init__(self):
        self.clock = VirtualClock()
        self.told = []
        self.environment = Environment(self.clock, log=self.told.append)
        self.session = Session(self.environment, "tree")
        self.other = Session(self.environment, "other")
        self.ticks = []

    def runner(self, root, **options):
        """What ticks a tree; takes note of the moments of its ticks."""
        runner = TreeRunner(root, self.session, **options)
        runner.tree.add_pre_tick_handler(lambda _: self.ticks.append(round(self.clock.elapsed, 3)))
        return runner

    async def make_cart(self, name):
        """Another cart, which no agent focuses on."""
        return await self.other.make_artifact(name, Cart)

    async def at(self, moment, *call):
        """Do an operation at a moment."""
        await self.clock.sleep(moment - self.clock.elapsed)
        await self.other.act(*call)


def on_rails(scene):
    """Run a coroutine function with the rails, the cart made and focused by the tree."""
    py_trees.blackboard.Blackboard.clear()
    rails = Rails()

    async def main():
        await rails.make_cart("cart")
        rails.session.focus("cart")
        try:
            return await asyncio.wait_for(scene(rails), 1000)
        finally:
            await rails.environment.close()

    return run(main, rails.clock)


@pytest.fixture(name="on_rails")
def _on_rails():
    return on_rails


@pytest.fixture
def rails():
    """The place of the rails, which are made in the loop of the test."""


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem):
    test = pyfuncitem.obj
    if not inspect.iscoroutinefunction(test):
        return None
    given = {name: pyfuncitem.funcargs[name] for name in inspect.signature(test).parameters}
    on_rails(lambda rails: test(**given | {"rails": rails}))
    return True


@pytest.fixture
def reactive():
    """A selector or sequence with the prefix `its` first child at every tick."""

    def make(kind, *children):
        composite = {"selector": Selector, "sequence": Sequence}[kind]
        return composite(kind, memory=False, children=list(children))

    return make

"""A running system as pages show and command it, whatever carries the records and commands."""

from collections.abc import Callable

from jacaros.agents.language.offers import OPERATOR, USER
from jacaros.look.page.live.agent_commands import FOR_OBSERVERS, FOR_OPERATORS, FOR_USERS
from jacaros.look.page.live.commands import Commands, artifact_commands, debug_commands, world_commands
from jacaros.look.page.live.live_view import LiveView
from jacaros.look.page.watch import Watch
from jacaros.look.records import records
from jacaros.robots.world import World
from jacaros.runtime.mas.system import System
from jacaros.serving.callers import Caller
from jacaros.serving.service import service_of


class ShownRun:
    """The records and commands of one run for its pages.

    Args:
        system: the run; already started.
        role: what pages may do: an ``observer`` only looks, a ``user`` also gives goals that agents offer, and answers
            their questions; an ``operator`` commands everything.

    Attributes:
        watcher: receives the run, and delivers it to pages.
    """

    def __init__(self, system: System, role: str = OPERATOR) -> None:
        self._system = system
        self._caller = Caller(role, "page", frozenset({role}))
        service = service_of(system)
        self._commands = Commands(lambda what: service.note(self._caller, what))
        open_session = lambda: service.open(self._caller)  # noqa: E731
        self.watcher = LiveView(system.deployment.name, self._commands, open_session=open_session)
        self._end_debug: Callable[[], None] = lambda: None

    def begin(self, watch: Watch) -> None:
        """Offer the commands, and record the state of the debugger until `end`.

        Args:
            watch: watch of the run, with `watcher` among its watchers.
        """
        system = self._system
        self._commands.add(FOR_OBSERVERS)
        if self._caller.has((USER,)):
            self._commands.add(FOR_USERS)
        if self._caller.has((OPERATOR,)):
            self._commands.add(FOR_OPERATORS)
            self._commands.add(artifact_commands(system), changes=True)
            self._commands.add(debug_commands(system.debugger))
            # The world may be created later, when an agent first needs a robot.
            system.ros.watch_world(lambda world: self._let_change(world, watch.look))
        self._show_debugger()

    def _let_change(self, world: World, look: Callable[[], None]) -> None:
        self._commands.add(world_commands(self._system, world, look), changes=True)
        self.watcher.commands_changed()

    def _show_debugger(self) -> None:
        debugger, history = self._system.debugger, self._system.history()
        history.record(records.DebugRecord(**debugger.state.data()))
        self._end_debug = debugger.listen(lambda state: history.record(records.DebugRecord(**state.data())))

    def end(self) -> None:
        """Stop recording the state of the debugger."""
        self._end_debug()

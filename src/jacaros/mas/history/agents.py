"""Observe the agents of a run: their minds, and the messages between them."""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from jacaros.agents.mind.mind import Mind
from jacaros.mas.agents.host import AgentHost
from jacaros.mas.history.causes import CauseRecords
from jacaros.mas.history.deliberations import IN_ALL, Allowance
from jacaros.mas.history.goals import GoalRecords
from jacaros.mas.history.intentions import Looks, Moments
from jacaros.mas.history.messages import MessageRecords
from jacaros.mas.history.minds import MindRecords, Records
from jacaros.mas.history.programs import ProgramRecords
from jacaros.mas.history.run_environment import ObservedSystem
from jacaros.runtime.trace import Cause

if TYPE_CHECKING:
    from jacaros.mas.agents.python_agents import PythonAgentHost

Tell = Callable[[str, Mapping[str, Any]], None]


class AgentRecords:
    """Records the agents of a run.

    Args:
        system: the run.
        links: creates the links of causal chains.
        t: returns times.
        tell: takes the kind of a record and its data.
    """

    def __init__(self, system: ObservedSystem, links: CauseRecords, t: Moments, tell: Tell) -> None:
        self._system, self._tell = system, tell
        self._looks = Looks(system.clock)
        self._goals = GoalRecords(lambda goal: tell("goal", goal))
        messages = MessageRecords(links, self._cause, tell)
        examinations = Allowance(t, IN_ALL)
        self._records = Records(tell, t, links, examinations, ProgramRecords(tell), messages, self._looks)
        self._minds: dict[str, MindRecords] = {}
        self._ends: dict[str, Callable[[], None]] = {}

    def start(self) -> Callable[[], None]:
        """Observe all agents, including future ones. Return a function that ends this."""
        for host in self._system.directory:
            self._began(host)
        end_watch = self._system.directory.watch(self._changed)
        self._system.mailboxes.observer = self._records.messages.sent

        def end() -> None:
            end_watch()
            self._system.mailboxes.observer = None
            self._looks.look()
            self._looks.stop()
            for name in list(self._ends):
                self._ends.pop(name)()

        return end

    def look(self) -> None:
        """Record programs and intentions that have changed."""
        for mind in self._minds.values():
            mind.had_turn()
        self._looks.look()

    def run_ended(self) -> None:
        """Record the final state of the agents. Open goals are dropped."""
        self._looks.look()
        self._goals.drop()

    def _changed(self, name: str, present: bool) -> None:
        host = self._system.directory.find(name)
        if present and host is not None:
            self._began(host)
        elif not present:
            self._ended(name)

    def _began(self, host: AgentHost) -> None:
        mind = host.mind
        what = "asl" if isinstance(mind, Mind) else "python"
        self._tell("agent", {"agent": host.name, "what": what, "state": "began"})
        self._goals.listen(host)
        if isinstance(mind, Mind):
            self._ends[host.name] = self._observe_mind(host, mind)
            return
        from jacaros.mas.agents.python_agents import (
            PythonAgentHost,  # here: most runs have no agent in Python
        )

        if isinstance(host, PythonAgentHost):
            self._ends[host.name] = self._observe_inbox(host)

    def _observe_inbox(self, host: "PythonAgentHost") -> Callable[[], None]:
        inbox = host.mail
        inbox.when_read = self._records.messages.read

        def end() -> None:
            inbox.when_read = None

        return end

    def _observe_mind(self, host: AgentHost, mind: Mind) -> Callable[[], None]:
        records = self._minds[host.name] = MindRecords(mind, self._records)
        records.had_turn()
        end_turns = observe_turns(host, records.had_turn)

        def end() -> None:
            end_turns()
            records.end()

        return end

    def _ended(self, name: str) -> None:
        self._minds.pop(name, None)
        end = self._ends.pop(name, None)
        if end is not None:
            end()
        self._goals.drop(name)
        self._tell("agent", {"agent": name, "what": "", "state": "ended"})

    def _cause(self, sender: str) -> Cause | None:
        mind = self._minds.get(sender)
        return None if mind is None else mind.cause()


def observe_turns(host: AgentHost, had_turn: Callable[[], None]) -> Callable[[], None]:
    """Call *had_turn* after each turn of an agent. Return a function that ends this."""
    run = host.run

    def observed(fuel: int) -> bool:
        more = run(fuel)
        had_turn()
        return more

    host.run = observed

    def end() -> None:
        if host.run is observed:
            host.run = run

    return end

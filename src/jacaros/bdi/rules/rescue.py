"""What is done when something goes wrong that no rule of the language foresees, such as a lack of memory: an agent loses
one message, event or intention, says so, and lives on."""

from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import Intention
from jacaros.terms.unifier import undo


def told(fault: BaseException) -> str:
    """An exception in words."""
    message = str(fault)
    return f"{type(fault).__name__}: {message}" if message else type(fault).__name__


def note_lack_of_memory(agent: Circumstance, fault: BaseException) -> None:
    """Report a `MemoryError` to the host, before anything else is done that needs memory."""
    if isinstance(fault, MemoryError):
        agent.architecture.out_of_memory()


def passed_over(agent: Circumstance, what: str, fault: Exception) -> None:
    """Something cannot be dealt with and is left out."""
    note_lack_of_memory(agent, fault)
    undo(agent.trail, 0)
    agent.architecture.log("error", f"{what} is passed over: {told(fault)}")


def give_up(agent: Circumstance, intention: Intention, fault: Exception) -> None:
    """An intention cannot go on: it ends without failure events."""
    note_lack_of_memory(agent, fault)
    undo(agent.trail, 0)
    agent.current = None
    if not intention.dropped:
        agent.architecture.log("error", f"intention {intention.id} is given up: {told(fault)}")
        agent.finish(intention)

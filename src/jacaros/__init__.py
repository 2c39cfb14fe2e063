"""Program robots as rational agents: AgentSpeak minds, artifacts and ROS, in Python.

Import the names for your Python code from here: ``from jacaros import internal_action, Agent, Out``. Each name is loaded
on first use, so ``import jacaros`` costs nothing.
"""

from jacaros.exports import exported
from jacaros.version import VERSION

TYPE_CHECKING = False  # True for type checkers; importing the typing module takes longer than all of this

if TYPE_CHECKING:
    from jacaros.asl.diagnostics import AslError
    from jacaros.bdi.actions.internal_action import ActionError, WrongArguments
    from jacaros.bdi.object_kinds import NotStorable
    from jacaros.env.errors import OperationFailed
    from jacaros.env.values import Atom, Out, Structure
    from jacaros.errors import InternalError, JacarosError, UsageError
    from jacaros.extension.agent import Agent
    from jacaros.extension.declaring import arithmetic_function, internal_action
    from jacaros.extension.literal import Literal
    from jacaros.extension.python_agent import PythonAgent
    from jacaros.extension.views import Message, Option, ReceivedMessage
    from jacaros.extension.views import PlanView as Plan
    from jacaros.mas.deployment import ProjectError
    from jacaros.mas.embedding.errors import AgentEnded, GoalFailed, RunEnded, UnknownAgent
    from jacaros.mas.embedding.mas import Mas
    from jacaros.mas.embedding.run import run
    from jacaros.mas.options import RunOptions

__version__ = VERSION

__all__ = [
    "ActionError",
    "Agent",
    "AgentEnded",
    "AslError",
    "Atom",
    "GoalFailed",
    "InternalError",
    "JacarosError",
    "Literal",
    "Mas",
    "Message",
    "NotStorable",
    "OperationFailed",
    "Option",
    "Out",
    "Plan",
    "ProjectError",
    "PythonAgent",
    "ReceivedMessage",
    "RunEnded",
    "RunOptions",
    "Structure",
    "UnknownAgent",
    "UsageError",
    "WrongArguments",
    "arithmetic_function",
    "internal_action",
    "run",
]

_MODULES = {
    "jacaros.asl.diagnostics": "AslError",
    "jacaros.bdi.actions.internal_action": "ActionError WrongArguments",
    "jacaros.bdi.object_kinds": "NotStorable",
    "jacaros.env.errors": "OperationFailed",
    "jacaros.env.values": "Atom Out Structure",
    "jacaros.errors": "InternalError JacarosError UsageError",
    "jacaros.extension.agent": "Agent",
    "jacaros.extension.declaring": "arithmetic_function internal_action",
    "jacaros.extension.literal": "Literal",
    "jacaros.extension.python_agent": "PythonAgent",
    "jacaros.extension.views": "Message Option Plan=PlanView ReceivedMessage",
    "jacaros.mas.deployment": "ProjectError",
    "jacaros.mas.embedding.errors": "AgentEnded GoalFailed RunEnded UnknownAgent",
    "jacaros.mas.embedding.run": "run",
    "jacaros.mas.embedding.mas": "Mas",
    "jacaros.mas.options": "RunOptions",
}
"""Where the names are defined; views of the mind's objects have other names there."""

__getattr__ = exported(__name__, _MODULES)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

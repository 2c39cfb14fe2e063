"""Program robots as rational agents: AgentSpeak minds, artifacts and ROS, in Python.

Import the names for your Python code from here: ``from jacaros import internal_action, Agent, Out``. Each name is loaded
on first use, so ``import jacaros`` costs nothing.
"""

from jacaros.runtime.exports import exported

TYPE_CHECKING = False  # True for type checkers; importing the typing module takes longer than all of this

if TYPE_CHECKING:
    from jacaros.agents.language.diagnostics import AslError
    from jacaros.agents.mind.actions.internal_action import ActionError, WrongArguments
    from jacaros.agents.mind.storage import NotStorable
    from jacaros.agents.python.agent import Agent, Literal, Message, Option, ReceivedMessage
    from jacaros.agents.python.agent import PlanView as Plan
    from jacaros.agents.python.declaring import arithmetic_function, internal_action
    from jacaros.agents.python.python_agent import PythonAgent
    from jacaros.artifacts.env.errors import OperationFailed
    from jacaros.artifacts.env.values import Atom, Out, Structure
    from jacaros.runtime.errors import InternalError, JacarosError, UsageError
    from jacaros.runtime.mas.deployment import ProjectError
    from jacaros.runtime.mas.embedding.mas import Mas, run
    from jacaros.runtime.mas.embedding.waits import AgentEnded, GoalFailed, RunEnded, UnknownAgent
    from jacaros.runtime.mas.options import RunOptions

__version__: str

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
    "jacaros.agents.language.diagnostics": "AslError",
    "jacaros.agents.mind.actions.internal_action": "ActionError WrongArguments",
    "jacaros.agents.mind.storage": "NotStorable",
    "jacaros.agents.python.agent": "Agent Literal Message Option Plan=PlanView ReceivedMessage",
    "jacaros.agents.python.declaring": "arithmetic_function internal_action",
    "jacaros.agents.python.python_agent": "PythonAgent",
    "jacaros.artifacts.env.errors": "OperationFailed",
    "jacaros.artifacts.env.values": "Atom Out Structure",
    "jacaros.notebook.magics": "load_ipython_extension",
    "jacaros.runtime.errors": "InternalError JacarosError UsageError",
    "jacaros.runtime.mas.deployment": "ProjectError",
    "jacaros.runtime.mas.embedding.waits": "AgentEnded GoalFailed RunEnded UnknownAgent",
    "jacaros.runtime.mas.embedding.mas": "Mas run",
    "jacaros.runtime.mas.options": "RunOptions",
    "jacaros.version": "__version__=VERSION",
}
"""Where the names are defined; views of the mind's objects have other names there."""

__getattr__ = exported(__name__, _MODULES)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

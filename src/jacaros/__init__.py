"""Program robots as rational agents: AgentSpeak minds, artifacts and ROS, in Python.

What projects write in Python imports its names from here: ``from jacaros import internal_action, Agent, Out``.  Each
is loaded when it is first used, so that ``import jacaros`` costs nothing.
"""

from importlib import import_module

from jacaros.version import VERSION

TYPE_CHECKING = (
    False  # as type checkers see it; the typing module alone takes longer to import than all of this
)

if TYPE_CHECKING:
    from jacaros.asl.diagnostics import AslError
    from jacaros.bdi.actions.internal_action import ActionError, WrongArguments
    from jacaros.env.errors import OperationFailed
    from jacaros.env.values import Atom, Out, Structure
    from jacaros.errors import InternalError, JacarosError, UsageError
    from jacaros.extension.agent import Agent
    from jacaros.extension.architecture import Action, AgentArch
    from jacaros.extension.belief_base import BeliefBase
    from jacaros.extension.conversation import ReceivedMessage
    from jacaros.extension.declaring import arithmetic_function, internal_action
    from jacaros.extension.errors import UnknownAgent
    from jacaros.extension.literal import Literal
    from jacaros.extension.python_agent import PythonAgent
    from jacaros.extension.views import EventView as Event
    from jacaros.extension.views import IntentionView as Intention
    from jacaros.extension.views import Message, Option
    from jacaros.extension.views import PerceptView as Percept
    from jacaros.extension.views import PlanView as Plan
    from jacaros.mas.deployment import ProjectError
    from jacaros.mas.embedding.errors import AgentEnded, GoalFailed, RunEnded
    from jacaros.mas.embedding.main import run
    from jacaros.mas.embedding.mas import Mas

__version__ = VERSION

__all__ = [
    "Action",
    "ActionError",
    "Agent",
    "AgentArch",
    "AgentEnded",
    "AslError",
    "Atom",
    "BeliefBase",
    "Event",
    "GoalFailed",
    "Intention",
    "InternalError",
    "JacarosError",
    "Literal",
    "Mas",
    "Message",
    "OperationFailed",
    "Option",
    "Out",
    "Percept",
    "Plan",
    "ProjectError",
    "PythonAgent",
    "ReceivedMessage",
    "RunEnded",
    "Structure",
    "UnknownAgent",
    "UsageError",
    "WrongArguments",
    "arithmetic_function",
    "internal_action",
    "run",
]

_PLACES = {
    "Action": "jacaros.extension.architecture",
    "ActionError": "jacaros.bdi.actions.internal_action",
    "Agent": "jacaros.extension.agent",
    "AgentArch": "jacaros.extension.architecture",
    "AgentEnded": "jacaros.mas.embedding.errors",
    "AslError": "jacaros.asl.diagnostics",
    "Atom": "jacaros.env.values",
    "BeliefBase": "jacaros.extension.belief_base",
    "Event": "jacaros.extension.views",
    "GoalFailed": "jacaros.mas.embedding.errors",
    "Intention": "jacaros.extension.views",
    "InternalError": "jacaros.errors",
    "JacarosError": "jacaros.errors",
    "Literal": "jacaros.extension.literal",
    "Mas": "jacaros.mas.embedding.mas",
    "Message": "jacaros.extension.views",
    "OperationFailed": "jacaros.env.errors",
    "Option": "jacaros.extension.views",
    "Out": "jacaros.env.values",
    "Percept": "jacaros.extension.views",
    "Plan": "jacaros.extension.views",
    "ProjectError": "jacaros.mas.deployment",
    "PythonAgent": "jacaros.extension.python_agent",
    "ReceivedMessage": "jacaros.extension.conversation",
    "RunEnded": "jacaros.mas.embedding.errors",
    "Structure": "jacaros.env.values",
    "UnknownAgent": "jacaros.extension.errors",
    "UsageError": "jacaros.errors",
    "WrongArguments": "jacaros.bdi.actions.internal_action",
    "arithmetic_function": "jacaros.extension.declaring",
    "internal_action": "jacaros.extension.declaring",
    "run": "jacaros.mas.embedding.main",
}


_NAMES = {"Event": "EventView", "Intention": "IntentionView", "Percept": "PerceptView", "Plan": "PlanView"}
"""What is called otherwise there, to tell it from a class of the mind."""


def __getattr__(name: str) -> object:
    place = _PLACES.get(name)
    if place is None:
        raise AttributeError(f"module 'jacaros' has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(place), _NAMES.get(name, name))
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

"""The choice of the engine that runs programs: the rules of the language as written, or generated code."""

from collections.abc import Mapping

from jacaros.bdi.actions.internal_action import InternalAction
from jacaros.bdi.rules.interpreter import Interpreter
from jacaros.bdi.state.engine import Engine


def new_engine(actions: Mapping[str, InternalAction], plain: bool = False) -> Engine:
    """Return the engine for plans and rules.

    Args:
        actions: the internal actions that plans may call.
        plain: leave out everything that exists only for speed.
    """
    if plain:
        return Interpreter(actions)
    from jacaros.bdi.fast.compiler import Compiler  # imported here: a plain run does not need it

    return Compiler(actions)

"""The choice of the engine that runs programs: the rules of the language as written, or generated code."""

import os
from collections.abc import Mapping

from jacaros.bdi.actions.internal_action import InternalAction
from jacaros.bdi.rules.interpreter import Interpreter
from jacaros.bdi.state.engine import Engine


def is_plain() -> bool:
    """Return whether to leave out everything that exists only for speed (``JACAROS_PLAIN=1`` in the environment)."""
    return os.environ.get("JACAROS_PLAIN", "0") not in ("", "0")


def new_engine(actions: Mapping[str, InternalAction], plain: bool | None = None) -> Engine:
    """Return the engine for plans and rules.

    Args:
        actions: the internal actions that plans may call.
        plain: no generated code; the default is `is_plain`.
    """
    if is_plain() if plain is None else plain:
        return Interpreter(actions)
    from jacaros.bdi.fast.compiler import Compiler  # imported here: a plain run does not need it

    return Compiler(actions)

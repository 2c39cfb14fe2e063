"""Which code carries out programs: the rules of the language as they are written, or generated code in their place."""

import os
from collections.abc import Mapping

from jacaros.bdi.actions.internal_action import InternalAction
from jacaros.bdi.rules.interpreter import Interpreter
from jacaros.bdi.state.engine import CodeCache, Engine


def is_plain() -> bool:
    """Whether everything that is there for speed alone is to be left out (``JACAROS_PLAIN=1`` in the environment)."""
    return os.environ.get("JACAROS_PLAIN", "0") not in ("", "0")


def new_engine(
    actions: Mapping[str, InternalAction], plain: bool | None = None, cache: CodeCache | None = None
) -> Engine:
    """What carries out plans and rules.

    Args:
        plain: without generated code; as `is_plain` says unless given.
        cache: where generated code is kept from run to run; None for nowhere.
    """
    if is_plain() if plain is None else plain:
        return Interpreter(actions)
    from jacaros.bdi.fast.compiler import Compiler  # here: a plain run does without it altogether

    return Compiler(actions, cache)

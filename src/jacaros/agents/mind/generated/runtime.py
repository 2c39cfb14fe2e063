"""What generated code calls: the names of this module are those of its global namespace.

Nothing here knows of agents beyond what is passed in: tables of beliefs, the trail, the context of internal actions.
"""

# ruff: noqa: F401 - generated code calls what is imported

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Final

from jacaros.agents.language.lowering import Variables, lower
from jacaros.agents.mind.rules.belief_update import add_belief, delete_belief, replace_belief
from jacaros.agents.mind.rules.deadlines import begin_guarded
from jacaros.agents.mind.rules.forks import join_branch
from jacaros.agents.mind.rules.query import constructed, deconstruct, deconstruct_in, deconstructed
from jacaros.agents.mind.rules.searching import (
    Loop,
    Remaining,
    answers_of,
    cannot_wait,
    deeper,
    exists,
    facts,
    first_answer_of,
    holds,
    refuse,
    refuse_quietly,
    release,
    rows_still_held,
    run,
    solve,
    solve_annotated,
    solve_held,
    too_many_open,
    unify_rows,
    unknown,
    values_of,
)
from jacaros.agents.mind.state.plan import FAILED, NextPlan
from jacaros.agents.mind.state.triggers import (
    annotations_of_event,
    literal_in,
    literal_of,
    namespace_name,
    namespace_of,
    own_annotations,
    positive,
    resolve_all,
)
from jacaros.agents.terms.operators import OPERATORS, calculated, qualify
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.substitution import ATOMIC, equal, free_variables, related, rename, resolve
from jacaros.agents.terms.unifier import Trail, undo, unify, unify_annotations
from jacaros.agents.terms.values import (
    BY_SELF,
    CONS,
    Annotated,
    Functor,
    List,
    String,
    Var,
    bare,
    deref,
    make_list,
)
from jacaros.runtime.errors import InternalError

NESTED = 100
"""So many generators may be nested: each is a level of Python's stack, of which a thousand are allowed."""


CLOSED = frozenset({float, String, Functor, List})
"""Values that never unify with a structure."""


_ARITHMETIC = {
    each.numbers.__name__: each.numbers for each in OPERATORS if each.numbers is not None and not each.code
}
copy, new = rename, object.__new__
NAMES: Final[Mapping[str, Any]] = MappingProxyType(
    {**{name: value for name, value in globals().items() if name[0] != "_"}, **_ARITHMETIC}
)
"""The global names of generated code: those of this module."""

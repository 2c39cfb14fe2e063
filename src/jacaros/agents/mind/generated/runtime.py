"""What generated code calls: the names of its global namespace.

Nothing here knows of agents beyond what is passed in: tables of beliefs, the trail, the context of internal actions.
"""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Final

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
from jacaros.errors import InternalError

NESTED = 100
"""So many generators may be nested: each is a level of Python's stack, of which a thousand are allowed."""


CLOSED = frozenset({float, String, Functor, List})
"""Values that never unify with a structure."""


_FUNCTIONS = (
    add_belief,
    annotation_set,
    annotations_of_event,
    answers_of,
    values_of,
    calculated,
    cannot_wait,
    related,
    constructed,
    deconstruct,
    deconstruct_in,
    deconstructed,
    deeper,
    delete_belief,
    bare,
    deref,
    equal,
    exists,
    facts,
    first_answer_of,
    free_variables,
    holds,
    begin_guarded,
    join_branch,
    literal_in,
    literal_of,
    make_list,
    namespace_name,
    namespace_of,
    own_annotations,
    positive,
    qualify,
    refuse,
    refuse_quietly,
    release,
    replace_belief,
    resolve,
    resolve_all,
    rows_still_held,
    run,
    solve,
    solve_annotated,
    solve_held,
    too_many_open,
    undo,
    unify,
    unify_annotations,
    unify_rows,
    unknown,
)
_CLASSES = (Annotated, InternalError, Loop, NextPlan, Remaining, Functor, List, String, Trail, Var)

NAMES: Final[Mapping[str, Any]] = MappingProxyType(
    {
        **{item.__name__: item for item in (*_FUNCTIONS, *_CLASSES)},
        **{
            each.numbers.__name__: each.numbers
            for each in OPERATORS
            if each.numbers is not None and not each.code
        },
        "ATOMIC": ATOMIC,
        "BY_SELF": BY_SELF,
        "CLOSED": CLOSED,
        "CONS": CONS,
        "FAILED": FAILED,
        "NESTED": NESTED,
        "copy": rename,
        "new": object.__new__,
    }
)
"""The global names of generated code."""

"""Internal actions that make terms of terms: copies and annotations."""

from collections.abc import Callable

from jacaros.bdi.actions.internal_action import internal_action
from jacaros.bdi.rules.context import Context
from jacaros.bdi.state.belief_base import is_source, without_sources
from jacaros.bdi.state.intention import STEP
from jacaros.terms.order import annotation_set
from jacaros.terms.plans import PLAN, body_steps, is_body, step_parts
from jacaros.terms.substitution import rename
from jacaros.terms.values import (
    SOURCE,
    Annotated,
    String,
    Term,
    annotations_of,
    functor,
    functor_of,
    is_list,
    list_items,
    make_list,
)

CODE_LINE, CODE_SRC = functor("code_line", 1), functor("code_src", 1)


@internal_action(".copy_term", arity=2)
def copy_term(ctx: Context, term: Term, copy: Term) -> bool:
    """``.copy_term(T, C)``: *C* is the term *T* with other variables in place of the unbound ones."""
    return ctx.unify(copy, rename(term))


@internal_action(".rename_apart", arity=2)
def rename_apart(ctx: Context, term: Term, copy: Term) -> bool:
    """``.rename_apart(T, C)``: *C* is the term *T* with variables that occur nowhere else."""
    return ctx.unify(copy, rename(term))


@internal_action(".add_annot", arity=3)
def add_annot(ctx: Context, term: Term, annotation: Term, result: Term) -> bool:
    """``.add_annot(L, A, R)``: *R* is the literal *L* with the annotation *A*.

    In a list (and lists in it) each literal gets it; what is no literal stays as it is.
    """
    return ctx.unify(_in_lists(term, lambda literal: annotated(literal, (annotation,))), result)


@internal_action(".add_nested_source", arity=3)
def add_nested_source(ctx: Context, term: Term, source: Term, result: Term) -> bool:
    """``.add_nested_source(L, Ag, R)``: *R* is the literal *L* as told by *Ag*, its sources so far inside.

    ``p[source(bob)]`` from carl gives ``p[source(carl)[source(bob)]]``.  Lists are treated as by
    ``.add_annot``.
    """
    return ctx.unify(_in_lists(term, lambda literal: told_by(literal, source)), result)


@internal_action(".remove_source_annot", arity=2)
def remove_source_annot(ctx: Context, term: Term, result: Term) -> bool:
    """``.remove_source_annot(L, R)``: *R* is *L* without its sources.

    *L* is a literal, a plan (whose label loses the sources), or a list of such terms.
    """
    if is_list(term):
        return ctx.unify(make_list([_without_source(item) for item in list_items(term)]), result)
    return ctx.unify(_without_source(term), result)


def _in_lists(term: Term, change: Callable[[Term], Term]) -> Term:
    """Apply *change* to a literal, or to each literal in a list."""
    if is_list(term):
        return make_list([_in_lists(item, change) for item in list_items(term)])
    return term if functor_of(term) is None else change(term)


def annotated(term: Term, annotations: tuple[Term, ...]) -> Term:
    """The literal with *annotations* besides those that it has."""
    if isinstance(term, Annotated):
        return Annotated(term.term, annotation_set((*term.annotations, *annotations)), term.tail)
    return Annotated(term, annotation_set(annotations)) if annotations else term


def told_by(term: Term, source: Term) -> Term:
    """The literal as heard from *source*: its own sources become annotations of the new one."""
    sources = tuple(a for a in annotations_of(term) if is_source(a))
    return annotated(without_sources(term), (annotated((SOURCE, source), sources),))


def _without_source(term: Term) -> Term:
    if term.__class__ is tuple and term[0] is PLAN:
        return (PLAN, without_sources(term[1]), *term[2:])
    return without_sources(term)


@internal_action(".get_src_info", arity=2)
def get_src_info(ctx: Context, term: Term, result: Term) -> bool:
    """``.get_src_info(L, R)``: *R* is the literal *L* with ``code_line(N)`` and ``code_src("file:…")``: where it is
    written, that is, the place of the step that asks.  Fails when *L* is no literal."""
    inner = _only_operand(term)
    if functor_of(inner) is None:
        return False
    current = ctx.intention
    place: tuple[Term, ...] = ()
    if current is not None and current.frames:
        info = getattr(current.frames[-1][STEP], "info", None)
        if info is not None and info.node.span is not None:
            line, file = info.node.span.line, info.node.span.file.name
            place = ((CODE_LINE, float(line)), (CODE_SRC, String(f"file:{file}")))
    return ctx.unify(annotated(inner, place), result)


def _only_operand(term: Term) -> Term:
    """What the only step of a plan body is about; any other term is itself."""
    steps = list(body_steps(term)) if is_body(term) else []
    return step_parts(steps[0])[1][0] if len(steps) == 1 else term

"""The internal actions ``cartago.*``: agents create Python objects, call their methods, and list their workspaces.

In CArtAgO they are for Java objects. Values are converted as for artifacts (`jacaros.agents.body.values`). Anything else is
an opaque reference. All errors fail the step with ``error(internal_action)``.
"""

import builtins
import importlib
from collections.abc import Iterable
from functools import partial
from typing import Any

from jacaros.agents.body.body import AgentBody, name_of
from jacaros.agents.body.values import UNKEPT, to_term, to_value
from jacaros.agents.mind.actions.internal_action import ActionError, InternalAction, InternalActions
from jacaros.agents.mind.rules.context import Context
from jacaros.agents.python.declaring import FAULTS
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import Reference, Term, bare, is_list, make_list
from jacaros.artifacts.env.values import Out, plain
from jacaros.artifacts.kernel.faults import error_text
from jacaros.runtime.errors import InternalError
from jacaros.runtime.files.python_modules import ProjectModules

PACKAGE = "cartago."
"""Common prefix of their names."""


def actions(modules: ProjectModules) -> InternalActions:
    """Return the internal actions for a project, whose classes are found beside it."""
    declared = (
        InternalAction(f"{PACKAGE}new_obj", partial(_new_object, modules), arity=3, restricted=0),
        InternalAction(f"{PACKAGE}invoke_obj", partial(_invoke, modules), arity=(2, 3), restricted=0),
        InternalAction(f"{PACKAGE}new_array", _new_array, arity=3, restricted=0),
        InternalAction(f"{PACKAGE}array_to_list", _array_to_list, arity=2),
        InternalAction(f"{PACKAGE}current_wsps", _current_workspaces, arity=1),
    )
    return {action.name: action for action in declared}


def _new_object(
    modules: ProjectModules, ctx: Context, class_name: Term, arguments: Term, reference: Term
) -> bool:
    """``cartago.new_obj(Class, Arguments, -Reference)``."""
    name = name_of(bare(class_name))
    if name is None:
        raise ActionError(f"expected the name of a class, found {text(class_name)}")
    made = _call(f"{name}(...)", _find(modules, name), _values(arguments))
    return ctx.unify(reference, Reference(made))


def _invoke(modules: ProjectModules, ctx: Context, target: Term, call: Term, *result: Term) -> bool:
    """``cartago.invoke_obj(ReferenceOrClass, method(Arguments) {, -Result})``; or an attribute instead of a call."""
    owner, shown = _owner(modules, target)
    call = bare(call)
    name = name_of(call[0] if isinstance(call, tuple) else call)
    if name is None:
        raise ActionError(f"expected a call such as append(3), found {text(call)}")
    try:
        member = getattr(owner, name)
    except AttributeError:
        raise ActionError(f"unknown method `{name}` of {shown}") from None
    given = [_bound(to_value(each)) for each in call[1:]] if isinstance(call, tuple) else []
    value = member if not given and not callable(member) else _call(f"{name} of {shown}", member, given)
    if not result or value is None:
        return True
    return ctx.unify(result[0], to_term(value, UNKEPT))


def _owner(modules: ProjectModules, target: Term) -> tuple[Any, str]:
    target = bare(target)
    if target.__class__ is Reference:
        return target.value, f"an object of class {type(target.value).__name__}"
    name = name_of(target)
    if name is None:
        raise ActionError(f"expected an object or the name of a class, found {text(target)}")
    return _find(modules, name), f"class {name}"


def _find(modules: ProjectModules, name: str) -> Any:
    """Return the class (or module, which has functions) with this name.

    Beside the project, ``my.shapes.Square`` is in ``my/shapes.py``, and ``Square`` in ``artifacts.py``. Otherwise
    it is searched among Python's built-in names and the installed modules.
    """
    path, _, last = name.rpartition(".")
    try:
        for module in modules.load(path or "artifacts"):
            if hasattr(module, last):
                return getattr(module, last)
        own = modules.load(name)
        return own[0] if own else _installed(name)
    except InternalError:
        raise
    except FAULTS as error:
        help = "; only Python classes are supported" if name.startswith(("java.", "javax.")) else ""
        raise ActionError(f"unknown class `{name}`: {error_text(error)}{help}") from error


def _installed(name: str) -> Any:
    """Return what a name means: a built-in, or the longest prefix that is a module, and its attributes."""
    if hasattr(builtins, name):
        return getattr(builtins, name)
    parts = name.split(".")
    for length in range(len(parts), 0, -1):
        path = ".".join(parts[:length])
        try:
            found: Any = importlib.import_module(path)
        except ModuleNotFoundError as error:
            if length > 1 and error.name is not None and f"{path}.".startswith(f"{error.name}."):
                continue
            raise
        for part in parts[length:]:
            found = getattr(found, part)
        return found
    raise ModuleNotFoundError(name)


def _call(what: str, function: Any, given: list[Any]) -> Any:
    if not callable(function):
        raise ActionError(f"expected a function as {what}, found {type(function).__name__}")
    try:
        return function(*given)
    except InternalError:
        raise
    except FAULTS as error:
        raise ActionError(f"{what}: {error_text(error)}") from error


def _values(arguments: Term) -> list[Any]:
    if not is_list(bare(arguments)):
        raise ActionError(f"expected a list of arguments, found {text(arguments)}")
    return [_bound(value) for value in to_value(bare(arguments))]


def _bound(value: Any) -> Any:
    if isinstance(value, Out):
        raise ActionError(
            "expected ground arguments, found an unbound variable; only the result may be unbound"
        )
    return value


def _new_array(ctx: Context, type_name: Term, items: Term, reference: Term) -> bool:
    """``cartago.new_array("int[]", List, -Reference)``: a Python list, whose item type the type declares."""
    name = name_of(bare(type_name))
    if name is None or not name.endswith("[]"):
        raise ActionError(f'expected a type such as "int[]", found {text(type_name)}')
    kinds = _ITEMS.get(name.removesuffix("[]").rpartition(".")[2])
    values = _values(items)
    for value in values:
        if kinds is not None and (
            not isinstance(value, kinds) or (isinstance(value, bool) and bool not in kinds)
        ):
            raise ActionError(f"expected items of {name}, found {value!r}")
    if kinds is not None and kinds[0] is float:
        values = [float(value) for value in values]
    return ctx.unify(reference, Reference(values))


_WHOLE, _REAL = (int,), (float, int)
_ITEMS: dict[str, tuple[type, ...]] = {
    **dict.fromkeys(("byte", "short", "int", "long", "Byte", "Short", "Integer", "Long"), _WHOLE),
    **dict.fromkeys(("float", "double", "Float", "Double"), _REAL),
    **dict.fromkeys(("boolean", "Boolean"), (bool,)),
    **dict.fromkeys(("char", "String"), (str,)),
}
"""Python types of items, by Java type name. Items of other types may be anything."""


def _array_to_list(ctx: Context, reference: Term, result: Term) -> bool:
    """``cartago.array_to_list(Reference, -List)``: the items of any iterable."""
    target = bare(reference)
    value = plain(target.value) if target.__class__ is Reference else None
    if not isinstance(value, Iterable) or isinstance(value, str):
        raise ActionError(f"expected an array, found {text(reference)}")
    try:
        items = list(value)
    except FAULTS as error:
        raise ActionError(f"the items of {text(reference)}: {error_text(error)}") from error
    return ctx.unify(result, make_list([to_term(item, UNKEPT) for item in items]))


def _current_workspaces(ctx: Context, result: Term) -> bool:
    """``cartago.current_wsps(-Ids)``: the joined workspaces, in the order of joining."""
    body = getattr(ctx.architecture, "situated", lambda: None)()
    if not isinstance(body, AgentBody):
        raise ActionError("the project has no environment")
    body.enter()
    ids = [body.references.of(workspace) for workspace in body.workspaces.joined()]
    return ctx.unify(result, make_list(ids))

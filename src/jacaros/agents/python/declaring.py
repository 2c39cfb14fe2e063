"""The decorators for a project's Python code, what modules declare with them, and how the mind calls it."""

import inspect
import typing
from asyncio import CancelledError
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import chain, repeat
from pathlib import Path
from types import ModuleType
from typing import TypeVar, overload

from jacaros.agents.body.values import Outputs, to_value
from jacaros.agents.mind.actions.internal_action import ActionError, Crashed, InternalAction, WrongArguments
from jacaros.agents.mind.rules.context import Context
from jacaros.agents.mind.rules.deadlines import fail, succeed
from jacaros.agents.mind.rules.failure import error_terms
from jacaros.agents.mind.state.pending import CoroutineWait, Waiting
from jacaros.agents.python.agent import Agent, Literal, agent_of, literal_of, term_of
from jacaros.agents.terms.operators import ArithmeticFault
from jacaros.agents.terms.substitution import free_variables, resolve
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import NUMBERS, Term, atom, functor_of
from jacaros.artifacts.env.errors import InvalidArtifact
from jacaros.artifacts.env.values import Atom, Out, Structure
from jacaros.artifacts.kernel import declaration as operations
from jacaros.artifacts.kernel.faults import error_text
from jacaros.runtime.errors import InternalError
from jacaros.runtime.files.python_modules import (
    INCOMPLETE,
    UNSEEN,
    ModuleUnreadable,
    ProjectModules,
    place_of,
)
from jacaros.runtime.files.texts import suggestion

# Calls of project functions by the mind: terms become values, results are unified, exceptions become failures.


FAULTS = (Exception, SystemExit, CancelledError)
"""Exceptions of project code that end only the step that called it."""
_ITERATORS = ("Iterator", "Iterable", "Generator")


class Undeclarable(Exception):
    """Raised when a function does not fit its decorator; the text says why and how to fix it."""


def action_of(name: str, function: Callable[..., object]) -> InternalAction:
    """Return the internal action for a function.

    Raises:
        Undeclarable: its parameters do not fit.
    """
    callee = _Callee(name, function)
    if inspect.isasyncgenfunction(function):
        raise Undeclarable("an 'async def' with 'yield' cannot be an internal action; use one of the two")
    suspends = inspect.iscoroutinefunction(function)
    backtracks = inspect.isgeneratorfunction(function)
    return InternalAction(
        name,
        callee.begin if suspends else callee.answers if backtracks else callee.call,
        backtracks=backtracks,
        suspends=suspends,
        body_only=suspends,
        arity=(callee.minimum, callee.maximum),
        result_hint=callee.result_hint,
    )


class _Callee:
    """A function and what is known of its parameters.

    Attributes:
        minimum, maximum: numbers of arguments that programs may pass.
        wants_agent: its first parameter is the calling agent.
        gives_value: it declares a return value; programs then pass one more argument.
    """

    def __init__(self, name: str, function: Callable[..., object]) -> None:
        self.name, self.function = name, function
        self.wants_agent = _wants_agent(function)
        self.signature = _signature(function, self.wants_agent)
        self.gives_value = _gives_value(function)
        self.minimum = self.signature.fewest + self.gives_value
        most = len(self.signature.parameters) + self.gives_value
        self.maximum = None if self.signature.rest is not None else most
        self.result_hint = ""
        if not self.gives_value and "return" not in _hints(function):
            written = "Iterator[str]" if inspect.isgeneratorfunction(function) else "str"
            parameters = "..." if self.signature.parameters else ""
            self.result_hint = (
                f"to return a result, annotate it: def {function.__name__}({parameters}) -> {written}"
            )

    # the three kinds of calls

    def call(self, ctx: Context, *terms: Term) -> bool:
        """Call a plain function."""
        call = _Call(self, ctx, terms)
        try:
            value = self.function(*call.arguments)
        except FAULTS as error:
            raise action_fault(self.name, self.function, error) from error
        return call.accept(value)

    def answers(self, ctx: Context, *terms: Term) -> Iterator[None]:
        """Call a generator: one answer for each value that it yields and that unifies."""
        call = _Call(self, ctx, terms)
        search = self.function(*call.arguments)
        assert inspect.isgenerator(search)
        while True:
            try:
                value = next(search, search)
            except FAULTS as error:
                raise action_fault(self.name, self.function, error) from error
            if value is search:
                return
            if call.accept(value):
                yield

    def begin(self, ctx: Context, *terms: Term) -> Waiting:
        """Call a coroutine: the intention waits for its end."""
        call = _Call(self, ctx, terms)
        agent, waiting = ctx.agent, CoroutineWait(ctx.suspendable(), atom(self.name))

        def ended(value: object, error: BaseException | None) -> None:
            try:
                if error is not None:
                    raise action_fault(self.name, self.function, error)
                fits = call.accept(value)
            except Crashed as crashed:
                ctx.architecture.log("error", str(crashed))
                fail(agent, waiting, str(crashed), *error_terms("internal_action", str(crashed)))
            except WrongArguments as wrong:
                fail(agent, waiting, str(wrong), *error_terms("wrong_arguments", str(wrong)))
            except ActionError as refused:
                fail(agent, waiting, str(refused), *refused.annotations, *_message(refused))
            else:
                del ctx.trail[:]
                if fits:
                    succeed(agent, waiting)
                else:
                    failed = f"internal action {self.name} failed"
                    fail(agent, waiting, failed, *error_terms("ia_failed", failed))

        work = self.function(*call.arguments)
        assert inspect.iscoroutine(work)
        waiting.task = ctx.architecture.start_coroutine(work, ended)
        return waiting


class _Call:
    """One call: the values for the function, and the terms that its results are unified with."""

    def __init__(self, callee: _Callee, ctx: Context, terms: tuple[Term, ...]) -> None:
        self._callee, self._ctx = callee, ctx
        self._outputs: Outputs = []
        self._results: list[tuple[Term, Out]] = []
        self._last: Term = None
        if callee.gives_value:
            *rest, self._last = terms
            terms = tuple(rest)
        signature = callee.signature
        parameters = chain(signature.parameters, repeat(signature.rest))
        try:
            bound = signature.bind(tuple(map(self._value, parameters, terms)))
        except operations.ArgumentMismatch as wrong:
            raise WrongArguments(f"{callee.name}: {wrong}") from None
        self.arguments = (agent_of(ctx.agent), *bound) if callee.wants_agent else bound

    def _value(self, parameter: operations.Parameter | None, term: Term) -> object:
        if parameter is not None and parameter.output:
            out = Out()
            self._results.append((term, out))
            return out
        if parameter is not None and parameter.expected == Literal.__name__ and functor_of(term):
            return literal_of(term, self._outputs)
        return to_value(term, self._outputs)

    def accept(self, value: object) -> bool:
        """Unify the result of the function; return False if it does not unify, or if the function returned False.

        Raises:
            ActionError: the function returned a value without declaring one, or one that is not a term.
        """
        try:
            pairs = self._pairs(value)
        except ActionError:
            raise
        except FAULTS as error:
            # For example, a list that contains itself.
            raise action_fault(self._callee.name, self._callee.function, error) from error
        return pairs is not None and self._ctx.unify_all(*pairs)

    def _pairs(self, value: object) -> list[tuple[Term, Term]] | None:
        """Return the arguments with the terms to unify them with; None if the function reported failure."""
        pairs: list[tuple[Term, Term]] = []
        if self._callee.gives_value:
            if value is None:
                return None
            pairs.append((self._last, term_of(value)))
        elif value is False:
            return None
        elif value is not None and value is not True:
            raise self._undeclared(value)
        for target, out in (*self._results, *self._outputs):
            if out.is_set:
                pairs.append((target, term_of(out.value)))
        return pairs

    def _undeclared(self, value: object) -> ActionError:
        callee = self._callee
        kind = type(value).__name__
        return ActionCrashed(
            f"{callee.name}: the function returns {text(term_of(value))} without declaring it: write "
            f"'def {callee.function.__name__}(...) -> {kind}', and pass one more argument in programs",
        )


def _message(refused: ActionError) -> tuple[Term, ...]:
    """Return the ``error_msg`` of a coroutine's `ActionError`, and its error unless it has one."""
    names = {symbol.name for symbol in map(functor_of, refused.annotations) if symbol is not None}
    return tuple(t for t in error_terms("internal_action", str(refused)) if t[0].name not in names)


# --- arithmetic functions ----------------------------------------------------------------------------------


def function_of(
    name: str, function: Callable[..., object]
) -> tuple[Callable[..., Term], tuple[int, int | None]]:
    """Return the evaluator for a function, and its minimum and maximum number of arguments.

    Raises:
        Undeclarable: its parameters do not fit, or it is a generator or coroutine.
    """
    if inspect.isgeneratorfunction(function) or inspect.iscoroutinefunction(function):
        raise Undeclarable("an arithmetic function must be a plain function that returns a number")
    signature = _signature(function, False)
    if any(parameter.output for parameter in signature.parameters):
        raise Undeclarable("an arithmetic function returns its number and cannot have Out parameters")
    most = None if signature.rest is not None else len(signature.parameters)
    return _evaluator(name, function, signature), (signature.fewest, most)


def _evaluator(
    name: str, function: Callable[..., object], signature: operations.Signature
) -> Callable[..., Term]:
    def evaluate(*terms: Term) -> Term:
        known = [resolve(term) for term in terms]
        if any(free_variables(term) for term in known):
            return None
        try:
            values = signature.bind(tuple(to_value(term) for term in known))
        except operations.ArgumentMismatch as wrong:
            raise ArithmeticFault(f"{name}: {wrong}") from None
        try:
            value = function(*values)
        except FAULTS as error:
            raise FunctionCrashed(crash_text(name, function, error)) from error
        number = term_of(value)
        if number.__class__ not in NUMBERS:
            raise FunctionCrashed(f"{name}: the function returned {value!r}, which is not a number")
        return number

    return evaluate


# --- signatures --------------------------------------------------------------------------------------------


def _signature(function: Callable[..., object], skip_first: bool) -> operations.Signature:
    try:
        return operations.signature_of(function, skip_first)
    except InvalidArtifact as wrong:
        raise Undeclarable(str(wrong)) from wrong


def _hints(function: Callable[..., object]) -> dict[str, object]:
    """Return the annotations; those that cannot be resolved stay as text."""
    known, unknown = operations.annotations_of(function)
    return {**known, **unknown}


def _wants_agent(function: Callable[..., object]) -> bool:
    first = next(iter(inspect.signature(function).parameters), None)
    hint = _hints(function).get(first) if first is not None else None
    if isinstance(hint, str):
        return hint.rpartition(".")[2] == Agent.__name__
    return isinstance(hint, type) and issubclass(hint, Agent)


def _gives_value(function: Callable[..., object]) -> bool:
    """Return whether the annotation of the returned (or yielded) value declares a value."""
    hint = _hints(function).get("return")
    if isinstance(hint, str):
        hint = _written(hint)
    elif inspect.isgeneratorfunction(function):
        hint = next(iter(typing.get_args(hint)), None)
    return hint not in (None, type(None), bool, bool | None, "None", "bool")


def _written(hint: str) -> str | None:
    """Return what an unresolved annotation declares: the value of an iterator, or the whole."""
    kind, bracket, inner = hint.partition("[")
    if kind.rpartition(".")[2] in _ITERATORS:
        return inner.rstrip("]").partition(",")[0].strip() if bracket else None
    return hint


# --- exceptions --------------------------------------------------------------------------------------------


class ActionCrashed(ActionError, Crashed):
    """The Python code of an internal action raised an exception other than `ActionError`."""


class FunctionCrashed(ArithmeticFault, Crashed):
    """The Python code of an arithmetic function raised an exception."""


def action_fault(name: str, function: Callable[..., object], error: BaseException) -> Exception:
    """Return the failure for an exception of an internal action's function.

    Raises:
        InternalError: the exception is one: a defect of JaCaROS.
    """
    if isinstance(error, InternalError):
        raise error
    if isinstance(error, WrongArguments):
        return error
    if isinstance(error, ActionError):
        return ActionError(str(error), *map(_annotation, error.annotations))
    return ActionCrashed(crash_text(name, function, error))


def _annotation(value: Term) -> Term:
    return term_of(value) if isinstance(value, (Literal, Structure, Atom, str)) else value


def crash_text(name: str, function: Callable[..., object], error: BaseException) -> str:
    """Describe an exception for the log: the action, the exception, and where it was raised."""
    return f"{name}: {error_text(error)} ({_place_of_fault(function, error)})"


def _place_of_fault(function: Callable[..., object], error: BaseException) -> str:
    code = getattr(function, "__code__", None)
    if code is None:
        return getattr(function, "__module__", "?")
    file = Path(code.co_filename)
    place, line = place_of(error, file.parent) or (file, code.co_firstlineno)
    return f"{place}:{line}"


F = TypeVar("F", bound=Callable[..., object])

_MARK = "__jacaros_declared__"


@dataclass(frozen=True, slots=True)
class Declared:
    """What a decorator declares of a function.

    Attributes:
        kind: ``internal action`` or ``arithmetic function``.
        function: the function itself.
        name: as programs write it; None for the default, module and function.
    """

    kind: str
    function: Callable[..., object]
    name: str | None


ACTION, FUNCTION = "internal action", "arithmetic function"


@overload
def internal_action(name: F, /) -> F: ...


@overload
def internal_action(name: str | None = None, /) -> Callable[[F], F]: ...


def internal_action(name: str | F | None = None, /) -> object:
    """Make a function an internal action of the project's agents.

    The first part of the name must lead to the module: for ``my.norm(X, Y, L)`` agents look for ``my.py``, or a package
    ``my/``, beside the project. The function itself is unchanged and can be called from Python, too.

    * A plain function succeeds unless it returns False. If it declares a return value (``-> float``),
    programs pass one
      more argument at the end, which the value is unified with; if the value is None, the action fails.
    * A generator gives an answer with every ``yield``; conditions try them in turn.
    * A coroutine (``async def``) suspends the intention that calls it until it is done; dropping the
    intention
      cancels it.

    Arguments are Python values. A parameter annotated `Out` is a result: its value is unified with the argument. A first
    parameter annotated `Agent` receives the calling agent, and is not counted.

    Args:
        name: as programs write it, with dots; by default the module and the function.

    Examples:
        @internal_action("my.norm")
        def norm(x: float, y: float) -> float:
            return math.hypot(x, y)
    """
    return _declare(ACTION, name)


@overload
def arithmetic_function(name: F, /) -> F: ...


@overload
def arithmetic_function(name: str | None = None, /) -> Callable[[F], F]: ...


def arithmetic_function(name: str | F | None = None, /) -> object:
    """Make a function an arithmetic function of the project's programs: ``X = my.sq(3) + 1``.

    It is called with Python values once all arguments are known, and returns a number. An exception fails the step with
    ``error(arithmetic_error)``.

    Args:
        name: as programs write it, with dots; by default the module and the function.

    Examples:
        @arithmetic_function("my.sq")
        def sq(x: float) -> float:
            return x * x
    """
    return _declare(FUNCTION, name)


def _declare(kind: str, name: str | F | None) -> F | Callable[[F], F]:
    if callable(name):
        return _mark(name, Declared(kind, name, None))
    if name is not None and (not isinstance(name, str) or "." not in name[1:] or name.startswith(".")):
        raise ValueError(f"the name of an {kind} must begin with the module, as in 'my.norm', not {name!r}")
    return lambda function: _mark(function, Declared(kind, function, name))


def _mark(function: F, declared: Declared) -> F:
    setattr(function, _MARK, (*declarations(function), declared))
    return function


def declarations(function: object) -> tuple[Declared, ...]:
    """Return what decorators declared of a function."""
    found: tuple[Declared, ...] = getattr(function, _MARK, ())
    return found


ArityRange = tuple[int, int | None]


class Additions:
    """What the modules of a project add.

    Attributes:
        actions: internal actions by name.
        functions: evaluators of arithmetic functions by name.
        arities: their minimum and maximum numbers of arguments.
        unseen: names that may be added when their file runs, or (ending with a dot) prefixes of such names.
        plain: names of functions without decorator, as programs would write them.
    """

    def __init__(self) -> None:
        self.actions: dict[str, InternalAction] = {}
        self.functions: dict[str, Callable[..., Term]] = {}
        self.arities: dict[str, ArityRange] = {}
        self.plain: set[str] = set()
        self.unseen: dict[str, Path] = {}
        self._places: dict[str, str] = {}

    def collect(self, modules: ProjectModules, name: str) -> None:
        """Collect what the module *name* (all modules, if it is a package) declares.

        Raises:
            ModuleUnreadable: a file cannot be imported, or has an invalid declaration; the text names file and line.
        """
        for module in modules.load(name):
            if INCOMPLETE in vars(module):
                self.unseen[f"{modules.name_of(module)}."] = Path(module.__file__ or name)
            self._collect_module(modules.name_of(module), module, name.partition(".")[0])

    def _collect_module(self, module_name: str, module: ModuleType, top: str) -> None:
        for key, value in list(vars(module).items()):
            if value is UNSEEN and module.__file__ is not None:
                self.unseen[_default_name(module_name, key)] = Path(module.__file__)
            if not callable(value) or getattr(value, "__module__", None) != module.__name__:
                continue
            default = _default_name(module_name, key)
            found = declarations(value)
            if not found and not isinstance(value, type):
                self.plain.add(default)
            for declared in found:
                self._add(declared.name or default, declared, top)

    def _add(self, name: str, declared: Declared, top: str) -> None:
        place = _place(declared)
        if name.partition(".")[0] != top:
            raise ModuleUnreadable(
                f"{place}: no program can find {name}: it looks for a module {name.partition('.')[0]}; "
                f"write {top}.{name.rpartition('.')[2]}"
            )
        if self._places.get(name, place) != place:
            raise ModuleUnreadable(f"{place}: {name} is declared twice, also in {self._places[name]}")
        self._places[name] = place
        try:
            if declared.kind == ACTION:
                self.actions[name] = action_of(name, declared.function)
            else:
                self.functions[name], self.arities[name] = function_of(name, declared.function)
        except Undeclarable as wrong:
            raise ModuleUnreadable(f"{place}: {name}: {wrong}") from wrong

    def help(self, name: str) -> str | None:
        """Return a suggested fix for an unknown internal action, or None."""
        if name in self.plain:
            return f"put @internal_action before the function {name}"
        if name in self.arities:
            least, most = self.arities[name]
            takes = str(least) if least == most else f"{least} to {'any' if most is None else most}"
            return f"{name} is an arithmetic function with {takes} arguments"
        return suggestion(name, [*self.actions, *self.arities]) or None


def _default_name(module_name: str, function_name: str) -> str:
    """Return ``my.norm`` for a function of ``my.py``, and for the function ``norm`` of ``my/norm.py``."""
    if "." in module_name and module_name.rpartition(".")[2] == function_name:
        return module_name
    return f"{module_name}.{function_name}"


def _place(declared: Declared) -> str:
    code = getattr(declared.function, "__code__", None)
    if code is None:
        return str(getattr(declared.function, "__module__", "?"))
    return f"{code.co_filename}:{code.co_firstlineno}"

"""The decorators for a project's Python code, and the collection of what modules declare with them."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import TypeVar, overload

from jacaros.agents.mind.actions.internal_action import InternalAction
from jacaros.agents.python.calling import Undeclarable, action_of, function_of
from jacaros.agents.terms.values import Term
from jacaros.files.python_modules import INCOMPLETE, UNSEEN, ModuleUnreadable, ProjectModules
from jacaros.files.texts import suggestion

Function = TypeVar("Function", bound=Callable[..., object])

_MARK = "__jacaros_declared__"


@dataclass(frozen=True, slots=True)
class Declared:
    """What a decorator declares of a function.

    Attributes:
        kind: ``internal action`` or ``arithmetic function``.
        function: the function itself.
        name: as programs write it; None for the default, module and function.
        pure: whether questions about an agent may call it.
    """

    kind: str
    function: Callable[..., object]
    name: str | None
    pure: bool = False


ACTION, FUNCTION = "internal action", "arithmetic function"


@overload
def internal_action(name: Function, /) -> Function: ...


@overload
def internal_action(name: str | None = None, /, *, pure: bool = False) -> Callable[[Function], Function]: ...


def internal_action(name: str | Function | None = None, /, *, pure: bool = False) -> object:
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
        pure: the function only computes its result. Questions (the console of the live page, conditions of breakpoints, and
            explanations of failures) call pure functions only.

    Examples:
        @internal_action("my.norm", pure=True)
        def norm(x: float, y: float) -> float:
            return math.hypot(x, y)
    """
    return _declare(ACTION, name, pure)


@overload
def arithmetic_function(name: Function, /) -> Function: ...


@overload
def arithmetic_function(name: str | None = None, /) -> Callable[[Function], Function]: ...


def arithmetic_function(name: str | Function | None = None, /) -> object:
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


def _declare(
    kind: str, name: str | Function | None, pure: bool = False
) -> Function | Callable[[Function], Function]:
    if callable(name):
        return _mark(name, Declared(kind, name, None))
    if name is not None and (not isinstance(name, str) or "." not in name[1:] or name.startswith(".")):
        raise ValueError(f"the name of an {kind} must begin with the module, as in 'my.norm', not {name!r}")
    return lambda function: _mark(function, Declared(kind, function, name, pure))


def _mark(function: Function, declared: Declared) -> Function:
    setattr(function, _MARK, (*declarations(function), declared))
    return function


def declarations(function: object) -> tuple[Declared, ...]:
    """Return what decorators declared of a function."""
    found: tuple[Declared, ...] = getattr(function, _MARK, ())
    return found


Limits = tuple[int, int | None]


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
        self.arities: dict[str, Limits] = {}
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
                self.actions[name] = action_of(name, declared.function, declared.pure)
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

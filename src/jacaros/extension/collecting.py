"""From the modules of a project to what they add to the language."""

from collections.abc import Callable
from difflib import get_close_matches
from pathlib import Path
from types import ModuleType

from jacaros.bdi.actions.internal_action import InternalAction
from jacaros.extension.calling import Undeclarable, action_of, function_of
from jacaros.extension.declaring import ACTION, Declared, declarations
from jacaros.module_outlines import INCOMPLETE, UNSEEN
from jacaros.project_modules import ModuleUnreadable, ProjectModules
from jacaros.terms.values import Term

Limits = tuple[int, int | None]


class Additions:
    """What the modules of a project add.

    Attributes:
        actions: internal actions by name.
        functions: evaluators of arithmetic functions by name.
        arities: their least and greatest numbers of arguments.
        unseen: names that may be added when their file is run, or (with a dot at the end) the beginnings of such names.
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
        """Take what the module *name* (of a package: all its modules) declares.

        Raises:
            ModuleUnreadable: a file cannot be imported, or declares what cannot be; the text names file and line.
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
                self.actions[name] = action_of(name, declared)
            else:
                self.functions[name], self.arities[name] = function_of(name, declared)
        except Undeclarable as wrong:
            raise ModuleUnreadable(f"{place}: {name}: {wrong}") from wrong

    def hint(self, name: str) -> str | None:
        """What may help somebody who writes the name of an internal action that there is not."""
        if name in self.plain:
            return f"the function {name} exists: put @internal_action before it"
        if name in self.arities:
            least, most = self.arities[name]
            takes = str(least) if least == most else f"{least} to {'any' if most is None else most}"
            return f"{name} is an arithmetic function with {takes} arguments"
        close = get_close_matches(name, [*self.actions, *self.arities], 1)
        return f"did you mean {close[0]}?" if close else None


def _default_name(module_name: str, function_name: str) -> str:
    """``my.norm`` for a function of ``my.py``, and for the function ``norm`` of ``my/norm.py``."""
    if "." in module_name and module_name.rpartition(".")[2] == function_name:
        return module_name
    return f"{module_name}.{function_name}"


def _place(declared: Declared) -> str:
    code = getattr(declared.function, "__code__", None)
    if code is None:
        return str(getattr(declared.function, "__module__", "?"))
    return f"{code.co_filename}:{code.co_firstlineno}"

"""Python files of projects: what they declare, without running them, and the modules that run.

An outline is made from the syntax tree of the file. Of its code, only this is executed: class and function statements
with the decorators of jacaros, constants, and imports of jacaros and of a few harmless modules. Whatever only running
the file could show (a class made by a call, a base class of another package, an unknown decorator) becomes `UNSEEN`.
"""

import ast
import builtins
import importlib
import importlib.util
import itertools
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from importlib.util import resolve_name
from pathlib import Path
from threading import RLock
from types import ModuleType
from typing import Any, Final

from jacaros.runtime.errors import JacarosError
from jacaros.runtime.files.texts import file_text

_HARMLESS: Final = frozenset(
    [
        "__future__",
        "abc",
        "collections",
        "collections.abc",
        "dataclasses",
        "enum",
        "math",
        "numbers",
        "typing",
    ]
)
"""Modules beside jacaros that an outline imports: all that they do is known."""

_DECORATORS: Final = frozenset(
    {
        *("operation", "internal_operation", "link", "initializer", "common_operation"),
        *("internal_action", "arithmetic_function", "dataclass", "abstractmethod", "final", "override"),
        *("staticmethod", "classmethod", "property"),
    }
)
_BINDING_CALLS: Final = frozenset(
    {"exec", "eval", "globals", "locals", "setattr", "vars", "__import__", "import_module"}
)
INCOMPLETE: Final = "__jacaros_incomplete__"
"""The attribute of an outline that lists names that only running the file can reveal."""


class Unseen:
    """A value that is unknown until the file runs; usable wherever an annotation or a default value is."""

    def __getattr__(self, name: str) -> "Unseen":
        if name.startswith("__"):
            raise AttributeError(name)
        return self

    def __call__(self, *_: object, **__: object) -> "Unseen":
        return self

    def __getitem__(self, _: object) -> "Unseen":
        return self

    def __or__(self, _: object) -> "Unseen":
        return self

    __ror__ = __or__


UNSEEN: Final = Unseen()


def fill(module: ModuleType, file: Path, text: str, project: Callable[[str], ModuleType | None]) -> None:
    """Add the declarations of a file to *module*.

    Args:
        module: an empty one.
        file: its file, for errors.
        text: of the file.
        project: returns the outline of another module of the project; None for other names.

    Raises:
        SyntaxError: the text is not Python.
        Exception: a declaration is invalid, such as an operation with keyword parameters.
    """
    tree = ast.parse(text, str(file))
    outline = _Outline(module, project)
    for statement in _flat(tree.body):
        if outline.declares(statement):
            part = ast.fix_missing_locations(ast.Module([statement], []))
            exec(compile(part, str(file), "exec", dont_inherit=True), module.__dict__)
    if (doc := ast.get_docstring(tree)) is not None:
        module.__doc__ = doc


def _flat(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """Yield the statements of a module; of conditions and ``try``, all branches."""
    for statement in body:
        if isinstance(statement, ast.If):
            yield from _flat([*statement.body, *statement.orelse])
        elif isinstance(statement, ast.Try):
            handlers = [each for handler in statement.handlers for each in handler.body]
            yield from _flat([*handlers, *statement.body, *statement.orelse, *statement.finalbody])
        else:
            yield statement


_Declaration = ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef


class _Outline:
    """Reduces the statements of a file to harmless ones.

    Args:
        module: contains the names known so far.
        project: returns other modules of the project.
    """

    def __init__(self, module: ModuleType, project: Callable[[str], ModuleType | None]) -> None:
        self._module, self._project = module, project
        self._names = module.__dict__
        self._names["__unseen__"] = Unseen

    def declares(self, statement: ast.stmt) -> bool:
        """Return whether to execute a statement, reduced to its declaration; names of others are bound here."""
        match statement:
            case ast.Import() | ast.ImportFrom():
                self._import(statement)
            case ast.ClassDef() | ast.FunctionDef() | ast.AsyncFunctionDef():
                if self._reduce(statement):
                    return True
                self._names[statement.name] = UNSEEN
            case ast.Assign() | ast.AnnAssign():
                self._assign(statement)
            case _ if _binds_more(statement):
                self._names[INCOMPLETE] = True
        return False

    # imports

    def _import(self, statement: ast.Import | ast.ImportFrom) -> None:
        if isinstance(statement, ast.Import):
            for each in statement.names:
                whole = self._found(each.name)
                top = each.name.partition(".")[0]
                self._names[each.asname or top] = (
                    whole if each.asname or whole is UNSEEN else self._found(top)
                )
            return
        source = self._found("." * statement.level + (statement.module or ""))
        for each in statement.names:
            if each.name == "*":
                if source is UNSEEN or INCOMPLETE in vars(source):
                    self._names[INCOMPLETE] = True
                if source is not UNSEEN:
                    shown = getattr(source, "__all__", [name for name in vars(source) if name[0] != "_"])
                    self._names.update({name: getattr(source, name, UNSEEN) for name in shown})
            else:
                self._names[each.asname or each.name] = self._part(source, statement, each.name)

    def _part(self, source: Any, statement: ast.ImportFrom, name: str) -> Any:
        if source is UNSEEN and not statement.level:
            return UNSEEN
        found = getattr(source, name, None) if source is not UNSEEN else None
        if found is None:  # a module of a package
            found = self._found("." * statement.level + ".".join(filter(None, (statement.module, name))))
        return found

    def _found(self, name: str) -> Any:
        with suppress(ImportError):  # beyond the top of its package
            name = resolve_name(name, self._module.__package__)
        own = self._project(name)
        if own is not None:
            return own
        if name in _HARMLESS or name == "jacaros" or name.startswith("jacaros."):
            try:
                return importlib.import_module(name)
            except Exception:  # needs what is not installed here
                return UNSEEN
        return UNSEEN

    # declarations

    def _reduce(self, node: _Declaration) -> bool:
        """Reduce a class or function to what it declares; return False if only running the file could show that."""
        node.type_params = []  # type: ignore[union-attr]  # annotations with them become texts
        if not all(map(self._is_known, node.decorator_list)):
            return False  # they may turn it into anything
        if isinstance(node, ast.ClassDef):
            return self._reduce_class(node)
        documentation = node.body[:1] if ast.get_docstring(node) is not None else []
        node.body = [*documentation, ast.Expr(ast.Yield()) if _yields(node) else ast.Pass()]
        node.returns = _written(node.returns)
        _reduce_parameters(node.args)
        return True

    def _reduce_class(self, node: ast.ClassDef) -> bool:
        bases = [base.value if isinstance(base, ast.Subscript) else base for base in node.bases]
        found = [self._value(base) for base in bases]
        # Base classes of typing matter to type checkers only.
        if node.keywords or not all(
            isinstance(each, type) or getattr(each, "__module__", "") == "typing" for each in found
        ):
            return False
        body: list[ast.stmt] = []
        for statement in _flat(node.body):
            match statement:
                case ast.FunctionDef() | ast.AsyncFunctionDef():
                    if _is_part_of_property(statement):
                        continue
                    if not self._reduce(statement):
                        return False
                    body.append(statement)
                case ast.ClassDef(name=name):
                    body.append(statement if self._reduce(statement) else _unseen(statement, name))
                case ast.Assign() | ast.AnnAssign():
                    body += _attributes(statement)
                case ast.Expr(value=ast.Constant()):
                    body.append(statement)
                case _ if _binds_more(statement):
                    return False
        node.bases = [base for base, value in zip(bases, found, strict=True) if isinstance(value, type)]
        node.body = body or [ast.Pass()]
        return True

    def _is_known(self, decorator: ast.expr) -> bool:
        """Return whether a decorator only declares, with constants as its arguments."""
        called = decorator.func if isinstance(decorator, ast.Call) else decorator
        if isinstance(decorator, ast.Call) and not all(
            map(_is_constant, [*decorator.args, *(each.value for each in decorator.keywords)])
        ):
            return False
        value = self._value(called)
        module = getattr(value, "__module__", "") or ""
        ours = module.startswith(("jacaros.", "dataclasses", "abc", "typing", "builtins"))
        return value is not UNSEEN and ours and getattr(value, "__name__", "") in _DECORATORS

    def _assign(self, statement: ast.Assign | ast.AnnAssign) -> None:
        if statement.value is None:
            return
        value = self._value(statement.value)
        for target in _targets(statement):
            for each in ast.walk(target):
                if isinstance(each, ast.Name):
                    self._names[each.id] = value if each is target else UNSEEN

    def _value(self, node: ast.expr) -> Any:
        """Return the value of a constant, or of a name with or without dots; `UNSEEN` for anything else."""
        if isinstance(node, ast.Name):
            return self._names.get(node.id, getattr(builtins, node.id, UNSEEN))
        if isinstance(node, ast.Attribute):
            owner = self._value(node.value)
            return UNSEEN if owner is UNSEEN else getattr(owner, node.attr, UNSEEN)
        return ast.literal_eval(node) if _is_constant(node) else UNSEEN


def _targets(statement: ast.Assign | ast.AnnAssign) -> list[ast.expr]:
    return statement.targets if isinstance(statement, ast.Assign) else [statement.target]


def _is_part_of_property(node: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    return any(
        isinstance(each, ast.Attribute) and each.attr in ("setter", "getter", "deleter")
        for each in node.decorator_list
    )


def _is_constant(node: ast.expr) -> bool:
    try:
        ast.literal_eval(node)
    except (ValueError, TypeError, SyntaxError, MemoryError, RecursionError):
        return False
    return True


def _made_unseen() -> ast.expr:
    """Return a new object each time: the values of an enumeration must differ."""
    return ast.Call(ast.Name("__unseen__", ast.Load()), [], [])


def _unseen(node: ast.stmt, name: str) -> ast.stmt:
    value = _made_unseen()
    return ast.copy_location(ast.Assign(targets=[ast.Name(name, ast.Store())], value=value), node)


def _attributes(statement: ast.Assign | ast.AnnAssign) -> list[ast.stmt]:
    """Attributes of a class: constants as they are, others unseen."""
    if isinstance(statement, ast.Assign):
        if _is_constant(statement.value) and all(isinstance(each, ast.Name) for each in statement.targets):
            return [statement]
        parts = (each for target in statement.targets for each in ast.walk(target))
        return [_unseen(statement, each.id) for each in parts if isinstance(each, ast.Name)]
    if not isinstance(statement.target, ast.Name):
        return []
    value = statement.value
    if value is not None and not _is_constant(value):
        value = _made_unseen()
    annotation = _written(statement.annotation) or ast.Constant("object")
    return [ast.copy_location(ast.AnnAssign(statement.target, annotation, value, 1), statement)]


def _reduce_parameters(given: ast.arguments) -> None:
    """Keep annotations of parameters as texts, and constants as default values."""
    for each in ast.walk(given):
        if isinstance(each, ast.arg):
            each.annotation = _written(each.annotation)
    given.defaults = [each if _is_constant(each) else _made_unseen() for each in given.defaults]
    given.kw_defaults = [
        each if each is None or _is_constant(each) else _made_unseen() for each in given.kw_defaults
    ]


_OF_TYPES: Final = (ast.Name, ast.Attribute, ast.Subscript, ast.BinOp, ast.BitOr, ast.Tuple, ast.List)


def _written(annotation: ast.expr | None) -> ast.expr | None:
    """An annotation as a text, which may be evaluated: names, brackets and ``|`` only."""
    if annotation is None:
        return None
    if isinstance(annotation, ast.Constant) and isinstance(annotation.value, str):
        try:
            annotation = ast.parse(annotation.value, mode="eval").body
        except (SyntaxError, ValueError):
            return None
    for each in ast.walk(annotation):
        # Texts within texts would be evaluated in turn.
        is_constant = isinstance(each, ast.Constant) and not isinstance(each.value, str)
        if not (is_constant or isinstance(each, (*_OF_TYPES, ast.Load))):
            return None
    return ast.copy_location(ast.Constant(ast.unparse(annotation)), annotation)


def _yields(function: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    """Return whether a function is a generator: it contains a yield, not counting nested functions."""
    stack: list[ast.AST] = list(function.body)
    while stack:
        node = stack.pop()
        if isinstance(node, ast.Yield | ast.YieldFrom):
            return True
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda | ast.ClassDef):
            stack.extend(ast.iter_child_nodes(node))
    return False


def _binds_more(statement: ast.stmt) -> bool:
    """Return whether a statement may bind names of a module or class that cannot be determined."""
    for node in ast.walk(statement):
        match node:
            case (
                ast.FunctionDef() | ast.AsyncFunctionDef() | ast.ClassDef() | ast.Import() | ast.ImportFrom()
            ):
                return True
            case ast.Name(ctx=ast.Store()) | ast.Attribute(attr="import_module" | "modules" | "update"):
                return True
            case ast.Name(id=name) if name in _BINDING_CALLS:
                return True
    return False


# The Python files of a project: ``NAME.py``, or a package ``NAME/``, in its folders.
#
# Artifacts (``artifacts.py``), internal actions, agent classes and belief bases are found here. The files are loaded under
# module names of their own, so that several projects with files of the same names can live in one process; the import path
# is restored after loading.


_numbers = itertools.count(1)
_import_path = RLock()
"""Held while `sys.path` and `sys.modules` show the files of one project: they belong to the process, so systems in other
threads have to wait.
"""


class ModuleUnreadable(JacarosError):
    """A project's Python file cannot be imported; the original error is the ``__cause__``."""


class NotImported(JacarosError):
    """Raised when the declarations of a project's Python file cannot be known without running it, which was not
    requested.
    """


class ProjectModules:
    """The Python modules of one project; each is loaded once, on first use.

    A file may import others of the project by plain names (``import gripper``) while it is loaded, and those of its
    package by relative names (``from .gripper import Gripper``). All importers share one module.

    Args:
        folders: where the files are searched, in order.
        unseen: if given, no file runs: modules are outlines, and files with declarations
            that an outline does not show are added here when they are needed.
    """

    def __init__(self, *folders: Path | str, unseen: set[Path] | None = None) -> None:
        self.unseen = unseen
        self.folders = tuple(dict.fromkeys(Path(folder).resolve() for folder in folders))
        self._prefix = f"jacaros_project_{next(_numbers)}"
        self._loaded: dict[str, tuple[ModuleType, ...]] = {}
        # By the names under which the project's own files import them.
        self._modules: dict[str, ModuleType] = {}

    def place(self, name: str) -> Path | None:
        """Return the file or folder of a module such as ``my`` or ``my.shapes``, or None."""
        parts = name.split(".")
        if not all(part.isidentifier() for part in parts):
            return None
        for folder in self.folders:
            package = folder.joinpath(*parts)
            single = package.parent / f"{package.name}.py"
            if os.path.isfile(single):  # unlike Path.is_file, it raises nothing for a name that is too long
                return single
            if os.path.isdir(package) and next(package.glob("*.py"), None) is not None:
                return package
        return None

    def load(self, name: str) -> tuple[ModuleType, ...]:
        """Return the module called *name*; of a package, all modules, its own first. Empty if it does not exist.

        Raises:
            ModuleUnreadable: a file has an error; the text names file and line.
        """
        found = self._loaded.get(name)
        if found is None:
            place = self.place(name)
            if place is None:
                return ()
            # Nothing of a package, if it is a file.
            rest = [file for file in sorted(place.glob("*.py")) if file.name != "__init__.py"]
            first = self._module(name, place)
            found = (first, *(self._file(f"{name}.{file.stem}", file) for file in rest))
            self._loaded[name] = found
        return found

    def require_seen(self, module: ModuleType, name: str) -> None:
        """Raise an exception unless it is known that the module lacks the name.

        Raises:
            NotImported: the module is an outline, and the name may exist when the file runs.
        """
        if self.unseen is None:
            return
        value = vars(module).get(name)
        if value is UNSEEN or (value is None and INCOMPLETE in vars(module)):
            file = Path(module.__file__ or module.__name__)
            self.unseen.add(file)
            raise NotImported(f"{file} is not imported, so {name} is not known; --import imports it")

    def loaded_files(self) -> list[Path]:
        """Return the files that have been loaded, each once."""
        files = (getattr(module, "__file__", None) for module in self._modules.values())
        return [Path(file) for file in dict.fromkeys(files) if file]

    def forget(self) -> None:
        """Remove the outlines from the module table, which keeps them alive. Their types remain usable."""
        for name in self._modules:
            sys.modules.pop(f"{self._prefix}.{name}", None)

    def name_of(self, module: ModuleType) -> str:
        """The name by which the project knows a module, such as ``my.geometry``."""
        return module.__name__.removeprefix(f"{self._prefix}.")

    def _module(self, name: str, place: Path) -> ModuleType:
        if os.path.isfile(place):
            return self._file(name, place)
        entry = place / "__init__.py"
        return self._file(name, entry, place) if os.path.isfile(entry) else self._empty_package(name, place)

    def _empty_package(self, name: str, folder: Path) -> ModuleType:
        module = self._modules.get(name) or ModuleType(f"{self._prefix}.{name}")
        module.__path__ = [str(folder)]
        sys.modules[f"{self._prefix}.{name}"] = self._modules[name] = module
        return module

    def _file(self, name: str, file: Path, package: Path | None = None) -> ModuleType:
        known = self._modules.get(name)
        if known is not None:
            return known
        full = f"{self._prefix}.{name}"
        locations = [str(package)] if package is not None else None
        spec = importlib.util.spec_from_file_location(full, file, submodule_search_locations=locations)
        assert spec is not None, file
        assert spec.loader is not None, file
        module = sys.modules[full] = self._modules[name] = importlib.util.module_from_spec(spec)
        try:
            if self.unseen is not None:
                fill(module, file, file_text(file), self._outline)
            else:
                with self._importing():
                    spec.loader.exec_module(module)
        except (Exception, SystemExit) as error:
            if isinstance(error, ModuleUnreadable) and self.unseen is not None:
                raise  # of a module that this one imports
            del sys.modules[full], self._modules[name]
            raise ModuleUnreadable(_where(error, file)) from error
        return module

    def _outline(self, name: str) -> ModuleType | None:
        """Return the outline of another module of the project that one imports."""
        name = name.removeprefix(f"{self._prefix}.")
        place = self.place(name)
        return None if place is None else self._module(name, place)

    @contextmanager
    def _importing(self) -> Iterator[None]:
        """Let imports find the project's files first, and take those files out of the module table again."""
        with _import_path:
            before = set(sys.modules)
            shown = {name: module for name, module in self._modules.items() if name not in before}
            sys.modules.update(shown)
            paths = [str(folder) for folder in self.folders]
            sys.path[:0] = paths
            try:
                yield
            finally:
                for path in paths:
                    sys.path.remove(path)
                for name in [name for name in list(sys.modules) if name not in before]:
                    module = sys.modules[name]
                    if name.startswith(f"{self._prefix}."):
                        self._modules.setdefault(name.removeprefix(f"{self._prefix}."), module)
                    elif name in shown or self._is_own(module):
                        self._modules.setdefault(name, module)
                        del sys.modules[name]

    def _is_own(self, module: ModuleType) -> bool:
        file = getattr(module, "__file__", None)
        if file is None:
            return False
        path = Path(file).resolve()
        # A project's folder often holds its virtual environment, too. Libraries stay: numpy cannot be loaded twice.
        return any(
            path.is_relative_to(folder) and "site-packages" not in path.relative_to(folder).parts
            for folder in self.folders
        )


def _where(error: BaseException, file: Path) -> str:
    if isinstance(error, SyntaxError):
        return f"{error.filename}:{error.lineno}: {error.msg}"
    place, line = place_of(error, file.parent) or (file, 1)
    return f"{place}:{line}: {type(error).__name__}: {error}"


def place_of(error: BaseException, folder: Path) -> tuple[Path, int] | None:
    """Return the innermost line of a file in *folder* in the traceback of *error*, or None."""
    found = None
    step = error.__traceback__
    while step is not None:
        file = Path(step.tb_frame.f_code.co_filename)
        if file.is_relative_to(folder):
            found = (file, step.tb_lineno)
        step = step.tb_next
    return found

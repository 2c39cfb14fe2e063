"""Where a Python file can be changed so that its meaning changes, and how: one place at a time.

Operators: a comparison, an arithmetic operator or a Boolean is replaced by its opposite, a number by another, ``min`` by
``max``, ``break`` by ``continue``; a condition is negated, a statement removed, a value not returned; the first two
arguments of a call are swapped if they look alike, a keyword argument dropped. Not changed, because no test could or should
notice it: docstrings, type hints, `Protocol` bodies, members of enumerations, log calls, f-strings, texts of errors.

The boundary of a comparison (``<`` becomes ``<=``) is changed for whole numbers only: no robot measures exactly its limit.
"""

import ast
import copy
from typing import NamedTuple

OPPOSITES: dict[type[ast.AST], type[ast.AST]] = {
    ast.Lt: ast.GtE,
    ast.LtE: ast.Gt,
    ast.Gt: ast.LtE,
    ast.GtE: ast.Lt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.Mult,
    ast.Pow: ast.Mult,
    ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd,
    ast.And: ast.Or,
    ast.Or: ast.And,
}
BOUNDARIES = {ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt}
OTHER_CALLS = {"min": "max", "max": "min", "any": "all", "all": "any"}
LOGS = {"log", "warn", "warning", "info", "debug", "print"}
UNTESTED_FUNCTIONS = {"__repr__", "__str__"}
UNTESTED_DECORATORS = {"overload", "abstractmethod"}
UNTESTED_ARGUMENTS = {"strict", "repr", "compare"}
UNTESTED_BASES = {"Protocol", "Enum", "IntEnum", "StrEnum", "Flag", "TypedDict"}


class Mutant(NamedTuple):
    """A change of a file.

    Attributes:
        file: name of the file.
        line: where it changes, from 1.
        last_line: the last line that is replaced.
        operator: kind of the change.
        start: offset of the first byte that is replaced.
        end: offset after the last one.
        text: the replacement.
        functions: name and first line of the functions around it, the outermost first; empty for code that runs on import.
    """

    file: str
    line: int
    last_line: int
    operator: str
    start: int
    end: int
    text: str
    functions: tuple[tuple[str, int], ...]

    def apply(self, source: bytes) -> bytes:
        """Return the changed source."""
        return source[: self.start] + self.text.encode() + source[self.end :]


def mutants_of(file: str, source: bytes) -> list[Mutant]:
    """Return all mutants of a file, in the order of its lines."""
    finder = _Finder(file, source)
    finder.visit(ast.parse(source))
    return sorted(finder.found, key=lambda each: (each.start, each.operator, each.text))


class _Finder(ast.NodeVisitor):
    """Visits all nodes that may change."""

    def __init__(self, file: str, source: bytes) -> None:
        self.found: list[Mutant] = []
        self._file = file
        self._starts = [0]
        for line in source.splitlines(keepends=True):
            self._starts.append(self._starts[-1] + len(line))
        self._functions: list[tuple[str, int]] = []

    def _replace(self, node: ast.expr | ast.stmt, operator: str, new: ast.AST | str) -> None:
        start = self._starts[node.lineno - 1] + node.col_offset
        end = self._starts[(node.end_lineno or 0) - 1] + (node.end_col_offset or 0)
        text = new if isinstance(new, str) else ast.unparse(new)
        place = node.lineno, node.end_lineno or node.lineno, operator, start, end, text
        self.found.append(Mutant(self._file, *place, tuple(self._functions)))

    # ---- definitions

    def _function(self, node: ast.FunctionDef | ast.AsyncFunctionDef) -> None:
        names = {_name(each) for each in node.decorator_list}
        if node.name in UNTESTED_FUNCTIONS or names & UNTESTED_DECORATORS:
            return
        for each in (*node.args.defaults, *node.args.kw_defaults):
            if each is not None:
                self.visit(each)
        first = min((each.lineno for each in node.decorator_list), default=node.lineno)
        self._functions.append((node.name, first))
        for statement in node.body:
            self.visit(statement)
        self._functions.pop()

    visit_FunctionDef = visit_AsyncFunctionDef = _function  # noqa: N815

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        if not {_name(each) for each in node.bases} & UNTESTED_BASES:
            for statement in node.body:
                self.visit(statement)

    def visit_If(self, node: ast.If) -> None:
        if _name(node.test) == "TYPE_CHECKING" or "__name__" in ast.unparse(node.test):
            return
        self._negate(node.test)
        self.generic_visit(node)

    # ---- statements

    def _statement(self, node: ast.stmt) -> None:
        self._replace(node, "removed statement", "pass")
        self.generic_visit(node)

    visit_Delete = _statement  # noqa: N815

    def visit_Break(self, node: ast.Break) -> None:
        self._statement(node)
        self._replace(node, "break, continue", "continue")

    def visit_Continue(self, node: ast.Continue) -> None:
        self._statement(node)
        self._replace(node, "break, continue", "break")

    def visit_Expr(self, node: ast.Expr) -> None:
        value = node.value.value if isinstance(node.value, ast.Await) else node.value
        if isinstance(value, ast.Call) and _name(value).lstrip("_") not in LOGS:
            self._statement(node)

    def visit_Assign(self, node: ast.Assign) -> None:
        if _name(node.targets[0]).startswith("__"):
            return
        self._assignment(node, node.targets[0])
        self.visit(node.value)

    def visit_AugAssign(self, node: ast.AugAssign) -> None:
        self._replace(node, "removed statement", "pass")
        changed = _with_opposite(node, "op")
        if changed is not None and not _is_text(node.value):
            self._replace(node, "arithmetic", changed)
        self.visit(node.value)

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        if node.value is not None and _name(node.annotation) != "TypeAlias":
            self._assignment(node, node.target)
            self.visit(node.value)

    def _assignment(self, node: ast.stmt, target: ast.expr) -> None:
        """Remove an assignment, but not the first one, without which the attribute does not exist."""
        first = self._functions and self._functions[-1][0] in ("__init__", "__post_init__", "__new__")
        if isinstance(target, ast.Attribute | ast.Subscript) and not first:
            self._replace(node, "removed statement", "pass")

    def visit_Return(self, node: ast.Return) -> None:
        if node.value is None:
            self._replace(node, "removed statement", "pass")
            return
        if not isinstance(node.value, ast.Constant):
            self._replace(node, "returned value", "return None")
        self.visit(node.value)

    def visit_Raise(self, node: ast.Raise) -> None:
        self._replace(node, "removed statement", "pass")

    def visit_Assert(self, node: ast.Assert) -> None:
        pass

    def visit_While(self, node: ast.While) -> None:
        self._negate(node.test)
        self.generic_visit(node)

    # ---- expressions

    def visit_JoinedStr(self, node: ast.JoinedStr) -> None:
        pass

    def visit_Subscript(self, node: ast.Subscript) -> None:
        if self._functions or not isinstance(node.ctx, ast.Load):  # elsewhere it is most often a type
            self.generic_visit(node)

    def visit_Call(self, node: ast.Call) -> None:
        name = _name(node)
        if name.lstrip("_") in LOGS:
            return
        if name in ("isinstance", "issubclass", "cast"):
            self.visit(node.args[1 if name == "cast" else 0])
            return
        if isinstance(node.func, ast.Name) and name in OTHER_CALLS:
            self._replace(node.func, "call", OTHER_CALLS[name])
        else:
            self._change_arguments(node)
        self.generic_visit(node)

    def _change_arguments(self, node: ast.Call) -> None:
        if len({type(each) for each in node.args[:2]} - {ast.Starred}) == 1 < len(node.args):
            swapped = copy.deepcopy(node)
            swapped.args[:2] = reversed(swapped.args[:2])
            if ast.dump(swapped) != ast.dump(node):
                self._replace(node, "swapped arguments", swapped)
        for place, each in enumerate(node.keywords):
            if each.arg is not None and each.arg not in UNTESTED_ARGUMENTS:
                fewer = copy.deepcopy(node)
                del fewer.keywords[place]
                self._replace(node, "dropped argument", fewer)

    def visit_IfExp(self, node: ast.IfExp) -> None:
        self._negate(node.test)
        self.generic_visit(node)

    def visit_comprehension(self, node: ast.comprehension) -> None:
        for test in node.ifs:
            self._negate(test)
        self.generic_visit(node)

    def visit_Compare(self, node: ast.Compare) -> None:
        for place, operator in enumerate(node.ops):
            kinds = [OPPOSITES[type(operator)]]
            if type(operator) in BOUNDARIES and any(map(_is_whole, (node.left, *node.comparators))):
                kinds.append(BOUNDARIES[type(operator)])
            for kind in kinds:
                changed = copy.deepcopy(node)
                changed.ops[place] = kind()  # type: ignore[call-overload]
                self._replace(node, "comparison", changed)
        self.generic_visit(node)

    def visit_BinOp(self, node: ast.BinOp) -> None:
        changed = _with_opposite(node, "op")
        is_type = isinstance(node.op, ast.BitOr | ast.BitAnd) and not self._functions
        if changed is not None and not is_type and not _is_text(node.left) and not _is_text(node.right):
            self._replace(node, "arithmetic", changed)
        self.generic_visit(node)

    def visit_BoolOp(self, node: ast.BoolOp) -> None:
        changed = _with_opposite(node, "op")
        if changed is not None:
            self._replace(node, "and, or", changed)
        self.generic_visit(node)

    def visit_UnaryOp(self, node: ast.UnaryOp) -> None:
        if isinstance(node.op, ast.Not | ast.USub):
            self._replace(node, "negation", node.operand)
        self.generic_visit(node)

    def visit_Constant(self, node: ast.Constant) -> None:
        value = node.value
        if isinstance(value, bool):
            self._replace(node, "constant", str(not value))
        elif isinstance(value, int):
            self._replace(node, "constant", str(value + 1))
        elif isinstance(value, float):
            self._replace(node, "constant", repr(2.0 * value if value else 1.0))

    def _negate(self, test: ast.expr) -> None:
        """Negate a condition whose own operator is not already replaced by its opposite."""
        simple = isinstance(test, ast.Compare) and len(test.ops) == 1
        if not simple and not isinstance(test, ast.UnaryOp | ast.Constant):
            self._replace(test, "negation", ast.UnaryOp(ast.Not(), test))


def _with_opposite(node: ast.AST, field: str) -> ast.AST | None:
    kind = OPPOSITES.get(type(getattr(node, field)))
    if kind is None:
        return None
    changed = copy.deepcopy(node)
    setattr(changed, field, kind())
    return changed


def _is_whole(node: ast.AST) -> bool:
    """Whether an operand certainly is a whole number."""
    return (isinstance(node, ast.Constant) and type(node.value) is int) or _name(node) == "len"


def _is_text(node: ast.AST) -> bool:
    """Whether an operand is a text or a collection, for which arithmetic has no opposite."""
    constant = isinstance(node, ast.Constant) and isinstance(node.value, str | bytes)
    return constant or isinstance(
        node, ast.JoinedStr | ast.List | ast.Tuple | ast.ListComp | ast.Dict | ast.Set
    )


def _name(node: ast.AST) -> str:
    """Return the last name of an expression: ``log`` for ``self.log(...)``."""
    while isinstance(node, ast.Call | ast.Subscript):
        node = node.func if isinstance(node, ast.Call) else node.value
    return node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "")

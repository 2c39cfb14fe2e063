"""Parse whole files: beliefs, rules, initial goals, plans and directives, with recovery after errors."""

from collections.abc import Callable
from typing import Final, Protocol

from jacaros.agents.language import nodes
from jacaros.agents.language.cursor import CLOSERS, ProgramNames, SyntaxPanic
from jacaros.agents.language.diagnostics import Diagnostic, Fix, SourceFile, Span, fix
from jacaros.agents.language.lexer import Token
from jacaros.agents.language.nodes import UNDECLARED, parts_of
from jacaros.agents.language.plan_parser import CONTROL, PlanParser
from jacaros.agents.language.term_parser import Namespaces

_DIRECTIVE_WORDS: Final = frozenset({"begin", "end", "include", "namespace", "register_function", "offer"})
_STARTS: Final = frozenset({"atom", "variable", "~", "!", "{", "@", "+", "-", "^"})
"""Tokens that may begin a clause."""


class WrongDirective(Exception):
    """Raised when a directive is used wrongly.

    Attributes:
        help: how to use it.
        span: the place, if it is not that of the whole directive.
        code: the kind of the diagnostic.
    """

    def __init__(
        self, message: str, help: str | None = None, span: Span | None = None, code: str = "wrong-directive"
    ) -> None:
        super().__init__(message)
        self.help, self.span, self.code = help, span, code


class Directives(Protocol):
    """Runs the directives of a file (`DirectiveProcessor`, which makes parsers itself); errors go to the parser."""

    def apply(self, parser: "ProgramParser", directive: nodes.Literal, section: nodes.Section) -> None:
        """Run ``{ directive }``, which follows the clauses of *section*."""

    def apply_to_block(
        self, parser: "ProgramParser", directive: nodes.Literal, section: nodes.Section
    ) -> None:
        """Parse the block of ``{ begin directive }`` and add the resulting clauses to *section*."""


class ProgramParser(PlanParser):
    """Parse the clauses of one file."""

    def __init__(
        self,
        file: SourceFile,
        names: ProgramNames,
        diagnostics: list[Diagnostic],
        directives: Directives,
        namespaces: Namespaces | None = None,
        last_dot_optional: bool = False,
    ) -> None:
        super().__init__(file, names, diagnostics)
        self.directives = directives
        self._last_dot_optional = last_dot_optional
        if namespaces is not None:
            self.namespaces = namespaces

    def file_clauses(self) -> nodes.Section:
        """Parse all clauses of the file."""
        section = nodes.Section()
        while self.token.kind != "end":
            if self._at_end_directive():
                self.report("end-without-begin", "`{ end }` without `{ begin ... }`", help="remove it")
                self._take_end_directive()
            else:
                self._recovering(self._clause, section)
        return section

    def block(self, begin: nodes.Literal) -> nodes.Section:
        """Parse the clauses up to ``{ end }``, which is consumed; *begin* is the directive that opened the block."""
        section = nodes.Section()
        while not self._at_end_directive():
            if self.token.kind == "end":
                self.report(
                    "unclosed-block",
                    f"block of `{begin.functor}` without `{{ end }}`",
                    begin.span,
                    f"close it with `{{ end }}`; the file ends at line {self.token.line}",
                )
                return section
            self._recovering(self._clause, section)
        self._take_end_directive()
        return section

    # clauses

    def _recovering(self, read: Callable[[nodes.Section], None], section: nodes.Section) -> None:
        """Parse one clause; after an error, resume at the next one."""
        start = self.index
        self.begin_clause()
        try:
            read(section)
        except SyntaxPanic:
            self._synchronise(start)
        except RecursionError:
            self.report("nested-too-deeply", "nested too deeply", self.span_of(self.tokens[start]))
            self._synchronise(start)

    def _clause(self, section: nodes.Section) -> None:
        kind = self.token.kind
        if kind == "{":
            self._directive(section)
        elif kind == "!":
            self._initial_goal(section)
        elif kind in ("@", "+", "-", "^"):
            section.plans.append(self._plan_clause())
        elif kind in ("atom", "variable", "~", "::", "true", "false"):
            self._belief_or_rule(section)
        else:
            self._no_clause()

    def _no_clause(self) -> None:
        kind = self.token.kind
        if kind == "!!":
            self.fail("wrong-goal", "expected one `!` before an initial goal", help="write `!goal.`")
        if kind == "?":
            self.fail("wrong-goal", "a test goal cannot be an initial goal", help="write `!goal.`")
        if kind in (".", ";"):
            self.report("empty-clause", f"nothing before this `{kind}`", help="remove it")
            self.advance()
            return
        self.unexpected("a belief, a goal or a plan")

    def _initial_goal(self, section: nodes.Section) -> None:
        self.advance()
        goal = self._goal()
        if not isinstance(goal, nodes.Literal):
            self.fail("wrong-goal", "an initial goal cannot be a variable", goal.span)
        self._finish("goal")
        section.goals.append(goal)

    def _belief_or_rule(self, section: nodes.Section) -> None:
        start = self.token
        head = self.operand(formula=True)
        if self.token.kind in ("<-", ":") and not isinstance(head, nodes.InternalAction):
            self.fail(
                "missing-trigger",
                "expected the trigger of a plan",
                self.span_from(start),
                "write a plan as `+!goal : condition <- steps.`; a rule has `:-` in place of `<-`",
            )
        if not isinstance(head, nodes.Literal):
            self._no_belief(head)
        elif self.accept(":-"):
            section.beliefs.append(nodes.Rule(head, self.condition(), span=self.span_from(start)))
            self._finish("rule")
        else:
            section.beliefs.append(head)
            self._finish("belief")

    def _no_belief(self, term: nodes.Term) -> None:
        if isinstance(term, nodes.InternalAction | nodes.FunctionCall):
            self.fail(
                "misplaced-action",
                f"internal action `{term.name}` outside a plan",
                term.span,
                "if it is a step of the plan before, end the step before it with `;`, not `.`",
            )
        self.fail("not-a-belief", "expected a literal as belief", term.span)

    def _plan_clause(self) -> nodes.Plan:
        plan = self.plan()
        _check_context(self, plan.context)
        if self._at_subplans() or (self.token.kind == "{" and self.peek().kind == "}"):
            # Sub-plans may also follow in place of the final '.'.
            plan = nodes.replace(plan, subplans=self._subplans())
            self.accept(".")
            return plan
        self._finish("plan")
        if self._at_subplans() or (self.token.kind == "{" and self.peek().kind == "}"):
            plan = nodes.replace(plan, subplans=self._subplans())
        return plan

    def _subplans(self) -> tuple[nodes.Plan, ...]:
        opener = self.advance()
        section = nodes.Section()
        while self.token.kind not in ("}", "end"):
            self._recovering(self._subplan, section)
        if not self.accept("}"):
            self.report("unclosed-bracket", "unclosed `{` of sub-plans", self.span_of(opener))
        return tuple(section.plans)

    def _subplan(self, section: nodes.Section) -> None:
        if self.token.kind not in ("@", "+", "-", "^"):
            self.unexpected("a plan")
        section.plans.append(self._plan_clause())

    def _final_dot(self, where: str) -> Fix:
        return fix(f"put a `.` at the end of {where}", ".", self.behind(self.previous()))

    def _finish(self, what: str) -> None:
        """Parse the final '.' of a clause. If it is missing and the next line begins a clause, continue there."""
        token = self.token
        if self.accept(".") or (token.kind == "end" and self._last_dot_optional):
            return
        if token.kind == "end":
            self.report("missing-dot", f"{what} without a final `.`", help=self._final_dot("the file"))
        elif self._begins_clause(self.index) or (what != "plan" and token.first and token.kind in _STARTS):
            self.report(
                "missing-dot",
                f"{what} without a final `.` before {_naming(token)}",
                help=self._final_dot(f"line {self.previous().line}"),
            )
        elif token.kind == "," and what in ("belief", "goal"):
            self.fail(
                "wrong-separator", f"expected `.` after a {what}, found `,`", help="write `p(1). p(2).`"
            )
        elif token.kind == ",":
            self.fail(
                "wrong-separator",
                "expected `&` between conditions, found `,`",
                help=fix("write `&` for 'and'", "&"),
            )
        elif token.kind == ";" and what == "rule":
            self.fail(
                "wrong-separator",
                "expected `&` or `|` between conditions, found `;`",
                help=fix("write `|` for 'or'", "|"),
            )
        elif token.kind in CLOSERS.values():
            self.fail("unopened-bracket", f"unmatched `{token.kind}`")
        else:
            self.unexpected("`;` or `.`" if what == "plan" else "`.`")

    # recovery

    def _begins_clause(self, index: int) -> bool:
        """Return whether a clause is likely to begin at *index*, which must be the first token of its line."""
        token = self.tokens[index]
        if not token.first:
            return self.at_plan(index) and token.kind != "@"
        if self.at_plan(index):
            return True
        if token.kind == "{":
            return self.tokens[index + 1].text in _DIRECTIVE_WORDS
        if token.column > 1:
            return False
        if token.kind == "!":
            index += 1
        behind = self.after_literal(index)
        return behind > index and self.tokens[behind].kind in (".", ":-")

    def _synchronise(self, start: int) -> None:
        """Skip past the next final '.', or to the next line that begins a clause."""
        if self.index == start:
            self.advance()
        while self.token.kind != "end":
            if self.token.first and self._begins_clause(self.index):
                return
            if self.advance().kind == ".":
                break
        if self._at_subplans():
            self._subplans()

    # directives

    def _directive(self, section: nodes.Section) -> None:
        opener = self.advance()
        begins = self.token.kind == "atom" and self.token.text == "begin" and self.peek().kind == "atom"
        if begins:
            self.advance()
        if self.token.kind != "atom":
            self.unexpected("the name of a directive")
        directive = self.operand()
        if not isinstance(directive, nodes.Literal):
            self.fail("unknown-directive", "expected a directive", directive.span)
        self.accept(".")
        self.close(opener)
        directive = nodes.replace(directive, span=self.span_from(opener))
        if begins:
            self.directives.apply_to_block(self, directive, section)
        else:
            self.directives.apply(self, directive, section)

    def _at_end_directive(self) -> bool:
        following = self.peek()
        return self.token.kind == "{" and following.text == "end" and following.kind == "atom"

    def _take_end_directive(self) -> None:
        opener = self.advance()
        self.advance()
        if self.token.kind == "}":
            self.advance()
        else:
            self.report("unclosed-bracket", "expected `}` after `{ end`", self.span_of(opener))


def _naming(token: Token) -> str:
    """Describe what begins with *token*."""
    if token.kind in ("@", "+", "-", "^"):
        return "the next plan"
    return {"!": "a goal", "{": "a directive"}.get(token.kind, "the next belief")


def _check_context(parser: ProgramParser, formula: nodes.Term | None) -> None:
    """Report internal actions in a context that act or wait: they cannot be asked whether they hold."""
    for part in () if formula is None else parts_of(formula):
        if isinstance(part, nodes.InternalAction) and _acts(part.name, parser.names):
            message = f"internal action `{part.name}` acts and cannot be in a context"
            parser.report("action-in-context", message, part.span, "move it into the body")


def _acts(name: str, names: ProgramNames) -> bool:
    """Return whether an internal action of the language acts or waits. Those of projects only cause a warning."""
    if name in CONTROL:
        return True
    return name.startswith(".") and names.actions.get(name, UNDECLARED).body_only

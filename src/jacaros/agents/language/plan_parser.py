"""Parse plans, triggers, rules and bodies, and the terms in braces that hold them.

Control statements can also be written as Jason's internal actions: ``.foreach(F, { steps })``.

>>> from jacaros.agents.language.lowering import format_term
>>> from jacaros.agents.language.loader import parse_term
>>> format_term(control_statement(parse_term(".foreach(p(X), { a(X) })")))
'for (p(X)) { a(X) }'
"""

from typing import Final

from jacaros.agents.language import nodes
from jacaros.agents.language.cursor import CLOSERS, SyntaxPanic
from jacaros.agents.language.diagnostics import fix
from jacaros.agents.language.lexer import Token
from jacaros.agents.language.term_parser import TermParser
from jacaros.agents.terms.operators import BINARY

_CONTROL: Final = frozenset({"if", "while", "for"})
_STEP_STARTS: Final = _CONTROL | frozenset(
    {"atom", "variable", "number", "string", "true", "false", "not", "~", "::", "(", "[", "{"}
    | {"!", "!!", "?", "+", "-", "^", "else", "elif", "error"}
)
_CHANGES: Final = frozenset({"+", "-", "-+", "++", "--", "+<", "+>"})
_ENDS: Final = frozenset({".", "}", ")", "]", "{", "<-", "end", "error"})
"""Tokens that may follow a body, and tokens that are reported better by the caller."""
_FORMULA_AFTER_GROUP: Final = frozenset(BINARY) - {"+", "-"}
"""Operators that show that the preceding round brackets held a formula, not a group of steps."""
_BEHIND_HEAD: Final = frozenset({"<-", ".", "{", "}", ")", "]", "end", "error"})


class PlanParser(TermParser):
    """Parse plans, their bodies, and terms in braces."""

    def plan(self, as_term: bool = False) -> nodes.Plan:
        """Parse a plan up to its final '.', which is not consumed.

        *as_term*: the plan is in braces, where label, context and body may be variables.
        """
        start = self.token
        label: nodes.Literal | nodes.Variable | None = None
        trigger = nodes.Trigger("+", "!", nodes.Literal("unreadable"))
        context = goal_condition = None
        try:
            label = self._label(as_term) if start.kind == "@" else None
            trigger = self.trigger()
            context = self._context()
            goal_condition = self._part("goal condition") if self.token.kind == "<:" else None
            self._require_body_or_end()
        except SyntaxPanic:
            # The error has been reported; the body may have more of them.
            self._skip_to_body()
        body = self._plan_body()
        inner: nodes.Body | nodes.Variable = body
        if as_term and len(body.steps) == 1:
            inner = _body_variable(body.steps[0]) or body
        return nodes.Plan(label, trigger, context, inner, goal_condition, span=self.span_from(start))

    def _require_body_or_end(self) -> None:
        """Report a token that cannot follow the head of a plan; a token that begins a line may be the next clause."""
        kind = self.token.kind
        if kind == "," and not self.token.first:
            self.fail(
                "wrong-separator",
                "expected `&` between conditions, found `,`",
                help=fix("write `&` for 'and'", "&"),
            )
        if kind not in _BEHIND_HEAD and not self.token.first and not self.at_plan():
            self.unexpected("`<-` or `.`")

    def _skip_to_body(self) -> None:
        """Skip to the ``<-`` of this plan.

        Raises:
            SyntaxPanic: the plan has no ``<-``.
        """
        while self.token.kind != "<-":
            self.advance()
            if self.token.kind in (".", "end") or (self.token.first and self.at_plan()):
                raise SyntaxPanic

    def trigger(self) -> nodes.Trigger:
        """Parse ``+!g(X)``, ``-b``, ``^!g[state(S)]``; a variable may take the place of the literal."""
        if self.token.kind not in ("+", "-", "^"):
            self.unexpected("a trigger such as `+!goal`")
        start = self.advance()
        kind = self.advance().kind if self.token.kind in ("!", "?") else ""
        if self.token.kind == "!!":
            self.fail(
                "wrong-trigger",
                "expected a trigger with one `!`",
                help="write `+!goal`; `!!` posts a goal in a body",
            )
        if self.token.kind not in ("atom", "variable", "~", "::"):
            self.unexpected("a literal")
        literal = self.operand(formula=True)
        if not isinstance(literal, nodes.Literal | nodes.Variable):
            help = "if the `.` ends a plan, put a blank or a line end after it"
            self.fail("wrong-trigger", "an internal action cannot be a trigger", literal.span, help)
        return nodes.Trigger(start.kind, kind, literal, span=self.span_from(start))

    def _label(self, as_term: bool) -> nodes.Literal | nodes.Variable:
        at = self.advance()
        if self.token.kind == "[":
            annotations = self._annotations()
            # Only needs to differ from the names of other plans.
            return nodes.Literal(
                f"p__a{next(self.names.labels)}", annotations=annotations, span=self.span_from(at)
            )
        if self.token.kind not in ("atom", "variable", "::"):
            self.unexpected("the label of the plan", "wrong-label")
        label = self.operand(formula=True)
        if isinstance(label, nodes.Literal) or (as_term and isinstance(label, nodes.Variable)):
            return label
        what = "expected an atom as label, optionally with annotations"
        return self.fail("wrong-label", what, label.span, "write `@stop[atomic] +!stop <- ...`")

    def _context(self) -> nodes.Term | None:
        if self.token.kind == ":-":
            self.report(
                "wrong-operator",
                "unexpected `:-` in a plan",
                help="write a plan as `+!goal : condition <- steps.`",
            )
            self.advance()
            return self.condition()
        if self.token.kind != ":":
            return None
        if self.peek().kind == "<-":
            colon = self.advance()
            self.forgive(
                "missing-context",
                "missing context after `:`",
                self.span_of(colon),
                fix("remove the `:`, or write `: true`", ""),
            )
            return None
        context = self._part("context")
        while self.token.kind == ":":
            self.report("second-context", "second context of a plan", help="join the conditions with `&`")
            self._part("context")
        return context

    def _part(self, what: str) -> nodes.Term:
        """Parse the condition after ``:`` or ``<:``."""
        sign = self.advance()
        if self.token.kind in ("<-", "<:", ".", "}", "end"):
            self.report("missing-context", f"missing {what} after `{sign.kind}`", self.span_of(sign))
            return nodes.Literal("true", span=self.span_of(sign))
        return self.condition()

    def _plan_body(self) -> nodes.Body:
        arrow = self.token
        if not self.accept("<-"):
            if self.token.kind in ("atom", "!", "!!", "?", "if", "for", "while") and not self.is_slip():
                self.fail(
                    "unexpected-token",
                    f"expected `<-`, found `{arrow.text}`",
                    help="write `<-` before the steps of a plan",
                )
            return nodes.Body(span=self.span_of(arrow))
        if self.token.kind in (".", "}", "end") or self.at_plan():
            self.report(
                "missing-body",
                "missing body after `<-`",
                self.span_of(arrow),
                "write the steps, or remove `<-` if there is nothing to do",
            )
            return nodes.Body(span=self.span_of(arrow))
        body = self.body()
        if self.token.kind == "<-":
            self.fail(
                "second-body",
                "second `<-` in a plan",
                help="if this is a new plan, end the one before it with `.`",
            )
        return body

    # terms in braces

    def braces(self) -> nodes.Term:
        """Parse ``{ }``, ``{ +!g }``, ``{ @l +!g : c <- b }``, ``{ h :- b }`` or ``{ a; !b }``."""
        opener = self.advance()
        self.enter()
        term = self._in_braces()
        if isinstance(term, nodes.PlanTerm | nodes.RuleTerm):
            self.accept(".")
        self.leave()
        self.close(opener)
        return nodes.replace(term, span=self.span_from(opener))

    def _in_braces(self) -> nodes.Term:
        kind, following = self.token.kind, self.peek().kind
        if kind == "^" or (kind in ("+", "-") and following in ("!", "?")) or self.at_plan():
            return self._plan_or_trigger()
        behind = self.after_literal(self.index)
        if behind > self.index and self.tokens[behind].kind == ":-":
            return nodes.RuleTerm(self.rule())
        return nodes.BodyTerm(self.body())

    def _plan_or_trigger(self) -> nodes.Term:
        goal = self.peek().kind in ("!", "?")
        behind = self.after_literal(self.index + (2 if goal else 1))
        if self.token.kind != "@" and self.tokens[behind].kind == "}":
            return nodes.TriggerTerm(self.trigger())
        return nodes.PlanTerm(self.plan(as_term=True))

    def rule(self) -> nodes.Rule:
        """Parse ``head :- body`` without the final '.'."""
        start = self.token
        head = self.operand(formula=True)
        if not isinstance(head, nodes.Literal):
            self.fail("not-a-belief", "expected a literal as the head of a rule", head.span)
        if not self.accept(":-"):
            self.unexpected("`:-`")
        return nodes.Rule(head, self.condition(), span=self.span_from(start))

    # bodies

    def body(self) -> nodes.Body:
        """Parse steps up to the first token that cannot be part of a body; a trailing ``;`` is allowed.

        After an error, parsing resumes after the next ``;`` of the body.
        """
        start = self.token
        nesting = self.nesting
        steps: list[nodes.Step] = []
        while self.token.kind in _STEP_STARTS and not self.at_plan():
            try:
                steps.extend(self._fork())
                if not self._separator():
                    self._require_end()
                    break
            except SyntaxPanic:
                self.nesting = nesting
                if not self._next_statement():
                    break
        return nodes.Body(tuple(steps), span=self.span_from(start) if steps else self.span_of(start))

    def _separator(self) -> bool:
        """Consume the separator of two steps; return False at the end of the body."""
        token = self.token
        if token.kind == ";":
            self.advance()
            if self.token.kind == ";":
                self.report("empty-step", "empty step between two `;`")
                self.advance()
            return True
        if token.kind == ",":
            self.report("wrong-separator", "expected `;` between steps, found `,`")
            self.advance()
            return True
        if self._statement_end == self.index:
            return True  # the ``;`` after a control statement is optional
        if token.kind == "error" or token.kind not in _STEP_STARTS or self.at_plan() or self._at_subplans():
            return False
        self.fail_on_slip()
        self.report(
            "missing-semicolon",
            "missing `;` before this step",
            help="separate steps with `;` and end the last one with `.`",
        )
        return True

    def _require_end(self) -> None:
        """Report a token that can neither continue nor end a body."""
        if self.token.kind not in _ENDS and not self.token.first and not self.at_plan():
            self.unexpected("`;` or `.`")

    def _next_statement(self) -> bool:
        """Recover from an error: skip past the next ``;`` of this body; return False at the bracket that closes the
        body.

        Raises:
            SyntaxPanic: the clause ends first.
        """
        if self.token.kind == "error" and self._torn_statement():
            return True
        in_block = self.unclosed_braces() > 0
        depth = 0
        while self.token.kind not in (".", "end") and not (self.token.first and self.at_plan()):
            kind = self.token.kind
            if kind == ";" and depth == 0:
                self.advance()
                return True
            if kind == "}" and depth == 0 and in_block:
                return False
            if kind in CLOSERS:
                depth += 1
            elif kind in CLOSERS.values():
                depth = max(depth - 1, 0)
            self.advance()
        raise SyntaxPanic

    def _torn_statement(self) -> bool:
        """Skip an unterminated string; return whether the next line continues with a statement.

        The string has swallowed the rest of its line, including any ``;`` and brackets in it.
        """
        self.advance()
        self.torn = True
        return self.token.first and self.token.kind in _STEP_STARTS and not self.at_plan()

    _statement_end = -1
    """Index of the token after the last control statement."""

    def _at_subplans(self) -> bool:
        return self.token.kind == "{" and self.peek().kind in ("+", "-", "^", "@")

    # forks and groups

    def _fork(self, symbol: str = "|||", operator: str = "or") -> list[nodes.Step]:
        """Parse branches joined by *symbol*; ``|&|`` binds tighter than ``|||``."""
        start = self.token
        steps = self._branch(symbol)
        if self.token.kind != symbol:
            return steps
        branches = [nodes.Body(tuple(steps), span=self.span_from(start))]
        while self.accept(symbol):
            first = self.token
            branches.append(nodes.Body(tuple(self._branch(symbol)), span=self.span_from(first)))
        return [nodes.Fork(operator, tuple(branches), span=self.span_from(start))]

    def _branch(self, symbol: str) -> list[nodes.Step]:
        return self._fork("|&|", "and") if symbol == "|||" else self._factor()

    def _factor(self) -> list[nodes.Step]:
        kind = self.token.kind
        if kind in _CONTROL:
            statement = self._statement()
            self._statement_end = self.index
            return [statement]
        if kind == "(" and not self._brackets_hold_formula():
            return self._group()
        if kind == "{":
            term = self.expression()
            if isinstance(term, nodes.BodyTerm):
                return list(term.body.steps)
            step = self._formula_step(term)
        else:
            step = self._step()
        return [] if step is None else [step]

    def _group(self) -> list[nodes.Step]:
        opener = self.advance()
        self.enter()
        if self.token.kind == ")":
            self.report("empty-step", "expected a step, found empty brackets", self.span_of(opener))
        group = self.body()
        self.leave()
        self.close(opener)
        return list(group.steps)

    def _brackets_hold_formula(self) -> bool:
        behind = self.tokens[self.after_brackets(self.index)]
        return behind.kind in _FORMULA_AFTER_GROUP

    # control statements

    def _statement(self) -> nodes.Step:
        start = self.advance()
        self.enter()
        condition = self._condition_of(start)
        body = self._block(start)
        step: nodes.Step
        if start.kind == "if":
            step = self._if(start, condition, body)
        else:
            loop = nodes.While if start.kind == "while" else nodes.For
            step = loop(condition, body, span=self.span_from(start))
        self.leave()
        return step

    def _if(self, start: Token, condition: nodes.Term, then: nodes.Body) -> nodes.If:
        """Parse the rest of an ``if``. A loop reads the chain of ``elif``, then folds it from the end."""
        cases = [(start, condition, then)]
        otherwise: nodes.Body | None = None
        while self.token.kind in ("elif", "else"):
            word = self.advance()
            if word.kind == "else" and self.token.kind == "if":
                self.report(
                    "else-if", "write `elif` for `else if`", self.span_of(word), "elif (condition) { ... }"
                )
                self.advance()
            elif word.kind == "else":
                otherwise = self._block(word)
                break
            cases.append((word, self._condition_of(word), self._block(word)))
        while True:
            word, condition, then = cases.pop()
            step = nodes.If(condition, then, otherwise, span=self.span_from(word))
            if not cases:
                return step
            otherwise = nodes.Body((step,), span=step.span)

    def _condition_of(self, word: Token) -> nodes.Term:
        opener = self.token
        if opener.kind != "(":
            self.fail(
                "missing-condition",
                f"expected `(` and the condition of `{word.kind}`, found {self.found()}",
                help=f"write `{word.kind} (condition) {{ steps }}`",
            )
        self.advance()
        condition = self.condition()
        self.close(opener)
        return condition

    def _block(self, word: Token) -> nodes.Body:
        opener = self.token
        if opener.kind != "{":
            self.unexpected(f"`{{` and the steps of `{word.kind}`", "missing-block")
        self.advance()
        body = self.body()
        self.close(opener)
        return body

    # steps

    def _step(self) -> nodes.Step | None:
        """Parse one simple step; return None for ``true``, which does nothing."""
        start = self.token
        kind = start.kind
        if kind in ("!", "!!"):
            self.advance()
            goal = self._goal()
            return nodes.Achieve(goal, kind == "!!", span=self.span_from(start))
        if kind == "?":
            self.advance()
            formula = self.condition()
            if isinstance(formula, nodes.InternalAction):
                self.report(
                    "tested-action",
                    f"internal action `{formula.name}` cannot be a test goal",
                    formula.span,
                    fix("remove the `?`", "", self.span_of(start)),
                )
            return nodes.Test(formula, span=self.span_from(start))
        if kind in ("+", "-", "^"):
            return self._belief_change()
        if kind in ("else", "elif"):
            self.fail(
                "else-without-if",
                f"`{kind}` without `if`",
                help=self._without_semicolon(),
            )
        return self._formula_step(self.expression())

    def _without_semicolon(self) -> str:
        help, before = "remove the `;` before it", self.previous()
        return fix(help, "", self.span_of(before)) if before.kind == ";" else help

    def _goal(self) -> nodes.Literal | nodes.Variable:
        if self.token.kind not in ("atom", "variable", "~", "::"):
            self.unexpected("a goal")
        mark = self.span_of(self.previous())
        goal = self.operand(formula=True)
        if not isinstance(goal, nodes.Literal | nodes.Variable):
            help = fix("remove the `!`", "", mark)
            self.fail("wrong-goal", "an internal action cannot be a goal", goal.span, help)
        return goal

    def _belief_change(self) -> nodes.BeliefChange:
        start = self.advance()
        operator = start.kind
        while self.token.kind in ("+", "-", "<", ">") and self.token.column == self.previous().end:
            operator += self.advance().kind
        if operator not in _CHANGES:
            self.fail(
                "wrong-belief-change",
                f"unknown operator `{operator}`",
                self.span_from(start),
                "change beliefs with `+b`, `-b` or `-+b`",
            )
        if self.token.kind in ("!", "?", "!!"):
            sign = self.token.kind
            self.report(
                "trigger-in-body",
                f"expected a step, found the trigger `{operator}{sign}`",
                self.span_from(start).to(self.span_of(self.token)),
                f"post a goal with `{sign}g`; drop it with `.drop_desire(g)`",
            )
            self.advance()
        if self.token.kind not in ("atom", "variable", "~", "::", "{"):
            self.unexpected("a belief")
        operand = self.operand(formula=True)
        if isinstance(operand, nodes.TriggerTerm):
            plan = nodes.Plan(None, operand.trigger, None, nodes.Body(span=operand.span), span=operand.span)
            operand = nodes.PlanTerm(plan, span=operand.span)
        allowed = (nodes.Literal, nodes.Variable, nodes.PlanTerm, nodes.RuleTerm)
        if not isinstance(operand, allowed):
            self.report(
                "wrong-belief-change", f"`{operator}` expects a belief, a plan or a rule", operand.span
            )
        return nodes.BeliefChange(operator, operand, span=self.span_from(start))

    def _formula_step(self, term: nodes.Term) -> nodes.Step | None:
        """Convert an expression to a step: an action, an internal action, a relation or a variable."""
        span = term.span
        match term:
            case nodes.Literal("true", ()) if span is not None:
                return None
            case nodes.Literal() | nodes.Variable():
                return nodes.ExternalAction(term, span=span)
            case nodes.InternalAction():
                return control_statement(term) or nodes.Constraint(term, span=span)
            case nodes.Relation():
                return nodes.Constraint(term, span=span)
            case nodes.FunctionCall(name, arguments):
                return nodes.Constraint(nodes.InternalAction(name, arguments, span=span), span=span)
            case nodes.And() | nodes.Or() | nodes.Not():
                return self._condition_as_action(term)
        return self.fail("not-a-step", "expected a step, found a term", span)

    def _condition_as_action(self, term: nodes.Connective) -> nodes.ExternalAction:
        """Warn about a bare condition: the language reads it as an action, but a test is usually meant."""
        word, span = term.operator, term.span
        if span is not None:
            test = "not f" if word == "not" else f"a {word} b"
            message = f"`{word}` is an action of the environment here, not a test"
            self.warn("condition-as-step", message, span, f"to test the condition, write `?({test})`")
        return nodes.ExternalAction(nodes.Literal(word, term.operands, span=span), span=span)


def _body_variable(step: nodes.Step) -> nodes.Variable | None:
    if isinstance(step, nodes.ExternalAction) and isinstance(step.action, nodes.Variable):
        return step.action
    return None


CONTROL: Final = frozenset({".if_then_else", ".foreach", ".loop", ".fork", ".join"})
"""Jason's internal actions that are statements here, and the one that waits for their branches."""


def control_statement(action: nodes.InternalAction) -> nodes.Step | None:
    """Return the statement that an internal action stands for, or None if it is not a control statement.

    ``.if_then_else(F, {..}[, {..}])``, ``.foreach(F, {..})``, ``.loop(F, {..})``, ``.fork(and, {..}, {..})``.
    """
    first, *rest = action.arguments or (None,)
    bodies = [term.body for term in rest if isinstance(term, nodes.BodyTerm)]
    if first is None or not bodies or len(bodies) != len(rest):
        return None
    span = action.span
    match action.name, bodies:
        case ".if_then_else", [then]:
            return nodes.If(first, then, span=span)
        case ".if_then_else", [then, otherwise]:
            return nodes.If(first, then, otherwise, span=span)
        case ".foreach", [body]:
            return nodes.For(first, body, span=span)
        case ".loop", [body]:
            return nodes.While(first, body, span=span)
        case ".fork", [_, _, *_] if isinstance(first, nodes.Literal) and first.functor in ("and", "or"):
            return nodes.Fork(first.functor, tuple(bodies), span=span)
    return None

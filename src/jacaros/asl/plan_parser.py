"""Parse plans, triggers, rules, and the terms in braces that hold them."""

from typing import Final

from jacaros.asl import nodes
from jacaros.asl.body_parser import BodyParser
from jacaros.asl.cursor import SyntaxPanic

_BEHIND_HEAD: Final = frozenset({"<-", ".", "{", "}", ")", "]", "end", "error"})


class PlanParser(BodyParser):
    """Parse plans and terms in braces."""

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
                "wrong-separator", "expected `&` between conditions, found `,`", help="write `&` for 'and'"
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
                "remove the `:`, or write `: true`",
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


def _body_variable(step: nodes.Step) -> nodes.Variable | None:
    """Return the variable that this step consists of, if it does."""
    if isinstance(step, nodes.ExternalAction) and isinstance(step.action, nodes.Variable):
        return step.action
    return None

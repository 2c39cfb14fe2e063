r"""Directives: files that programs include, namespaces, patterns and declarations, and libraries of other systems.

Their contents are built in here (joining and focusing, answers to messages), have a counterpart in our own library
(questions about workspaces), or are not supported (organisations).

>>> is_library("$jacamo/templates/common-cartago.asl"), is_library("robot.asl")
(True, False)

Of the goal patterns, a declarative goal is achieved when its belief holds.

>>> from jacaros.agents.language.lowering import format_plan
>>> from jacaros.agents.language.loader import load_program
>>> program, _ = load_program("robot.asl", "{ begin bdg(at_home) } +!at_home <- drive. { end }")
>>> print(*map(format_plan, program.plans), sep="\n")
+!at_home : at_home.
+!at_home <- drive; ?at_home.
+at_home <- .succeed_goal(at_home).
-!at_home <- !at_home.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import count
from pathlib import Path
from typing import Any, Final, NamedTuple

from jacaros.agents.language import nodes
from jacaros.agents.language.cursor import ProgramNames, SyntaxPanic
from jacaros.agents.language.diagnostics import Diagnostic, SourceFile, Span
from jacaros.agents.language.lowering import fresh_names, lower
from jacaros.agents.language.nodes import is_ground, rebuilt
from jacaros.agents.language.offer_directive import offer_of
from jacaros.agents.language.plan_parser import PlanParser
from jacaros.agents.language.program_parser import ProgramParser, WrongDirective
from jacaros.agents.language.term_parser import Namespaces
from jacaros.agents.terms.unifier import Trail, unify
from jacaros.runtime.files.texts import suggestion

# Shared parts of goal patterns: their arguments, and the plans they add.
#
# A pattern is a function from the clauses of its block to the clauses that replace them. Where patterns are known to
# misbehave in Jason, ours follow the intent of the pattern; each such function says so.


TRUE = nodes.Literal("true")


@dataclass(frozen=True)
class PatternCall:
    """One use of a pattern.

    ``arguments`` belong to the namespace of the block. Their unnamed variables have names, so that one argument may be
    put into several places of one plan. ``number`` differs for each use in a program; ``parse`` parses an argument given
    as text (a trigger or a condition, as its last argument says).
    """

    name: str
    arguments: tuple[nodes.Term, ...]
    span: Span | None
    number: int
    parse: Callable[[str, Callable[[PlanParser], Any], str], Any]

    def literal(self, index: int, what: str) -> nodes.Literal:
        """Return the argument *index*, which has to be a literal."""
        if index >= len(self.arguments):
            raise WrongDirective(f"`{self.name}` expects {what} as argument {index + 1}")
        argument = self.arguments[index]
        if not isinstance(argument, nodes.Literal):
            raise WrongDirective(f"argument {index + 1} of `{self.name}` ({what}) is not a literal")
        return argument

    def at_most(self, count: int) -> None:
        """Reject more than *count* arguments."""
        if len(self.arguments) > count:
            raise WrongDirective(
                f"`{self.name}` expects at most {count} argument{'s' if count > 1 else ''}, found {len(self.arguments)}"
            )

    def plans(self, text: str, **parts: nodes.Node) -> list[nodes.Plan]:
        """Return the plans written in *text*, with *parts* in place of its variables; ``Goal`` is the first argument.

        They have the place of the directive. A part that is ``true`` is left out of a context. A label is the end of the
        name that the plan gets.
        """
        if "Goal" not in parts:
            parts["Goal"] = self.literal(0, "the goal")
        return [rebuilt(plan, lambda node: self._filled(node, parts)) for plan in _template(text)]

    def _filled(self, node: nodes.Node, parts: dict[str, nodes.Node]) -> nodes.Node:
        """Return the part that a variable of a template stands for; other nodes get the place of the directive."""
        match node:
            case nodes.Variable(name, annotations) if name in parts:
                part = parts[name]
                return nodes.replace(part, annotations=annotations) if annotations else part
            case nodes.And(left, right) if right == TRUE:
                return left
            case nodes.Trigger(literal=nodes.Trigger() as given):
                return given
            case nodes.Trigger(literal=literal):
                return nodes.replace(node, span=literal.span)
            case nodes.Plan(label, context=context):
                if isinstance(label, nodes.Literal):
                    label = nodes.replace(label, functor=f"p__{self.name}{self.number}_{label.functor}")
                context = None if context == TRUE else context
                return nodes.replace(node, label=label, context=context, span=self.span)
        return nodes.replace(node, span=self.span)


def _template(text: str) -> tuple[nodes.Plan, ...]:
    parser = PlanParser(SourceFile("a goal pattern", text), ProgramNames(count(1), count(1), count(1)), [])
    plans = []
    while parser.token.kind != "end":
        plans.append(parser.plan())
        parser.advance()
    assert not parser.diagnostics, parser.diagnostics
    return tuple(plans)


def is_about(plan: nodes.Plan, goal: nodes.Literal) -> bool:
    """Return whether *plan* achieves *goal* or handles its failure: both literals may unify."""
    literal = plan.trigger.literal
    return plan.trigger.kind == "!" and isinstance(literal, nodes.Literal) and _may_unify(literal, goal)


def achieves(plan: nodes.Plan, goal: nodes.Literal) -> bool:
    """Return whether *plan* is one for ``+!goal``."""
    return plan.trigger.operator == "+" and is_about(plan, goal)


def _may_unify(left: nodes.Literal, right: nodes.Literal) -> bool:
    """Return whether two literals unify, whatever their annotations."""
    one, other = (lower(nodes.replace(each, annotations=None), fresh_names()) for each in (left, right))
    return unify(one, other, Trail())


def declarative(call: PatternCall, section: nodes.Section) -> nodes.Section:
    """``dg(g)``: the goal is achieved when, and only when, *g* is believed.

    Adds ``+!g : g``, a test ``?g`` at the end of each plan for g (its ``-!g`` plans among them), and ``+g <-
    .succeed_goal(g)``. Jason also treats a goal that is already intended as achieved, which ends the retry of ``bdg``
    and ``bc`` immediately; ours does not.
    """
    call.at_most(1)
    goal = call.literal(0, "the goal")
    plans = [_tested(plan, call) if is_about(plan, goal) else plan for plan in section.plans]
    believed, succeed = call.plans("+!Goal : Goal. +Goal <- .succeed_goal(Goal).")
    return replace(section, plans=[believed, *plans, succeed])


def exclusive(call: PatternCall, section: nodes.Section) -> nodes.Section:
    """``ebdg(g)``: a backtracking declarative goal that tries each plan at most once.

    Plans that were tried are recorded in beliefs ``p__tried(Plan, g)``, which are removed when the goal ends. When no
    plan is left, the goal fails (Jason retries it forever).
    """
    goal = call.literal(0, "the goal")
    plans: list[nodes.Plan] = []
    for plan in section.plans:
        plans.append(_tried_once(plan, len(plans), call) if achieves(plan, goal) else plan)
    inner = declarative(call, replace(section, plans=plans))
    failing, retry = call.plans(
        """-!Goal[error(no_applicable)]
             <- .abolish(p__tried(Any, Goal));
                .fail(error(no_applicable), error_msg("all plans for the goal have been tried")).
           -!Goal <- !Goal.""",
        Any=nodes.Variable("_", unnamed=True, span=call.span),
    )
    *others, succeed = inner.plans
    forget = _steps(failing)[0]
    return replace(inner, plans=[*others, _with_steps(succeed, forget, *_steps(succeed)), failing, retry])


def _steps(plan: nodes.Plan) -> tuple[nodes.Step, ...]:
    assert isinstance(plan.body, nodes.Body)
    return plan.body.steps


def _with_steps(plan: nodes.Plan, *steps: nodes.Step) -> nodes.Plan:
    return nodes.replace(plan, body=nodes.replace(plan.body, steps=steps))


def _tested(plan: nodes.Plan, call: PatternCall) -> nodes.Plan:
    """Return *plan* with a last step that tests its own goal."""
    (tested,) = call.plans("+!Goal <- ?Goal.", Goal=_own_goal(plan))
    return _with_steps(plan, *_steps(plan), *_steps(tested))


def _tried_once(plan: nodes.Plan, index: int, call: PatternCall) -> nodes.Plan:
    """Return *plan* restricted to goals for which it has not been tried."""
    text = "+!Goal : not p__tried(N, Goal) <- +p__tried(N, Goal)."
    (once,) = call.plans(text, Goal=_own_goal(plan), N=nodes.Number(float(index), span=call.span))
    context = once.context
    if context is not None and plan.context is not None:
        context = nodes.And(context, plan.context, span=plan.context.span)
    return nodes.replace(_with_steps(plan, *_steps(once), *_steps(plan)), context=context)


def _own_goal(plan: nodes.Plan) -> nodes.Literal:
    """Return the goal of a plan with the plan's own variables, without annotations."""
    assert isinstance(plan.trigger.literal, nodes.Literal)
    return nodes.replace(plan.trigger.literal, annotations=None)


def sequenced(call: PatternCall, section: nodes.Section) -> nodes.Section:
    """``sga("trigger", "context", g)``: each such event adopts *g*, one goal at a time.

    Waiting goals are kept in order in beliefs ``p__queue(N, g)``; a goal that is already waiting is not queued again.
    Each goal is an intention of its own, and a goal that fails also makes room for the next one. (Jason adopts a waiting
    goal only if its arguments equal those of the goal that ended.)
    """
    call.at_most(3)
    trigger, context = _trigger(call), _context(call)
    goal = call.literal(2, "the goal")
    # The plans are atomic: nothing may happen between asking whether the queue is busy and noting that it is.
    adopted = call.plans(
        """@begin[atomic] +Event : not p__busy(N) & Context <- +p__busy(N); !!p__serve(N, Goal).
           @wait[atomic] +Event : Context <- +>p__queue(N, Goal).
           +!p__serve(N, _0) <- !_0; !!p__next(N).
           -!p__serve(N, _0) <- !!p__next(N); .fail.
           @next[atomic] +!p__next(N) : p__queue(N, _0) <- -p__queue(N, _0); !!p__serve(N, _0).
           @end[atomic] +!p__next(N) <- -p__busy(N).""",
        Event=trigger,
        Context=context,
        Goal=goal,
        N=nodes.Number(float(call.number), span=call.span),
    )
    return replace(section, plans=[*section.plans, *adopted])


def _trigger(call: PatternCall) -> nodes.Trigger:
    """Return the first argument: a trigger as text."""
    argument = call.arguments[0] if call.arguments else None
    if isinstance(argument, nodes.String):
        trigger: nodes.Trigger = call.parse(argument.value, PlanParser.trigger, "trigger")
        return trigger
    raise WrongDirective("argument 1 of `sga` is not a trigger", 'write sga("+order(X)", "true", serve(X))')


def _context(call: PatternCall) -> nodes.Term:
    """Return the second argument: a condition as text."""
    argument = call.arguments[1] if len(call.arguments) > 1 else None
    if not isinstance(argument, nodes.String):
        raise WrongDirective("`sga` expects a context as argument 2", 'write "true" for no context')
    condition: nodes.Term = call.parse(argument.value, PlanParser.condition, "condition")
    return condition


class Recipe(NamedTuple):
    """A pattern that adds plans to those of another one.

    Attributes:
        inner: the pattern of the block.
        adds: the plans that follow.
        wants: the arguments behind the goal, as variables of these plans.
        nests: a second argument names another pattern than *inner*.
    """

    inner: str
    adds: str
    wants: tuple[str, ...] = ()
    nests: bool = False


_WANTED: Final = {
    "Impossible": "the belief that the goal is impossible",
    "Motivation": "the motivation",
}
_RECIPES: Final = {
    # A declarative goal that is retried when a plan fails.
    "bdg": Recipe("dg", "-!Goal : Possible <- !Goal."),
    # Blind commitment, until the goal is believed, whatever fails: a last plan posts it again if no other is applicable.
    "bc": Recipe("bdg", "+!Goal : Possible <- !Goal.", nests=True),
    # The goal fails when it is impossible, and its failure reaches the goal or plan that posted it; the retry of the
    # blind commitment inside does not catch it (in Jason it does).
    "smc": Recipe(
        "bc",
        """-!Goal <- .fail(error(impossible), error_msg("the goal is believed to be impossible")).
           +Impossible <- .fail_goal(Goal).""",
        ("Impossible",),
    ),
    # Losing the motivation ends the goal as if it was achieved.
    "rc": Recipe("bc", "-Motivation <- .succeed_goal(Goal).", ("Motivation",)),
    "omc": Recipe("smc", "-Motivation <- .succeed_goal(Goal).", ("Impossible", "Motivation")),
    # The goal holds initially, and is pursued again whenever it is lost.
    "mg": Recipe("bc", "-Goal <- !Goal.", nests=True),
}
_WRITTEN: Final = {"dg": declarative, "ebdg": exclusive, "sga": sequenced}
PATTERNS: Final = (*_WRITTEN, *_RECIPES)
"""The names of all goal patterns."""


def apply_pattern(call: PatternCall, section: nodes.Section) -> nodes.Section:
    """Return the clauses that replace *section*, those of the block of a pattern.

    Raises:
        WrongDirective: the pattern is used wrongly.
    """
    recipe = _RECIPES.get(call.name)
    if recipe is None:
        if call.name not in _WRITTEN:
            raise WrongDirective(f"unknown pattern `{call.name}`", f"use one of {', '.join(PATTERNS)}")
        return _WRITTEN[call.name](call, section)
    call.at_most(1 + len(recipe.wants) + recipe.nests)
    wanted = {name: call.literal(place, _WANTED[name]) for place, name in enumerate(recipe.wants, 1)}
    impossible = wanted.get("Impossible")
    possible = TRUE if impossible is None else nodes.Not(impossible, span=call.span)
    return _cooked(call.name, call, section, {**wanted, "Possible": possible})


def _cooked(
    name: str, call: PatternCall, section: nodes.Section, parts: dict[str, nodes.Node]
) -> nodes.Section:
    if name == "dg":
        return declarative(replace(call, arguments=call.arguments[:1]), section)
    recipe, goal = _RECIPES[name], call.literal(0, "the goal")
    if name == call.name and recipe.nests and len(call.arguments) > 1:
        written = call.literal(1, "a pattern")
        arguments = written.arguments or (goal,)
        inner = apply_pattern(replace(call, name=written.functor, arguments=arguments), section)
    else:
        inner = _cooked(recipe.inner, call, section, parts)
    beliefs = [goal] if name == "mg" and is_ground(goal) else []
    plans = call.plans(recipe.adds, **parts)
    return replace(inner, beliefs=[*beliefs, *inner.beliefs], plans=[*inner.plans, *plans])


_ROOTS: Final = frozenset(
    {"$jacamo", "$jacamoJar", "$jason", "$jasonJar", "$moise", "$moiseJar", "$cartago", "$cartagoJar"}
)
_KNOWN: Final = frozenset(
    {"common.asl", "dynamic-focus.asl", "kqmlPlans.asl"}
    | {"tester_agent.asl", "test_assert.asl", "test_manager.asl"}
)
"""Files of them that programs here do not need."""
_ORGANISATIONS: Final = frozenset({"common-moise.asl", "org-obedient.asl", "org-rules.asl", "sai-rules.asl"})
_OURS: Final = {"common-cartago.asl": "common_cartago.asl", "wsp-rules.asl": "common_cartago.asl"}


def is_library(path: str) -> bool:
    """Return whether *path* names a file of one of these systems, as in ``$jacamo/templates/common-cartago.asl``."""
    return path.partition("/")[0] in _ROOTS


# Run the directives of a program: includes, namespaces, functions and goal patterns.


ReadSource = Callable[[str, str], tuple[str, str]]
"""``read(path, including_name) -> (name, text)``: finds an included file; raises FileNotFoundError,
whose text says where it was searched."""

_SIMPLE: Final = ("include", "namespace", "register_function", "offer")
_DEEPEST: Final = 40
"""Maximum depth of includes, so that parsing them does not exhaust Python's stack."""
_MOST_INCLUDES: Final = 10_000
"""Maximum number of includes: 30 files that each include the next one twice would make a thousand million."""


class DirectiveProcessor:
    """The directives of one program with all its files."""

    def __init__(self, read: ReadSource | None, names: ProgramNames, diagnostics: list[Diagnostic]) -> None:
        self._read = read
        self._names = names
        self._diagnostics = diagnostics
        self._open_files: list[str] = []
        self._pattern_numbers = count(1)
        self._warned_of_organisations = False
        self._included = 0

    def read_file(
        self, file: SourceFile, namespaces: Namespaces | None = None, last_dot_optional: bool = False
    ) -> nodes.Section:
        """Parse all clauses of *file* and of its includes."""
        self._open_files.append(file.name)
        parser = ProgramParser(
            file, self._names, self._diagnostics, self, namespaces, last_dot_optional=last_dot_optional
        )
        section = parser.file_clauses()
        self._open_files.pop()
        return section

    def apply(self, parser: ProgramParser, directive: nodes.Literal, section: nodes.Section) -> None:
        """Run a directive without a block."""
        name = directive.functor
        run = {
            "include": self._include,
            "namespace": self._declare_namespace,
            "register_function": self._register,
            "offer": self._offer,
        }.get(name)
        try:
            if run is not None:
                run(parser, directive, section)
            elif name in PATTERNS:
                raise WrongDirective(f"`{name}` expects a block", f"{{ begin {name}(...) }} plans {{ end }}")
            else:
                message = f"unknown directive `{name}`"
                parser.report("unknown-directive", message, directive.span, _meant(name))
        except WrongDirective as wrong:
            _report(parser, directive, wrong)

    def apply_to_block(self, parser: ProgramParser, directive: nodes.Literal, section: nodes.Section) -> None:
        """Parse the block of a directive and add the resulting clauses to *section*."""
        name = directive.functor
        outside = parser.namespaces.current
        try:
            if name == "namespace":
                parser.namespaces.current = self._namespace(parser, directive)
            elif name not in PATTERNS:
                help = f"write `{{ {name}(...) }}` without `begin`" if name in _SIMPLE else _meant(name)
                message = f"unknown directive `{name}` with a block"
                parser.report("unknown-directive", message, directive.span, help)
        except WrongDirective as wrong:
            _report(parser, directive, wrong)
        block = parser.block(directive)
        parser.namespaces.current = outside
        try:
            section.extend(apply_pattern(self._call(parser, directive), block) if name in PATTERNS else block)
        except WrongDirective as wrong:
            _report(parser, directive, wrong)
            section.extend(block)

    # include

    def _include(self, parser: ProgramParser, directive: nodes.Literal, section: nodes.Section) -> None:
        match directive.arguments:
            case (nodes.String(path), *namespace) if len(namespace) <= 1:
                pass
            case _:
                message = "`include` expects the name of a file as a string"
                raise WrongDirective(message, 'write `{ include("file.asl") }`')
        # As in Jason, local namespaces are local to their file.
        namespaces = Namespaces(parser.namespaces.current)
        if namespace:
            namespaces.current = self._include_namespace(parser, namespace[0])
        found = self._find(parser, path, directive)
        if found is not None:
            self._refuse_circles(found, path)
            self._included += 1
            section.extend(self._clauses_of(found, namespaces))

    def _clauses_of(self, file: SourceFile, namespaces: Namespaces) -> nodes.Section:
        """Parse an included file. A library file is the same in all programs that register no functions."""
        if file.name[0] != "$" or namespaces.current is not None or self._names.functions:
            return self.read_file(file, namespaces)
        known = self._names.library
        if file.name not in known:
            known[file.name] = self.read_file(file, namespaces)
        return known[file.name]

    def _refuse_circles(self, found: SourceFile, path: str) -> None:
        if found.name in self._open_files:
            wrong, help = f"file `{path}` includes itself", "break the cycle: files cannot include each other"
        elif len(self._open_files) > _DEEPEST:
            wrong = f"file `{path}` is included more than {_DEEPEST} levels deep"
            help = "include it from a file further up"
        elif self._included >= _MOST_INCLUDES:
            wrong, help = f"program includes more than {_MOST_INCLUDES} files", "include each file once"
        else:
            return
        raise WrongDirective(wrong, help, code="include-circle")

    def _find(self, parser: ProgramParser, path: str, directive: nodes.Literal) -> SourceFile | None:
        """Return the included file; None for most libraries of other systems."""
        try:
            if self._read is None:
                raise FileNotFoundError(path)
            return SourceFile(*self._read(path, parser.file.name))
        except FileNotFoundError as missing:
            if not is_library(path):
                message = f"included file not found: `{path}`"
                raise WrongDirective(message, str(missing), code="include-not-found") from None
        except (OSError, UnicodeError) as error:
            message = f"cannot read the included file `{path}`: {error}"
            raise WrongDirective(message, code="include-not-found") from error
        name = path.rpartition("/")[2]
        if name in _OURS:
            file = Path(__file__).parent / "library" / _OURS[name]
            return SourceFile(f"$jacaros/{file.name}", file.read_text(encoding="utf-8"))
        if name in _ORGANISATIONS:
            self._warn_of_organisations(parser, path, directive)
        elif name not in _KNOWN:
            message = f"unknown library `{path}`: nothing is included"
            parser.warn("unknown-library", message, _place(directive))
        return None

    def _warn_of_organisations(self, parser: ProgramParser, path: str, directive: nodes.Literal) -> None:
        """Warn once per program that organisations are not supported: their libraries are included together."""
        if not self._warned_of_organisations:
            self._warned_of_organisations = True
            message = f"nothing of `{path}` is included: organisations are not supported"
            parser.warn("organisation-library", message, _place(directive))

    def _include_namespace(self, parser: ProgramParser, term: nodes.Term) -> str | None:
        match term:
            case nodes.Literal(name, ()) | nodes.String(name):
                return Namespaces().resolve(name)
            case nodes.Variable(name):
                return f"{name}#{next(self._names.local_namespaces)}"
        parser.report("wrong-directive", "the namespace of an include must be an atom", term.span)
        return None

    # namespaces and functions

    def _declare_namespace(
        self, parser: ProgramParser, directive: nodes.Literal, section: nodes.Section
    ) -> None:
        """Declare a namespace local or global; without a block it stays empty."""
        self._namespace(parser, directive)
        if len(directive.arguments) == 1:
            message = "this directive has no effect without a block"
            help = "write `{ begin namespace(...) } clauses { end }`"
            parser.warn("wrong-directive", message, _place(directive), help)

    def _namespace(self, parser: ProgramParser, directive: nodes.Literal) -> str | None:
        local = parser.namespaces.local
        match directive.arguments:
            case (nodes.Literal(name, ()),):
                pass
            case (nodes.Literal(name, ()), nodes.Literal("local", ())):
                if name not in local:
                    # A name that cannot be written, so that the namespace cannot be reached from outside.
                    local[name] = f"{name}#{next(self._names.local_namespaces)}"
            case (nodes.Literal(name, ()), nodes.Literal("global", ())):
                local.pop(name, None)
            case _:
                message = "`namespace` expects an atom, and optionally `local` or `global`"
                help = "write `{ begin namespace(robot) }` or `{ namespace(robot, local) }`"
                raise WrongDirective(message, help)
        return parser.namespaces.resolve(name)

    def _register(self, parser: ProgramParser, directive: nodes.Literal, section: nodes.Section) -> None:
        match directive.arguments:
            case (nodes.String(name),):
                if self._names.known.get(name) is None:
                    _warn_of_java_function(parser, directive, name)
            case (nodes.String(name) as written, nodes.Number(arity), nodes.String(rule)):
                if "." not in name.strip(".") or name.startswith("."):
                    message = f"function name `{name}` must contain a dot, but not at the beginning"
                    raise WrongDirective(message, "write a name such as `my.sum`", written.span)
                self._names.functions[name] = int(arity)
                function = nodes.RegisteredFunction(name, int(arity), rule, span=directive.span)
                section.functions.append(function)
            case _:
                message = "`register_function` expects a name, a number of arguments and a rule"
                raise WrongDirective(message, '{ register_function("my.sum", 2, "sum") }')

    def _offer(self, parser: ProgramParser, directive: nodes.Literal, section: nodes.Section) -> None:
        offer = offer_of(directive)
        if any((each.what, each.key) == (offer.what, offer.key) for each in section.offers):
            raise WrongDirective(f"the {offer.what} {offer.key} is offered twice", "leave out one of them")
        section.offers.append(offer)

    # patterns

    def _call(self, parser: ProgramParser, directive: nodes.Literal) -> PatternCall:
        def parse(text: str, read: Callable[[PlanParser], Any], what: str) -> Any:
            text_parser = PlanParser(SourceFile(f"`{text}`", text), self._names, [])
            text_parser.namespaces = parser.namespaces
            return _parse_text(text_parser, read, what)

        arguments = tuple(
            self._placed(parser.namespaces, rebuilt(argument, _named)) for argument in directive.arguments
        )
        number = next(self._pattern_numbers)
        return PatternCall(directive.functor, arguments, directive.span, number, parse)

    def _placed(self, namespaces: Namespaces, argument: nodes.Term) -> nodes.Term:
        """Put a goal or belief given to a pattern into the namespace of the block."""
        if isinstance(argument, nodes.Literal) and argument.namespace is None:
            return nodes.replace(argument, namespace=namespaces.of_literal(argument.functor))
        return argument


def _report(parser: ProgramParser, directive: nodes.Literal, wrong: WrongDirective) -> None:
    parser.report(wrong.code, str(wrong), wrong.span or directive.span, wrong.help)


def _warn_of_java_function(parser: ProgramParser, directive: nodes.Literal, name: str) -> None:
    module, _, function = name.rpartition(".")
    parser.warn(
        "java-function",
        f"function `{name}` is written in Java and not available",
        _place(directive),
        f"write it in Python: a function {function} with @arithmetic_function in {module.replace('.', '/')}.py; "
        'or as a rule: { register_function("my.sum", 2, "sum") }',
    )


def _parse_text(parser: PlanParser, read: Callable[[PlanParser], Any], what: str) -> Any:
    """Parse the whole text of *parser* with *read*; an invalid text is an invalid argument of the directive."""
    try:
        result = read(parser)
    except SyntaxPanic:
        result = None
    if result is None or parser.token.kind != "end" or parser.diagnostics:
        reason = parser.diagnostics[0].message if parser.diagnostics else f"unexpected `{parser.token.text}`"
        raise WrongDirective(f"{parser.file.name} is not a {what}: {reason}")
    return result


def _named(node: nodes.Node) -> nodes.Node:
    """Give an unnamed variable a name, so that it means the same in several places of a plan."""
    unnamed = isinstance(node, nodes.Variable) and node.unnamed
    return nodes.replace(node, unnamed=False) if unnamed else node


def _meant(name: str) -> str | None:
    return suggestion(name, [*_SIMPLE, *PATTERNS]) or None


def _place(directive: nodes.Literal) -> Span:
    """Return the place of a directive, which the parser always sets."""
    assert directive.span is not None
    return directive.span

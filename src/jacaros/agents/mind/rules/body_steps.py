"""What the steps of a plan body mean: one function for each kind of formula (rule ExecInt).

``step(agent, frame)`` runs its formula and sets ``frame[0]`` to the next step. It returns None, or one goal (a tuple
that begins with its trigger) to be handled for this intention, or `SUSPENDED`. If the formula does not hold, it returns
`FAILED` or raises an exception before ``frame[0]`` changes, so the failed step is known.

A variable that is bound on one branch only may be unbound afterwards. Variables that one round of a loop binds are
unbound in the next round.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import Any

from jacaros.agents.language import nodes
from jacaros.agents.language.loader import parse_trigger
from jacaros.agents.language.lowering import (
    Reflection,
    Variables,
    fresh_names,
    lower,
    lower_plan,
    lower_trigger,
)
from jacaros.agents.language.nodes import names_in, nodes_in
from jacaros.agents.mind.rules.forks import join_branch
from jacaros.agents.mind.rules.query import answers, collecting
from jacaros.agents.mind.rules.searching import Loop, Remaining, first_answer_of, refuse, run
from jacaros.agents.mind.state.belief_base import has_source, parts
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import FIRST_SLOT, GOAL, PLAN, STEP, Frame, NextStep, variables_of
from jacaros.agents.mind.state.plan import FAILED, Failure, Plan, StepInfo
from jacaros.agents.mind.state.triggers import Trigger, trigger
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.plans import PLAN as PLAN_TERM
from jacaros.agents.terms.plans import RULE, TRIGGERS, body_steps, is_body, step_parts, trigger_parts
from jacaros.agents.terms.substitution import free_variables, resolve
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import (
    ACTION,
    BY_SELF,
    SOURCE,
    Annotated,
    String,
    Term,
    Var,
    annotations_of,
    arguments_of,
    atom,
    bare,
    deref,
    functor,
    functor_of,
    make_list,
    structure,
)
from jacaros.agents.terms.values import PLAN as PLAN_KIND

Next = Callable[[Any, Frame], object] | None


class Step:
    """A step of a plan.

    Attributes:
        plan: whose step it is.
        node: its formula.
        info: what is known of it.
        steps: the same for all steps of the plan, by their names.
        names: the variables that it mentions.
        next: the step behind it; None at the end of the body.
        first: the first steps of the bodies inside it, or what comes behind them where they are empty.
        place: where it keeps in the frame what it needs for itself.
    """

    __slots__ = ("__name__", "first", "info", "names", "next", "node", "place", "plan", "steps")

    def __init__(self, node: nodes.Node, name: str, plan: Plan, steps: dict[str, StepInfo]) -> None:
        self.__name__ = name
        self.plan = plan
        self.node = node
        self.next: Next = None
        self.info = steps[name] = StepInfo(node, "None")
        self.steps = steps
        self.first: tuple[Next, ...] = ()
        self.names: list[str] = []
        self.place = 0

    def __call__(self, agent: Any, frame: Frame) -> object:
        return _MEANING[type(self.node)](self, self.node, agent, frame)

    def go_on_with(self, behind: Next) -> None:
        """Set the step that follows."""
        self.next = behind
        self.info.next = "None" if behind is None else behind.__name__

    def values(self, frame: Frame) -> Variables:
        """The variables that the step mentions; those without a value are made when they are first asked for."""
        return Variables(variables_of(frame, self.names))

    def keep(self, frame: Frame, names: Variables) -> None:
        """Store the variables that the step has bound. Known variables keep their places: a loop around unbinds them."""
        slots = frame[PLAN].slots
        for name in self.names:
            if name in slots and name in names and frame[slots[name]] is None:
                frame[slots[name]] = deref(names[name])

    def go_on(self, frame: Frame, names: Variables, posted: object = None) -> object:
        """The step has succeeded."""
        self.keep(frame, names)
        frame[STEP] = self.next
        return posted


class Round(Step):
    """The beginning of each round of a loop; the step before it sets the loop up."""

    __slots__ = ()

    def __call__(self, agent: Any, frame: Frame) -> None:
        if isinstance(self.node, nodes.While):
            _while_round(self, self.node, agent, frame)
        elif isinstance(self.node, nodes.For):
            _for_round(self, self.node, agent, frame)


class InterpretedBody:
    """The steps of a plan body.

    Attributes:
        first: the first one, or None.
        steps: what is known of each, by name.
        by_name: the steps themselves.
        known: the variables that are bound when the body begins: those of trigger and context.
        extra: number of places that they need in the frame for themselves.
    """

    def __init__(self, plan: Plan) -> None:
        self.steps: dict[str, StepInfo] = {}
        self.extra = 0
        self.by_name: dict[str, Step] = {}
        self.known = names_in(plan.node.trigger, plan.node.context)
        self._plan = plan
        self._behind_variables = FIRST_SLOT + len(plan.slots)
        self._count = 0
        body = plan.node.body
        assert isinstance(body, nodes.Body)
        self.first = self._steps(body.steps, self._name(), None) if body.steps else None

    def _steps(self, formulae: Sequence[nodes.Step], first: str, behind: Next) -> Next:
        """Make the steps for formulae, in order; *first* is the name of the first one."""
        if not formulae:
            return behind
        names = [first, *(self._name() for _ in formulae[1:])]
        steps = [self._made(Step, node, name) for node, name in zip(formulae, names, strict=True)]
        for step, following in zip(steps, [*steps[1:], behind], strict=True):
            step.go_on_with(following)
            self._fill(step, step.node)
        return steps[0]

    def _made(self, kind: type[Step], node: nodes.Node, name: str) -> Step:
        step = self.by_name[name] = kind(node, name, self._plan, self.steps)
        return step

    def _name(self) -> str:
        self._count += 1
        return f"step_{self._count}"

    def _fill(self, step: Step, node: nodes.Node) -> None:
        if isinstance(node, nodes.If):
            step.names = names_in(node.condition)
            then, otherwise = self._name(), self._name()
            other_steps = () if node.otherwise is None else node.otherwise.steps
            step.first = (
                self._steps(node.then.steps, then, step.next),
                self._steps(other_steps, otherwise, step.next),
            )
        elif isinstance(node, nodes.Fork):
            firsts = [self._name() for _ in node.branches]
            step.first = tuple(
                self._steps(branch.steps, first, join_branch)
                for branch, first in zip(node.branches, firsts, strict=True)
            )
        elif isinstance(node, (nodes.While, nodes.For)):
            step.names = names_in(node.condition)
            step.place = self._behind_variables + self.extra
            self.extra += 1
            again, first = self._made(Round, node, self._name()), self._name()
            again.go_on_with(step.next)
            again.names, again.place = step.names, step.place
            again.first = (self._steps(node.body.steps, first, again),)
            step.first = (again,)
        else:
            step.names = names_in(node)


def interpreted(plan: Plan) -> InterpretedBody:
    """Return the steps of a plan, made when first needed."""
    body: InterpretedBody | None = plan.interpreted
    if body is None:
        body = plan.interpreted = InterpretedBody(plan)
        if plan.first is None:
            plan.first, plan.steps, plan.size = body.first, body.steps, len(plan.slots) + body.extra
        if plan.goal_condition is None and plan.node.goal_condition is not None:
            plan.goal_condition = GoalCondition(plan.node.goal_condition)
    return body


class GoalCondition:
    """Tests whether the goal of a frame is achieved, without leaving bindings behind."""

    __slots__ = ("names", "node")

    def __init__(self, node: nodes.Node) -> None:
        self.node, self.names = node, names_in(node)

    def __call__(self, agent: Any, frame: Frame) -> bool:
        """Ask the beliefs."""
        found = holds(agent, self.node, Variables(variables_of(frame, self.names)), agent.trail)
        undo(agent.trail, 0)
        return found


def holds(agent: Any, condition: nodes.Node, names: Variables, trail: Trail) -> bool:
    """Whether a condition has an answer; the bindings of the first one stay."""
    for _ in run(answers(agent, condition, names.__getitem__, trail), agent.options.rule_depth):
        return True
    return False


def _achieve(step: Step, node: nodes.Achieve, agent: Any, frame: Frame) -> object:
    """``!g`` and ``!!g``."""
    names = step.values(frame)
    posted = agent.goal_from("+", "!", lower(node.goal, names.__getitem__), node.separate)
    if node.separate:
        posted = agent.post_separate(posted)
    return step.go_on(frame, names, posted)


def _test(step: Step, node: nodes.Test, agent: Any, frame: Frame) -> object:
    """``?g``: a question to the belief base, or else a goal that a plan may achieve."""
    names = step.values(frame)
    asked = isinstance(node.formula, (nodes.Literal, nodes.Variable))
    if isinstance(node.formula, nodes.Variable):
        wanted = lower(node.formula, names.__getitem__)
        if bare(wanted).__class__ is Var:
            agent.test_goal_from(wanted)  # raises the failure
    if holds(agent, node.formula, names, agent.trail):
        return step.go_on(frame, names)
    if not asked:
        return FAILED
    return step.go_on(frame, names, agent.test_goal_from(lower(node.formula, names.__getitem__)))


def _constraint(step: Step, node: nodes.Constraint, agent: Any, frame: Frame) -> object:
    formula = node.formula
    if isinstance(formula, nodes.InternalAction) and collecting(agent, formula) is None:
        return _internal_action(step, formula, agent, frame)
    names = step.values(frame)
    return step.go_on(frame, names) if holds(agent, formula, names, agent.trail) else FAILED


def _internal_action(step: Step, node: nodes.InternalAction, agent: Any, frame: Frame) -> object:
    names = step.values(frame)
    arguments = [resolve(lower(argument, names.__getitem__)) for argument in node.arguments]
    action = agent.engine.actions.get(node.name)
    if action is None:
        step.keep(frame, names)
        return agent.begin_act(functor(node.name, len(arguments)), tuple(arguments), (), step.next)
    if not action.takes(len(arguments)):
        return refuse(action, len(arguments))
    if action.suspends:
        step.keep(frame, names)
        return agent.finish_call(action.function(agent.context, *arguments), frame, step.next)
    if action.backtracks:
        found = first_answer_of(agent.context, agent.trail, action, *arguments)
    else:
        found = action.function(agent.context, *arguments) is not False
    return step.go_on(frame, names) if found else FAILED


def _belief_change(step: Step, node: nodes.BeliefChange, agent: Any, frame: Frame) -> object:
    """``+b``, ``-b``, ``-+b`` and the like."""
    names = step.values(frame)
    posted = agent.change_mind(node.operator, resolve(lower(node.operand, names.__getitem__)))
    return step.go_on(frame, names, posted)


def _external_action(step: Step, node: nodes.ExternalAction, agent: Any, frame: Frame) -> object:
    """An action of the environment, or what a variable stands for."""
    action = node.action
    names = step.values(frame)
    term = lower(action, names.__getitem__)
    step.keep(frame, names)
    if not isinstance(action, nodes.Literal):
        return agent.run_value(term, frame, step.next)
    annotations = tuple(map(resolve, term.annotations)) if term.__class__ is Annotated else ()
    arguments = tuple(map(resolve, arguments_of(term)))
    return agent.begin_act(functor_of(term), arguments, annotations, step.next)


def _if(step: Step, node: nodes.If, agent: Any, frame: Frame) -> None:
    names = step.values(frame)
    then, otherwise = step.first
    if holds(agent, node.condition, names, agent.trail):
        step.keep(frame, names)
        frame[STEP] = then
    else:
        undo(agent.trail, 0)
        frame[STEP] = otherwise


def _loop(step: Step, frame: Frame) -> Loop:
    """Return what a new loop has to unbind in each round."""
    shared = [c.value for c in nodes_in(nodes.Constant, step.node)]
    slots = frame[PLAN].slots
    held = [frame[slot] for slot in slots.values() if frame[slot] is not None]
    inner = [slots[n] for n in names_in(step.node) if n in slots and frame[slots[n]] is None]
    # `free_variables` takes the first element of a tuple for a functor.
    loop = frame[step.place] = Loop(free_variables((None, *held, *shared)), inner)
    return loop


def _while(step: Step, node: nodes.While, agent: Any, frame: Frame) -> object:
    _loop(step, frame)
    return step.first[0](agent, frame)  # type: ignore[misc]


def _while_round(step: Step, node: nodes.While, agent: Any, frame: Frame) -> None:
    frame[step.place].begin_round(frame)
    names = step.values(frame)
    if holds(agent, node.condition, names, agent.trail):
        step.keep(frame, names)
        frame[STEP] = step.first[0]
    else:
        undo(agent.trail, 0)
        frame[STEP] = step.next


def _for(step: Step, node: nodes.For, agent: Any, frame: Frame) -> object:
    loop = _loop(step, frame)
    slots = frame[PLAN].slots
    wanted = [name for name in step.names if name in slots and slots[name] in loop.inner]
    loop.answers = Remaining(_rounds(node, agent, step.values(frame), wanted))
    return step.first[0](agent, frame)  # type: ignore[misc]


def _rounds(node: nodes.For, agent: Any, names: Variables, wanted: list[str]) -> Iterator[tuple[Term, ...]]:
    """Yield the values of the variables of a ``for`` in each round."""
    trail = Trail()
    trail.serial = agent.trail.serial
    for _ in run(answers(agent, node.condition, names.__getitem__, trail), agent.options.rule_depth):
        bound = [(variable, variable.ref) for variable in trail]
        yield tuple(deref(names[name]) for name in wanted)
        for variable, value in bound:  # the loop unbound them, and the search continues from there
            variable.ref = value


def _for_round(step: Step, node: nodes.For, agent: Any, frame: Frame) -> None:
    loop: Loop = frame[step.place]
    loop.begin_round(frame)
    slots = frame[PLAN].slots
    wanted = [slots[name] for name in step.names if name in slots and slots[name] in loop.inner]
    assert loop.answers is not None
    for values in loop.answers:
        for slot, value in zip(wanted, values, strict=True):
            frame[slot] = value
        loop.round = free_variables((None, *values, *loop.free))
        frame[STEP] = step.first[0]
        return
    frame[step.place] = None
    frame[STEP] = step.next


def _fork(step: Step, node: nodes.Fork, agent: Any, frame: Frame) -> object:
    """``a |&| b`` and ``a ||| b``."""
    return agent.fork(node.operator, frame, step.first, step.next)


_MEANING: dict[type, Callable[..., object]] = {
    nodes.Achieve: _achieve,
    nodes.Test: _test,
    nodes.Constraint: _constraint,
    nodes.BeliefChange: _belief_change,
    nodes.ExternalAction: _external_action,
    nodes.If: _if,
    nodes.While: _while,
    nodes.For: _for,
    nodes.Fork: _fork,
}


# Plans as terms, ``{ +!g : c <- a; b }``, and plan bodies held by variables.
#
# The steps of a body that a variable holds run in a frame above the plan that holds it.


def plan_term(agent: Circumstance, plan: Plan) -> Term:
    """A plan of an agent as a term, with its label and what is known of it."""
    term = lower_plan(plan.node, fresh_names())
    return (term[0], agent.library.label(plan), *term[2:])


def bindings_of(frame: Frame) -> Term:
    """The list ``[map('Var', Value), …]`` of a frame; variables without value are left out."""
    values = ((name, resolve(value)) for name, value in variables_of(frame).items())
    return make_list(
        [
            structure("map", atom(f"'{name}'"), value)
            for name, value in values
            if bare(value).__class__ is not Var
        ]
    )


def trigger_of(term: Term) -> tuple[Trigger | None, Term, str] | None:
    """Trigger object (None when its literal is a variable), literal and operator of a trigger term, or None."""
    term = deref(term)
    if term.__class__ is String:
        term = lower_trigger(parse_trigger(str(term)), fresh_names())
    if term.__class__ is tuple and term[0] in TRIGGERS:
        operator, literal = trigger_parts(term)
    elif is_body(term):
        steps = list(body_steps(term))
        if len(steps) != 1:
            return None
        operator, operands = step_parts(steps[0])
        if operator not in ("+", "-"):
            return None
        literal = operands[0]
    else:
        return None
    symbol = parts(literal)[0]
    return (None if symbol is None else trigger(operator[0], operator[1:], symbol)), literal, operator


def relevant_plans(agent: Circumstance, event: Term) -> list[Plan] | None:
    """Return the plans whose triggers unify with an event, in order; None if it is not a trigger.

    An event without a source stands for events from any source.
    """
    found = trigger_of(event)
    if found is None:
        return None
    symbol, literal, operator = found
    if symbol is None:
        return [p for p in agent.library.plans if p.node.trigger.operator + p.node.trigger.kind == operator]
    literal = resolve(literal)
    annotations = annotations_of(literal)
    if not has_source(annotations):
        literal = Annotated(bare(literal), annotation_set((*annotations, (SOURCE, Var()))))
    return [plan for plan in agent.library.relevant(symbol) if _fits(plan, literal)]


def _fits(plan: Plan, literal: Term) -> bool:
    trail = Trail()
    head = trigger_parts(lower_trigger(plan.node.trigger, fresh_names()))[1]
    fits = unify(head, literal, trail)
    undo(trail, 0)
    return fits


ERROR = functor("error", 1)
_BODY = trigger("+", "", functor("body", 0, namespace="jacaros"))


def is_body_frame(frame: Frame) -> bool:
    """Whether a frame runs a body held by a variable, not a plan of its own."""
    return frame[GOAL][0] is _BODY


def run_value(agent: Circumstance, value: Term, frame: Frame, next_step: NextStep) -> Any:
    """A variable as a body formula: a plan body, or an action."""
    term = resolve(value)
    if is_body(term):
        return _run_body(agent, term, frame, next_step)
    symbol = functor_of(term)
    if symbol is None or symbol in TRIGGERS or symbol in (PLAN_TERM, RULE):
        unknown = bare(term).__class__ is Var
        raise Failure((ERROR, atom("body_var_without_value" if unknown else "body_var_not_literal")))
    if symbol.kind in (ACTION, PLAN_KIND):
        return _run_body(agent, term, frame, next_step)
    return agent.begin_act(symbol, arguments_of(term), annotations_of(term), next_step)  # type: ignore[attr-defined]


def _run_body(agent: Circumstance, term: Term, frame: Frame, next_step: NextStep) -> Any:
    """Run a body held by a variable, on a frame of its own above the plan's."""
    frame[STEP] = next_step
    plan = plan_of_body(agent, term)
    assert agent.current is not None
    if plan.first is not None:
        inner: Frame = [plan.first, (_BODY,), BY_SELF, agent.trail.serial, plan, *([None] * plan.size)]
        agent.current.frames.append(inner)
        return plan.first(agent, inner)
    return None


def plan_of_body(agent: Circumstance, term: Term) -> Plan:
    """A body as a plan; one that is run often is made once."""
    known = agent.library.bodies.get(id(term))
    if known is not None and known[0] is term:
        plan: Plan = known[1]
        return plan
    body = Reflection(shared=True).body(term)
    node = nodes.Plan(None, nodes.Trigger("+", "!", nodes.Literal("body")), None, body)
    plan = Plan(node, atom("body"))
    plan.body_term = term
    plan.keep_all_variables()
    agent.engine.give_steps(plan)
    if len(agent.library.bodies) > 256:
        agent.library.bodies.clear()
    agent.library.bodies[id(term)] = (term, plan)
    return plan

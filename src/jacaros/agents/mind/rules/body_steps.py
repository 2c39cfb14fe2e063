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
from jacaros.agents.language.lowering import Names, lower
from jacaros.agents.language.nodes import names_in, nodes_in
from jacaros.agents.mind.rules.forks import join_branch
from jacaros.agents.mind.rules.query import answers, collecting
from jacaros.agents.mind.rules.searching import Loop, Remaining, first_answer_of, refuse, run
from jacaros.agents.mind.state.intention import FIRST_SLOT, PLAN, STEP, Frame
from jacaros.agents.mind.state.plan import FAILED, Plan, StepInfo
from jacaros.agents.terms.substitution import free_variables, resolve
from jacaros.agents.terms.unifier import Trail, undo
from jacaros.agents.terms.values import Annotated, Term, Var, arguments_of, bare, deref, functor, functor_of

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
        """Run the step."""
        return _MEANING[type(self.node)](self, self.node, agent, frame)

    def go_on_with(self, behind: Next) -> None:
        """Set the step that follows."""
        self.next = behind
        self.info.next = "None" if behind is None else behind.__name__

    def values(self, frame: Frame) -> Names:
        """The variables that the step mentions; those without a value are made when they are first asked for."""
        slots = frame[PLAN].slots
        return Names(
            (name, frame[slots[name]])
            for name in self.names
            if name in slots and frame[slots[name]] is not None
        )

    def keep(self, frame: Frame, names: Names) -> None:
        """Store the variables that the step has bound. Known variables keep their places: a loop around unbinds them."""
        slots = frame[PLAN].slots
        for name in self.names:
            if name in slots and name in names and frame[slots[name]] is None:
                frame[slots[name]] = deref(names[name])

    def go_on(self, frame: Frame, names: Names, posted: object = None) -> object:
        """The step has succeeded."""
        self.keep(frame, names)
        frame[STEP] = self.next
        return posted


class Round(Step):
    """The beginning of each round of a loop; the step before it sets the loop up."""

    __slots__ = ()

    def __call__(self, agent: Any, frame: Frame) -> None:
        """Run the step."""
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
        """Make the steps inside a step."""
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
        slots = frame[PLAN].slots
        values = Names(
            (name, frame[slots[name]])
            for name in self.names
            if name in slots and frame[slots[name]] is not None
        )
        found = holds(agent, self.node, values, agent.trail)
        undo(agent.trail, 0)
        return found


def holds(agent: Any, condition: nodes.Node, names: Names, trail: Trail) -> bool:
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
    """A condition, or an internal action."""
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


def _rounds(node: nodes.For, agent: Any, names: Names, wanted: list[str]) -> Iterator[tuple[Term, ...]]:
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

"""The agent: a mind with a program. It gets input, runs cycles, and reaches out through its architecture."""

from collections.abc import Iterable, Mapping
from typing import Any

from jacaros.agents.language import nodes
from jacaros.agents.language.loader import include_program
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.actions.internal_action import STANDARD, ActionError, InternalAction
from jacaros.agents.mind.rules import (
    belief_update,
    body_steps,
    context,
    cycle,
    deadlines,
    forks,
    goals,
    meta_events,
    needs,
    pending,
    plan_changes,
    query,
    supervision,
)
from jacaros.agents.mind.rules.add_im import Interpreter
from jacaros.agents.mind.rules.context import Context
from jacaros.agents.mind.rules.failure import output_misfit
from jacaros.agents.mind.rules.proc_msg import answer_by_plan
from jacaros.agents.mind.rules.urgency import Fair
from jacaros.agents.mind.state.act import Act, Architecture, Completion, Percept, SpeechAct, message_id
from jacaros.agents.mind.state.belief_base import parts
from jacaros.agents.mind.state.budget import Options
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import STEP, Frame, Intention, NextStep, Posted, Raised
from jacaros.agents.mind.state.pending import ACTION, Need, Waiting, Wanted
from jacaros.agents.mind.state.plan import FAILED, SUSPENDED, Engine, Fail, Failure, OpenFact, Rule
from jacaros.agents.mind.state.plan_library import ProgramPlans
from jacaros.agents.mind.state.triggers import (
    Goal,
    Trigger,
    annotations_of_event,
    apart,
    own_annotations,
    trigger,
)
from jacaros.agents.terms import functions as _functions  # noqa: F401 - fills the table of arithmetic functions
from jacaros.agents.terms.operators import ArithmeticFault
from jacaros.agents.terms.plans import is_body
from jacaros.agents.terms.substitution import free_variables, rename, resolve
from jacaros.agents.terms.unifier import undo, unify
from jacaros.agents.terms.values import (
    BY_SELF,
    Functor,
    Term,
    Var,
    annotations_of,
    arguments_of,
    atom,
    bare,
    functor,
    functor_of,
)
from jacaros.runtime.trace import Cause

# The choice of the engine that runs programs: the rules of the language as written, or generated code.


def new_engine(actions: Mapping[str, InternalAction], plain: bool = False) -> Engine:
    """Return the engine for plans and rules.

    Args:
        actions: the internal actions that plans may call.
        plain: leave out everything that exists only for speed.
    """
    if plain:
        return Interpreter(actions)
    from jacaros.agents.mind.generated.compiler import Compiler  # imported here: a plain run does not need it

    return Compiler(actions)


ERROR = functor("error", 1)


class Mind(Circumstance):
    """A mind.

    Args:
        actions: internal actions; by default the standard ones.
        plans: the plans of the program with the same actions, if another agent has already made them.
    """

    __slots__ = (
        "_acts",
        "_beginning",
        "_ended_at_once",
        "_namespaces",
        "face",
        "messages",
        "program",
    )

    def __init__(
        self,
        name: str,
        program: nodes.Program,
        architecture: Architecture,
        options: Options | None = None,
        actions: Mapping[str, InternalAction] | None = None,
        plans: ProgramPlans | None = None,
    ) -> None:
        known = STANDARD if actions is None else actions
        made = plans or ProgramPlans(program.plans, new_engine(known))
        super().__init__(name, architecture, options or Options(), made)
        self.program = program
        self.context = Context(self)
        self.face: object = None
        self.selections = Fair(self)
        self._acts = 0
        self._beginning = 0
        self._ended_at_once: Completion | None = None
        self.messages = 0
        self._namespaces = 0
        self.register_functions(program.functions)
        plan_changes.look_at_plans(self)

    # --- life ----------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Adopt the initial beliefs and goals."""
        self.engine.begin(self)
        with context.evaluating(self):
            self.take_up(self.program)

    def take_up(self, program: nodes.Program) -> None:
        """Adopt the beliefs and goals of a program."""
        for belief in reversed(program.beliefs):
            try:
                self._initial_belief(belief)
            except ArithmeticFault as fault:
                self._without_value(belief, fault)
        self.adopt(program.goals)
        self.architecture.ready()

    def adopt(self, goals: Iterable[nodes.Literal]) -> None:
        """Adopt the goals of a program."""
        with context.evaluating(self):
            for goal in goals:
                term = self._initial_value(goal)
                if term is not None:
                    self.post_goal(term)

    def _initial_value(self, node: nodes.Literal) -> Term:
        """Return the term of an initial belief or goal; None if it contains an expression without a value."""
        try:
            return lower_value(node)
        except ArithmeticFault as fault:
            self._without_value(node, fault)
            return None

    def _without_value(self, node: nodes.Node, fault: ArithmeticFault) -> None:
        place = f"{node.span.file.name}:{node.span.line}: " if node.span is not None else ""
        self.architecture.log("error", f"{place}cannot evaluate an initial belief or goal: {fault}")

    def include(self, path: str, namespace: str | None = None) -> None:
        """Include a program file at run time, optionally all of it in a namespace.

        Raises:
            FileNotFoundError: the file does not exist.
            AslError: the program has errors.
            ActionError: another plan has the same label.
        """
        read, names = self.architecture.system.read_program, context.known_names(self)
        program = include_program(path, read, names, self.engine.actions, namespace)
        self.register_functions(program.functions)
        plan_changes.include_plans(self, program.plans)
        self.take_up(program)

    def fresh_namespace(self) -> str:
        """Return the name of an unused namespace."""
        self._namespaces += 1
        return f"ns#{self._namespaces}_{self.name}"

    def register_functions(self, declared: tuple[nodes.RegisteredFunction, ...]) -> None:
        """Register the arithmetic functions of a program."""
        for function in declared:
            self.functions.own[function.name] = context.RegisteredFunction(
                function.arity, function.implementation
            )

    def _initial_belief(self, node: nodes.Literal | nodes.Rule) -> None:
        if isinstance(node, nodes.Rule):
            rule = Rule(node, of_program=True)
            head = functor_of(rule.head())
            assert head is not None
            belief_update.add_rule(self, rule, head, last=False)
            return
        term = self._initial_value(node)
        if term is None:
            return
        symbol, _, annotations = parts(term)
        assert symbol is not None
        if free_variables(term):
            own = own_annotations(annotations)
            fact = OpenFact(bare(term), own, node)
            self.beliefs[symbol].add(fact, own)
        else:
            belief_update.tell(self, term)

    def post_goal(self, goal: Term, cause: Cause | None = None) -> None:
        """Adopt a new goal in an intention of its own.

        Args:
            goal: the goal.
            cause: what led to it, outside the agent.
        """
        symbol, arguments, annotations = parts(rename(goal))
        if symbol is None:
            raise ActionError("a goal must be a literal")
        kind = trigger("+", "!", symbol)
        event = ((kind, *arguments), None, own_annotations(annotations), cause)
        deadlines.adopt(self, event)
        self.architecture.ready()

    run = cycle.run

    # --- from outside --------------------------------------------------------------------------------------

    def accept_kill(self, killer: str) -> bool:
        """Return whether another agent may end this one; agent classes of projects may refuse."""
        del killer
        return True

    def accepts(self, message: SpeechAct) -> bool:
        """Return whether a message is acceptable; agent classes of projects may refuse."""
        del message
        return True

    def receive(self, message: SpeechAct) -> None:
        """Receive a message, to be read in a later cycle.

        Raises:
            Failure: the mailbox is full; the step that sends the message fails.
        """
        if len(self.incoming.messages) >= self.options.mailbox_limit:
            raise self.budgets["mailbox_limit"].failure(
                len(self.incoming.messages), f" that {self.name} has not read"
            )
        if self.selections.urgencies is not None:
            self.selections.note_message(message)
        self.incoming.messages.append(message)
        self.incoming.called = True
        self.architecture.ready()

    def perceive(self, percepts: list[Percept]) -> None:
        """Receive changes of the environment; they are taken in before the next cycle."""
        if percepts:
            self.incoming.percepts.append(percepts)
            self.incoming.called = True
            self.architecture.ready()

    has_untaken = belief_update.is_untaken

    def complete(self, act_id: int, completion: Completion) -> None:
        """Handle the end of an external action; ids of acts that are not pending are ignored."""
        if act_id == self._beginning:
            self._beginning, self._ended_at_once = 0, completion
            return
        waiting = self.waits.acts.pop(act_id, None)
        if waiting is None:
            return
        if not completion.success:
            self.waits.needs.pop(act_id, None)
            deadlines.fail(
                self, waiting, "the action failed", (ERROR, atom("action_failed")), *completion.annotations
            )
            return
        misfit = self._take_outputs(completion)
        if misfit is None:
            deadlines.succeed(self, waiting)
        else:
            deadlines.fail(self, waiting, "", *misfit)

    def _take_outputs(self, completion: Completion) -> tuple[Term, ...] | None:
        """Bind the output variables of an act; return the failure if one already has another value."""
        mark = len(self.trail)
        for variable, value in completion.outputs:
            if not unify(variable, value, self.trail):
                misfit = output_misfit(variable, value)
                undo(self.trail, mark)
                return misfit
        del self.trail[mark:]
        return None

    shut_down_in = meta_events.shutting_down
    observe_rest = meta_events.observe_rest  # pyright: ignore[reportAssignmentType]
    drop_wait = deadlines.drop  # pyright: ignore[reportAssignmentType]
    end_above = supervision.end_above  # pyright: ignore[reportAssignmentType]
    end_wait = deadlines.come_true  # pyright: ignore[reportAssignmentType]
    notify_listeners = pending.notify_listeners  # pyright: ignore[reportAssignmentType]

    # --- called by generated code --------------------------------------------------------------------------

    add_belief = belief_update.add_belief
    replace_belief = belief_update.replace_belief
    delete_belief = belief_update.delete_belief
    tell = belief_update.tell
    believe = belief_update.believe
    untell = belief_update.untell
    solve_formula = query.solve_formula
    solve_in_namespaces = query.solve_in_namespaces
    collect_formula = query.collect_formula
    drop_desire = goals.drop_desire
    call_function = context.call_function
    call_own = context.call_own  # pyright: ignore[reportAssignmentType]

    def change_mind(self, operator: str, term: Term) -> Raised:
        """Run a belief operator whose operand is known only at run time: a literal, a plan or a rule.

        Raises:
            Failure: with ``body_var_without_value`` or ``body_var_not_literal``.
        """
        if self.change_plans(operator, term):
            return None
        symbol, row, annotations = parts(term)
        if symbol is None:
            error = "body_var_without_value" if free_variables(term) else "body_var_not_literal"
            raise Failure((ERROR, atom(error)))
        own = own_annotations(annotations)
        if operator in ("-", "--"):
            return self.delete_belief(symbol, row, own, operator == "--")
        if operator == "-+":
            return self.replace_belief(symbol, row, BY_SELF if own == BY_SELF else own)
        return self.add_belief(symbol, row, own, operator == "+>", operator != "++")

    def annotated_goal(
        self, goal: Goal, items: tuple[Term, ...], tail: Term, separate: bool = False
    ) -> Posted:
        """Return a posted goal with annotations."""
        annotations = own_annotations(items, tail)
        if not separate:
            goal = deadlines.supervised(self, self.current, goal, annotations)
        return Posted(goal, annotations)

    def goal_from(self, operator: str, kind: str, term: Term, separate: bool = False) -> Goal | Posted:
        """Return the goal that a term denotes.

        Raises:
            Failure: with ``body_var_without_value`` or ``body_var_not_literal``.
        """
        term = resolve(term)
        symbol = functor_of(term)
        if symbol is None or symbol.kind:
            raise Failure((ERROR, atom(_no_goal(term))))
        goal = (trigger(operator, kind, symbol), *arguments_of(term))
        if not annotations_of(term):
            return goal
        return self.annotated_goal(goal, annotations_of(term), None, separate)

    def test_goal_from(self, term: Term) -> Goal | Posted:
        """Return the test goal for a query known only at run time; fail if no plan handles it."""
        goal = self.goal_from("+", "?", term)
        plain = goal.goal if isinstance(goal, Posted) else goal
        if not self.may_test(plain[0]):
            raise Fail
        return goal

    def may_test(self, kind: Trigger) -> bool:
        """Return whether there is a plan for a test goal of the running intention."""
        if self.library.selects[kind] is not None:
            return True
        current = self.current
        return current is not None and any(
            forks.has_inner(self, frame, kind) for frame in forks.scopes(current)
        )

    def post_separate(self, goal: Goal | Posted) -> None:
        """``!!g``: adopt a new intention that shares no variables with this one."""
        current = self.current
        cause = self.cause_now() or (current.cause if current else None)
        if isinstance(goal, Posted):
            kind, *own = apart((*goal.goal, *annotations_of_event(goal.annotations)))
            arity = len(goal.goal) - 1
            deadlines.adopt(self, ((kind, *own[:arity]), None, tuple(own[arity:]), cause))
        else:
            meta_events.post_new_goal(self, (apart(goal), None, BY_SELF, cause))

    def begin_act(
        self, symbol: Functor, arguments: tuple[Term, ...], annotations: tuple[Term, ...], next_step: NextStep
    ) -> Any:
        """Begin an external action; the intention waits for its completion, unless it has already ended."""
        intention = self.current
        assert intention is not None
        self._acts += 1
        number = self._beginning = self._acts
        act = Act(number, symbol, arguments, annotations, intention.id, intention.cause)
        if self.selections.urgencies is not None or self.atomic is not None or self.waits.needs:
            needs.claim(self, intention, act)
        if self.observers.mind is not None:
            act.cause, act.place = self.cause_now() or act.cause, self.observers.mind.place(intention)
        try:
            self.architecture.act(act)
        finally:
            self._beginning = 0
            completion, self._ended_at_once = self._ended_at_once, None
        if (
            completion is not None
            and completion.success
            and not self.features.meta_plans
            and (not completion.outputs or self._take_outputs(completion) is None)
        ):
            # It would become ready in the next cycle before all others, so make it ready now.
            intention.frames[-1][STEP] = next_step
            return None
        waiting = Waiting(intention, (ACTION, (symbol, *arguments) if arguments else symbol), number)
        waiting.attach(intention.frames[-1], next_step)
        self.waits.acts[number] = waiting
        if completion is not None:
            self.complete(number, completion)
        return SUSPENDED

    def begin_need(self, intention: Intention, frame: Frame, wanted: Wanted) -> bool:
        """Request what a plan or goal needs; return False if the intention waits for it, or has failed."""
        self._acts += 1
        number = self._beginning = self._acts
        act = needs.act_for(self, number, intention, frame, wanted)
        self.waits.needs[number] = Need(number, intention)
        try:
            self.architecture.act(act)
        finally:
            self._beginning = 0
            completion, self._ended_at_once = self._ended_at_once, None
        if completion is not None and completion.success:
            return True
        needs.wait(self, intention, frame, number, wanted)
        if completion is not None:
            self.complete(number, completion)
        return False

    def preempted(self, act_id: int, resource: str) -> None:
        """Handle that a more urgent claim takes a resource away from an act, or from a plan that needs it."""
        self.do_soon(goals.suspend, act_id, resource)
        self.architecture.ready()

    def regained(self, act_id: int) -> None:
        """Handle that the act, or the plan, has the resource again, or no longer waits for it."""
        self.do_soon(goals.resume, act_id)
        self.architecture.ready()

    def finish_call(self, result: Any, frame: Frame, next_step: NextStep) -> Any:
        """Handle the result of an internal action that may suspend: continue, fail, or wait."""
        if result is False:
            return FAILED
        if result is SUSPENDED:
            return SUSPENDED
        if isinstance(result, Waiting) and not (result.ended and result.failure is None):
            result.attach(frame, next_step)
            if result.ended:
                deadlines.announce_end(self, result)
            return SUSPENDED
        if frame in self.current.frames if self.current is not None else False:
            frame[STEP] = next_step
        return None

    run_value = body_steps.run_value

    fork = forks.fork

    # --- plans ---------------------------------------------------------------------------------------------

    add_plan = plan_changes.add_plan
    remove_plan = plan_changes.remove_plan
    change_plans = plan_changes.change_plans
    change_rule = plan_changes.change_rule

    # --- messages ------------------------------------------------------------------------------------------

    def next_message_id(self) -> str:
        """Return an id for a message, unique together with the name of the agent."""
        self.messages += 1
        return message_id(self.messages, self.name)

    test_for = answer_by_plan


def _no_goal(term: Term) -> str:
    """Return the error for a term that is posted as a goal but is not one."""
    if bare(term).__class__ is Var:
        return "body_var_without_value"
    return "body_var_with_op" if is_body(term) else "body_var_not_literal"

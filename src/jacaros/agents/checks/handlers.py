"""Check for plans of goals that nothing posts, and for actions that lack the mark of a goal or internal action.

>>> from jacaros.agents.language.loader import load_program
>>> program, _ = load_program("robot.asl", "!start. +!start <- !go_to(3). +!go_to(X) <- drive(X). -!goto(X).")
>>> [each.help for each in unused_handlers(program, KnownActions({}))]
['did you mean `-!go_to/1`?']
"""

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence, Set
from typing import Final

from jacaros.agents.checks.beliefs import is_misspelt
from jacaros.agents.checks.flow import is_own
from jacaros.agents.checks.formulas import Key, indicator_of, labelled
from jacaros.agents.checks.goals import ON_GOALS, PRINTING, KnownActions
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import Diagnostic, Span, problem
from jacaros.agents.language.nodes import ByKind, names_in, walk
from jacaros.runtime.files.texts import close_matches, did_you_mean

_WORD: Final = re.compile(r"\w+")
_OF_MESSAGES: Final = "kqml_received"
"""The goal that every message posts."""


class Posts:
    """The goals that programs may post, and those that they have plans for.

    Attributes:
        handled: goals with plans ``+!g``.
    """

    def __init__(self, *found: ByKind) -> None:
        triggers = [trigger for each in found for trigger in each.of(nodes.Trigger)]
        self.handled = {key for each in found for key in handled_in(each)}
        calls = [call for each in found for call in each.of(nodes.InternalAction)]
        printed = [call.arguments for call in calls if call.name in PRINTING]
        named = [call.arguments[0] for call in calls if call.name in ON_GOALS and call.arguments]
        steps = [step.action for each in found for step in each.of(nodes.ExternalAction)]
        no_posts = {id(each.literal) for each in triggers} | set(map(id, (*steps, *named, *walk(*printed))))
        self._literals = Counter(
            indicator_of(each) for one in found for each in one.of(nodes.Literal) if id(each) not in no_posts
        )
        self._reacted = {indicator_of(each.literal) for each in triggers if not each.kind}
        texts = [each.value for one in found for each in one.of(nodes.String) if id(each) not in no_posts]
        self._words = {word for text in texts for word in _WORD.findall(text)}

    def may_post(self, goal: Key) -> bool:
        """Return whether a goal is posted, or may be: it appears in a term, or its name in a text."""
        return goal in self._literals or goal[0] in self._words or goal[0] == _OF_MESSAGES

    def appears_only_as(self, facts: Sequence[nodes.Literal]) -> bool:
        """Return whether the name of facts appears nowhere but in these and in plans for the goal of that name."""
        key = indicator_of(facts[0])
        return self._literals[key] == len(facts) and key[0] not in self._words and key not in self._reacted


def handled_in(found: ByKind) -> set[Key]:
    """Return the goals with plans ``+!g``."""
    triggers = found.of(nodes.Trigger)
    return {indicator_of(each.literal) for each in triggers if (each.operator, each.kind) == ("+", "!")}


def unused_handlers(program: nodes.Program, known: KnownActions) -> Iterator[Diagnostic]:
    """Warn of ``-!g`` and ``-?g`` plans for goals that nothing posts and that have no plan."""
    if _is_open(program, known):
        return
    found = program.found
    posts = Posts(found)
    yield from _misspelt_plans(found, posts)
    for plan, literal in _of_goals(found.of(nodes.Plan), "-"):
        trigger, key = plan.trigger, indicator_of(literal)
        asked = any(
            (each.operator, each.kind, indicator_of(each.literal)) == ("+", "?", key)
            for each in found.of(nodes.Trigger)
        )
        if not posts.may_post(key) and key not in posts.handled and not asked:
            meant = _meant(key, posts.handled)
            message = f"no goal `{trigger.kind}{_text(key)}` can fail: nothing posts it, and it has no plan"
            help = did_you_mean(f"-!{_text(each)}" for each in meant) or None
            yield problem("unused-handler", message, trigger.span, help)


def _misspelt_plans(found: ByKind, posts: Posts) -> Iterator[Diagnostic]:
    """Warn of plans for goals that nothing posts, if one of a similar name or another size is posted and has a plan."""
    posted = [step.goal for step in found.of(nodes.Achieve)]
    heads = [each.literal for each in found.of(nodes.Trigger) if each.kind == "!"]
    sizes = Counter(map(indicator_of, heads))
    known = sizes.keys() & map(indicator_of, posted)
    for plan, literal in _of_goals(found.of(nodes.Plan), "+"):
        trigger, key = plan.trigger, indicator_of(literal)
        if trigger.kind != "!" or posts.may_post(key):
            continue
        meant = [f"+!{name}" for name, size in sorted(known) if size == key[1] and is_misspelt(key[0], name)]
        # A plan that begins the rounds of its own goal, as in `+!patrol <- !patrol(1).`, is for others to post. A number
        # of arguments that several plans have, such as `+!make(X)` and `-!make(X)`, is not a slip either.
        steps = ByKind(plan.body, plan.subplans).of(nodes.Achieve)
        if sizes[key] == 1 and key[0] not in {indicator_of(step.goal)[0] for step in steps}:
            meant += [f"+!{_text(each)}" for each in sorted(known) if each[0] == key[0]]
        if meant:
            message = f"nothing posts the goal `!{_text(key)}`"
            yield problem("unused-handler", message, trigger.span, did_you_mean(meant[:1]))


def _of_goals(plans: Iterable[nodes.Plan], operator: str) -> Iterator[tuple[nodes.Plan, nodes.Literal]]:
    """Yield the plans ``+!g`` and ``+?g``, or with ``-``, that are not of a library of JaCaROS, with their goals."""
    for plan in plans:
        is_goal = plan.trigger.operator == operator and plan.trigger.kind
        literal = plan.trigger.literal if is_goal else None
        if isinstance(literal, nodes.Literal) and _is_own(literal):
            yield plan, literal


def _is_own(literal: nodes.Literal) -> bool:
    """Return whether a literal is in the default namespace, and in a file of the project."""
    return literal.namespace is None and is_own(literal)


def _is_open(program: nodes.Program, known: KnownActions) -> bool:
    """Return whether goals or plans come from elsewhere: a plan for any goal, a computed goal, plans added at run time."""
    found = program.found
    return (
        any(isinstance(each.literal, nodes.Variable) and each.kind for each in found.of(nodes.Trigger))
        or any(_computes_goal(plan, in_plan) for plan, in_plan in program.in_plans)
        or any(known.of(call).brings_in for call in found.of(nodes.InternalAction))
    )


def _computes_goal(plan: nodes.Plan, in_plan: ByKind) -> bool:
    """Return whether a plan posts a goal from elsewhere. An argument of its own goal is in the program that posts that."""
    names = {step.goal.name for step in in_plan.of(nodes.Achieve) if isinstance(step.goal, nodes.Variable)}
    return bool(names) and not (plan.trigger.kind == "!" and names.issubset(names_in(plan.trigger.literal)))


def _meant(wanted: Key, handled: Iterable[Key]) -> list[Key]:
    """Return the goals of the same or a similar name."""
    same = sorted(each for each in handled if each[0] == wanted[0])
    close = close_matches(wanted[0], [name for name, _ in handled])
    return same or sorted(each for each in handled if each[0] in close)


def _text(key: Key) -> str:
    return f"{key[0]}/{key[1]}"


def never_posted(
    programs: Sequence[nodes.Program], known: KnownActions, is_project: Callable[[Span], bool]
) -> Iterator[Diagnostic]:
    """Note plans for goals that no agent of a project posts, in files of which *is_project* is true.

    Args:
        programs: all programs of the project.
        known: their internal actions.
        is_project: whether a place is in a file that only this project uses.
    """
    if any(_is_open(each, known) for each in programs):
        return
    posts = Posts(*(each.found for each in programs))
    for plan, literal in _of_goals((plan for each in programs for plan in each.plans), "+"):
        trigger = plan.trigger
        is_test = any(item.functor == "test" for item in labelled(plan))
        if (
            trigger.span is None
            or is_test
            or posts.may_post(indicator_of(literal))
            or not is_project(trigger.span)
        ):
            continue
        goal = f"{trigger.kind}{_text(indicator_of(literal))}"
        help = "post it, offer it to callers with `{ offer(goal, ...) }`, or remove the plan"
        yield problem("goal-never-posted", f"no agent of the project posts `{goal}`", trigger.span, help)


_OFTEN_MEANT: Final = frozenset(
    {"abolish", "broadcast", "concat", "drop_desire", "drop_intention", "fail", "findall", "length", "member"}
    | {"my_name", "nth", "send", "stopMAS", "succeed_goal", "wait"}
)
"""Internal actions without their dots that are not operations of usual artifacts."""


def with_mark(action: Key, handled: Set[Key], known: KnownActions) -> str:
    """Return the goal or internal action that an unknown action probably is; empty if it is neither."""
    if action in handled:
        return f"!{action[0]}"
    internal = known.declared.get(f".{action[0]}")
    return f".{action[0]}" if internal is not None and internal.takes(action[1]) else ""


def facts_for_goals(program: nodes.Program) -> Iterator[Diagnostic]:
    """Warn of initial beliefs that nothing reads, if there is a plan for the goal of that name and nothing posts it.

    A plan may post its own goal again.
    """
    facts: dict[Key, list[nodes.Literal]] = {}
    for belief in program.beliefs:
        if isinstance(belief, nodes.Literal) and _is_own(belief):
            facts.setdefault(indicator_of(belief), []).append(belief)
    heads = [each.trigger for each in program.plans]
    goals = {indicator_of(each.literal) for each in heads if (each.operator, each.kind) == ("+", "!")}
    for key in facts.keys() & goals:
        of_goal = [
            plan
            for plan in program.plans
            if (plan.trigger.kind, indicator_of(plan.trigger.literal)) == ("!", key)
        ]
        others = [plan for plan in program.plans if plan not in of_goal]
        own = ByKind(*of_goal)
        repeated = {id(step.goal) for step in own.of(nodes.Achieve)} | {
            id(each.literal) for each in own.of(nodes.Trigger)
        }
        is_read = any(
            indicator_of(each) == key and id(each) not in repeated for each in own.of(nodes.Literal)
        )
        rest = ByKind(program.beliefs, program.goals, program.offered_goals, tuple(others))
        if not is_read and Posts(rest).appears_only_as(facts[key]):
            message = f"nothing reads the belief `{_text(key)}`, and nothing posts the goal `!{_text(key)}`"
            yield problem("missing-mark", message, facts[key][0].span, did_you_mean([f"!{key[0]}"]))


def bypassed_plans(programs: Sequence[nodes.Program]) -> Iterator[Diagnostic]:
    """Warn of actions, if a plan for the goal of that name handles their failure, and no program posts it."""
    bypassing: list[nodes.Literal] = []
    for program in programs:
        handled = {indicator_of(literal) for _, literal in _of_goals(program.plans, "+")}
        handled &= {indicator_of(literal) for _, literal in _of_goals(program.plans, "-")}
        for plan, in_plan in program.in_plans if handled else ():
            for action in (step.action for step in in_plan.of(nodes.ExternalAction)):
                is_other = indicator_of(action) != indicator_of(plan.trigger.literal)
                if isinstance(action, nodes.Literal) and indicator_of(action) in handled and is_other:
                    bypassing.append(action)
    posts = Posts(*(program.found for program in programs if bypassing))
    for action in bypassing:
        if not posts.may_post(indicator_of(action)):
            name = action.functor
            message = f"`{name}` is the operation, and nothing posts `!{name}`, which handles its failure"
            yield problem("missing-mark", message, action.span, did_you_mean([f"!{name}"]))


def missing_marks(program: nodes.Program, known: KnownActions) -> Iterator[Diagnostic]:
    """Warn of actions, in a program whose artifacts are not known, that are certainly goals or internal actions.

    They are goals if a plan handles the goal of that name, and nothing posts it or the plan is of a library of JaCaROS; a
    plan for a goal may call the operation of the same name.
    """
    posts = Posts(program.found)
    heads = [each.trigger.literal for each in program.plans]
    own = {indicator_of(head) for head in heads if isinstance(head, nodes.Literal) and _is_own(head)}
    for plan, found in program.in_plans:
        of = plan.trigger.literal.functor if isinstance(plan.trigger.literal, nodes.Literal) else ""
        for step in found.of(nodes.ExternalAction):
            action = step.action
            if not isinstance(action, nodes.Literal) or not _is_own(action) or action.functor == of:
                continue
            key = indicator_of(action)
            meant = with_mark(key, posts.handled, known)
            is_goal = meant.startswith("!") and (key not in own or not posts.may_post(key))
            if is_goal or meant[1:] in _OFTEN_MEANT:
                message = f"`{_text(key)}` is an action of the environment: it has no mark of a goal or internal action"
                yield problem("missing-mark", message, step.span, did_you_mean([meant]))

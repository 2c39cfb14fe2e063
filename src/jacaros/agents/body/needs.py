"""Resources that plans of an agent need: claimed, lost, regained and released."""

from collections.abc import Callable, Iterable
from itertools import chain

from jacaros.agents.mind.state.act import Act
from jacaros.agents.terms.values import functor_of, list_items
from jacaros.artifacts.env.environment import Environment
from jacaros.artifacts.env.errors import ArtifactId, OperationFailed
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.artifacts.resources.arbiter import Arbiter
from jacaros.artifacts.resources.claim import POLICIES, Claim, Policy, local_name, read_uses

OnNeed = Callable[[OperationFailed | None], None]
OnPreempted = Callable[[str | None], None]


class HeldNeed:
    """The resources of one plan or goal; a claimant of the arbiter.

    Args:
        arbiter: arbiter of the environment.
        yields: whether they may be pre-empted.
        on_done: called when the plan has all its resources for the first time, or with the reason why it cannot have them.
        on_preempted: called with the resource that the plan has lost, and with None when it has it again or no longer
            waits for it.
    """

    def __init__(self, arbiter: Arbiter, yields: bool, on_done: OnNeed, on_preempted: OnPreempted) -> None:
        self._arbiter, self._on_done, self._on_preempted = arbiter, on_done, on_preempted
        self.can_yield = yields
        self._begun = self._lost = False
        self.claim: Claim

    def ask(self, claim: Claim) -> None:
        """Enter the claim."""
        self.claim = claim
        self._arbiter.enter(claim)

    def granted(self, claim: Claim) -> None:
        """Begin or continue the plan."""
        if not self._begun:
            self._begun = True
            self._on_done(None)
        self._found()

    def preempted(self, claim: Claim, resource: str) -> None:
        """Suspend the intention; its operations give way on their own."""
        self._lose(resource)
        self._arbiter.gave_way(claim)

    def refused(self, claim: Claim, reason: Structure | Atom) -> None:
        """Fail the plan, also if its claim was granted before."""
        name = reason.arguments[0] if isinstance(reason, Structure) else ""
        self._on_done(OperationFailed(f"{claim.who} cannot have {name}", reason))

    def pause(self) -> None:
        """Release the resources while the program suspends the intention."""
        self._arbiter.leave(self.claim)
        self._found()

    def resume(self) -> None:
        """Claim the resources again; the intention continues when they are granted."""
        if not self._arbiter.enter(self.claim) and self._begun:
            self._lose(self.claim.uses[0])

    def end(self) -> None:
        """Release the resources."""
        self._arbiter.leave(self.claim)

    def _lose(self, resource: str) -> None:
        if not self._lost:
            self._lost = True
            self._on_preempted(local_name(resource))

    def _found(self) -> None:
        if self._lost:
            self._lost = False
            self._on_preempted(None)


class Needs:
    """All resources that the plans of one agent need.

    Args:
        agent: name of the agent.
        environment: environment with the resources.
    """

    def __init__(self, agent: str, environment: Environment) -> None:
        self._agent, self._environment = agent, environment
        self._held: dict[int, HeldNeed] = {}

    def __contains__(self, number: object) -> bool:
        return number in self._held

    def __getitem__(self, number: int) -> HeldNeed:
        return self._held[number]

    def claims(self, numbers: Iterable[int]) -> tuple[Claim, ...]:
        """Return the claims of the enclosing acts."""
        return tuple(self._held[number].claim for number in numbers if number in self._held)

    def ask(
        self,
        act: Act,
        focused: Iterable[ArtifactId],
        near: Iterable[ArtifactId],
        on_done: OnNeed,
        on_preempted: OnPreempted,
    ) -> None:
        """Claim the resources of an act.

        Args:
            act: names resources, a policy and a goal.
            focused: artifacts whose resources take precedence.
            near: artifacts in the workspaces that the agent has joined.
            on_done: see `HeldNeed`.
            on_preempted: see `HeldNeed`.

        Raises:
            OperationFailed: ``wrong_resource(Name)`` or ``ambiguous_resource(Name)``.
        """
        names, policy, goal = act.arguments
        wanted = _read(str(each) for each in list_items(names))
        uses = tuple(dict.fromkeys(self._resolved(name, focused, near) for name in wanted))
        need = HeldNeed(self._environment.arbiter, act.yields, on_done, on_preempted)
        self._held[act.id] = need
        who = f"[{self._agent}] {goal}"
        blocks = "" if act.yields else self._agent
        within = self.claims(act.within)
        need.ask(Claim(uses, who, need, act.urgency, _policy(policy), within, self._agent, blocks))

    def forget(self, number: int) -> None:
        """Release the resources of an act."""
        need = self._held.pop(number, None)
        if need is not None:
            need.end()

    def close(self) -> None:
        """Release everything."""
        for number in reversed(tuple(self._held)):
            self.forget(number)

    def _resolved(self, name: str, focused: Iterable[ArtifactId], near: Iterable[ArtifactId]) -> str:
        """Resolve a resource: of a focused artifact, else of a near one, else of the run.

        For a robot without a namespace, ``wheels`` is the full name, whatever other robots there are.
        """
        if "/" in name:
            return name
        for artifacts in (focused, near):
            used = chain.from_iterable(map(self._environment.used_by, artifacts))
            meant = dict.fromkeys(each for each in used if local_name(each) == name)
            if name in meant:
                return name
            if len(meant) > 1:
                raise OperationFailed(
                    f"{name} is ambiguous: {', '.join(meant)}; write the full name as a string",
                    Structure("ambiguous_resource", (Atom(name),)),
                )
            if meant:
                return next(iter(meant))
        return name


def _read(names: Iterable[str]) -> tuple[str, ...]:
    listed = tuple(names)
    try:
        return read_uses(listed)
    except ValueError as wrong:
        raise OperationFailed(str(wrong), Structure("wrong_resource", listed)) from None


def _policy(term: object) -> Policy:
    symbol = functor_of(term)
    name = symbol.name if symbol is not None else ""
    if name not in POLICIES:
        raise OperationFailed(
            f"unknown policy `{name}`: expected one of {', '.join(POLICIES)}",
            Structure("wrong_policy", (Atom(name),)),
        )
    return name

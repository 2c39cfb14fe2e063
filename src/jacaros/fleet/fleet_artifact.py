"""The artifact `fleet` in ``/main``: agents perceive the members of their fleet."""

from collections.abc import Callable, Mapping

from jacaros.artifacts import Artifact, Atom, internal_operation

NAME = "fleet"
"""Name of the artifact."""

States = Mapping[str, tuple[str, float | None]]
"""State of each other member, and the seconds that its clock is ahead of ours; None: not measured yet."""


class Fleet(Artifact):
    """The members of the fleet.

    Properties:
        fleet_member(Name, State): one for each member. State is ``self`` for this system, ``joined``, or ``lost`` while
            a member does not answer. A member that has left has none, and one that is lost for a minute has left.
        fleet_clock(Name, Seconds): seconds that the clock of another member is ahead of the clock of this one. Updated
            when they change by more than 0.1.
    """

    def init(
        self,
        member: str,
        states: Callable[[], States],
        watch: Callable[[Callable[[], None]], Callable[[], None]],
    ) -> None:
        """Show the members, and follow changes."""
        self._states = states
        self._shown: dict[str, tuple[str, float | None]] = {}
        self.define_property("fleet_member", Atom(member), Atom("self"))
        self._show()
        self.on_dispose(watch(lambda: self.start(self._show)))

    @internal_operation
    def _show(self) -> None:
        states = self._states()
        for name in self._shown.keys() - states.keys():
            self._withdraw("fleet_member", name)
            self._withdraw("fleet_clock", name)
        for name, (state, ahead) in states.items():
            self._set("fleet_member", name, Atom(state))
            if ahead is not None:
                self._set("fleet_clock", name, round(ahead, 3))
        self._shown = dict(states)

    def _set(self, what: str, name: str, value: object) -> None:
        if self.has_property(what, Atom(name), None):
            self.update_property(what, Atom(name), value, if_new=True, where=(Atom(name), None))
        else:
            self.define_property(what, Atom(name), value)

    def _withdraw(self, what: str, name: str) -> None:
        if self.has_property(what, Atom(name), None):
            self.remove_property(what, Atom(name), None)

"""What the internal actions of this package ask of the mind that runs them."""

from typing import Protocol

from jacaros.bdi.architecture import Architecture
from jacaros.bdi.intention import Intention
from jacaros.terms.values import Term


class Named(Protocol):
    """The agent on whose behalf an action runs."""

    @property
    def name(self) -> str:
        """Its name in the system."""


class Context(Protocol):
    """The first argument of an internal action: the place in a running mind that it is called from."""

    @property
    def agent(self) -> Named:
        """The agent."""

    @property
    def architecture(self) -> Architecture:
        """Its host."""

    def unify(self, left: Term, right: Term) -> bool:
        """Unify, the annotations of *left* being a subset of those of *right*; a failure binds nothing."""

    def parse_term(self, text: str) -> Term:
        """Read a term; its variables are those of the running plan that have the same names.

        Raises:
            JacarosError: when *text* is no term.
        """

    @property
    def intention(self) -> Intention | None:
        """The intention whose step this is; None in contexts of plans."""

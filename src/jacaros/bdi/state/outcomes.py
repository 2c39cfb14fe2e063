"""How a step of a plan may end otherwise than by going on to the next one."""

from jacaros.terms.values import Term


class Fail(Exception):
    """A formula does not hold: the step fails with the error that goes with its kind."""


class Failure(Fail):
    """A step fails with given annotations.

    Attributes:
        annotations: terms for the failure event, ``error(..)`` among them.
    """

    def __init__(self, *annotations: Term) -> None:
        super().__init__(*annotations)
        self.annotations = annotations


class NextPlan(Exception):
    """Among all applicable plans, one answer of a plan's context is enough."""


SUSPENDED = object()
"""What a step returns when its intention has to wait."""
FAILED = object()
"""What a step returns when its formula does not hold; the same as raising `Fail`, at a tenth of the price."""

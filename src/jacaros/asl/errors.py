"""The error of a program that cannot be taken in."""

from collections.abc import Sequence

from jacaros.asl.diagnostics import Diagnostic, render_all
from jacaros.errors import JacarosError


class AslError(JacarosError):
    """A program with errors.  ``diagnostics`` holds all of them (and the warnings), ``str()`` shows them."""

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        self.diagnostics = tuple(diagnostics)
        super().__init__(render_all(self.diagnostics))

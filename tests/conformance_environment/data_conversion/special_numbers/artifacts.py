"""The artifacts of this case, written from its spec.md."""

import math

from jacaros.artifacts import Artifact, Atom


class Odd(Artifact):
    """Shows odd values."""

    def init(self) -> None:
        for name, value in {
            "nan": math.nan,
            "up": math.inf,
            "down": -math.inf,
            "huge": 10**400,
            "none": None,
        }.items():
            self.define_property("value", Atom(name), value)

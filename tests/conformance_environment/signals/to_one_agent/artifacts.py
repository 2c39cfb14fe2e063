"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, operation


class Bell(Artifact):
    """Rings for one."""

    def init(self) -> None:
        self.define_property("rung", 0)

    @operation
    def ring_for(self, agent: str) -> None:
        rung = self.value("rung") + 1
        self.update_property("rung", rung)
        self.signal_to(agent, "ring", rung)

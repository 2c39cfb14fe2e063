"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, operation


class Ticker(Artifact):
    """Counts, and says so."""

    def init(self, start: int = 0) -> None:
        self.define_property("count", start)

    @operation
    def inc(self) -> None:
        self.update_property("count", self.value("count") + 1)

    @operation(name="tickInc")
    def tick_inc(self) -> None:
        self.inc()
        self.signal("tick", self.value("count"))

    @operation(name="sigFirst")
    def signal_first(self) -> None:
        self.signal("early", 0)
        self.inc()

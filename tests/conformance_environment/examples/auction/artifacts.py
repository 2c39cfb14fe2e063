"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Atom, operation


class Auction(Artifact):
    """Sells one thing to who bids most."""

    def init(self, item: str, start: int) -> None:
        self.define_property("item", item)
        self.define_property("state", Atom("waiting"))
        self.define_property("best", start, Atom("nobody"))

    @operation(name="open")
    def open_it(self) -> None:
        self.update_property("state", Atom("open"))

    @operation
    def close(self) -> None:
        self.update_property("state", Atom("closed"))

    @operation
    def bid(self, who: Atom, price: int) -> None:
        if price <= self.value("best"):
            self.fail("too low", "too_low", price, self.value("best"))
        self.update_property("best", price, who)

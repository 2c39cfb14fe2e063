"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Atom, Out, operation


class TaskBoard(Artifact):
    """Announces tasks, each with a board of its own for the bids."""

    @operation
    async def announce(self, task: str, board: str) -> None:
        await self.workspace.make_artifact(board, ContractBoard)
        self.define_property("task", task, board)


class ContractBoard(Artifact):
    """Takes bids for a while."""

    def init(self) -> None:
        self.define_property("state", "open")
        self.define_property("winner", Atom("none"))
        self._bids: list[list[object]] = []

    @operation
    def bid(self, bidder: Atom, price: int, number: Out) -> None:
        if self.value("state") != "open":
            self.fail("closed", "closed", self.name)
        self._bids.append([len(self._bids) + 1, bidder, price])
        number.set(len(self._bids))

    @operation(name="getBids")
    async def get_bids(self, bids: Out) -> None:
        await self.sleep(0.3)
        self.update_property("state", "closed")
        bids.set(self._bids)

    @operation
    def award(self, number: int) -> None:
        self.update_property("winner", number)

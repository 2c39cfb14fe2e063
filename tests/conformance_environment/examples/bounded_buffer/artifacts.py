"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Atom, Out, operation


class Buffer(Artifact):
    """Has a few places."""

    def init(self, places: int) -> None:
        self._places = places
        self._items: list[tuple[Atom, int]] = []
        self._put: list[tuple[Atom, int]] = []
        self._got: list[tuple[Atom, int]] = []
        self._most = 0

    @operation(guard="has_room")
    def put(self, producer: Atom, number: int) -> None:
        self._items.append((producer, number))
        self._put.append((producer, number))
        self._most = max(self._most, len(self._items))

    def has_room(self, producer: Atom, number: int) -> bool:
        return len(self._items) < self._places

    @operation(guard="has_items")
    def get(self, producer: Out, number: Out) -> None:
        item = self._items.pop(0)
        self._got.append(item)
        producer.set(item[0])
        number.set(item[1])

    def has_items(self, producer: Out, number: Out) -> bool:
        return bool(self._items)

    @operation
    def account(self, put: Out, got: Out, most: Out, in_order: Out) -> None:
        put.set(len(self._put))
        got.set(len(self._got))
        most.set(self._most)
        in_order.set(self._put == self._got)

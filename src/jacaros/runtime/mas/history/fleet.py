"""Records of the members of a fleet."""

from collections.abc import Callable

from msgspec.structs import replace

from jacaros.look.records import records
from jacaros.look.records.records import RecordSink
from jacaros.runtime.mas.fleet import Fleet

_LATER = 0.005
"""Seconds by which a delay or an offset has changed when it is recorded again."""
_SHARE = 0.5
"""Part of a delay by which it has changed as well: that of a long way varies more."""


class FleetRecords:
    """Makes a record ``member`` whenever a member comes, goes or changes.

    Args:
        find: returns the fleet; None before the system has joined one.
        tell: takes the records.
    """

    def __init__(self, find: Callable[[], Fleet | None], tell: RecordSink) -> None:
        self._find, self._tell = find, tell
        self._known: dict[str, records.MemberRecord] = {}

    def watch(self) -> Callable[[], None]:
        """Record also as soon as a member comes or goes. Return a function that ends this."""
        fleet = self._find()
        return (lambda: None) if fleet is None else fleet.watch(self.look)

    def look(self) -> None:
        """Record what has changed. Call it about once a second."""
        fleet = self._find()
        if fleet is None:
            return
        present = {each.member: each for each in fleet.members()}
        for name in [name for name in self._known if name not in present]:
            del self._known[name]
            self._tell(records.MemberRecord(name, "left"))
        for name, member in present.items():
            known = self._known.get(name)
            if known is None or _differ(known, member):
                self._known[name] = member
                self._tell(member)


def _differ(known: records.MemberRecord, now: records.MemberRecord) -> bool:
    if (known.delay is None) != (now.delay is None):
        return True
    if abs(known.offset - now.offset) > _LATER:
        return True
    before, delay = known.delay or 0.0, now.delay or 0.0
    if abs(delay - before) > max(_LATER, _SHARE * before):
        return True
    return replace(known, delay=now.delay, offset=now.offset) != now

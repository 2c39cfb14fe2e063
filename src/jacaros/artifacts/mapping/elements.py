"""One property for each element of an array: what is new is defined, what changed updated, what is gone removed."""

import dataclasses
import itertools

from jacaros.artifacts.kit.reading import Outlet, Reading
from jacaros.artifacts.mapping.declared import TopicPart
from jacaros.artifacts.mapping.extracting import Row
from jacaros.artifacts.mapping.host import Host
from jacaros.clock import Timer
from jacaros.trace import Cause


class Elements:
    """The elements of the newest message, by their keys.

    Args:
        host: the artifact.
        part: what the mapping says.
    """

    def __init__(self, host: Host, part: TopicPart) -> None:
        self._host, self._part = host, part
        self._wanted: dict[object, Row] = {}
        self._shown: dict[object, Row] = {}
        self._seen: dict[object, float] = {}
        self._expiry: Timer | None = None
        self._versions = itertools.count()
        self._coming = False
        policy = dataclasses.replace(part.policy, dead_band=0.0, expire=None)
        outlet = Outlet(behind=lambda: self._coming or host.has_untaken(part.name))
        self._reading = Reading(policy, host.clock, self._deliver, outlet)
        host.at_dispose(self.close)

    def take(self, rows: list[Row], cause: Cause | None) -> None:
        """Take the elements of a message."""
        now, expire = self._host.clock.elapsed, self._part.policy.expire
        new = {row.key: self._kept(row) for row in rows}
        if expire is not None:
            self._seen.update(dict.fromkeys(new, now))
            new = {**self._alive(now, expire), **new}
            if self._expiry is None:
                self._expiry = self._host.clock.call_later(expire, self._look)
        self._want(new, cause)

    def _kept(self, row: Row) -> Row:
        """The row that is shown, if the new one hardly differs."""
        old = self._wanted.get(row.key)
        if old is None or self._part.policy.differ(old.values, row.values):
            return row
        return old

    def _want(self, new: dict[object, Row], cause: Cause | None) -> None:
        if new != self._wanted:
            self._wanted = new
            self._reading.take((next(self._versions),), cause)

    def _deliver(self, values: tuple[object, ...], cause: Cause | None) -> None:
        self._coming = True
        self._host.start(self._host.show_rows, self._part.name, cause=cause)

    def show(self) -> None:
        """Bring the properties up to date, within an operation."""
        self._coming = False
        host, name = self._host, self._part.name
        before, self._shown = self._shown, self._wanted
        for key, row in before.items():
            if key not in self._shown:
                host.remove_property(name, *row.values)
        for key, row in self._shown.items():
            old = before.get(key)
            if old is None:
                host.define_property(name, *row.values, annotations=row.annotations)
            elif old != row:
                host.update_property(name, *row.values, annotations=row.annotations, where=old.values)

    def _alive(self, now: float, expire: float) -> dict[object, Row]:
        """The elements that were seen a short while ago."""
        alive = {
            key: row for key, row in self._wanted.items() if now - self._seen.get(key, now) < expire - 1e-9
        }
        self._seen = {key: at for key, at in self._seen.items() if key in alive or at == now}
        return alive

    def _look(self) -> None:
        expire = self._part.policy.expire
        assert expire is not None
        now = self._host.clock.elapsed
        alive = self._alive(now, expire)
        self._want(alive, None)
        self._expiry = None
        if alive:
            oldest = min(self._seen.get(key, now) for key in alive)
            self._expiry = self._host.clock.call_later(max(0.001, oldest + expire - now), self._look)

    def close(self) -> None:
        """Look no more."""
        self._reading.close()
        if self._expiry is not None:
            self._expiry.cancel()

"""The resources that an operation or plan uses: ``wheels``, ``lift(2)`` (two units) or ``map(shared)`` (readers)."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

_WRITTEN = re.compile(r"([A-Za-z_][A-Za-z0-9_/]*)(?:\((shared|[0-9]+)\))?")

WHEELS = "wheels"
"""The resource that every motion of a robot uses."""


@dataclass(frozen=True, slots=True)
class Use:
    """The use of one resource by a claim.

    Attributes:
        name: name of the resource. One of a robot begins with the robot's name, such as ``/robot_0/wheels``.
        capacity: number of units that exist. None: as declared elsewhere, or 1.
        shared: any number of shared uses are compatible, but none with another use.
        units: number of units that are claimed.
    """

    name: str
    capacity: int | None = None
    shared: bool = False
    units: int = 1

    def __str__(self) -> str:
        inner = "shared" if self.shared else self.capacity
        return self.name if inner is None else f"{self.name}({inner})"


def read_use(text: str) -> Use:
    """Parse one use, such as ``lift(2)``.

    Raises:
        ValueError: *text* is not a use. The message says what to write.
    """
    found = _WRITTEN.fullmatch(text.strip())
    if found is None:
        raise ValueError(f"invalid resource `{text}`; write name, name(2) or name(shared)")
    name, inner = found.groups()
    if inner == "shared":
        return Use(name, shared=True)
    if inner is None:
        return Use(name)
    if int(inner) < 1:
        raise ValueError(f"invalid resource `{text}`: the capacity must be at least 1")
    return Use(name, int(inner))


def read_uses(written: str | Use | Iterable[str | Use]) -> tuple[Use, ...]:
    """Parse the uses of a declaration: one, or several.

    Raises:
        ValueError: one of them is not a use.
    """
    listed = (written,) if isinstance(written, str | Use) else tuple(written)
    return together(each if isinstance(each, Use) else read_use(each) for each in listed)


def together(uses: Iterable[Use]) -> tuple[Use, ...]:
    """Merge uses of the same resource. A resource that is named twice needs two units."""
    found: dict[str, Use] = {}
    for each in uses:
        known = found.get(each.name)
        if known is None:
            found[each.name] = each
            continue
        capacities = [c for c in (known.capacity, each.capacity) if c is not None]
        found[each.name] = Use(
            each.name,
            min(capacities, default=None),
            known.shared and each.shared,
            known.units if known.shared and each.shared else known.units + each.units,
        )
    return tuple(found.values())


def scoped(uses: Sequence[Use], scope: str) -> tuple[Use, ...]:
    """Return the resources of one robot. *scope* is its name, empty for resources of the whole run."""
    return tuple(replace(each, name=f"{scope}/{each.name}") for each in uses) if scope else tuple(uses)


def local_name(name: str) -> str:
    """Return the name of a resource without that of its robot."""
    return name.rpartition("/")[2]

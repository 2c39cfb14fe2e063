"""Names that a package exports, loaded on first use: importing the package alone costs nothing."""

import sys
from collections.abc import Callable, Mapping
from importlib import import_module


def exported(package: str, modules: Mapping[str, str]) -> Callable[[str], object]:
    """Return the ``__getattr__`` of a package.

    Args:
        package: its name.
        modules: the names that each module defines, separated by blanks; ``Plan=PlanView`` exports a name as another.
    """
    places = {
        name.partition("=")[0]: (module, name.rpartition("=")[2])
        for module, names in modules.items()
        for name in names.split()
    }

    def getattr_(name: str) -> object:
        place = places.get(name)
        if place is None:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        module, own_name = place
        value = getattr(import_module(module), own_name)
        setattr(sys.modules[package], name, value)
        return value

    return getattr_

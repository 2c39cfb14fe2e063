"""Switches of the world in the ROS graph: doors and faults."""

from collections.abc import Callable, Mapping
from typing import Any

from jacaros.ros.backend import Backend
from jacaros.ros.errors import UnknownInterface
from jacaros.ros.services import Service
from jacaros.sim.world_time import WorldTime

_TYPE = "std_srvs/srv/SetBool"


class SwitchService:
    """A service of type ``std_srvs/srv/SetBool``; where that type is not installed, log a warning and offer nothing.

    Args:
        time: the world on a clock.
        backend: graph; already started.
        name: name of the service.
        switch: switches on (True) or off; returns why it cannot, or None.
    """

    def __init__(
        self, time: WorldTime, backend: Backend, name: str, switch: Callable[[bool], str | None]
    ) -> None:
        self._time, self._switch = time, switch
        self._service: Service | None = None
        try:
            self._service = backend.service(name, _TYPE, self._answer)
        except UnknownInterface:
            backend.rosout("warn", f"service {name} is not offered: unknown type {_TYPE}")

    def _answer(self, request: Any) -> Mapping[str, Any]:
        self._time.catch_up()
        problem = self._switch(bool(request.data))
        return {"success": problem is None, "message": problem or ""}

    def close(self) -> None:
        """Withdraw the service."""
        if self._service is not None:
            self._service.close()

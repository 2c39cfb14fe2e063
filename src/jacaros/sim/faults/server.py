"""The faults of the world in the graph: a service for each."""

from collections.abc import Mapping
from typing import Any

from jacaros.ros.backend import Backend, Service
from jacaros.ros.errors import UnknownInterface
from jacaros.sim.world_time import WorldTime


class FaultServer:
    """One fault: service ``/faults/NAME`` (``std_srvs/srv/SetBool``: true begins it, false ends it).

    Args:
        time: the world, on a clock.
        name: of the fault.
        backend: the graph; it is started already.
    """

    def __init__(self, time: WorldTime, name: str, backend: Backend) -> None:
        self._time, self._name = time, name
        self._service: Service | None = None
        try:
            self._service = backend.service(f"/faults/{name}", "std_srvs/srv/SetBool", self._set)
        except UnknownInterface:
            backend.rosout("warn", f"no service for the fault {name}: std_srvs/srv/SetBool is not known here")

    def _set(self, request: Any) -> Mapping[str, Any]:
        self._time.catch_up()
        faults = self._time.world.faults
        if request.data:
            why = faults.begin(self._name)
            return {"success": why is None, "message": why or ""}
        faults.end(self._name)
        return {"success": True, "message": ""}

    def close(self) -> None:
        """Leave the service."""
        if self._service is not None:
            self._service.close()

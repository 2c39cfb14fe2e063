"""Which ROS graph to join, under which names, and how to open a node in it.

Code that only programs with robots need is imported in functions: every run has an address among its options.
"""

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from inspect import signature
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jacaros.robots.ros.errors import BackendUnavailable, NameInvalid, ParameterRefused
from jacaros.robots.ros.middleware import MIDDLEWARES, Middleware, middleware
from jacaros.runtime.errors import UsageError

if TYPE_CHECKING:
    from jacaros.robots.ros.action_client import OrphanPolicy
    from jacaros.robots.ros.backend import Backend
    from jacaros.robots.ros.parameter import ParameterValue
    from jacaros.runtime.clock import Clock

LAST_DOMAIN = 232
"""The highest domain id whose ports all exist (ROS 2 documentation, "The ROS_DOMAIN_ID")."""


@dataclass(frozen=True, slots=True)
class GraphAddress:
    """A graph and the names of our node in it. None: use the environment, as other ROS nodes do.

    Attributes:
        ros: kind of the ROS graph: ``memory`` (in-process), ``ros1``, ``ros2``, ``rosbridge``, or a class of your
            own, see `jacaros.robots.ros.middleware`.
        domain_id: domain of ROS 2; default: ``ROS_DOMAIN_ID``.
        master: address of the ROS 1 master, such as ``http://robot.lab.example:11311``; default: ``ROS_MASTER_URI``.
        bridge: address of a rosbridge server, such as ``ws://robot.lab.example:9090``.
        namespace: prefix of relative names; on ROS 1 the default is ``ROS_NAMESPACE``.
        node_name: name of our node, in place of the program's default.
        remap: remapping rules, ``{"/cmd_vel": "/robot_1/cmd_vel"}``.
        parameters: values of declared parameters of our node, in place of the defaults, ``{"speed": 0.3}``.
        orphans: what to do with action goals that an earlier run of this node left on a real graph: ``"cancel"`` or
            ``"keep"``.
    """

    ros: str = "memory"
    domain_id: int | None = None
    master: str | None = None
    bridge: str | None = None
    namespace: str = ""
    node_name: str | None = None
    remap: Mapping[str, str] = field(default_factory=dict)
    parameters: "Mapping[str, ParameterValue]" = field(default_factory=dict)
    orphans: "OrphanPolicy" = "keep"

    @property
    def identity(self) -> str:
        """The domain or address of the graph, whichever is given."""
        kind = middleware(self.ros)
        given = self._given(kind)
        return str(given if given is not None else os.environ.get(kind.variable) or kind.default)

    @property
    def arguments(self) -> list[str]:
        """Return the graph and the namespace as command-line options."""
        kind = middleware(self.ros)
        options = {"--ros": self.ros, kind.flag: self._given(kind), "--namespace": self.namespace or None}
        return [part for name, value in options.items() if value is not None for part in (name, str(value))]

    def _given(self, kind: Middleware) -> Any:
        """Return the option that selects a graph of this kind, if given."""
        return getattr(self, kind.option) if kind.option else None

    def check(self) -> None:
        """Check values and combinations.

        Raises:
            UsageError: with what to write instead.
        """
        from jacaros.robots.ros.names import NodeNames

        chosen = middleware(self.ros)
        for name, kind in MIDDLEWARES.items():
            if self._given(kind) is not None and self.ros != name:
                raise UsageError(f"{kind.flag} needs --ros {name}, found --ros {self.ros}")
        if chosen.schemes:
            self._check_address(chosen)
        if self.domain_id is not None and not 0 <= self.domain_id <= LAST_DOMAIN:
            raise UsageError(
                f"--domain-id: expected an integer from 0 to {LAST_DOMAIN}, found {self.domain_id}"
            )
        self._check_parameters()
        try:
            NodeNames(self.node_name or "node", self.namespace, self.remap)
        except NameInvalid as wrong:
            raise UsageError(str(wrong)) from None

    def _check_address(self, kind: Middleware) -> None:
        from urllib.parse import urlsplit

        try:
            parts = urlsplit(self.identity)
            complete = parts.scheme in kind.schemes and parts.hostname and parts.port
        except ValueError:
            complete = None
        if not complete:
            source = kind.variable if self._given(kind) is None else kind.flag
            raise UsageError(
                f"{source}: expected an address with a port, such as {kind.example}, found {self.identity!r}"
            )

    def _check_parameters(self) -> None:
        if self.parameters and self.ros == "rosbridge":
            raise UsageError(
                f"--param {next(iter(self.parameters))}: over rosbridge there is no node of our own, and so no "
                "parameters; run on the robot itself, with --ros ros2 or --ros ros1"
            )
        from jacaros.robots.ros.parameter import checked_value

        for name, value in self.parameters.items():
            try:
                checked_value(value)
            except ParameterRefused as wrong:
                raise UsageError(f"--param {name}: {wrong}") from None

    def open(self, clock: "Clock", node_name: str, log: Callable[[str], None], **options: Any) -> "Backend":
        """Make our node; see `open_backend` for the errors.

        Args:
            clock: clock of the run.
            node_name: default of the node's name.
            log: called with lines about the connection.
            options: further options of the backend.
        """
        kind = middleware(self.ros)
        if kind.keyword:
            options[kind.keyword] = self._given(kind)
        if self.ros == "ros1" and self.master is not None:
            # rospy reads only this variable, and has one node per process anyway.
            os.environ["ROS_MASTER_URI"] = self.master
        namespace = self.namespace
        if not namespace and self.ros == "ros1":
            namespace = os.environ.get("ROS_NAMESPACE", "")
        return open_backend(
            self.ros,
            clock,
            self.node_name or node_name,
            namespace,
            log=log,
            remap=self.remap,
            parameters=self.parameters,
            orphans=self.orphans,
            **options,
        )


def open_backend(kind: str, clock: "Clock", node_name: str, namespace: str = "", **options: Any) -> "Backend":
    """Make a node of a backend; ``await backend.start()`` joins it to its graph.

    Args:
        kind: ``memory``, ``ros1``, ``ros2``, ``rosbridge``, or a class of your own, see `jacaros.robots.ros.middleware`.
        clock: the run's clock; the virtual clock works with ``memory`` only.
        node_name: plain name of the node.
        namespace: prefix of relative names.
        options: ``remap``, ``log``, ``parameters``, ``orphans``, ``interface_paths`` (see `NodeSettings`); for
            ``memory`` also ``graph``, a `jacaros.robots.ros.drivers.memory.graph.MemoryGraph` to share; for ``ros2`` also
            ``domain_id``; for ``rosbridge`` also ``url``, the server's address.

    Raises:
        UsageError: unknown kind or option, or the virtual clock with a real ROS graph.
        BackendUnavailable: the client library is not installed.
        NameInvalid: the node's name or a namespace breaks the rules of ROS.
    """
    from jacaros.robots.ros.node import NodeSettings

    chosen = middleware(kind)
    if clock.virtual and kind != "memory":
        raise UsageError(
            f"the virtual clock cannot run with a real ROS graph ({kind}): its nodes live in real time. "
            "Use the real clock (--clock real)"
        )
    options = {name: value for name, value in options.items() if value is not None}
    common = {
        name: options.pop(name) for name in ("remap", "log", "parameters", "orphans") if name in options
    }
    folders = tuple(Path(folder) for folder in options.pop("interface_paths", ()))
    made = _backend_class(kind, chosen)
    unknown = set(options) - set(signature(made).parameters)
    if unknown:
        raise UsageError(f"the {kind} backend has no option {', '.join(sorted(unknown))}")
    settings = NodeSettings(clock, node_name, namespace, interface_paths=folders, **common)
    backend: Backend = made(settings, **options)
    return backend


def _backend_class(kind: str, chosen: Middleware) -> Any:
    # Imported by name and only now: the client libraries are large, and most systems have one or none.
    try:
        if chosen.library:
            import_module(
                chosen.library
            )  # first, so that the error is about the library itself, not a part of it
        module, _, name = chosen.backend.partition(":")
        return getattr(import_module(module), name)
    except ImportError as problem:
        if chosen.library and not (problem.name or "").startswith("jacaros"):
            raise BackendUnavailable(
                f"error: --ros {kind} needs the package {chosen.library} ({problem})\n  = help: {chosen.install}"
            ) from problem
        if chosen.backend != kind:
            raise
        raise BackendUnavailable(
            f"the backend {kind} cannot be imported: {problem}. If it is in this folder, set PYTHONPATH=."
        ) from problem
    except AttributeError as problem:
        raise UsageError(f"unknown ROS backend {kind!r}: {problem}") from problem

"""What has to be put right in rospy itself; each repair says what goes wrong without it."""

import logging
import sys
import threading
import warnings
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from typing import Any

import rosgraph.xmlrpc  # type: ignore[import-not-found]
import rospy.impl.masterslave  # type: ignore[import-not-found]
import rospy.impl.registration as registration  # type: ignore[import-not-found]
from rospy.impl.paramserver import get_param_server_cache  # type: ignore[import-not-found]


def let_subscribers_hear() -> None:
    """rospy calls what Python 3.10 deprecated; with warnings as errors its subscribers would stay dumb."""
    warnings.filterwarnings("ignore", "notifyAll", DeprecationWarning)


def print_to_standard_error() -> None:
    """Turn what rospy prints to standard error: standard output belongs to the agents.  Before ``init_node``."""
    for module in (rospy.impl.masterslave, registration, rosgraph.xmlrpc):
        module.print = partial(print, file=sys.stderr)  # pyright: ignore[reportAttributeAccessIssue]


def log_to_standard_error() -> None:
    """Turn what rospy logs to standard error as well.  After ``init_node``, which sets the logs up."""
    for handler in logging.getLogger("rosout").handlers:
        if hasattr(handler, "_stdout"):
            handler._stdout = sys.stderr  # pyright: ignore[reportAttributeAccessIssue]


def let_parameters_tell(listener: Callable[[str, Any], None]) -> None:
    """Have *listener* called, on a thread of rospy's, with what the master says of a changed parameter.

    rospy itself keeps such news in a cache that nobody can watch, and refuses news of parameters that are not in it.
    """

    def parameter_update(_: Any, caller: str, name: str, value: Any) -> tuple[int, str, int]:
        with suppress(KeyError):
            get_param_server_cache().update(name, value)
        listener(name, value)
        return 1, "", 0

    rospy.impl.masterslave.ROSHandler.paramUpdate = parameter_update


class EndingServer(rosgraph.xmlrpc.ThreadingXMLRPCServer):  # type: ignore[misc]
    """The server of a node's XML-RPC interface, whose thread ends when it is closed.

    rospy's own, with its socket closed, asks that socket for connections for ever, at full speed.
    """

    def server_close(self) -> Any:
        """Close the socket and let the serving thread end; not waited for, as that may be this very thread."""
        super().server_close()
        threading.Thread(target=self.shutdown, name="XML-RPC server ends", daemon=True).start()


def let_closed_nodes_rest() -> None:
    """Use `EndingServer` for the node; before ``init_node``."""
    rosgraph.xmlrpc.ThreadingXMLRPCServer = EndingServer

"""What has to be put right in rospy itself; each repair says what goes wrong without it."""

import logging
import sys
import threading
import warnings
from functools import partial
from typing import Any

import rosgraph.xmlrpc  # type: ignore[import-not-found]
import rospy.impl.masterslave  # type: ignore[import-not-found]
import rospy.impl.registration as registration  # type: ignore[import-not-found]


def let_subscribers_hear() -> None:
    """rospy calls what Python 3.10 deprecated; with warnings as errors its subscribers would stay dumb."""
    warnings.filterwarnings("ignore", "notifyAll", DeprecationWarning)


def leave_standard_output_alone() -> None:
    """Turn rospy's reports to standard error: standard output belongs to the agents.  After ``init_node``."""
    for handler in logging.getLogger("rosout").handlers:
        if hasattr(handler, "_stdout"):
            handler._stdout = sys.stderr
    for module in (rospy.impl.masterslave, registration, rosgraph.xmlrpc):
        module.print = partial(print, file=sys.stderr)


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

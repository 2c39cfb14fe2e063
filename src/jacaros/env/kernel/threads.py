"""Run the code of an operation in a worker thread."""

import inspect
import threading
from collections.abc import Callable

from jacaros.env.errors import InvalidArtifact
from jacaros.env.execution import OperationExecution


def in_thread(execution: OperationExecution, work: Callable[[], object]) -> BaseException | None:
    """Run *work* in this thread. Return what it raised, or None.

    It is returned, because a future does not accept every exception (``StopIteration``).
    """
    execution.thread = threading.get_ident()
    try:
        result = work()
        if inspect.iscoroutine(result):
            result.close()
            raise InvalidArtifact(
                f"{execution.request.operation} returned a coroutine, which a thread cannot run"
            )
    except BaseException as error:
        return error
    finally:
        execution.thread = None
    return None

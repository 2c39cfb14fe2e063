"""Running the code of an operation in a worker thread."""

import inspect
import threading
from collections.abc import Callable

from jacaros.env.errors import InvalidArtifact
from jacaros.env.execution import OperationExecution


def in_thread(execution: OperationExecution, work: Callable[[], object]) -> BaseException | None:
    """Do *work* in this thread and give what it raised, None when it went well.

    It is given, not raised: a future does not take every exception (``StopIteration``).
    """
    execution.thread = threading.get_ident()
    try:
        result = work()
        if inspect.iscoroutine(result):
            result.close()
            raise InvalidArtifact(
                f"{execution.request.operation} gave a coroutine, which a thread cannot run"
            )
    except BaseException as error:
        return error
    finally:
        execution.thread = None
    return None

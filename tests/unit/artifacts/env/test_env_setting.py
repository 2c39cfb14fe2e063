"""What artifacts of an environment share: the log, and the handling of internal errors."""

import pytest

from jacaros.artifacts import Artifact, Environment, OperationRequest, operation
from jacaros.artifacts.kernel.publication import Setting
from jacaros.runtime.clock import VirtualClock
from jacaros.runtime.errors import InternalError
from jacaros.runtime.trace import Cause


class Thing(Artifact):
    def init(self):
        self.log("made")

    @operation
    def ping(self): ...

    @operation
    def defect(self):
        raise InternalError("ours")

    @operation
    def interrupted(self):
        raise KeyboardInterrupt


def test_without_a_log_lines_go_to_standard_error(capsys):
    Environment(VirtualClock()).workspace("/main").create("it", Thing)
    assert capsys.readouterr() == ("", "[it] made\n")


def test_an_error_that_has_no_trace_is_logged_too():
    lines = []
    Setting(VirtualClock(), log=lines.append).log_error("it", "went wrong:", ValueError("x"))
    assert lines == ["[it] went wrong:", "[it]   ValueError: x"]


def test_without_a_tracer_the_parent_stays_the_cause():
    parent = Cause(1, 0, "act", "x")
    assert Setting(VirtualClock()).trace("operation", "y", parent) is parent


def test_without_a_handler_an_internal_error_is_raised():
    workspace = Environment(VirtualClock(), log=lambda _: None).workspace("/main")
    made = []
    workspace.create("it", Thing, on_done=lambda artifact, _: made.append(artifact))

    def broken(outcome):
        raise ValueError("broken caller")

    with pytest.raises(InternalError, match="ValueError: broken caller"):
        workspace.execute(OperationRequest(made[0], "ping", on_done=broken))
    with pytest.raises(InternalError, match="ours"):
        workspace.execute(OperationRequest(made[0], "defect"))
    done = []
    workspace.execute(OperationRequest(made[0], "ping", on_done=done.append))
    assert done[0].ok, "the artifact is still usable"


def test_an_interruption_of_the_process_propagates_and_rolls_back_the_step():
    workspace = Environment(VirtualClock(), log=lambda _: None, on_internal_error=lambda _: None).workspace(
        "/main"
    )
    made, done = [], []
    workspace.create("it", Thing, on_done=lambda artifact, _: made.append(artifact))
    with pytest.raises(KeyboardInterrupt):
        workspace.execute(OperationRequest(made[0], "interrupted", on_done=done.append))
    workspace.execute(OperationRequest(made[0], "ping", on_done=done.append))
    assert done[-1].ok

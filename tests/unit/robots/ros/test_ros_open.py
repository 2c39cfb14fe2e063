"""Opening backends: what is asked wrongly or is not there."""

import importlib.util
import sys

import pytest

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.errors import BackendUnavailable, NameInvalid, RosError
from jacaros.robots.ros.open import GraphAddress, open_backend
from jacaros.runtime.clock import VirtualClock, WallClock, run
from jacaros.runtime.errors import UsageError


def test_an_unknown_kind_is_a_usage_error() -> None:
    with pytest.raises(UsageError, match="memory, ros1, ros2, rosbridge"):
        open_backend("ros3", WallClock(), "node")


@pytest.mark.parametrize("kind", ["ros1", "ros2"])
def test_virtual_time_and_a_real_graph_do_not_go_together(kind: str) -> None:
    with pytest.raises(UsageError, match="virtual clock"):
        open_backend(kind, VirtualClock(), "node")


@pytest.mark.parametrize(("kind", "library"), [("ros1", "rospy"), ("ros2", "rclpy")])
def test_a_missing_library_is_named_with_help(kind: str, library: str) -> None:
    if importlib.util.find_spec(library) is not None:
        pytest.skip(f"{library} is installed here")
    with pytest.raises(BackendUnavailable, match=rf"(?s){library}.*tools/install_{kind}\.sh"):
        open_backend(kind, WallClock(), "node")


def test_a_missing_cbor2_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in sys.modules if "rosbridge" in name]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "cbor2", None)
    with pytest.raises(BackendUnavailable, match=r"(?s)cbor2.*pip install 'jacaros\[rosbridge\]'"):
        open_backend("rosbridge", WallClock(), "node")


def test_a_wrong_address_in_the_environment_is_reported_with_its_variable(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    GraphAddress("rosbridge").check()
    monkeypatch.setenv("ROSBRIDGE_URI", "robot")
    with pytest.raises(UsageError, match="ROSBRIDGE_URI: expected an address with a port, such as ws://"):
        GraphAddress("rosbridge").check()


def test_an_option_of_another_backend_is_a_usage_error() -> None:
    with pytest.raises(UsageError, match="memory backend has no option domain_id"):
        open_backend("memory", WallClock(), "node", domain_id=3)


def test_a_wrong_namespace_is_refused() -> None:
    with pytest.raises(NameInvalid, match="robot 1"):
        open_backend("memory", WallClock(), "node", namespace="robot 1")


def test_a_backend_is_used_after_its_start() -> None:
    backend: Backend = open_backend("memory", VirtualClock(), "node")
    assert backend.connected is False
    with pytest.raises(RosError, match=r"await backend\.start"):
        backend.publisher("/a", "std_msgs/msg/String")


def test_reports_go_to_standard_error(capsys: pytest.CaptureFixture[str]) -> None:
    async def main() -> None:
        backend = open_backend("memory", clock, "node")
        await backend.start()
        with pytest.raises(RosError):
            await backend.client("/a", "std_srvs/srv/Empty").call(timeout=4)

    clock = VirtualClock()
    run(main, clock)
    out, err = capsys.readouterr()
    assert out == ""
    assert err.splitlines()[0] == "[ros] waiting for the service /a (std_srvs/srv/Empty)"
    assert "is missing; still trying" in err.splitlines()[1]

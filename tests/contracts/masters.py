"""What a graph needs beside its nodes, for tests: each on a free port, with its files in a folder of the test."""

import os
import shutil
import socket
import subprocess
import time
from pathlib import Path


class Server:
    """A program that can be killed and started again at the same port of this machine."""

    environment: dict[str, str]

    def __init__(self) -> None:
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self._process: subprocess.Popen[bytes] | None = None

    @staticmethod
    def program() -> str | None:
        """The program on this system."""
        raise NotImplementedError

    def arguments(self) -> list[str]:
        """What the program is given."""
        raise NotImplementedError

    def start(self) -> None:
        program = self.program()
        assert program is not None, f"{type(self).__name__.lower()}: the program is not installed"
        self._process = subprocess.Popen(
            [program, *self.arguments()],
            env=os.environ | self.environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        deadline = time.monotonic() + 30
        while not self._answers():
            assert self._process.poll() is None, f"{program} ended"
            assert time.monotonic() < deadline, f"{program} does not answer"
            time.sleep(0.02)

    def kill(self) -> None:
        assert self._process is not None
        self._process.kill()
        self._process.wait()
        self._process = None

    def close(self) -> None:
        if self._process is not None:
            self._process.terminate()
            try:
                self._process.wait(10)
            except subprocess.TimeoutExpired:
                self.kill()

    def _answers(self) -> bool:
        try:
            socket.create_connection(("127.0.0.1", self.port), timeout=1).close()
        except OSError:
            return False
        return True


class Master(Server):
    """A rosmaster."""

    def __init__(self, folder: Path) -> None:
        super().__init__()
        self.uri = f"http://127.0.0.1:{self.port}"
        self.environment = {
            "ROS_MASTER_URI": self.uri,
            "ROS_IP": "127.0.0.1",
            "ROS_LOG_DIR": str(folder / "log"),
            "ROS_HOME": str(folder / "home"),
            "JACAROS_CACHE": str(folder / "cache"),
        }

    @staticmethod
    def program() -> str | None:
        return shutil.which("rosmaster", path=f"{os.environ.get('PATH', '')}:/usr/bin")

    def arguments(self) -> list[str]:
        return ["--core", "-p", str(self.port)]


class Broker(Server):
    """A broker of MQTT, for the driver of these tests."""

    def __init__(self, folder: Path) -> None:
        super().__init__()
        self._settings = folder / "mosquitto.conf"
        self._settings.write_text(f"listener {self.port} 127.0.0.1\nallow_anonymous true\n", encoding="utf-8")
        self.environment = {"MQTT_BROKER": f"127.0.0.1:{self.port}"}

    @staticmethod
    def program() -> str | None:
        return shutil.which("mosquitto", path=f"{os.environ.get('PATH', '')}:/usr/sbin")

    def arguments(self) -> list[str]:
        return ["-c", str(self._settings)]

"""ROS masters for tests: each on a free port, with its files in a folder of the test."""

import os
import shutil
import socket
import subprocess
import time
from pathlib import Path


class Master:
    """A rosmaster that can be killed and started again at the same address."""

    def __init__(self, folder: Path) -> None:
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self.uri = f"http://127.0.0.1:{self.port}"
        self.environment = {
            "ROS_MASTER_URI": self.uri,
            "ROS_IP": "127.0.0.1",
            "ROS_LOG_DIR": str(folder / "log"),
            "ROS_HOME": str(folder / "home"),
            "JACAROS_CACHE": str(folder / "cache"),
        }
        self._process: subprocess.Popen[bytes] | None = None

    @staticmethod
    def program() -> str | None:
        """The rosmaster of this system."""
        return shutil.which("rosmaster", path=f"{os.environ.get('PATH', '')}:/usr/bin")

    def start(self) -> None:
        program = self.program()
        assert program is not None, "there is no rosmaster: run tools/install_ros1.sh"
        self._process = subprocess.Popen(
            [program, "--core", "-p", str(self.port)],
            env=os.environ | self.environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        deadline = time.monotonic() + 30
        while not self._answers():
            assert self._process.poll() is None, "rosmaster ended"
            assert time.monotonic() < deadline, "rosmaster does not answer"
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

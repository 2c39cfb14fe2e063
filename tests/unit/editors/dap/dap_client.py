"""A small client of the Debug Adapter Protocol, which knows nothing of the server's code."""

import json
import os
import queue
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Any

Message = dict[str, Any]
PATIENCE = 60.0
"""Seconds that a message may take on a busy machine."""


class DapClient:
    """Starts ``jacaros dap`` in a folder, and talks to it as an editor does.

    Attributes:
        output: what the editor's console shows, by category.
        process: the process.
    """

    def __init__(self, folder: Path, **environment: str) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-m", "jacaros", "dap"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            cwd=folder,
            env={**os.environ, **environment},
        )
        self.output: dict[str, str] = {}
        self._arrived: queue.Queue[Message | None] = queue.Queue()
        self._kept: list[Message] = []
        self._seq = 0
        threading.Thread(target=self._read, daemon=True).start()

    def __enter__(self) -> "DapClient":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.process.kill()
        self.process.communicate()

    def _read(self) -> None:
        stream = self.process.stdout
        assert stream is not None
        while header := stream.readline():
            assert stream.readline() == b"\r\n"
            self._arrived.put(json.loads(stream.read(int(header.removeprefix(b"Content-Length: ")))))
        self._arrived.put(None)

    # ---- messages

    def send_bytes(self, data: bytes) -> None:
        """Send anything."""
        assert self.process.stdin is not None
        self.process.stdin.write(data)
        self.process.stdin.flush()

    def send(self, command: str, **arguments: Any) -> int:
        """Send a request. Return its number."""
        self._seq += 1
        request = {"seq": self._seq, "type": "request", "command": command, "arguments": arguments}
        body = json.dumps(request).encode()
        self.send_bytes(b"Content-Length: %d\r\n\r\n%b" % (len(body), body))
        return self._seq

    def response(self, command: str, **arguments: Any) -> Message:
        """Send a request. Return the response."""
        seq = self.send(command, **arguments)
        return self._await(lambda message: message.get("request_seq") == seq)

    def ask(self, command: str, **arguments: Any) -> Any:
        """Send a request that succeeds. Return the body of the response."""
        response = self.response(command, **arguments)
        assert response["success"], response
        return response.get("body")

    def event(self, name: str) -> Any:
        """Return the body of the next event of this name."""
        return self._await(lambda message: message.get("event") == name)["body"]

    def _await(self, wanted: Callable[[Message], bool]) -> Message:
        found = next(filter(wanted, self._kept), None)
        if found is not None:
            self._kept.remove(found)
            return found
        while True:
            message = self._arrived.get(timeout=PATIENCE)
            assert message is not None, f"the server has closed its output: {self.errors()}"
            if message.get("event") == "output":
                body = message["body"]
                self.output[body["category"]] = self.output.get(body["category"], "") + body["output"]
            elif wanted(message):
                return message
            else:
                self._kept.append(message)

    # ---- what editors do

    def launch(
        self, program: Path, lines: list[Message] | None = None, filters: tuple[str, ...] = (), **more: Any
    ) -> list[Message]:
        """Launch a program with breakpoints. Return them as the server has set them."""
        capabilities = self.ask("initialize", adapterID="jacaros", linesStartAt1=True)
        assert capabilities["supportsConfigurationDoneRequest"]
        launched = self.send("launch", program=str(program), **{"clock": "fast", **more})
        self.event("initialized")
        found = self.ask("setBreakpoints", source={"path": str(program)}, breakpoints=lines or [])
        self.ask("setExceptionBreakpoints", filters=list(filters))
        self.ask("configurationDone")
        assert self._await(lambda message: message.get("request_seq") == launched)["success"]
        return list(found["breakpoints"])

    def frames(self, stopped: Message) -> list[Message]:
        """Return the stack of the thread that has stopped."""
        return list(self.ask("stackTrace", threadId=stopped["threadId"])["stackFrames"])

    def lines(self, stopped: Message) -> list[int]:
        """Return the lines of the stack of the thread that has stopped."""
        return [frame["line"] for frame in self.frames(stopped)]

    def step(self, command: str, stopped: Message, **more: Any) -> Message:
        """Step the thread that has stopped. Return how it stopped again."""
        self.ask(command, threadId=stopped["threadId"], **more)
        return dict(self.event("stopped"))

    def resume(self, stopped: Message) -> None:
        """Continue."""
        assert self.ask("continue", threadId=stopped["threadId"])["allThreadsContinued"]

    def variables(self, reference: int) -> dict[str, Message]:
        """Return the parts of a variable by name."""
        found = self.ask("variables", variablesReference=reference)["variables"]
        return {each["name"]: each for each in found}

    def scope(self, stopped: Message, name: str) -> dict[str, Message]:
        """Return the variables of a scope at the top of the stack."""
        scopes = self.ask("scopes", frameId=self.frames(stopped)[0]["id"])["scopes"]
        return self.variables({each["name"]: each["variablesReference"] for each in scopes}[name])

    def end(self) -> int:
        """Close the input. Return the exit code of the server."""
        assert self.process.stdin is not None
        self.process.stdin.close()
        self.process.stdin = None  # otherwise `communicate` flushes it
        return self.process.wait(PATIENCE)

    def errors(self) -> str:
        """Return the standard error output of the server, which has ended."""
        assert self.process.stderr is not None
        return self.process.stderr.read().decode()

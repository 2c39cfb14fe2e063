"""Serve a web form for deliveries at http://127.0.0.1:8080, in front of the agents' HTTP door.

``TOKEN=… python form.py http://127.0.0.1:8000``. The token stays here: a page that knew it could give any goal of its role.
"""

import os
import sys
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from urllib.error import HTTPError
from urllib.request import Request, urlopen

PAGE = Path(__file__).with_name("form.html").read_bytes()
FORWARDED = {
    ("GET", "/api/goals"),
    ("GET", "/api/agents/robot/beliefs/battery"),
    ("POST", "/api/agents/robot/goals/deliver"),
}


class Form(BaseHTTPRequestHandler):
    """Serves the page, and forwards its three requests with the token."""

    def do_GET(self) -> None:
        """Answer with the page, or what the door answers."""
        if self.path == "/":
            self._answer(200, "text/html; charset=utf-8", PAGE)
        else:
            self._forward("GET", None)

    def do_POST(self) -> None:
        """Forward a goal."""
        is_own = self.headers.get("Origin") == f"http://{self.headers.get('Host')}"
        self._forward("POST" if is_own else "", self.rfile.read(int(self.headers.get("Content-Length", 0))))

    def _forward(self, method: str, body: bytes | None) -> None:
        if (method, self.path) not in FORWARDED:
            self._answer(404, "text/plain", b"not found")
            return
        headers = {"Authorization": f"Bearer {os.environ['TOKEN']}", "Content-Type": "application/json"}
        request = Request(sys.argv[1] + self.path.removeprefix("/api"), body, headers, method=method)
        try:
            with urlopen(request) as answer:
                self._answer(answer.status, "application/json", answer.read())
        except HTTPError as error:  # such as a refused goal, with its reason
            self._answer(error.code, "application/json", error.read())

    def _answer(self, status: int, kind: str, body: bytes) -> None:
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)


if __name__ == "__main__":
    ThreadingHTTPServer(("127.0.0.1", int(os.environ.get("PORT", "8080"))), Form).serve_forever()

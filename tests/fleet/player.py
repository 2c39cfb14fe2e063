"""One session of plain Zenoh in a process of its own: it does what lines of its input say, and prints what it hears.

It plays members, which tests kill and freeze, and strangers. Its argument is JSON: `network` (fields of `Network`) for the
session of a member, with `router` (its address) for that of a router; or `plain` (keys of Zenoh's configuration) for any.
`changes` come on top.
"""

import json
import os
import sys
from pathlib import Path
from typing import Any

import zenoh

from jacaros.fleet.network import Network, open_session, router_config, session_config
from jacaros.runtime.errors import JacarosError


def config(
    network: dict[str, Any] | None, plain: dict[str, Any], router: str, changes: dict[str, Any]
) -> zenoh.Config:
    """Return the configuration of the session."""
    if network is None:
        made = zenoh.Config()
    else:
        network["keys"] = network.get("keys") and Path(network["keys"])
        network["routers"] = tuple(network.get("routers", ()))
        made = router_config(Network(**network), router) if router else session_config(Network(**network))
    for key, value in (plain | changes).items():
        made.insert_json5(key, json.dumps(value))
    return made


def say(*words: object) -> None:
    """Print a line, whole, from any thread."""
    os.write(1, (" ".join(map(str, words)) + "\n").encode())


class Player:
    """The session, and what it declares."""

    def __init__(self, session: zenoh.Session) -> None:
        self.session = session
        self.declared: list[Any] = []

    def put(self, key: str, text: str) -> None:
        """Publish."""
        self.session.put(key, text)

    def flood(self, key: str, count: str) -> None:
        """Publish often."""
        for number in range(int(count)):
            self.session.put(key, f"flood {number}", congestion_control=zenoh.CongestionControl.DROP)

    def large(self, key: str, size: str) -> None:
        """Publish a large message."""
        self.session.put(key, bytes(int(size)))

    def token(self, key: str) -> None:
        """Declare a liveliness token."""
        self.declared.append(self.session.liveliness().declare_token(key))

    def hear(self, key: str) -> None:
        """Print messages."""
        sees = self.session.declare_subscriber(
            key, lambda sample: say("heard", sample.key_expr, bytes(sample.payload)[:40].decode())
        )
        self.declared.append(sees)

    def see(self, key: str) -> None:
        """Print who comes and goes."""
        sees = self.session.liveliness().declare_subscriber(
            key,
            lambda sample: say("came" if sample.kind == zenoh.SampleKind.PUT else "went", sample.key_expr),
            history=True,
        )
        self.declared.append(sees)

    def delete(self, key: str) -> None:
        """Publish a deletion."""
        self.session.delete(key)

    def query(self, key: str) -> None:
        """Print answers of others: not those of the session itself."""
        own = f"@/{self.session.zid()}/"
        for reply in self.session.get(key, timeout=0.5):
            if reply.ok is not None and not str(reply.ok.key_expr).startswith(own):
                say("answer", reply.ok.key_expr)

    def links(self) -> None:
        """Print the names in the certificates at the other ends."""
        say("links", *sorted({f"{link.auth_identifier}" for link in self.session.info.links()}))


def main() -> None:
    """Open the session, and follow the input until it ends."""
    given = json.loads(sys.argv[1])
    made = config(
        given.get("network"), given.get("plain", {}), given.get("router", ""), given.get("changes", {})
    )
    try:
        session = open_session(made)
    except JacarosError as error:
        say("refused", error)
        return
    player = Player(session)
    say("open")
    for line in sys.stdin:
        action, *arguments = line.split()
        getattr(player, action)(*arguments)
        say("done", action)
    session.close()


main()

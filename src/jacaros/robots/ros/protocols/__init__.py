"""Protocols on top of messages and bytes, without sockets and without a loop."""

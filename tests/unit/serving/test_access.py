"""Sockets of the servers of a run."""

import socket

from jacaros.serving.access import LOOPBACK, listening_socket


def test_connections_send_small_pieces_without_delay() -> None:
    with (
        listening_socket("HTTP", LOOPBACK, 0, "") as listening,
        socket.create_connection(listening.getsockname()),
        listening.accept()[0] as accepted,
    ):
        assert accepted.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)

"""Ports for simulators that tests start."""

from __future__ import annotations

import itertools
import os
import socket
from contextlib import suppress

# The ports from here are none that a system gives away by itself (Linux: from 32768, others: from 49152), and each process
# of a test run has its own. Another run at the same time begins somewhere else.
FIRST_PORT, LAST_PORT, PORTS_OF_A_PROCESS = 20_000, 32_000, 1_500
_ports = itertools.count(16 * os.getpid())


def free_ports(count: int) -> list[int]:
    """Ports that nobody listens at, and that no other test is given."""
    worker = int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw"))
    first = FIRST_PORT + worker * PORTS_OF_A_PROCESS % (LAST_PORT - FIRST_PORT)
    found: list[int] = []
    while len(found) < count:
        port = first + next(_ports) % PORTS_OF_A_PROCESS
        with suppress(OSError), socket.create_server(("127.0.0.1", port)):
            found.append(port)
    return found

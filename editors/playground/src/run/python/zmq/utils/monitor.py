"""As in pyzmq."""

from typing import Any


def recv_monitor_message(monitor: Any) -> dict[str, int]:
    """The next event of a socket."""
    return {"event": monitor.events.popleft()}

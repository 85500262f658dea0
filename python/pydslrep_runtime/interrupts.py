"""Everything from outside that ends a run: Ctrl-C, a closed terminal, a request to end. All of them stop the robots first."""

import _thread
import os
import signal
import sys
import threading
import time
from types import FrameType
from typing import Any

from .settings import END_LIMIT

NAMES = ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT", "SIGBREAK")
SIGNALS = [getattr(signal, name) for name in NAMES if hasattr(signal, name)]
EXIT_CODE = 130

# Windows ends a process when it has handled one of these: a closed window, a logoff, a shutdown.
CONSOLE_EVENTS = (2, 5, 6)

_handlers: list[Any] = []  # what Windows calls
_timers: list[threading.Timer] = []  # at most one


def listen() -> None:
    """From now on, the first one raises KeyboardInterrupt at once, even while a call waits."""
    for number in SIGNALS:
        # What is ignored stays so, as with `nohup`; asyncio replaces the default handler by one that waits for the call.
        if signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler):
            signal.signal(number, _interrupt)
    if sys.platform == "win32":
        _listen_to_console()


def hold() -> None:
    """From now on, nothing interrupts: the run ends anyway, and stops the robots. It has END_LIMIT for that."""
    _replace(_interrupt, _end_in_time)


def ignore() -> None:
    """From now on, nothing changes how this process ends."""
    hold()
    _replace(_end_in_time, signal.SIG_IGN)


def _interrupt(number: int, frame: FrameType | None) -> None:
    hold()
    _end_in_time(number, frame)
    raise KeyboardInterrupt


def _end_in_time(_signal: int, _frame: FrameType | None) -> None:
    """Ends the process if it does not end by itself, as a robot of a user's own may wait forever."""
    if not _timers:
        timer = threading.Timer(END_LIMIT, os._exit, [EXIT_CODE])
        timer.daemon = True
        _timers.append(timer)
        timer.start()


def _replace(handler: object, other: Any) -> None:
    for number in SIGNALS:
        if signal.getsignal(number) is handler:
            signal.signal(number, other)


def _listen_to_console() -> None:
    """Handles Windows' console events, which are no signals."""
    if sys.platform == "win32":
        import ctypes
        from ctypes import wintypes

        @ctypes.WINFUNCTYPE(wintypes.BOOL, wintypes.DWORD)
        def handle(event: int) -> bool:
            if event not in CONSOLE_EVENTS:
                return False
            _thread.interrupt_main()
            # The system ends this process as soon as this returns.
            time.sleep(END_LIMIT)
            return True

        _handlers.append(handle)
        ctypes.windll.kernel32.SetConsoleCtrlHandler(handle, True)

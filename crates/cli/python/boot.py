"""Runs a script with the package that it imports.

The arguments are the folder of the package, the folder of the program if modules are imported from there, too, or
nothing, and then the script with its own arguments. Standard input must stay open: when it ends, the process that
started the script is gone, and the script ends, too.
"""

import sys

if not sys.flags.safe_path:
    # The current folder: its modules could replace those imported next.
    del sys.path[0]

import _thread
import os
import runpy
import signal
import threading
import time
from pathlib import Path

STOP_LIMIT = 5.0  # s, to stop the robots


def end_with_parent() -> None:
    """Ends this process after the end of its input, which the script finds empty."""
    parent_pipe = os.dup(0)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)

    def watch() -> None:
        try:
            while os.read(parent_pipe, 1024):
                pass
        except OSError:
            pass  # it has ended as well
        # As Ctrl-C does: this stops the robots of a simulator that goes on.
        if os.name == "nt":
            # There, `os.kill` ends a process at once.
            _thread.interrupt_main()
        else:
            os.kill(os.getpid(), signal.SIGINT)
        time.sleep(STOP_LIMIT)
        os._exit(130)

    threading.Thread(target=watch, daemon=True).start()


if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    # A shell has started the whole run in the background; this signal ends the script in any case.
    signal.signal(signal.SIGINT, signal.default_int_handler)
end_with_parent()
package, program, *sys.argv = sys.argv[1:]
folders = [package]
if not sys.flags.isolated:
    # As usual, a script finds the modules next to it.
    folders.append(str(Path(sys.argv[0]).parent))
sys.path[:0] = folders
if program:
    # At the end: no module there can replace another one.
    sys.path.append(program)
runpy.run_path(sys.argv[0], run_name="__main__")

"""Ctrl-C ends a script with one line and the usual exit code, without a traceback."""

import contextlib
import os
import signal

STOPPED = 130  # 128 + SIGINT, as the program itself ends


def end_on_interrupt():
    """From now on Ctrl-C ends this process at once. For the imports, which take long and leave nothing to clean up."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:  # else it is ignored, as in the background of a shell
        signal.signal(signal.SIGINT, _end)


def _end(number, frame):
    os.write(2, b"stopped\n")
    os._exit(STOPPED)


@contextlib.contextmanager
def interrupts_raised():
    """Within, Ctrl-C is a KeyboardInterrupt, so that files that are half written are removed."""
    before = signal.getsignal(signal.SIGINT)
    if before is _end:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    finally:
        if before is _end:
            signal.signal(signal.SIGINT, before)

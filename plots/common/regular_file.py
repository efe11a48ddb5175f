"""Reads a file as a whole: a regular one, and no larger than is allowed. A pipe or a device could be read for ever."""

import os
import stat

from common.plot_error import PlotError

MIB = 1 << 20
KINDS = ((stat.S_ISFIFO, "pipe"), (stat.S_ISSOCK, "socket"))


def read_bytes(path, most=256 * MIB):
    """The bytes of the file, or a PlotError that says what is wrong with it."""
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
        with open(descriptor, "rb") as file:
            mode = os.fstat(descriptor).st_mode
            if not stat.S_ISREG(mode):
                kind = next((name for is_kind, name in KINDS if is_kind(mode)), "device")
                raise PlotError(f"{path}: cannot be read (it is a {kind}, not a file).")
            content = file.read(most + 1)
    except (OSError, ValueError) as error:
        raise PlotError(f"{path}: cannot be read ({getattr(error, 'strerror', None) or error}).") from error
    if len(content) > most:
        raise PlotError(f"{path}: is larger than {most // MIB} MiB, which is not allowed.")
    return content

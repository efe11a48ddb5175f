"""Files whole or not at all, as the program itself writes them (experiments/core/files/pending_file.h).

They are made beside their place as NAME.rcme-HOST-PROCESS-NUMBER.part, go to the disk and are then moved: a reader never
meets half a file and a failure leaves what was there. Who makes one holds a lock on it, which ends with the process however
that ends; so what a killed one has left is known, and the next that writes into the folder removes it.
"""

import contextlib
import errno
import fcntl
import os
import re
import socket
import stat

HOST = re.sub("[^A-Za-z0-9._]", "_", socket.gethostname()[:64])
LONGEST_NAME = 255  # bytes


def write_whole(files):
    """`files` is {path: write}; `write(part)` writes the file at the path `part`. All are written before any is moved."""
    with contextlib.ExitStack() as parts:
        pending = [(parts.enter_context(pending_file(path)), path, write) for path, write in files.items()]
        for part, _, write in pending:
            write(part)
            sync(part)
        for part, path, _ in pending:
            os.replace(part, path)
        for folder in {os.path.dirname(path) or "." for path in files}:
            sync(folder)


def write_text(path, text):
    """A text as UTF-8, with its line ends as they are."""
    def write(part):
        with open(part, "w", encoding="utf-8", newline="") as file:
            file.write(text)
    write_whole({path: write})


@contextlib.contextmanager
def pending_file(path):
    """The path of an empty file beside `path`, locked; gone at the end, unless it was moved."""
    remove_abandoned(os.path.dirname(path) or ".")
    part, descriptor = new_part(path)
    try:
        yield part
    finally:
        with contextlib.suppress(FileNotFoundError):
            os.remove(part)
        os.close(descriptor)


def new_part(path):
    """A new file beside `path`: its path and a descriptor that holds its lock."""
    folder, name = os.path.split(path)
    for number in range(100):
        mark = f".rcme-{HOST}-{os.getpid()}-{number}.part"
        part = os.path.join(folder, os.fsdecode(os.fsencode(name)[:LONGEST_NAME - len(mark)]) + mark)
        try:
            descriptor = os.open(part, os.O_RDWR | os.O_CREAT | os.O_EXCL, 0o666)
        except FileExistsError:
            continue
        if is_locked_by_us(part, descriptor):
            return part, descriptor
        os.close(descriptor)  # another process took it for abandoned before it was locked
    raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), path)


def is_locked_by_us(path, descriptor):
    """On a file system without locks it stays unlocked, and nobody removes it."""
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        pass
    return is_still_there(path, descriptor)


def is_still_there(path, descriptor):
    try:
        return os.path.samestat(os.fstat(descriptor), os.lstat(path))
    except FileNotFoundError:
        return False


def remove_abandoned(folder):
    """Removes what processes of this user on this host have left that are no more: files that nobody has locked."""
    made_here = re.compile(re.escape(f".rcme-{HOST}-") + "[0-9-]+[.]part$")
    with contextlib.suppress(OSError):
        for name in filter(made_here.search, os.listdir(folder)):
            with contextlib.suppress(OSError):
                remove_if_abandoned(os.path.join(folder, name))


def remove_if_abandoned(path):
    descriptor = os.open(path, os.O_RDWR | os.O_NOFOLLOW | os.O_NONBLOCK)
    try:
        found = os.fstat(descriptor)
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        if found.st_uid == os.geteuid() and stat.S_ISREG(found.st_mode) and is_still_there(path, descriptor):
            os.remove(path)
    finally:
        os.close(descriptor)


def sync(path):
    """What was written goes to the disk; of a folder, its names. Some file systems know no such request."""
    with contextlib.suppress(OSError) if os.path.isdir(path) else contextlib.nullcontext():
        descriptor = os.open(path, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)

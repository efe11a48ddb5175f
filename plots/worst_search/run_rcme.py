"""Calls of `rcme` that end with the search, as the search ends with the program that began it: nothing goes on alone after a kill."""

import ctypes
import signal
import subprocess

PR_SET_PDEATHSIG = 1  # prctl(2), Linux


def end_with_parent():
    """From now on this process gets SIGTERM when its parent ends."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


def run_rcme(command):
    """The finished process, with its output as text."""
    return subprocess.run(command, capture_output=True, text=True, check=False, preexec_fn=end_with_parent)

"""Runs a script of the folder above, so that Ctrl-C ends it with one line also while it loads its modules, which takes long:
run_script.py NAME [ARGUMENT ...]. The program draws every figure in this way."""

import os
import runpy
import sys

if __name__ == "__main__":
    sys.path[0] = os.path.dirname(sys.path[0])

    from common.interrupt import end_on_interrupt

    end_on_interrupt()
    sys.argv[:2] = [os.path.join(sys.path[0], sys.argv[1] + ".py")]
    runpy.run_path(sys.argv[0], run_name="__main__")

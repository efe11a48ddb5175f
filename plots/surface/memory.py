"""Whether this machine has the memory for a surface: the model holds square matrices over all conditions."""

import math
import os
import resource

from common.command_line import PlotError

MORE_MATRICES = 5  # beside one per group of factors: their sums and temporaries (tests/plots/surface_report_test.py)
SHARE = 0.8  # of the memory that a surface may take
CGROUP_LIMIT = "/sys/fs/cgroup/memory.max"


def check_memory(num_conditions, num_groups):
    """Raises PlotError if the matrices do not fit; without it numpy fails after a long silence."""
    most = most_conditions(num_groups, memory_bytes())
    if num_conditions > most:
        raise PlotError(f"{num_conditions} conditions need about {matrix_bytes(num_conditions, num_groups) / 1e9:.0f} GB for the "
                        f"surface's matrices; with the memory of this machine a surface has at most {most} conditions, so give "
                        "a run with fewer draws (rcme run --set conditions.number=N).")


def matrix_bytes(num_conditions, num_groups):
    """Of the greatest number of square matrices of doubles that exist at a time."""
    return 8 * (num_groups + MORE_MATRICES) * num_conditions**2


def most_conditions(num_groups, available):
    return math.isqrt(int(SHARE * available) // matrix_bytes(1, num_groups))


def memory_bytes():
    """What this process may use at most: the machine's memory, or a limit on it."""
    limits = [os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"), cgroup_limit()]
    soft, _ = resource.getrlimit(resource.RLIMIT_AS)
    if soft != resource.RLIM_INFINITY:
        limits.append(soft)
    return min(limits)


def cgroup_limit():
    """Infinite without a control group that has a limit."""
    try:
        with open(CGROUP_LIMIT, encoding="ascii") as file:
            return int(file.read())
    except (OSError, ValueError):
        return math.inf

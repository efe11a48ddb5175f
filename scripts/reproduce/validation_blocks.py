"""Blocks of what `rcme validate` found: each is a function of its spec that returns Markdown."""

import math

from tables import filled, levels_of, markdown, read_table, select, the_row, words_of


def truth_free(spec):
    """Of each scene, for each table of `rcme validate` (tables: NAME as WORDS; ... of one folder, or NAME+NAME of several): the
    share that the 95 % region covers, the same of the twins, and by what the covariances are too small; one test, without the
    scenes that have no value."""
    tables = [([row for part in name.split("+") for row in read_table(part)], words)
              for name, words in spec.parts("tables")]
    body = []
    for scene in levels_of(tables[0][0], "set"):
        line = [scene]
        for rows, _ in tables:
            row = the_row(rows, f"set={scene}, test={spec.argument}")
            if not row["value"]:
                line.append("-")
                continue
            covered, twins = (f"{100 * float(row[name]):.0f}" for name in ("coverage", "twin_coverage"))
            upper = float(row["upper"]) if row["upper"] else math.inf
            line.append(f"{covered} ({twins}) of {row['n']}; {float(row['value']):.2g} "
                        f"[{float(row['lower']):.2g}, {upper:.2g}], {row['verdict']}")
        if set(line[1:]) != {"-"}:
            body.append(line)
    return markdown(["scene", *(words for _, words in tables)], body)


def exact_bound(hits, n, tail):
    """The probability at which `hits` or more of n have the probability `tail` (Clopper and Pearson 1934)."""
    low, high = 0.0, 1.0
    for _ in range(60):
        p = 0.5 * (low + high)
        at_least = sum(math.comb(n, k) * p ** k * (1 - p) ** (n - k) for k in range(hits, n + 1))
        low, high = (p, high) if at_least < tail else (low, p)
    return low


def share_with_interval(hits, n):
    """As "22 of 24 [73, 99]": exact 95 %."""
    lower = exact_bound(hits, n, 0.025) if hits else 0.0
    upper = exact_bound(hits + 1, n, 0.975) if hits < n else 1.0
    return f"{hits} of {n} [{100 * lower:.0f}, {100 * upper:.0f}]"


def caught(spec):
    """In how many sets each test gave the verdict that something is wrong, with an exact 95 % interval in %, a row per table
    (tables: NAME as WORDS; ...; also: further verdicts that count). With `intervals: below` cells are counts, and a line below the
    table has the intervals of none, half and all. `own: WORDS as TEST; ...` adds in how many the fault of a row is named, and the most of any
    other of these tests and of `others`."""
    below = spec.get("intervals") == "below"
    wrong = {"too small", "correlated", "wrong", *words_of(spec.get("also"))}
    body, tests, sizes, own = [], spec.parts("tests"), set(), spec.parts("own")
    naming = list(dict.fromkeys([test for _, named in own for test in words_of(named)] + words_of(spec.get("others"))))

    def count(rows, test):
        verdicts = [row["verdict"] for row in select(rows, f"test={test}")]
        sizes.add(len(verdicts))
        return sum(verdict in wrong for verdict in verdicts), len(verdicts)

    for name, words in spec.parts("tables"):
        rows = read_table(name)
        line = [words]
        for test, _ in tests:
            hits, n = count(rows, test)
            line.append(f"{hits}/{n}" if below else share_with_interval(hits, n))
        if own:
            mine = words_of(dict(own).get(words, ""))
            shares = [[f"{hits}/{n}" for hits, n in sorted(count(rows, test) for test in some)] for some in
                      (mine, [test for test in naming if test not in mine])]
            line += [", ".join(shares[0]) or "-", shares[1][-1] if shares[1] else "-"]
        body.append(line)
    table = markdown(["what is planted", *(heading for _, heading in tests), *(["the fault named", "another named, most"] if own else [])], body)
    if not below:
        return table
    intervals = [share_with_interval(hits, n) for n in sorted(sizes, reverse=True) for hits in (0, n // 2, n)]
    return f"{table}\n\n" + filled(f"Exact 95 % intervals, %: {', '.join(intervals)}.")

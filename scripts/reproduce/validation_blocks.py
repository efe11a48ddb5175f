"""Blocks of what `rcme validate` found: each is a function of its spec that returns Markdown."""

import math
import statistics

from tables import filled, levels_of, markdown, read_table, rms_over_sd, select, the_row, words_of


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


def validation_values(spec):
    """Of each scene what `rcme validate` says of each test (tests: NAME as WORDS; ...): its value, interval and verdict; tests
    named with a unit of 100 are printed in per cent (percent: NAME, ...)."""
    rows = read_table(spec.argument)
    per_cent = words_of(spec.get("percent"))
    tests = spec.parts("tests")

    def shown(row):
        if not row["value"]:
            return "-"
        scale = 100 if row["test"] in per_cent else 1
        bounds = [scale * float(row[name]) if row[name] else math.inf for name in ("lower", "upper")]
        ranges = f" [{bounds[0]:.2g}, {bounds[1]:.2g}]" if row["lower"] else ""
        return f"{scale * float(row['value']):.2g}{ranges}, {row['verdict']}"

    body = []
    for scene in levels_of(rows, "set"):
        here = {row["test"]: row for row in select(rows, f"set={scene}")}
        pairs = here["calibration"]["n"] if "calibration" in here else "0"
        body.append([f"{scene} ({pairs})", *(shown(here[name]) if name in here else "-" for name, _ in tests)])
    return markdown(["scene (pairs)", *(heading for _, heading in tests)], body)


def median_ratios(spec):
    """By what covariances are too small: of each test the middle one of the sets' ratios, a row per table (tables: NAME as WORDS;
    ...)."""
    tests = words_of(spec.get("tests"))
    body = []
    for name, words in spec.parts("tables"):
        rows = read_table(name)
        ratios = [sorted(float(row["value"]) for row in select(rows, f"test={test}") if row["value"]) for test in tests]
        body.append([words, *(f"{statistics.median(each):.2f} ({each[0]:.2f} to {each[-1]:.2f})" for each in ratios)])
    return markdown(["", *tests], body)


def closures(spec):
    """Of `rcme validate --loops`, a row per set and number of images: the loops, and for each table (tables: NAME as WORDS; ...) the share
    within the 95 % region and the root mean square over its standard deviation, shared errors allowed for and ignored (`kinds`: one of them);
    `where` picks rows."""
    def cell(row):
        return f"{100 * float(row['covered']):.0f} %; {rms_over_sd(row)}"

    tables = [(select(read_table(name), spec.get("where", "of=pairs")), words) for name, words in spec.parts("tables")]
    kinds = words_of(spec.get("kinds", "allowed for, ignored"))
    head = ["set", "images", *(f"{words}: {what}" for _, words in tables for what in ("loops", *(f"shared errors {kind}" for kind in kinds)))]
    body = []
    for place in dict.fromkeys((row["set"], row["images"]) for rows, _ in tables for row in rows):
        line = list(place)
        for rows, _ in tables:
            here = {row["shared_errors"]: row for row in rows if (row["set"], row["images"]) == place}
            line += [next(iter(here.values()))["loops"] if here else "0", *(cell(here[kind]) if kind in here else "-" for kind in kinds)]
        body.append(line)
    return markdown(head, body)

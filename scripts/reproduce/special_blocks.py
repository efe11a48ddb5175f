"""Blocks that one page needs: each is a function of its spec that returns Markdown."""

import itertools
import json
import re

from recipes import MADE, RESULTS, ROOT, data, read_recipes
from tables import is_level, levels_of, markdown, rate, read_table, scientific, select, the_row
from validation_blocks import caught, truth_free

REFUSALS = ("no_candidate", "other_refusal")  # what the summary tells apart


def made_by():
    return json.loads(MADE.read_text()) if MADE.exists() else {}


def version_words(entry):
    return f"{entry['commit']}, {entry['date']}" if entry else "not noted"


def made(spec):
    """How results are made again, and by what they were made; a list where there are several."""
    lines = [how_made(name) for name in spec.argument.split()]
    return lines[0] if len(lines) == 1 else "\n".join("- " + line for line in lines)


def how_made(name):
    recipe, entry = read_recipes()[name], made_by().get(name, {})
    minutes = entry.get("cpu_minutes", recipe.cpu_minutes)
    commands = " ".join(recipe.commands)
    places = [f"`{place}`" for place in data() if "{" + place + "}" in commands]
    needs = f", needs {' and '.join(places)}" if places else ""
    return f"`scripts/results {recipe.name}`: {minutes:g} CPU minutes{needs}; commit {version_words(entry)}"


def largest_sigma(spec):
    """The largest noise level up to which every cell of the validity map covers so much."""
    rows = select(read_table(spec.argument), "conditioning=all")
    limits = [float(word) for word in spec.get("limits").split(",")]
    quantities = spec.parts("quantities")
    baselines = levels_of(rows, "baseline_m")
    body = []
    for points in levels_of(rows, "num_points"):
        line = [points]
        for quantity, _ in quantities:
            here = select(rows, f"num_points={points}, quantity={quantity}")
            line.append("; ".join(", ".join(up_to(here, baseline, limit) for limit in limits)
                                  for baseline in baselines))
        body.append(line)
    return markdown(["points"] + [heading for _, heading in quantities], body)


def up_to(rows, baseline, limit):
    largest = "-"
    for row in sorted(select(rows, f"baseline_m={baseline}"), key=lambda row: float(row["sigma_px"])):
        if float(row["coverage"]) < limit:
            break
        largest = row["sigma_px"]
    return largest


def mean_rate(rows):
    """Over all trials of several conditions."""
    return sum(float(row["value"]) * int(row["n"]) for row in rows) / sum(int(row["n"]) for row in rows)


def pooled(spec):
    """Failure and refusal over all conditions, and in how many of them Holm's p is below 0.05, of several studies; `only` picks estimators."""
    body, chosen = [], [name for name, _ in spec.parts("only")]
    for name, words in spec.parts("tables"):
        summary, paired = read_table(name), read_table(name + "_paired")
        for estimator in chosen or [level for level in levels_of(summary, "estimator") if level != "scene"]:
            rates = [sum(mean_rate(select(summary, f"{estimator}, {quantity}")) for quantity in quantities)
                     for quantities in (("failure",), REFUSALS)]
            pairs = [row for row in paired if row["estimator"] == estimator and row["event"] == "failure_or_refusal"]
            sure = [float(row["risk_difference"]) for row in pairs if float(row["p_holm"]) < 0.05]
            body.append([words, estimator, f"{100 * rates[0]:.2f}", f"{100 * rates[1]:.2f}",
                         f"{sum(each < 0 for each in sure)} of {len(pairs)}" if pairs else "(reference)",
                         f"{sum(each > 0 for each in sure)} of {len(pairs)}" if pairs else ""])
    return markdown(["study", "estimator", "failure, %", "refusal, %", "better in", "worse in"], body)


def verdict_counts(spec):
    """How many claims have which verdict, in a sentence."""
    rows = {row["claim"]: row["claim_verdict"] for row in read_table(spec.argument)}
    words = list(rows.values())
    counts = sorted(((words.count(each), each) for each in set(words)), reverse=True)
    phrases = {"holds": "hold", "does not hold": "do not hold", "undecided": "are undecided", "measured": "are only measured",
               "holds in the small-noise limit only": "hold in the small-noise limit only", "not possible": "are not possible"}
    return f"Of {len(rows)} claims, " + ", ".join(f"{count} {phrases[verdict]}" for count, verdict in counts) + "."


def verdict_families(spec):
    """A row per family of claims: which hold, hold for small noise only, are undecided and do not hold, without the family's name."""
    rows, verdicts_shown = read_table(spec.argument), spec.parts("verdicts")
    claims = {row["claim"]: row for row in rows}
    body = []
    for family in dict.fromkeys(claim.partition(".")[0] for claim in claims):
        line = [family]
        for verdict, _ in verdicts_shown:
            names = []
            for claim, row in claims.items():
                start, _, name = claim.partition(".")
                if start == family and row["claim_verdict"] == verdict:
                    limit = f" ({float(row['holds_up_to_sigma_px']):g} px)" if "limit" in verdict else ""
                    names.append(f"{name}{limit}")
            line.append(", ".join(names) or "-")
        body.append(line)
    return markdown(["family", *(words for _, words in verdicts_shown)], body)


def better(spec):
    """In how many conditions each estimator is surely better or worse than the reference; `only` picks estimators."""
    rows = read_table(spec.argument)
    chosen = [name for name, _ in spec.parts("only")] or levels_of(rows, "estimator")
    body = []
    for event, words in spec.parts("events"):
        for estimator in chosen:
            pairs = [row for row in rows if row["estimator"] == estimator and row["event"] == event]
            sure = [float(row["risk_difference"]) for row in pairs if float(row["p_holm"]) < 0.05]
            body.append([words, estimator, f"{sum(each < 0 for each in sure)} of {len(pairs)}",
                         f"{sum(each > 0 for each in sure)} of {len(pairs)}"])
    return markdown(["event", "estimator", "less often", "more often"], body)


def greatest(spec):
    """Of each estimator the study in which its paired difference is greatest, with the interval, and the others whose interval is above
    0, or below ("less")."""
    rows = [row for name in spec.argument.split() for row in select(read_table(name), spec.get("where"))]
    body = []
    for estimator in levels_of(rows, "estimator"):
        here = sorted(select(rows, f"estimator={estimator}"), key=lambda row: -float(row["risk_difference"]))
        others = [row["study"] for row in here[1:] if float(row["lower"]) > 0] + [f"{row['study']} (less)" for row in here if float(row["upper"]) < 0]
        body.append([estimator, here[0]["study"], rate(here[0]), ", ".join(others) or "-"])
    return markdown([heading for _, heading in spec.parts("columns")], body)


def one_at_a_time(spec):
    """A row where every factor is at its usual level, and one for each other level; `only` picks estimators, `show` factors."""
    rows = read_table(spec.argument)
    factors = [name for name, _ in spec.parts("factors")]
    base = dict(zip(factors, [level for level, _ in spec.parts("base")]))
    estimators = [name for name, _ in spec.parts("only")]
    cells = [word.strip() for word in spec.get("cells").split(",")]

    def line(factor, level):
        here = [row for row in rows if all(is_level(row[name], level if name == factor else base[name]) for name in factors)]
        return [" / ".join(value_or_dash(here, estimator, cell) for cell in cells) for estimator in estimators]

    body = [["(usual)", "", *line(factors[0], base[factors[0]])]]
    for factor in [name for name, _ in spec.parts("show")] or factors:
        body += [[factor, level, *line(factor, level)] for level in levels_of(rows, factor) if not is_level(level, base[factor])]
    return markdown(["factor", "level"] + estimators, body)


def value_or_dash(rows, estimator, quantity):
    quantities = REFUSALS if quantity == "refusal" else (quantity,)
    found = [the_row(rows, f"{estimator}, {each}") for each in quantities]
    return f"{100 * sum(float(row['value']) for row in found):.1f}" if all(row["value"] for row in found) else "-"


def rare(spec):
    """Weighted rates beside those of many more plain trials."""
    tilted, plain = read_table(spec.argument), read_table(spec.get("against"))
    body = []
    for event, words in spec.parts("events"):
        for ratio in levels_of(tilted, "outlier_ratio"):
            where = f"outlier_ratio={ratio}, {event}"
            body.append([ratio, words, scientific(the_row(tilted, where)), scientific(the_row(plain, where))])
    return markdown(["probability", "event", "tilted", "by brute force"], body)


def pooled_rates(spec):
    """Failure and refusal of each estimator over all conditions."""
    rows = read_table(spec.argument)
    body = []
    for estimator in [level for level in levels_of(rows, "estimator") if level != "scene"]:
        right, failed, *refused = [mean_rate(select(rows, f"{estimator}, {quantity}"))
                                   for quantity in ("success", "failure", *REFUSALS)]
        body.append([estimator] + [f"{100 * each:.1f}" for each in (right, failed, sum(refused))])
    return markdown(["estimator", "right", "failed", "refused"], body)


def ratios(spec):
    """The ratios of benchmarks with their intervals, a column per processor: the files of a folder."""
    files = [json.loads(path.read_text()) for path in sorted((ROOT / spec.argument).glob("*.json"))]
    body = []
    for key, words in spec.parts("rows"):
        measured = []
        for file in files:
            interval = file["intervals"].get(key)
            measured.append(f"{file['ratios'][key]:.3g} [{interval['lower']:.3g}, {interval['upper']:.3g}]" if interval else "")
        name, _, target = words.partition(", target ")
        body.append([name, *measured, target])
    return markdown(["ratio", *(f"{file['run']['processor']}, {file['run']['instruction_set']}" for file in files), "target set beforehand"], body)


def transfer(spec):
    """What `rcme transfer` printed, without the list of families on which a setting is violated. Each block of its table
    begins with the families; a line without one goes on with the line before."""
    lines = (RESULTS / spec.argument).read_text().splitlines()
    heads, table = [], {}
    for rule in (i for i, line in enumerate(lines) if line.startswith("---")):
        starts = [dashes.start() for dashes in re.finditer("-+", lines[rule])]

        def cut(line, starts=starts):
            return [line[start:end].strip() for start, end in zip(starts, [*starts[1:], None])]

        names = cut(lines[rule - 1])
        heads += [name for name in names if name not in heads]
        for line in itertools.takewhile(str.strip, lines[rule + 1:]):
            cells = cut(line)
            family = cells[0] or family
            row = table.setdefault(family, {})
            row |= {name: f"{row.get(name, '')} {cell}".strip() for name, cell in zip(names[1:], cells[1:])}
    body = [[family, *(row.get(name, "") for name in heads[1:-1])] for family, row in table.items()]
    return markdown(heads[:-1], [[cell.split(":")[0] if cell.startswith("none") else cell for cell in row] for row in body])


def least_coverage(spec):
    """The least coverage of all cells "coverage (that of the plain interval) width"."""
    cells = re.findall(r"(\d\.\d{3}) \((\d\.\d{3})\)", (RESULTS / spec.argument).read_text())
    new, plain = min(float(cell[0]) for cell in cells), min(float(cell[1]) for cell in cells)
    return (f"Yes. It covers at least {new:.3f} in each of {len(cells)} cells, where 0.95 is claimed. The plain interval, value +- 1.96 "
            f"standard errors, covers as little as {plain:.3f}.")


def twins(spec):
    """Of each scene and of all how many of the predicted, and of the fitted, quantities lie within their joint interval with a
    twin, and which do not."""
    rows = read_table(spec.argument)

    def within(here):
        return f"{sum(row['within'] == 'yes' for row in here)} of {len(here)}" if here else "-"

    def line_of(name, pairs, chosen, names_missed):
        line = [name, pairs]
        for twin, _ in spec.parts("twins"):
            here = select(chosen, f"twin={twin}")
            line += [within([row for row in here if row["fitted"] == fitted]) for fitted in ("no", "yes")]
            missed = [row["quantity"] for row in here if row["within"] == "no"]
            line.append((", ".join(missed) or "none") if names_missed else "")
        return line

    body = []
    for scene in levels_of(rows, "scene"):
        chosen = select(rows, f"scene={scene}")
        body.append(line_of(scene, chosen[0]["pairs"], chosen, True))
    body.append(line_of("all", str(sum(int(line[1]) for line in body)), rows, False))
    head = [words for _, heading in spec.parts("twins")
            for words in (heading + ": predicted within", "fitted within", "not within")]
    return markdown(["scene", "pairs", *head], body)


def twin_values(spec):
    """Of each scene and quantity of `quantities` what one twin (`twin`) predicts, and what was observed with its joint interval."""
    rows = select(read_table(spec.argument), f"twin={spec.get('twin')}")
    quantities = spec.parts("quantities")

    def shown(row):
        scale, form = (100, "{:.0f}") if row["kind"] == "rate" else (1, "{:.3g}")
        predicted, observed, lower, upper = (
            form.format(scale * float(row[name])) if row[name] else "-" for name in ("predicted", "observed", "lower", "upper"))
        return f"{predicted} / {observed} [{lower}, {upper}]" + ("" if row["within"] == "yes" else " *")

    body = []
    for scene in levels_of(rows, "scene"):
        found = {row["quantity"]: row for row in rows if row["scene"] == scene}
        body.append([scene, *(shown(found[name]) if name in found else "-" for name, _ in quantities)])
    return markdown(["scene", *(heading for _, heading in quantities)], body)


def winners(spec):
    """Of each study and each kind of table who succeeds most often, whose interval overlaps the winner's, and which of all
    these is fastest."""
    kinds = spec.parts("tables")
    body = []
    for study in spec.argument.split():
        line = [study.rpartition("/")[2]]
        for suffix, _ in kinds:
            rows = read_table(f"{study}_{suffix}")
            rates = {row["estimator"]: row for row in select(rows, "quantity=success")}
            best = max(rates, key=lambda name: (float(rates[name]["lower"]), float(rates[name]["value"])))
            equals = [name for name in rates
                      if name != best and float(rates[name]["upper"]) >= float(rates[best]["lower"])]
            times = {name: float(the_row(rows, f"{name}, quantity=mean_time_ms")["value"]) for name in [best, *equals]}
            fastest = min(times, key=times.get)
            line += [f"{best} {rate(rates[best])}", ", ".join(equals) or "-", f"{fastest} ({times[fastest]:.2g} ms)"]
        body.append(line)
    head = [part for _, words in kinds for part in (words, "intervals overlap", "fastest of these (mean time)")]
    return markdown(["study", *head], body)


SPECIAL = {"made": made, "largest_sigma": largest_sigma, "pooled": pooled, "verdict_counts": verdict_counts,
           "verdict_families": verdict_families, "better": better, "greatest": greatest, "one_at_a_time": one_at_a_time, "rare": rare,
           "pooled_rates": pooled_rates, "ratios": ratios, "transfer": transfer, "least_coverage": least_coverage, "winners": winners,
           "truth_free": truth_free, "caught": caught, "twins": twins, "twin_values": twin_values}

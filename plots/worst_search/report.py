"""The files of a search: a table of regions, and of each region a study, a failing trial and its picture."""

import csv
import io
import json
import os

import numpy as np

from common.command_line import PlotError
from common.whole_file import write_text
from worst_search.intervals import simultaneous_share
from worst_search.run_rcme import run_rcme
from worst_search.run_trials import QUANTITIES, SHARPNESS, number_text, study_text
from worst_search.search import INTERVALS_OF_REGION


def limit_text(space, key, limit):
    if isinstance(limit, frozenset):
        left_out = sorted(set(space.words[key]) - limit)
        return f"{key}: not {', '.join(left_out)}" if len(left_out) < len(limit) else f"{key}: {', '.join(sorted(limit))}"
    least, most = space.sorted[key][[0, -1]]
    ends = [f"{word} {number_text(end)}" for word, end in zip(("from", "to"), limit) if np.isfinite(end)]
    return f"{key}: {' '.join(ends)} (drawn from {least:.3g} to {most:.3g})"


def share_of(region, num_regions, held_out):
    """A region's share of the population, on draws that had no part in the search, so that the shares and rates of all regions
    hold together."""
    return simultaneous_share(int(region.box.contains(held_out).sum()), held_out.size, INTERVALS_OF_REGION * num_regions)


def fresh_answer(objective, region):
    with open(objective.path(region.name, ".json"), encoding="utf-8") as file:
        return json.load(file)


def sharpness_columns(objective, region):
    """Of a miscoverage: medians of what the answers of its fresh trials state."""
    if objective.quantity != "miscoverage":
        return {}
    return {key: fresh_answer(objective, region).get("sharpness", {}).get(key) for key in SHARPNESS}


def sharpness_text(row):
    """Lines; none if no sharpness is known or asked for."""
    if row.get("sd_over_crb") is not None:
        return [f"  stated sd (median): {row['sd_over_crb']:.3g} times the least possible"]
    if row.get("rotation_sd_deg") is not None:
        return [f"  stated sd (median): {row['rotation_sd_deg']:.2g} deg of rotation, "
                f"{row['direction_sd_deg']:.2g} deg of direction"]
    return []


def row_of(objective, plan, number, region, share):
    return {"region": number, "rate": region.rate.estimate, "lower": region.rate.lower, "upper": region.rate.upper,
            "events": region.fresh.events, "reverse": region.fresh.reverse, "trials": region.fresh.trials,
            "claim": plan.claim, "is_find": region.is_find, "share": share.estimate, "share_lower": share.lower,
            "share_upper": share.upper, "search_rate": region.search_rate, **sharpness_columns(objective, region),
            "limits": "; ".join(limit_text(objective.space, k, v) for k, v in region.box.limits)}


def as_csv(rows):
    text = io.StringIO()
    writer = csv.DictWriter(text, list(rows[0]) if rows else ["region"], lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def percent(value):
    return f"{100 * value:.1f}"


def as_text(objective, plan, regions, rows, num_held_out):
    who = objective.labels[0] + (f" less {objective.labels[1]}" if objective.is_difference else "")
    lines = [f"{objective.study['name']}: {who}, {objective.quantity}: {QUANTITIES[objective.quantity]}",
             f"{objective.calls} trials were spent; the intervals of all rates and shares hold together with 95 %",
             f"(shares: of {num_held_out} draws of the population that had no part in the search)"]
    if not rows:
        lines.append("No region was found.")
    for row, region in zip(rows, regions):
        verdict = "above the claim" if region.is_find else "not surely above the claim"
        lines += ["", f"Region {row['region']}: {percent(row['rate'])} % [{percent(row['lower'])}, {percent(row['upper'])}] of "
                  f"{row['trials']} fresh trials ({verdict} of {percent(plan.claim)} %); {100 * row['share']:.2f} % "
                  f"[{100 * row['share_lower']:.2f}, {100 * row['share_upper']:.2f}] of the population"]
        lines += sharpness_text(row)
        lines += ["  " + limit_text(objective.space, key, limit) for key, limit in region.box.limits]
    return "\n".join(lines) + "\n"


def typical(objective, answer):
    """[condition, trial] of the event that is nearest to all others, by the shares of its levels."""
    failing = answer["failing"]
    if not failing:
        return None
    place = {condition: i for i, condition in enumerate(answer["conditions"])}
    features = objective.space.encode(objective.space.table([answer["levels"][place[c]] for c, _ in failing]))
    distances = np.abs(features[:, None, :] - features[None, :, :]).sum(axis=(1, 2))
    return failing[int(np.argmin(distances))]


def show(objective, number, study, answer):
    """Paths of the explanation and the pictures of a failing trial; none without one."""
    event = typical(objective, answer)
    if event is None:
        return []
    out = os.path.join(objective.folder, f"region_{number}")
    command = [objective.rcme, "show", study, "--condition", str(event[0]), "--trial", str(event[1]), "--estimators",
               ",".join(objective.labels), "--out", out, *objective.more]
    shown = run_rcme(command)
    if shown.returncode != 0:
        raise PlotError(f"the picture of region {number} was not drawn: {shown.stderr.strip()}")
    write_text(out + ".txt", shown.stdout)
    return [out + suffix for suffix in (".txt", ".png", ".pdf")]


def write_report(objective, plan, regions, held_out):
    """The paths that were written. `held_out`: a Table of draws of the population that had no part in the search."""
    rows = [row_of(objective, plan, number, region, share_of(region, len(regions), held_out))
            for number, region in enumerate(regions, 1)]
    paths = []
    for number, region in enumerate(regions, 1):
        study = objective.study_of_box(region.name, region.box, plan.num_fresh, "random")
        study = {**study, "name": f"{objective.study['name']}_region_{number}",
                 "description": f"Region {number} of a search for the worst {objective.quantity} of {objective.labels[0]}: "
                                "the draws of its fresh trials."}
        path = os.path.join(objective.folder, f"region_{number}.yaml")
        write_text(path, study_text(study))
        paths += [path, *show(objective, number, path, fresh_answer(objective, region))]
    text = as_text(objective, plan, regions, rows, held_out.size)
    files = {"worst.txt": text, "worst.csv": as_csv(rows),
             "worst.json": json.dumps({"format": "rcme worst 1", "study": objective.study["name"],
                                       "estimators": objective.labels, "quantity": objective.quantity,
                                       "claim": plan.claim, "trials": objective.calls, "budget": plan.budget,
                                       "regions": rows}, indent=1) + "\n"}
    for name, content in files.items():
        write_text(os.path.join(objective.folder, name), content)
        paths.append(os.path.join(objective.folder, name))
    print(text)
    return paths

"""The audit's numbers as tables, of audit.json: a row per claimed number; the coverage by difficulty."""

import csv
import io

COLUMNS = ["claim", "family", "reading", "claim_verdict", "holds_up_to_sigma_px", "conditions", "quantity", "kind",
           "nominal", "low", "high", "value", "lower", "upper", "n", "verdict", "side"]
TIMED = ",complexity,"  # in every row of the family whose numbers are times


def audit_rows(audit):
    for claim in audit["claims"]:
        head = {"claim": claim["id"], "family": claim["family"], "reading": claim["reading"],
                "claim_verdict": claim["verdict"], "holds_up_to_sigma_px": claim.get("holds_up_to_sigma_px")}
        for evidence in claim["evidence"]:
            place = place_of(evidence)
            for target in evidence["targets"]:
                interval = target.get("interval") or [None, None]
                yield head | {"conditions": place, "quantity": target["quantity"], "kind": target["kind"],
                              "nominal": target.get("nominal"), "low": target.get("low"), "high": target.get("high"),
                              "value": target["measured"], "lower": interval[0], "upper": interval[1],
                              "n": target["n"], "verdict": target["verdict"], "side": target["side"]}


def text_of(value):
    """Six digits of a number are more than any page shows; a missing one is an empty cell."""
    return "" if value is None else f"{value:.6g}" if isinstance(value, float) else str(value)


def as_csv(columns, rows):
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(rows)
    return text.getvalue()


def audit_csv(audit):
    return as_csv(COLUMNS, ([text_of(row[column]) for column in COLUMNS] for row in audit_rows(audit)))


def place_of(evidence):
    return "; ".join(f"{name} {level}" for name, level in evidence["conditions"].items())


def fifths_csv(audit):
    """The coverage at alpha 0.05 by fifths of the Cramer-Rao bound, easiest first, with the digits of the audit's page."""
    rows = ([claim["id"], place_of(evidence), place, *(f"{bound:.3g}" for bound in fifth["bound_deg"]),
             *(f"{value:.4g}" for value in (fifth["measured"], *fifth["interval"])), fifth["n"]]
            for claim in audit["claims"] for evidence in claim["evidence"]
            for place, fifth in enumerate(evidence.get("fifths_of_difficulty", []), 1))
    return as_csv(["claim", "conditions", "fifth", "least_bound_deg", "greatest_bound_deg", "value", "lower", "upper", "n"], rows)


TABLES = {"audit": audit_csv, "fifths": fifths_csv}  # `table` of a file in results.toml


def without_times(text):
    """The table without the rows of measured times."""
    return [line for line in text.splitlines() if TIMED not in line]

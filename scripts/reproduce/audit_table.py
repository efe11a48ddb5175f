"""The audit's numbers as one table: a row per claimed number, of audit.json."""

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
            place = "; ".join(f"{name} {level}" for name, level in evidence["conditions"].items())
            for target in evidence["targets"]:
                interval = target.get("interval") or [None, None]
                yield head | {"conditions": place, "quantity": target["quantity"], "kind": target["kind"],
                              "nominal": target.get("nominal"), "low": target.get("low"), "high": target.get("high"),
                              "value": target["measured"], "lower": interval[0], "upper": interval[1],
                              "n": target["n"], "verdict": target["verdict"], "side": target["side"]}


def text_of(value):
    """Six digits of a number are more than any page shows; a missing one is an empty cell."""
    return "" if value is None else f"{value:.6g}" if isinstance(value, float) else str(value)


def audit_csv(audit):
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for row in audit_rows(audit):
        writer.writerow([text_of(row[column]) for column in COLUMNS])
    return text.getvalue()


def without_times(text):
    """The table without the rows of measured times."""
    return [line for line in text.splitlines() if TIMED not in line]

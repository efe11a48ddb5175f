"""What a picture of a trial says in words; the numbers are those of the file."""

from common import style
from common.number_text import is_number

OUTCOMES = {"success": "within the bounds", "failure": "failure", "refusal": "refusal", "not_scored": "not scored"}


def number(value, unit=""):
    return "\u2013" if value is None else f"{value:.3g}{unit}"


def degrees(value):
    return number(value, "\u00b0")


def per_cent(value):
    return "\u2013" if value is None else f"{100 * value:.1f} %"


def title_of(trial):
    facts = trial.facts
    return f"{facts['study']}, condition {facts['condition']}, trial {facts['trial']}, seed {facts['seed']}"


def levels_of(trial):
    """Those of the condition's factors that say something, in words."""
    return ", ".join(style.level_in_words(name, rounded(level)) for name, level in trial.facts["factors"]
                     if level not in ("-", "none"))


def rounded(level):
    """'0.0447245' -> '0.0447'; whole numbers and words as they are."""
    if level.lstrip("-").isdigit() or not is_number(level):
        return level
    return f"{float(level):.3g}"


def outcome_of(trial, estimate):
    """One line over an estimator's images."""
    words = OUTCOMES[estimate.outcome]
    if estimate.status != "ok":
        return f"{words} ({estimate.status}): {estimate.message}"
    if estimate.rotation_error_deg is not None:
        words += f"; rotation {degrees(estimate.rotation_error_deg)} off"
        if estimate.direction_error_deg is not None:
            words += f", direction {degrees(estimate.direction_error_deg)} off"
    return words + f"; {len(estimate.inliers)} of {len(trial.matches)} matches accepted"


def facts_of(trial):
    """How hard the problem is, a sentence or less each."""
    severity, count = trial.severity, len(trial.matches)
    if trial.kinds is None:
        return [f"{count} matches of {trial.facts['origin']}; which of them are true is not known. Assumed noise: "
                f"{number(trial.facts['sigma_px'])} px."]
    num_true, num_hidden = (int((trial.kinds == kind).sum()) for kind in ("inlier", "undetectable"))
    parts = ", ".join(f"{part} {name}" for part, name in trial.facts["parts"])
    facts = [f"{parts[:1].upper()}{parts[1:]}.",
             f"{count} matches: {num_true} true, {count - num_true} wrong" +
             (f", of these {num_hidden} on their true epipolar line" if num_hidden else "") + ".",
             f"Assumed noise: {number(trial.facts['sigma_px'])} px.",
             f"Baseline: {number(trial.baseline_m)} m." if trial.baseline_m else "No baseline: a pure rotation."]
    known = [("image_coverage", per_cent, "of image 1 covered by true matches."),
             ("parallax_median_deg", degrees, "parallax (median of the true matches)."),
             ("chance_inlier_share", per_cent, "of uniform wrong matches would pass the true motion's 95 % test.")]
    facts += [f"{shown(severity[name])} {words}" for name, shown, words in known if severity.get(name) is not None]
    bounds = [f"{degrees(severity[name])} in {of}" for name, of in (("crb_rotation_deg", "rotation"),
                                                                    ("crb_direction_deg", "direction"))
              if severity.get(name) is not None]
    if bounds:
        facts.append(f"Gaussian bound: {' and '.join(bounds)}. No unbiased estimator can be better (root mean square) "
                     "with these true matches and normal noise, even if it knows which they are.")
    return facts


def table_of(trial, looks):
    """(names of the columns, rows of cells); no precision and recall where nobody knows what is true."""
    rows = [[looks[e.label].label, OUTCOMES[e.outcome] if e.status == "ok" else e.status.replace("_", " "),
             degrees(e.rotation_error_deg), degrees(e.direction_error_deg), f"{len(e.inliers)}", per_cent(e.precision),
             per_cent(e.recall)] for e in trial.estimates]
    names = ["Estimator", "Outcome", "Rotation error", "Direction error", "Accepted", "Precision", "Recall"]
    shown = slice(None) if trial.kinds is not None else slice(-2)
    return names[shown], [row[shown] for row in rows]


def missing_truth(trial):
    """Why there are no true epipolar lines; empty if there are."""
    if trial.F_true is not None:
        return []
    if not trial.truth:
        return ["The true motion is not known: no true epipolar lines, no errors."]
    if trial.baseline_m == 0:
        return ["A pure rotation: both cameras have one centre, so neither a direction of translation nor true epipolar "
                "lines are defined; those of an estimate say only what it takes for true."]
    return ["The true direction of translation is not known well enough: no true epipolar lines, only rotations are "
            "scored."]


def notes_of(trial, num_outside):
    """The caption's sentences. `num_outside`: points that the view from above leaves out; None: there is no view."""
    notes = missing_truth(trial)
    if trial.truth:
        bounds = trial.facts["bounds"]
        notes.append(f"Failed: rotation error above {degrees(bounds['max_rotation_error_deg'])} or direction error above "
                     f"{degrees(bounds['max_direction_error_deg'])}.")
    if trial.selected:
        has_lines = any(estimate.F is not None for estimate in trial.drawn)
        notes.append(f"Matches 1\u2013{len(trial.selected)} are spread over image 1" +
                     ("; in image 2 a number at the border names the match of an estimated line." if has_lines else "."))
    if num_outside is not None:
        notes.append(f"The scene in camera 1's frame, x to the right and z ahead; {num_outside} of {len(trial.matches)} "
                     "points lie outside the view. Of a wrong match it shows the point that one image should have shown.")
        if trial.baseline_m:
            notes.append("The cameras: broad line, the true way from 1 to 2; arrow, where an estimator puts camera 2 "
                         "at the true distance, the dotted circle; z points up from above, to the right from the right.")
    if trial.kinds is not None:
        notes.append("Precision: true ones among the accepted matches, those that no epipolar test can tell left out; "
                     "recall: accepted ones among the true.")
    return notes

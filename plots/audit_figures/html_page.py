"""The audit as one HTML page: what holds and what does not, the figures, and folded below each its claims with every number."""

import math

from audit_figures import audit_file as audit_of
from audit_figures import look
from common.number_text import number_text, power_text
from page.html import code, details, element, joined, page, table
from page.picture import picture_of
from page.script import SCRIPT
from page.style import CSS

CLASSES = {audit_of.HOLDS: "holds", audit_of.HOLDS_AT_SMALL_NOISE: "holds", audit_of.DOES_NOT_HOLD: "fails"}
ORDER = (audit_of.DOES_NOT_HOLD, audit_of.UNDECIDED, audit_of.HOLDS_AT_SMALL_NOISE, audit_of.HOLDS, audit_of.MEASURED,
         audit_of.NOT_POSSIBLE)  # what a reader must know comes first
DASH = "\u2013"


def anchor(claim):
    return "claim-" + "".join(character if character.isalnum() else "-" for character in f"{claim.id} {claim.reading}".strip())


def name_of(claim):
    return f"{claim.id} ({claim.reading})" if claim.reading else claim.id


def verdict(text, of=None):
    """With its mark, so that colour is not the only carrier."""
    return element("span", f"{look.LOOKS[of or text].glyph} {text}" if of is None else text, class_=CLASSES.get(of or text, "open"))


def findings(audit):
    """The claims by what became of them."""
    items = []
    for kind in ORDER:
        claims = [claim for claim in audit.claims if claim.verdict == kind]
        if claims:
            links = [joined(["; " if position else "", element("a", name_of(claim), href=f"#{anchor(claim)}")])
                     for position, claim in enumerate(claims)]
            items.append(joined([element("strong", verdict(kind)), f" ({len(claims)} of {len(audit.claims)}): ", *links]))
    return element("ul", *(element("li", item) for item in items), class_="findings")


def range_in_words(target):
    """What counts as nominal."""
    if not target.is_claim:
        return DASH
    low, high = (number_text(bound) for bound in (target.low, target.high))
    nominal = "" if math.isnan(target.nominal) else f"{number_text(target.nominal)} in "
    return f"{nominal}[{low}, {high}]"


def measured_in_words(target):
    return look.measured_text(target) + (" %" if target.kind == "rate" and not math.isnan(target.measured) else "")


def conditions_in_words(evidence):
    return ", ".join(f"{name} = {level}" for name, level in evidence.conditions.items()) or DASH


def numbers_of(claim):
    rows = []
    for evidence in claim.evidence:
        if evidence.not_possible:
            rows.append([conditions_in_words(evidence), DASH, DASH, DASH, 0, f"not possible: {evidence.not_possible}"])
        rows += [[conditions_in_words(evidence), target.quantity, range_in_words(target), measured_in_words(target), target.n,
                  verdict(f"{look.LOOKS[target.verdict].glyph} {look.with_side(target.verdict, target.side)}", target.verdict)]
                 for target in evidence.targets]
    return table("Every measured number with its interval; rates are in per cent, what counts as nominal is a fraction.",
                 ["conditions", "quantity", "counts as nominal", "measured", "n", "verdict"], [(None, rows)], 2, class_="words")


def claim_section(claim):
    said = [element("p", f"{claim.label}: \u201c{claim.sentence}.\u201d Measured: {claim.statistic}.")] if claim.sentence else []
    return element("div", details(joined([name_of(claim), ": ", verdict(look.verdict_text(claim), claim.verdict)]), *said,
                                  numbers_of(claim)), id=anchor(claim))


def family_section(audit, family, claims, draw):
    alt = (f"Claims of the family {family}: {len(claims)} panels or more with measured values, their intervals and the range that "
           "counts as nominal; the numbers are in the tables below.")
    figure = element("figure", picture_of(lambda: draw(audit, family, claims), alt),
                     element("figcaption", f"Family {family}. Drawn by ", code("rcme plot audit FOLDER"), "."))
    return element("section", element("h3", family, id=f"family-{family}"), "\n", figure, "\n",
                   *(claim_section(claim) + "\n" for claim in claims))


def verdicts(audit):
    rows = [[element("a", name_of(claim), href=f"#{anchor(claim)}"), claim.sentence or DASH, verdict(look.verdict_text(claim),
                                                                                                  claim.verdict)]
            for claim in audit.claims]
    return details("Every claim and its verdict", table("In the order of the paper.", ["claim", "the paper says", "verdict"],
                                                        [(None, rows)], class_="words"))


def audit_page(audit, draw):
    """The whole page; draw(audit, family, claims) is the figure of a family."""
    title = "Audit of the paper's claims" + (f" on study {audit.study}" if audit.study else "")
    confidence = f"1\u00a0\u2212\u00a0{power_text(1 - audit.confidence_per_target)}"
    header = element("header", element("h1", title), element(
        "p", f"Seed {audit.seed}, budget {audit.budget}. Every claim is a rate or a mean with a range that counts as nominal; it holds "
        f"only if the whole interval lies in that range. Intervals hold at all sample sizes at once, with confidence {confidence} each.",
        class_="subtitle"))
    families = audit.families()
    contents = element("nav", details("Contents", element("ul", *(
        element("li", element("a", family, href=f"#family-{family}")) for family in families))), aria_label="Contents")
    return page(title, CSS, SCRIPT, joined([header, contents, element(
        "main", element("h2", "Findings"), findings(audit), verdicts(audit), element("h2", "Figures and numbers"), "\n",
        *(family_section(audit, family, claims, draw) for family, claims in families.items()))]))

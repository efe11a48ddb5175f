"""The one script of a page: a heading of a table sorts its rows. Without it the page lacks nothing else.

Numbers go by their first number, words as words, dashes last; a second press turns the order round. Rows of a group (a
condition) stay in it.
"""

SCRIPT = """
"use strict";
const number = /^[\\u2212+-]?\\d[\\d,]*(\\.\\d+)?(e[+-]?\\d+)?/;
function keyOf(cell) {
  const text = cell ? cell.textContent.trim() : "";
  if (text === "" || text === "\\u2013") return null;
  const found = text.match(number);
  return found ? Number(found[0].replace(/,/g, "").replace("\\u2212", "-")) : text;
}
function compare(a, b, sign) {
  if (a === null || b === null) return (a === null) - (b === null);
  if (typeof a !== typeof b) return sign * (typeof a === "number" ? -1 : 1);
  return sign * (typeof a === "number" ? a - b : a.localeCompare(b, "en"));
}
function sortBy(heading, column) {
  const sign = heading.getAttribute("aria-sort") === "ascending" ? -1 : 1;
  for (const other of heading.parentElement.children) other.removeAttribute("aria-sort");
  heading.setAttribute("aria-sort", sign > 0 ? "ascending" : "descending");
  for (const body of heading.closest("table").tBodies) {
    const rows = [...body.rows].filter(row => !row.querySelector("[scope=rowgroup]"));
    const keyed = rows.map(row => [keyOf(row.cells[column]), row]);
    keyed.sort((a, b) => compare(a[0], b[0], sign));
    for (const [, row] of keyed) body.append(row);
  }
}
for (const heading of document.querySelectorAll("thead th")) {
  if (heading.closest("table").querySelectorAll("tbody tr").length < 2) continue;
  const button = document.createElement("button");
  button.type = "button";
  button.append(...heading.childNodes);
  heading.append(button);
  button.addEventListener("click", () => sortBy(heading, heading.cellIndex));
}
function openTarget() {
  const place = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  const folded = place && (place.closest("details") || place.querySelector("details"));
  if (folded) folded.open = true;
}
addEventListener("hashchange", openTarget);
openTarget();
"""

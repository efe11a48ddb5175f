"""How the report looks on a screen and on paper."""

CSS = """
:root { color-scheme: light; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 78rem; padding: 1.5rem 2rem 4rem; background: #fff; color: #1a1a1a;
  font: 16px/1.5 system-ui, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .3rem; overflow-wrap: anywhere; }
h2 { font-size: 1.45rem; line-height: 1.25; margin: 3rem 0 .8rem; padding-top: .8rem; border-top: 3px solid #0072b2;
  overflow-wrap: anywhere; }
h3 { font-size: 1.12rem; margin: 2rem 0 .5rem; }
p, dl, ul, ol { margin: .5rem 0; max-width: 52rem; }
a { color: #00558a; }
:focus-visible { outline: 3px solid #e69f00; outline-offset: 2px; }
code, pre { font: .86em/1.45 ui-monospace, "DejaVu Sans Mono", Menlo, Consolas, monospace; }
p code, li code, dd code, figcaption code { overflow-wrap: anywhere; }
pre { background: #f4f5f6; border: 1px solid #dcdfe2; border-radius: 4px; padding: .7rem .9rem; overflow-x: auto;
  white-space: pre-wrap; overflow-wrap: anywhere; }
nav { background: #f4f5f6; border: 1px solid #dcdfe2; border-radius: 4px; padding: .6rem 1rem; margin: 1.2rem 0; }
nav h2 { all: unset; display: block; font-weight: 600; }
nav > ul { columns: 2; column-gap: 2rem; }
nav ul { margin: .2rem 0; padding-left: 1.2rem; max-width: none; }
nav li { break-inside: avoid; overflow-wrap: anywhere; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .15rem 1.2rem; }
dt { font-weight: 600; max-width: 16rem; overflow-wrap: anywhere; }
dd { margin: 0; overflow-wrap: anywhere; }
.scroll { overflow-x: auto; margin: .8rem 0 1.2rem; }
table { border-collapse: collapse; font-size: .82rem; line-height: 1.3; font-variant-numeric: tabular-nums; }
caption { text-align: left; caption-side: top; padding: 0 0 .5rem; color: #444; font-size: .95em; max-width: 60rem; }
th, td { padding: .28rem .55rem; text-align: right; vertical-align: top; border-bottom: 1px solid #e4e6e8; }
td { white-space: nowrap; }
thead th { vertical-align: bottom; border-bottom: 2px solid #555; font-weight: 600; }
th.name, th[scope=rowgroup] { text-align: left; }
th.name[scope=row] { font-weight: 400; white-space: nowrap; }
th[scope=rowgroup] { background: #eef2f5; font-weight: 600; }
.aside { font-weight: 400; margin-left: 2rem; }
tbody tr:hover > * { background: #f2f7fb; }
small { font-size: .87em; color: #555; }
thead code { font-weight: 400; color: #555; font-size: .85em; }
.overview :is(th, td), .conditions :is(th, td) { text-align: left; white-space: normal; }
details { margin: .8rem 0; }
summary { cursor: pointer; font-weight: 600; color: #00558a; }
figure { margin: 1rem 0 1.8rem; }
figure img { display: block; max-width: 100%; height: auto; }
figcaption { font-size: .86rem; color: #444; max-width: 60rem; margin-top: .3rem; }
.note { color: #444; border-left: 4px solid #c8ccd0; padding: .1rem .8rem; }
.subtitle { color: #444; margin-top: 0; }
@media (max-width: 50rem) { body { padding: 1rem; } nav > ul { columns: 1; } }
@media print {
  @page { size: A4 landscape; margin: 12mm; }
  body { max-width: none; padding: 0; font-size: 10pt; }
  h2 { break-before: page; margin-top: 0; }
  nav h2 { break-before: auto; }
  h3, caption { break-after: avoid; }
  .scroll { overflow: visible; }
  table { font-size: 7.2pt; }
  th, td { padding: .12rem .35rem; }
  thead { display: table-header-group; }
  tr, figure { break-inside: avoid; }
  tr:has(th[scope=rowgroup]) { break-after: avoid; }
  figure img { max-height: 165mm; width: auto; }
  details.study::details-content { content-visibility: visible; display: block; block-size: auto; }
}
"""

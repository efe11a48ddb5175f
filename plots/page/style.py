"""How a page looks on a screen, wide or narrow, light or dark, and on paper."""

CSS = """
:root { color-scheme: light dark; --paper: #fff; --ink: #1a1a1a; --soft: #555; --panel: #f4f5f6; --line: #dcdfe2;
  --rule: #e4e6e8; --link: #00558a; --accent: #0072b2; --group: #eef2f5; --hover: #f2f7fb; --focus: #b35c00; }
@media (prefers-color-scheme: dark) {
  :root { --paper: #16191c; --ink: #e6e6e3; --soft: #b3b7ba; --panel: #20252a; --line: #3a4147; --rule: #30363b;
    --link: #7cc4f2; --accent: #56b4e9; --group: #262c32; --hover: #22303a; --focus: #f0a63c; }
}
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 80rem; padding: 1.5rem 2rem 4rem; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .3rem; overflow-wrap: anywhere; }
h2 { font-size: 1.45rem; line-height: 1.25; margin: 2.2rem 0 .8rem; padding-top: .8rem; border-top: 3px solid var(--accent);
  overflow-wrap: anywhere; }
h3 { font-size: 1.12rem; margin: 1.6rem 0 .5rem; overflow-wrap: anywhere; }
h4 { font-size: 1rem; margin: 1rem 0 .4rem; overflow-wrap: anywhere; }
p, dl, ul, ol { margin: .5rem 0; max-width: 52rem; }
ul.findings { padding-left: 1.2rem; }
ul.findings li { margin: .3rem 0; overflow-wrap: anywhere; }
a { color: var(--link); }
:focus-visible { outline: 3px solid var(--focus); outline-offset: 2px; }
code, pre { font: .86em/1.45 ui-monospace, "DejaVu Sans Mono", Menlo, Consolas, monospace; }
p code, li code, dd code, figcaption code { overflow-wrap: anywhere; }
pre { background: var(--panel); border: 1px solid var(--line); border-radius: 4px; padding: .7rem .9rem; overflow-x: auto;
  white-space: pre-wrap; overflow-wrap: anywhere; }
nav { background: var(--panel); border: 1px solid var(--line); border-radius: 4px; padding: .2rem 1rem; margin: 1.2rem 0; }
nav > details > ul { columns: 2; column-gap: 2rem; max-width: none; }
nav ul { margin: .2rem 0; padding-left: 1.2rem; }
nav li { break-inside: avoid; overflow-wrap: anywhere; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .15rem 1.2rem; }
dt { font-weight: 600; max-width: 16rem; overflow-wrap: anywhere; }
dd { margin: 0; overflow-wrap: anywhere; }
.beside { display: grid; grid-template-columns: minmax(0, 1fr) minmax(0, 24rem); gap: 0 1.6rem; align-items: start; }
.beside > aside { position: sticky; top: 1rem; background: var(--panel); border: 1px solid var(--line); border-radius: 4px;
  padding: .2rem .7rem .6rem; max-height: calc(100vh - 2rem); overflow-y: auto; }
aside table { font-size: .76rem; }
aside :is(th, td) { padding: .2rem .3rem; }
aside thead :not([aria-sort]) > button::after { content: ""; }
aside th.name[scope=row] { white-space: normal; }
aside h3 { margin-top: .6rem; }
aside p, aside caption { font-size: .82rem; color: var(--soft); }
.scroll { overflow-x: auto; margin: .8rem 0 1.2rem; }
table { border-collapse: collapse; font-size: .82rem; line-height: 1.3; font-variant-numeric: tabular-nums; }
caption { text-align: left; caption-side: top; padding: 0 0 .5rem; color: var(--soft); font-size: .95em;
  max-width: min(60rem, calc(100vw - 1.8rem)); }
th, td { padding: .28rem .55rem; text-align: right; vertical-align: top; border-bottom: 1px solid var(--rule); }
td { white-space: nowrap; }
thead th { vertical-align: bottom; border-bottom: 2px solid var(--soft); font-weight: 600; }
thead button { all: unset; cursor: pointer; display: block; width: 100%; border-radius: 2px; }
thead button::after { content: "\\2195"; color: var(--soft); font-weight: 400; padding-left: .3em; }
thead [aria-sort=ascending] button::after { content: "\\2191"; color: var(--accent); }
thead [aria-sort=descending] button::after { content: "\\2193"; color: var(--accent); }
thead button:focus-visible { outline: 3px solid var(--focus); }
th.name, th[scope=rowgroup] { text-align: left; }
th.name[scope=row] { font-weight: 400; white-space: nowrap; }
th[scope=rowgroup] { background: var(--group); font-weight: 600; }
.aside { font-weight: 400; margin-left: 2rem; }
tbody tr:hover > * { background: var(--hover); }
small { font-size: .87em; color: var(--soft); }
thead code { font-weight: 400; color: var(--soft); font-size: .85em; }
.overview :is(th, td), .conditions :is(th, td), .words :is(th, td) { text-align: left; white-space: normal; }
.words :is(th, td) { min-width: 5rem; max-width: 26rem; overflow-wrap: anywhere; }
details { margin: .8rem 0; }
summary { cursor: pointer; font-weight: 600; color: var(--link); overflow-wrap: anywhere; }
figure { margin: 1rem 0 1.8rem; }
figure img { display: block; max-width: 100%; height: auto; background: #fff; border-radius: 4px; }
figcaption { font-size: .86rem; color: var(--soft); max-width: 60rem; margin-top: .3rem; }
.note { color: var(--soft); border-left: 4px solid var(--line); padding: .1rem .8rem; }
.subtitle { color: var(--soft); margin-top: 0; }
.holds { color: #00785a; } .fails { color: #c2410c; } .open { color: var(--soft); }
@media (prefers-color-scheme: dark) { figure img { filter: brightness(.92); } .holds { color: #4cc9a0; } .fails { color: #ff9d70; } }
@media (max-width: 64rem) { .beside { grid-template-columns: minmax(0, 1fr); } .beside > aside { position: static; max-height: none; } }
@media (max-width: 40rem) {
  body { padding: .8rem; font-size: 15px; }
  nav > details > ul { columns: 1; }
  dl { grid-template-columns: minmax(0, 1fr); gap: 0; }
  dd { margin: 0 0 .5rem; }
  figure img { width: 100%; }
  figure .wide img { max-width: none; width: auto; }
  .aside { display: block; margin-left: 0; }
}
@media (prefers-reduced-motion: no-preference) { html { scroll-behavior: smooth; } }
@media print {
  @page { size: A4 portrait; margin: 12mm; }
  :root { color-scheme: light; --paper: #fff; --ink: #000; --soft: #444; --panel: #fff; --group: #eee; --link: #000; --rule: #ccc; }
  body { max-width: none; padding: 0; font-size: 10pt; }
  .beside { display: block; }
  h2 { break-before: page; margin-top: 0; }
  h3, caption { break-after: avoid; }
  .scroll { overflow: visible; }
  table { font-size: 7.2pt; }
  th, td { padding: .12rem .25rem; }
  td { white-space: normal; }
  thead th { overflow-wrap: anywhere; }
  thead { display: table-header-group; }
  thead button::after { content: ""; }
  tr, figure { break-inside: avoid; }
  tr:has(th[scope=rowgroup]) { break-after: avoid; }
  figure img { max-height: 230mm; width: auto; filter: none; }
  details.study::details-content { content-visibility: visible; display: block; block-size: auto; }
}
"""

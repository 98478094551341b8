#include "client/cli/report_style.h"

namespace milepost {

// The colours of methods are Okabe and Ito's, which colour-blind people can tell apart, each a
// little darker on white and lighter on black.
std::string_view report_style() {
  return R"css(
:root {
  color-scheme: light dark;
  --page: #fff; --ink: #1b1e23; --muted: #5c636e; --rule: #d9dde3; --grid: #eceef1; --band: #8a93a040;
  --road: #d5dae1; --m0: #0067a8; --m1: #c94f00; --m2: #00805c; --m3: #b85a93; --m4: #b87a00;
  --m5: #3d9bd1; --m6: #555b66; --m7: #7a5230;
  --e0: #9cc9e6; --e1: #4a96cb; --e2: #1f5fa3; --e3: #f0a13c; --e4: #dc5f12; --e5: #9c1c1c;
}
@media screen and (prefers-color-scheme: dark) {
  :root {
    --page: #14161a; --ink: #e6e8eb; --muted: #9aa2ad; --rule: #353a42; --grid: #24282e; --band: #aab4c240;
    --road: #3d444e; --m0: #56b4e9; --m1: #f08a4b; --m2: #2cc295; --m3: #df9cc4; --m4: #e6b23c;
    --m5: #6f8cff; --m6: #b9c0ca; --m7: #c49a78;
    --e0: #2f5f80; --e1: #4a96cb; --e2: #9fd3f5; --e3: #f0b45c; --e4: #f58549; --e5: #ff5d5d;
  }
}
* { box-sizing: border-box; }
body {
  margin: 0 auto; padding: 2.5rem 1.25rem 4rem; max-width: 62rem; background: var(--page);
  color: var(--ink); font: 16px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue",
  "Liberation Sans", Arial, sans-serif;
}
.over { margin: 0; color: var(--muted); font-size: .875rem; }
h1 { margin: 0 0 .75rem; font-size: 1.9rem; line-height: 1.2; font-weight: 650; letter-spacing: -.01em; }
h2 { margin: 0 0 .25rem; font-size: 1.1rem; line-height: 1.3; font-weight: 650; }
h1, h2, dd, td, th, p, figcaption { overflow-wrap: anywhere; }
.lead { margin: 0 0 1.5rem; max-width: 44rem; font-size: 1.1rem; text-wrap: balance; }
dl {
  display: grid; grid-template-columns: repeat(auto-fill, minmax(17rem, 1fr)); gap: .5rem 2rem;
  margin: 0 0 2rem; padding: .9rem 0; border: solid var(--rule); border-width: 1px 0; font-size: .9rem;
}
dt { color: var(--muted); font-size: .8rem; }
dd { margin: 0; }
table { width: 100%; border-collapse: collapse; font-size: .875rem; font-variant-numeric: tabular-nums; }
th, td { padding: .4rem .3rem; border-bottom: 1px solid var(--rule); text-align: right; }
th { font-weight: 500; }
thead th { color: var(--muted); vertical-align: bottom; line-height: 1.25; overflow-wrap: normal; }
thead small { display: block; font-size: .85em; }
tr > :first-child { padding-left: 0; text-align: left; }
td { white-space: nowrap; }
td strong { font-weight: 700; text-decoration: underline; text-decoration-thickness: 2px;
  text-decoration-color: var(--m0); text-underline-offset: 4px; }
.note, figcaption { max-width: 46rem; color: var(--muted); font-size: .875rem; }
.note { margin: .6rem 0 0; }
figure { margin: 2.75rem 0 0; break-inside: avoid; min-width: 0; }
figcaption { margin: 0; padding-top: .5rem; }
.pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(24rem, 100%), 1fr)); gap: 0 2.5rem; }
.empty { margin: .75rem 0; padding: 1.5rem; border: 1px dashed var(--rule); color: var(--muted); }
.legend { display: flex; flex-wrap: wrap; gap: 0 1.1rem; margin: 0; font-size: .8125rem; color: var(--muted); }
.legend span { display: inline-flex; align-items: center; gap: .4rem; }
.legend i { width: 18px; border-top: 3px solid var(--c); border-radius: 2px; }
.m0 { --c: var(--m0); } .m1 { --c: var(--m1); } .m2 { --c: var(--m2); } .m3 { --c: var(--m3); }
.m4 { --c: var(--m4); } .m5 { --c: var(--m5); } .m6 { --c: var(--m6); } .m7 { --c: var(--m7); }
.chart { display: block; width: calc(100% - 64px); margin: 30px 12px 0 52px; overflow: visible; }
.defs { position: absolute; width: 0; height: 0; }
.open { overflow: visible; }
svg text { fill: var(--muted); font-size: 12px; font-variant-numeric: tabular-nums; }
svg .strong { fill: var(--ink); font-weight: 600; paint-order: stroke; stroke: var(--page); stroke-width: 3px; }
.mid { text-anchor: middle; } .end { text-anchor: end; }
svg path, svg line { vector-effect: non-scaling-stroke; }
.grid { stroke: var(--grid); } .zero { stroke: var(--muted); stroke-opacity: .55; }
.plan .zero { stroke: var(--grid); stroke-opacity: 1; }
.line { fill: none; stroke: var(--c); stroke-width: 1.1px; stroke-linejoin: round; stroke-linecap: round; stroke-opacity: .85; }
.chief { stroke-width: 1.8px; stroke-opacity: 1; }
.dots { fill: none; stroke: var(--c); stroke-width: 4px; stroke-linecap: round; }
.fine { stroke-width: 2.2px; }
.arrow, .open circle { fill: var(--c); }
.band { fill: var(--band); stroke: var(--band); }
.area { fill: var(--c); fill-opacity: .16; }
.density { fill: none; stroke: var(--ink); stroke-width: 1px; }
.level { stroke: var(--muted); stroke-dasharray: 2 4; }
.hover rect { fill: transparent; } .hover rect:hover { fill: var(--band); }
.s-initializing, .s-predicted, .s-lost, .s-off-map { fill: none; stroke: var(--muted); stroke-width: 5px; stroke-linecap: square; }
.s-initializing { stroke-opacity: .4; }
.s-predicted { stroke-width: 2px; }
.s-lost { stroke: var(--ink); }
.s-off-map { stroke-dasharray: 2 3; stroke-linecap: butt; }
.road { fill: none; stroke: var(--road); stroke-width: 9px; stroke-linejoin: round; stroke-linecap: round; }
.path { fill: none; stroke: var(--muted); stroke-width: 1.2px; }
.scale { fill: none; stroke: var(--ink); stroke-width: 3px; }
.ring { fill: none; stroke: var(--ink); stroke-width: 1.5px; }
.nofix { fill: var(--page); stroke: var(--muted); stroke-width: 1.2px; }
.e0 { fill: var(--e0); } .e1 { fill: var(--e1); } .e2 { fill: var(--e2); }
.e3 { fill: var(--e3); } .e4 { fill: var(--e4); } .e5 { fill: var(--e5); }
@media screen and (max-width: 46rem) {
  body { padding-top: 1.5rem; }
  h1 { font-size: 1.5rem; }
  table, tbody, tr, th, td { display: block; }
  thead { display: none; }
  tbody tr { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 0 1.25rem; margin-bottom: 1.25rem; }
  tbody th { grid-column: 1 / -1; padding: .3rem 0; font-weight: 650; font-size: 1rem; }
  td { display: flex; padding: .25rem 0; }
  td::before { content: attr(data-label); margin-right: auto; color: var(--muted); }
  td:not([data-unit=""])::after { content: attr(data-unit); margin-left: .25rem; color: var(--muted); }
}
@media print {
  @page { margin: 16mm 14mm; }
  body { padding: 0; max-width: none; font-size: 10.5pt; }
  table { font-size: 7.5pt; }
  figure { margin-top: 1.5rem; }
}
)css";
}

}  // namespace milepost

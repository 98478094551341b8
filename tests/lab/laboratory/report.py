"""report.html: every table and figure in one file that loads nothing, in the look of milepost-client's report."""
import html

from .drawing import CLASSES
from .runs import PROJECT

# What a list of pairs needs beyond a single evaluation's report.
STYLE = """
h2.part { margin: 3rem 0 .25rem; font-size: 1.35rem; }
section { margin: 2.75rem 0 0; }
tr.group th { padding-top: 1rem; color: var(--ink); font-weight: 650; }
.drawing { display: block; width: 100%; height: auto; margin: .5rem 0 0; overflow: visible; }
.drawing text { font-family: inherit; }
.claims { margin: .75rem 0 0; padding: 0; list-style: none; }
.claims li { display: grid; grid-template-columns: 6.5rem minmax(0, 1fr); gap: 0 1rem; padding: .55rem 0;
  border-bottom: 1px solid var(--rule); }
.claims p { margin: 0; }
.claims .figures { color: var(--muted); font-size: .875rem; font-variant-numeric: tabular-nums; }
.verdict { font-weight: 650; font-size: .875rem; padding-top: .1rem; }
.verdict.held { color: var(--m2); } .verdict.not-held { color: var(--m1); } .verdict.not-tested { color: var(--muted); }
@media screen and (max-width: 46rem) { .wide-figure { overflow-x: auto; } .wide-figure .drawing { width: 46rem; } }
"""

PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8"/>
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'"/>
<meta name="viewport" content="width=device-width, initial-scale=1"/>
<title>{name} – milepost laboratory</title>
<style>{style}</style>
</head>
<body>
<header>
<p class="over">milepost laboratory</p>
<h1>{name}</h1>
<p class="lead">{lead}</p>
<dl>
{facts}
</dl>
</header>
{body}
</body>
</html>
"""


def page_style():
    """The client's style sheet, which is the one place where the look is told, and what is added to it."""
    return (PROJECT / "client/evaluate/report/page/page.css").read_text(encoding="utf-8") + STYLE


def legend(methods):
    names = (f'<span class="{CLASSES.get(method, "m7")}"><i></i>{html.escape(method)}</span>' for method in methods)
    return f'<p class="legend">{" ".join(names)}</p>\n'


def figure(title, drawing, caption, methods=()):
    return (f"<figure>\n<h2>{html.escape(title)}</h2>\n{legend(methods) if methods else ''}"
            f'<div class="wide-figure">{drawing}</div>\n<figcaption>{html.escape(caption)}</figcaption>\n</figure>\n')


def table(of):
    return (f"<section>\n<h2>{html.escape(of.title)}</h2>\n{of.as_html()}"
            f'<p class="note">{html.escape(of.note)}</p>\n</section>\n')


def claims(of, note):
    items = "".join(
        f'<li><p class="verdict {claim.verdict.replace(" ", "-")}">{claim.verdict}</p>'
        f'<div><p>{html.escape(claim.text)}</p><p class="figures">{html.escape(claim.figures)}</p></div></li>\n'
        for claim in of)
    return (f'<section>\n<h2>The paper\'s claims, one by one</h2>\n<ul class="claims">\n{items}</ul>\n'
            f'<p class="note">{html.escape(note)}</p>\n</section>\n')


def part(title):
    return f'<h2 class="part">{html.escape(title)}</h2>\n'


def page(name, lead, facts, body):
    """`facts`: (word, value) pairs; `body`: parts made by the functions above."""
    shown = "\n".join(f"<div><dt>{html.escape(word)}</dt><dd>{html.escape(value)}</dd></div>" for word, value in facts)
    return PAGE.format(name=html.escape(name), style=page_style(), lead=html.escape(lead), facts=shown,
                       body="".join(body))

"""report.html: every table and figure in one file that loads nothing; the page is milepost-client's own."""
import base64
import hashlib
import json
import pathlib

from .runs import PROJECT

PAGE = PROJECT / "schema/page"
CHART_JS = pathlib.Path("/usr/share/javascript/chart.js/chart.min.js")
SCRIPTS = ("document.js", "plots.js", "stretches.js", "interaction.js")


def figure(title, plots, caption, stacked=False):
    """`stacked`: the plots stand one below the other."""
    return {"part": "figure", "heading": title, "plots": plots, "caption": caption, "stacked": stacked}


def table(of):
    return {"part": "table", "heading": of.title, "note": of.note, **of.as_data()}


def folded(of):
    return {**table(of), "folded": True}


def claims(of, note):
    return {"part": "claims", "heading": "The paper's claims, one by one", "note": note,
            "claims": [{"verdict": claim.verdict, "text": claim.text, "figures": claim.figures} for claim in of]}


def part(title):
    return {"part": "title", "heading": title}


def script_hash(script):
    return f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'"


def page(name, lead, facts, parts):
    """`facts`: (word, value) pairs; `parts`: made by the functions above. As report_page() of the client."""
    data = {"kind": "laboratory", "title": name, "lead": lead, "facts": facts, "columns": {}, "parts": parts}
    library, (template, style, licence, *scripts) = CHART_JS.read_text(encoding="utf-8"), (
        (PAGE / file).read_text(encoding="utf-8") for file in ("page.html", "page.css", "chart.js-licence.txt", *SCRIPTS))
    script = "".join(scripts)
    rest, done = template, ""
    for word, text in (("@SCRIPT_HASHES@", f"{script_hash(library)} {script_hash(script)}"), ("@STYLE@", style),
                       ("@DATA@", json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")),
                       ("@LICENCE@", licence), ("@LIBRARY@", library), ("@SCRIPT@", script)):
        before, rest = rest.split(word, 1)
        done += before + text
    return done + rest

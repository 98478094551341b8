"""Drawings as SVG for the report: its fonts, its colours on light and dark pages, the same bytes each time.

Colours are drawn as those of the light page and then become the report's CSS variables, which know both.
"""
import io
import re

import matplotlib
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

# CSS variable of the report's style -> a stand-in that matplotlib draws with.
INK, MUTED, RULE, GRID = "#1b1e23", "#5c636e", "#d9dde3", "#eceef1"
VARIABLES = {INK: "--ink", MUTED: "--muted", RULE: "--rule", GRID: "--grid"}

# The report's class of each method, here and in milepost-client's own report.
CLASSES = {"milepost": "m0", "tracklet-regression-kalman": "m1", "tracklet-regression": "m2",
           "tracklet-regression-particle": "m3", "tracklet-matching": "m4", "scale-only": "m5", "wisurf": "m6",
           "tracklet-regression-unaveraged": "m7", "inverse-scale": "m8"}
STAND_INS = {"m0": "#0067a8", "m1": "#c94f00", "m2": "#00805c", "m3": "#b85a93", "m4": "#b87a00", "m5": "#3d9bd1",
             "m6": "#555b66", "m7": "#7a5230", "m8": "#6b4fc0"}
VARIABLES |= {colour: f"--{name}" for name, colour in STAND_INS.items()}

# A second mark beside the colour.
DASHES = {"milepost": "-", "tracklet-regression-kalman": "-", "tracklet-regression": (0, (5, 1.5)),
          "tracklet-regression-particle": (0, (1.2, 1.2)), "tracklet-matching": (0, (5, 1.5, 1, 1.5)),
          "scale-only": (0, (3, 1.2)), "wisurf": "-", "inverse-scale": (0, (7, 1.5))}
MARKERS = {"milepost": "o", "tracklet-regression-kalman": "s", "tracklet-regression": "^",
           "tracklet-regression-particle": "D", "tracklet-matching": "v", "scale-only": "P", "wisurf": "X",
           "inverse-scale": "p"}

WIDTH_IN = 9.6
STYLE = {
    "svg.fonttype": "none", "svg.hashsalt": "milepost", "font.size": 8.5, "font.family": "DejaVu Sans",
    "axes.titlesize": 9, "axes.titleweight": "bold", "axes.titlelocation": "left", "axes.titlecolor": INK,
    "axes.edgecolor": RULE, "axes.labelcolor": MUTED, "axes.grid": True, "axes.axisbelow": True,
    "axes.spines.top": False, "axes.spines.right": False, "text.color": INK,
    "grid.color": GRID, "grid.linewidth": 0.8, "xtick.color": MUTED, "ytick.color": MUTED,
    "xtick.labelsize": 8, "ytick.labelsize": 8, "lines.linewidth": 1.4, "legend.frameon": False,
    "legend.fontsize": 8, "figure.constrained_layout.use": True, "figure.facecolor": "none", "axes.facecolor": "none",
    "savefig.facecolor": "none",
}


def colour(method):
    return STAND_INS[CLASSES.get(method, "m7")]


def drawn(rows, columns, height_in, draw, **subplots):
    """The SVG element of a figure of rows x columns plots, which `draw(axes)` fills; `axes` is an array of them."""
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(WIDTH_IN, height_in))
        FigureCanvasSVG(figure)
        draw(figure.subplots(rows, columns, squeeze=False, **subplots))
        return svg_of(figure)


def svg_of(figure):
    text = io.StringIO()
    figure.savefig(text, format="svg")
    svg = text.getvalue()
    svg = svg[svg.index("<svg"):]
    # The date, which would differ each time, and addresses of standards.
    svg = re.sub(r"\s*<metadata>.*?</metadata>", "", svg, flags=re.DOTALL)
    svg = re.sub(r"<g id=\"[^\"]*\"", "<g", svg)  # nothing refers to them, and they are not unique in the page
    # The page's font; the weight and size are the drawing's.
    svg = re.sub(r"font: (?:(\d+) )?([\d.]+px) [^;\"]*",
                 lambda found: f"font-weight: {found[1] or 400}; font-size: {found[2]}", svg)
    svg = re.sub("|".join(VARIABLES), lambda found: f"var({VARIABLES[found[0]]})", svg)
    return svg.replace("<svg ", '<svg class="drawing" role="img" ', 1)

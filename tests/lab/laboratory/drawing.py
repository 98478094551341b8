"""The plots of the report as data, in the terms of milepost-client's (client/evaluate/report/report_json.h)."""
import math

# The report's colour of each method, here and in milepost-client's own report.
COLOURS = {"milepost": "m0", "tracklet-regression-kalman": "m1", "tracklet-regression": "m2",
           "tracklet-regression-particle": "m3", "tracklet-matching": "m4", "scale-only": "m5", "wisurf": "m6",
           "tracklet-regression-unaveraged": "m7", "inverse-scale": "m8"}

# A second mark beside the colour: pixels drawn and left out, and the shape of points.
DASHES = {"tracklet-regression": [7, 2], "tracklet-regression-particle": [2, 2], "tracklet-matching": [7, 2, 2, 2],
          "scale-only": [4, 2], "inverse-scale": [10, 2]}
MARKERS = {"milepost": {"marker": "circle"}, "tracklet-regression-kalman": {"marker": "rect"},
           "tracklet-regression": {"marker": "triangle"}, "tracklet-regression-particle": {"marker": "rectRot"},
           "tracklet-matching": {"marker": "triangle", "rotation_deg": 180},
           "scale-only": {"marker": "cross", "edge_px": 1.5}, "wisurf": {"marker": "crossRot", "edge_px": 1.5},
           "inverse-scale": {"marker": "star", "edge_px": 1.5}}
DIGITS = 5  # that numbers are kept to


def colour(method):
    return COLOURS.get(method, "m7")


def numbers(values):
    """None for what is not known."""
    return [float(f"{value:.{DIGITS}g}") if math.isfinite(value) else None for value in map(float, values)]


def axis(label, low=None, high=None, decimals=2, **more):
    """Without ends: as far as the layers reach. `more`: log; ticks, at which values; names of 0, 1, 2, ..."""
    ends = {name: float(f"{value:.{DIGITS}g}") for name, value in (("min", low), ("max", high)) if value is not None}
    return {"label": label, "decimals": decimals, **ends, **more}


def plot(layers, x, y, height_px=200, **more):
    """`layers` from back to front. `more`: title; bin, the width of a histogram's."""
    return {"description": f"{y['label']} against {x['label']}", "height_px": height_px, "x": x, "y": y, "layers": layers, **more}


def layer(kind, x, y, name=None, **look):
    return {"kind": kind, "x": numbers(x), "y": numbers(y), **({"name": name} if name else {}), **look}


def line(x, y, name, colour_name, width_px=1.4, **look):
    return layer("line", x, y, name, colour=colour_name, width_px=width_px, **look)


def method_line(x, y, method, **look):
    """In the colour and dashes of the method; ours is the widest."""
    dash = {"dash": DASHES[method]} if method in DASHES else {}
    return line(x, y, method, colour(method), 2 if method == "milepost" else 1.4, **dash, **look)


def dots(x, y, colour_name, radius_px=2, name=None, **look):
    return layer("dots", x, y, name, colour=colour_name, radius_px=radius_px, **look)


def texts(x, y, strings, align="left", shift_px=(4, 4)):
    return layer("texts", x, y, text=list(strings), align=align, shift_px=list(shift_px))

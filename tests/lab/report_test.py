"""The report is the client's page, loads nothing, is the same each time, and keeps to the client's colours."""
import json
import re
import unittest

import numpy as np

from laboratory import claims, drawing, figures, report, statistics, tables
from laboratory.regressions import regression_table, samples_of
from laboratory.runs import PROJECT
from made_up import data_of, fixes, regression_rows

METHODS = ["wisurf", "scale-only", "tracklet-matching", "tracklet-regression", "tracklet-regression-kalman",
           "tracklet-regression-particle", "milepost"]


def some_fixes():
    generator = np.random.default_rng(7)
    return [fixes(pair, method, generator.normal(0, scale, 40), curved=[True] * 15 + [False] * 25)
            for pair in ("</script><b>", "two") for scale, method in enumerate(METHODS, start=1)]


def some_page():
    of = some_fixes()
    errors_m = np.random.default_rng(8).normal(0, 1, 500)
    samples = samples_of(regression_rows())
    return report.page("a <list>", "A lead & more.", [("Pairs", "</script><b>, two")], [
        report.table(tables.table_1(of)), report.claims(claims.claims_of(of), "A note."),
        report.figure("means", figures.means_beside_paper(of), "c"),
        report.figure("5", figures.error_along_route(of), "c"),
        report.figure("all", figures.error_distribution(of), "c"),
        report.figure("6", figures.error_by_road_type(of), "c"),
        report.figure("7", figures.regressions(samples), "c"), report.folded(regression_table(samples)),
        report.figure("8", figures.estimate_histogram(errors_m, statistics.normality_of(errors_m)), "c"),
        report.part("Studies"),
        report.figure("study", figures.study_figure({"milepost": [(1, 2, 3), (2, 3, 4)]}, "x", x_log=True,
                                                    second_label="y"), "c"),
        report.figure("honesty", figures.honesty_figure({"whole map": np.abs(errors_m), "starts": 2 * np.abs(errors_m)}), "c"),
        report.figure("evidence", figures.evidence_figure(errors_m + 5, errors_m - 5), "c"),
    ])


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.page = some_page()
        cls.data = data_of(cls.page)
        cls.plots = {part["heading"]: part["plots"] for part in cls.data["parts"] if part["part"] == "figure"}

    def test_nothing_is_loaded_and_names_are_no_markup(self):
        self.assertIsNone(re.search(r"(src|href)=\"|@import|<link|<img", self.page))
        self.assertIn("default-src 'none'", self.page)
        self.assertNotIn("<b>", self.page)
        self.assertEqual(self.data["title"], "a <list>")

    def test_every_placeholder_of_the_template_is_filled(self):
        template = (report.PAGE / "page.html").read_text(encoding="utf-8")
        for word in re.findall("@[A-Z_]+@", template):
            self.assertNotIn(word, self.page)

    def test_every_figure_has_its_plots(self):
        self.assertEqual({heading: len(plots) for heading, plots in self.plots.items()},
                         {"means": 1, "5": 2, "all": 1, "6": 2, "7": 2, "8": 2, "study": 2, "honesty": 1, "evidence": 1})
        self.assertEqual([plot["title"] for plot in self.plots["5"]], ["</script><b>", "two"])
        self.assertEqual([layer["name"] for layer in self.plots["all"][0]["layers"]], METHODS[::-1])
        for plots in self.plots.values():
            for layer in (layer for plot in plots for layer in plot["layers"]):
                self.assertEqual(len(layer["x"]), len(layer["y"]))

    def test_distributions_end_at_all_frames(self):
        for layer in self.plots["all"][0]["layers"]:
            self.assertEqual(layer["y"][-1], 100)
            self.assertEqual(layer["x"], sorted(layer["x"]))

    def test_the_same_bytes_each_time(self):
        self.assertEqual(self.page, some_page())
        self.assertNotRegex(json.dumps(self.data), r"20\d\d-\d\d-\d\d")

    def test_colours_are_variables_of_the_style(self):
        style = (report.PAGE / "page.css").read_text(encoding="utf-8")
        used = {layer["colour"] for plots in self.plots.values() for plot in plots for layer in plot["layers"] if "colour" in layer}
        for name in used | set(drawing.COLOURS.values()):
            self.assertGreaterEqual(style.count(f"--{name}:"), 2, name)  # light and dark
        self.assertEqual(len(set(drawing.COLOURS.values())), len(drawing.COLOURS))

    def test_the_client_gives_each_method_the_same_colour(self):
        source = (PROJECT / "client/evaluate/report/report_series.cc").read_text(encoding="utf-8")
        listed = re.search(r"kMethodOfColour = \{kDefaultMethod,([^}]*)\}", source)[1]
        methods = ["milepost", *re.findall('"([^"]+)"', listed)]
        self.assertEqual(drawing.COLOURS, {method: f"m{index}" for index, method in enumerate(methods)})

    def test_numbers_are_kept_to_some_digits_and_unknown_ones_null(self):
        self.assertEqual(drawing.numbers([1 / 3, np.nan, np.inf, -2]), [0.33333, None, None, -2])


if __name__ == "__main__":
    unittest.main(verbosity=2)

"""The report loads nothing, is the same each time, and keeps to the client's colours."""
import html.parser
import re
import unittest
import xml.etree.ElementTree

import numpy as np

from laboratory import claims, drawing, figures, report, statistics, tables
from laboratory.regressions import regression_table, samples_of
from made_up import fixes, regression_rows

METHODS = ["wisurf", "scale-only", "tracklet-matching", "tracklet-regression", "tracklet-regression-kalman",
           "tracklet-regression-particle", "milepost"]


def some_fixes():
    generator = np.random.default_rng(7)
    return [fixes(pair, method, generator.normal(0, scale, 40), curved=[True] * 15 + [False] * 25)
            for pair in ("<one>", "two") for scale, method in enumerate(METHODS, start=1)]


def some_page():
    of = some_fixes()
    errors_m = np.random.default_rng(8).normal(0, 1, 500)
    samples = samples_of(regression_rows())
    return report.page("a <list>", "A lead & more.", [("Pairs", "<one>, two")], [
        report.table(tables.table_1(of)), report.claims(claims.claims_of(of), "A note."),
        report.figure("means", figures.means_beside_paper(of), "c"),
        report.figure("5", figures.error_along_route(of), "c", METHODS),
        report.figure("all", figures.error_distribution(of), "c", METHODS),
        report.figure("6", figures.error_by_road_type(of), "c", METHODS),
        report.figure("7", figures.regressions(samples), "c"), report.table(regression_table(samples)),
        report.figure("8", figures.estimate_histogram(errors_m, statistics.normality_of(errors_m)), "c"),
        report.figure("study", figures.study_figure({"milepost": [(1, 2, 3), (2, 3, 4)]}, "x", x_log=True,
                                                    second_label="y"), "c"),
        report.figure("honesty", figures.honesty_figure({"whole map": np.abs(errors_m), "starts": 2 * np.abs(errors_m)}), "c"),
    ])


class Parts(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.tags, self.references = [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        self.references += [value for name, value in attributes if name in ("src", "href", "xlink:href", "data")]


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.page = some_page()

    def test_nothing_is_loaded(self):
        parts = Parts(self.page)
        self.assertEqual([each for each in parts.references if not each.startswith("#")], [])
        self.assertNotRegex(self.page, r"@import|url\((?!#)")
        self.assertFalse({"script", "link", "img", "iframe", "object"} & set(parts.tags))
        self.assertIn("default-src 'none'", self.page)

    def test_what_is_referred_to_is_there_once(self):
        for name in set(re.findall(r'(?:url\(#|href="#)([^)"]+)', self.page)):
            self.assertGreaterEqual(self.page.count(f'id="{name}"'), 1, name)

    def test_drawings_are_well_formed_and_names_are_escaped(self):
        drawings = re.findall(r"<svg.*?</svg>", self.page, re.DOTALL)
        self.assertEqual(len(drawings), 8)
        for each in drawings:
            xml.etree.ElementTree.fromstring(each)
        self.assertNotIn("<one>", self.page)
        self.assertIn("a &lt;list&gt;", self.page)

    def test_the_same_bytes_each_time(self):
        self.assertEqual(self.page, some_page())
        self.assertNotRegex(self.page, r"20\d\d-\d\d-\d\d")

    def test_colours_are_variables_of_the_style_light_and_dark(self):
        style = report.page_style()
        for variable in set(re.findall(r"var\((--\w+)\)", self.page)) - {"--c"}:
            self.assertGreaterEqual(style.count(f"{variable}:"), 2, variable)
        body = self.page[self.page.index("</style>"):]
        self.assertEqual(sorted(set(re.findall(r"#[0-9a-f]{6}\b", body))), [])

    def test_stand_ins_are_the_light_pages_colours(self):
        light = report.page_style().split("@media")[0]
        for name, colour in drawing.STAND_INS.items():
            self.assertIn(f"--{name}: {colour};", light)
        self.assertEqual(len(set(drawing.CLASSES.values())), len(drawing.CLASSES))


if __name__ == "__main__":
    unittest.main(verbosity=2)

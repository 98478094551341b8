"""The report of a map in a browser: it opens from disk, draws the network, and shows the stretch that is clicked."""
import csv
import json
import pathlib
import shutil
import tempfile

import commands
from commands import MAPPER, STREET, CommandTest, edit_json, report_data, run
from report_test import Page, browser, resize

HOSTILE = "</script><img src=x onerror=\"document.title = 'run'\">"
FILE_NAME = "<img src=x onerror=\"document.title = 'run'\">"  # a file's name has no slash
APART_M = 60
VIEWS = ["σ of a fix in the world", "σ against the map", "landmarks a metre", "passes", "fit of the images"]


def moved_drive(folder):
    """The street's drive again, driven on another road: so far to the east."""
    shutil.copytree(STREET / "street-map", folder)
    edit_json(folder / "drive.json", lambda drive: drive.update(name="other"))
    file = folder / "trajectory.csv"
    with open(file, newline="") as table:
        rows = list(csv.DictReader(table))
    east = "east_m" if "east_m" in rows[0] else "longitude_deg"
    for row in rows:
        row[east] = str(float(row[east]) + (APART_M if east == "east_m" else APART_M / 73000))
    with open(file, "w", newline="") as table:
        writer = csv.DictWriter(table, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)


class MapPage(Page):
    """A report of a map. Its first plot is the plan."""

    PLAN = 0

    def stretch_in_window(self, stretch):
        """The middle of a stretch on the plan, in the window."""
        self.show(self.PLAN)
        x, y = self.ask("return place(plots[0], arguments[0])", stretch)
        return self.ask("const r = plots[0].box.getBoundingClientRect(); return [r.left + arguments[0], r.top + arguments[1]]", x, y)

    def click(self, x, y):
        self.mouse("mouseMoved", x, y)
        self.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
        self.mouse("mouseReleased", x, y, button="left", clickCount=1)
        self.settled()

    def colours(self, plot):
        """The opaque colours of a canvas, by how many pixels have them."""
        picture = self.picture(plot)
        return {colour[:3]: count for count, colour in picture.getcolors(picture.width * picture.height) if colour[3] == 255}

    def look(self, name):
        """A colour of the style sheet."""
        return tuple(bytes.fromhex(self.ask("return colour(arguments[0])", name)[1:7]))

    def choose_view(self, name):
        self.ask("[...document.querySelectorAll('.views label')].find((each) => each.textContent === arguments[0]).click()", name)
        self.settled()

    def segment_shown(self):
        return self.ask("return page.segments[document.getElementById('segment').value].name")


class MapReport(CommandTest):
    @classmethod
    def setUpClass(cls):
        cls.driver = browser()
        cls.addClassCleanup(cls.driver.quit)
        made = tempfile.TemporaryDirectory()
        cls.addClassCleanup(made.cleanup)
        folder = pathlib.Path(made.name)
        moved_drive(folder / "other")
        cls.map = folder / "town.map"
        built = run(MAPPER, "build", "--drive", STREET / "street-map", "--drive", folder / "other", "--map", cls.map)
        assert built.returncode == 0, built.stderr

    def report(self, map_file=None):
        out = self.folder / "report.html"
        self.expect_done(run(MAPPER, "report", "--map", map_file or self.map, "--out", out))
        return out

    def expect_quiet(self, page, file):
        self.assertEqual(page.complaints(), [])
        asked = [url for url in page.requests() if not url.startswith("data:")]
        self.assertEqual(asked, [file.as_uri()])

    def expect_view_drawn(self, page, view):
        """The plan has the colours of the classes that the data has in this view, and of no other."""
        page.choose_view(VIEWS[view])
        classes = page.ask("return looks(page.views[arguments[0]]).map((look) => [look.colour, column(page.views[arguments[0]].column).includes(look.is)])", view)
        drawn = page.colours(page.PLAN)
        for name, is_there in classes:
            self.assertEqual(drawn.get(page.look(name), 0) > 100, is_there, (VIEWS[view], name))
        cells = set(page.ask("return [...document.querySelectorAll('.strip .cell')].map((cell) => cell.style.fill)"))
        self.assertEqual(cells, {f"var(--{name})" for name, is_there in classes if is_there})
        legend = page.ask("return [...document.querySelectorAll('#view-legend span')].map((node) => node.textContent)")
        self.assertEqual(legend[:5], page.ask("return page.views[arguments[0]].classes.map((each) => each.name)", view))
        return {name for name, is_there in classes if is_there}

    def test_a_map_of_two_roads(self):
        file = self.report()
        page = MapPage(self.driver, file)
        self.assertEqual(page.ask("return document.title"), "town – milepost map")
        self.assertEqual(page.ask("return page.segments.map((segment) => segment.name.split('-')[0])"), ["other", "street"])
        headings = page.ask("return [...document.querySelectorAll('h2')].map((node) => node.textContent)")
        self.assertEqual(headings[:4], ["The road network", "Each segment, ten metres a cell", "Along one segment", "Distributions"])
        self.assertEqual(headings[-2:], ["Findings of the build", "The drives"])
        self.assertEqual(page.ask("return document.querySelectorAll('.strip .cell').length"), page.ask("return column('segment').length"))
        seen = [self.expect_view_drawn(page, view) for view in range(5)]
        self.assertGreater(len(set(map(frozenset, seen))), 2)  # the switch changes the colours
        self.assertTrue(seen[4])
        self.assertNotIn("none", seen[4])                      # the fit of the images is recorded everywhere
        for plot in range(1, page.ask("return plots.length")):
            picture = page.picture(plot)
            self.assertGreater(len(picture.getcolors(picture.width * picture.height)), 10, plot)
        self.check_clicks(page)
        self.check_cells(page)
        self.check_choice(page)
        self.expect_quiet(page, file)

    def check_clicks(self, page):
        """A click into the plan shows the stretch under it, and its segment's plots."""
        for segment in (0, 1):
            first, end, name = page.ask("const {first, end, name} = page.segments[arguments[0]]; return [first, end, name]", segment)
            stretch = first + 2
            page.click(*page.stretch_in_window(stretch))
            self.assertEqual(page.ask("return chosen"), stretch)
            self.assertEqual(page.segment_shown(), name)
            self.assertIn(f"{name}, 20 to 30 m", page.readout())
            self.assertIn(f"{page.ask('return column(`sigma_m`)')[stretch]:.3f} m", page.readout())
            facts = page.ask("return document.getElementById('segment-facts').innerText")
            self.assertIn("Chosen: 20 to 30 m", facts)
            self.assertIn("0.180\u00a0m, assumed" if "0.180" in facts else "0.18\u00a0m, assumed", facts)
            shown = page.ask("return plots.filter(({spec}) => Array.isArray(spec.frames)).map(({spec}) => spec.frames)")
            self.assertEqual(shown, [[first, end]] * 4)
        page.mouse("mouseMoved", 5, 5)
        self.assertIsNone(page.readout())

    def check_cells(self, page):
        cell = self.driver.find_elements("css selector", ".strip .cell")[1]
        page.ask("arguments[0].scrollIntoView({block: 'center'})", cell)
        cell.click()
        self.assertEqual(page.ask("return chosen"), int(cell.get_attribute("data-frame")))

    def check_choice(self, page):
        """A segment that is chosen by its name, and a cursor over its plots alone."""
        page.ask("const select = document.getElementById('segment'); select.value = 0; select.dispatchEvent(new Event('change'))")
        page.settled()
        self.assertEqual(page.ask("return chosen"), page.ask("return page.segments[0].first"))
        along = page.plots("label === undefined && Array.isArray(plot.spec.frames)")
        left, top, width, _ = page.show(along[0])
        page.mouse("mouseMoved", left + 0.45 * width, top + 20)
        page.settled()
        self.assertIn(page.ask("return page.segments[0].name"), page.readout())
        marks = page.marks()
        self.assertTrue(all(marks[plot] for plot in [page.PLAN, *along]))

    def test_names_are_texts_and_every_screen_will_do(self):
        named = self.folder / f"{FILE_NAME}.map"
        named.write_bytes(self.map.read_bytes())
        file = self.report(named)
        # No map has such an id, since its reader refuses it: the page alone is asked.
        text = file.read_text(encoding="utf-8")
        hostile = json.dumps(HOSTILE).replace("<", "\\u003c")
        for segment in report_data(text)["segments"]:
            text = text.replace(json.dumps(segment["name"]), hostile)
        text = text.replace('"street-map"', hostile)
        file.write_text(text, encoding="utf-8")
        page = MapPage(self.driver, file)
        self.assertEqual(page.ask("return document.querySelector('h1').textContent"), FILE_NAME)
        self.assertEqual(page.ask("return document.title"), f"{FILE_NAME} – milepost map")
        self.assertEqual(page.ask("return document.querySelector('.strips button').textContent"), HOSTILE)
        self.assertEqual(page.ask("return document.querySelector('#segment option').textContent"), HOSTILE)
        page.click(*page.stretch_in_window(1))
        self.assertIn(HOSTILE, page.readout())
        self.assertIn(HOSTILE, page.ask("return document.querySelector('main > section:last-of-type').textContent"))
        self.assertEqual(page.ask("return document.querySelectorAll('img').length"), 0)
        self.addCleanup(resize, self.driver, 1100, 900)
        resize(self.driver, 390, 800)
        page.settled()
        self.assertLessEqual(page.ask("return document.documentElement.scrollWidth"), 390)
        light = page.colours(page.PLAN)
        self.addCleanup(self.driver.execute_cdp_cmd, "Emulation.setEmulatedMedia", {"features": []})
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": "dark"}]})
        page.settled()
        self.assertNotEqual(light.keys(), page.colours(page.PLAN).keys())
        self.expect_view_drawn(page, 1)
        self.expect_quiet(page, file)

    def test_too_few_landmarks_are_marked(self):
        sparse = self.folder / "sparse.map"
        self.expect_done(self.build(STREET / "street-map", sparse, "--size-target-kb-per-m", 0.02))
        page = MapPage(self.driver, self.report(sparse))
        self.assertIn("too few landmarks", page.ask("return document.querySelector('.lead').textContent"))
        self.assertIn("too few landmarks for a fix", page.ask("return document.getElementById('view-legend').textContent"))
        self.assertGreater(page.ask("return document.querySelectorAll('.strip .gap').length"), 0)
        self.assertTrue(all(page.ask("return plots.filter(({spec}) => Array.isArray(spec.frames)).map(({spec}) => spec.lanes[0].marks.length)")))

    def test_a_map_of_walls_alone(self):
        walls, town = self.folder / "walls.geojson", self.folder / "town.map"
        walls.write_text(json.dumps({"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {}, "geometry": {
            "type": "Polygon", "coordinates": [[[8.4, 49], [8.4, 49.0002], [8.4003, 49.0002], [8.4003, 49], [8.4, 49]]]}}]}))
        self.expect_done(run(MAPPER, "aerial", "--footprints", walls, "--map", town))
        file = self.report(town)
        page = MapPage(self.driver, file)
        self.assertIn("The map has no segments.", page.ask("return document.body.textContent"))
        self.expect_quiet(page, file)

    def test_what_cannot_be_written_or_read(self):
        notes = self.folder / "notes.txt"
        notes.write_text("my notes")
        self.expect_refused(run(MAPPER, "report", "--map", self.map, "--out", notes), 1, "notes.txt", "is not a report of milepost", "--out")
        self.assertEqual(notes.read_text(), "my notes")
        self.expect_refused(run(MAPPER, "report", "--map", self.map, "--out", self.map), 1, "town.map", "--out")
        self.expect_refused(run(MAPPER, "report", "--map", notes, "--out", self.folder / "report.html"), 1, "notes.txt")
        self.expect_refused(run(MAPPER, "report", "--map", self.folder / "none.map", "--out", self.folder / "report.html"), 1, "none.map")
        self.expect_refused(run(MAPPER, "report", "--map", self.map), 2, "--out")
        self.assertEqual([each.name for each in self.folder.iterdir()], ["notes.txt"])

    def test_the_same_map_gives_the_same_page(self):
        first = self.report().read_bytes()
        self.assertEqual(self.report().read_bytes(), first)
        self.expect_teaches(run(MAPPER, "report", "--help"), "--map", "--out", "Example:")


commands.main() if __name__ == "__main__" else None

"""Reports in a browser: they open from disk, draw, show values beside the pointer, and zoom together."""
import base64
import io
import json
import re

from PIL import Image
from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

import commands
from commands import CLIENT, CommandTest, MAPPER, STREET, edit_json, rows_of, run
from find_test import SIMULATOR

METHODS = ["tracklet-regression", "inverse-scale", "milepost"]
HOSTILE = "</script><script>document.title = 'run'</script><img src=x onerror=\"document.title = 'run'\">"
FRAME = 12


def browser(width_px=1100, height_px=900):
    options = Options()
    options.binary_location = "/usr/bin/chromium"
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    driver.set_script_timeout(30)
    resize(driver, width_px, height_px)
    return driver


def resize(driver, width_px, height_px):
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
        "width": width_px, "height": height_px, "deviceScaleFactor": 1, "mobile": False})


class Page:
    """A report in the browser. Plots are numbered in the order of the page."""

    def __init__(self, driver, file):
        self.driver = driver
        driver.get_log("browser"), driver.get_log("performance")
        driver.get(file.as_uri())

    def ask(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def settled(self):
        """Waits until the requested drawing is done."""
        self.driver.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")

    def mouse(self, kind, x, y, **more):
        self.driver.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": kind, "x": x, "y": y, **more})

    def plots(self, condition):
        return self.ask(f"return plots.map((plot, i) => plot.spec.{condition} ? i : -1).filter((i) => i >= 0)")

    def show(self, plot):
        """Scrolls to a plot, and returns its plotting area in the window: left, top, width, height."""
        self.ask("plots[arguments[0]].box.scrollIntoView({block: 'center'})", plot)
        self.settled()
        self.ask("scrolled = -Infinity")  # as if the page had come to rest long ago
        return self.ask("""const {box, chart: {chartArea: area}} = plots[arguments[0]], {left, top} = box.getBoundingClientRect();
                           return [left + area.left, top + area.top, area.width, area.height]""", plot)

    def place(self, plot, frame):
        """The position of a frame in the window."""
        left, top, *_ = self.show(plot)
        x, y = self.ask("return place(plots[arguments[0]], arguments[1])", plot, frame)
        return self.ask("const r = plots[arguments[0]].box.getBoundingClientRect(); return [r.left + arguments[1], r.top + arguments[2]]",
                        plot, x, y + 5)

    def drag(self, start, end):
        self.mouse("mouseMoved", *start)
        self.mouse("mousePressed", *start, button="left", buttons=1, clickCount=1)
        self.mouse("mouseMoved", *end, button="left", buttons=1)
        self.mouse("mouseReleased", *end, button="left", clickCount=1)
        self.settled()

    def double_click(self, x, y):
        for count in (1, 2):
            self.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=count)
            self.mouse("mouseReleased", x, y, button="left", clickCount=count)
        self.settled()

    def ranges(self, plot):
        return self.ask("return ['x', 'y'].map((which) => range(plots[arguments[0]], which))", plot)

    def picture(self, plot):
        """The picture of a canvas, with a transparent background."""
        url = self.ask("return plots[arguments[0]].canvas.toDataURL('image/png')", plot)
        return Image.open(io.BytesIO(base64.b64decode(url.split(",")[1]))).convert("RGBA")

    def marks(self):
        """Of each plot: the position of its cursor, or of the mark on the plan; None if there is none."""
        return self.ask("""return plots.map(({box, spec}) => { const mark = box.querySelector(spec.plan ? '.here' : '.cursor');
                           return mark.hidden ? null : [parseFloat(mark.style.left), parseFloat(mark.style.top)]; })""")

    def readout(self):
        return self.ask("const node = document.getElementById('readout'); return node.hidden ? null : node.innerText")

    def complaints(self):
        return [entry["message"] for entry in self.driver.get_log("browser")]

    def requests(self):
        events = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        return [event["params"]["request"]["url"] for event in events if event["method"] == "Network.requestWillBeSent"]


class Reports(CommandTest):
    @classmethod
    def setUpClass(cls):
        cls.driver = browser()
        cls.addClassCleanup(cls.driver.quit)

    def expect_quiet(self, page, file):
        self.assertEqual(page.complaints(), [])
        asked = [url for url in page.requests() if not url.startswith("data:")]
        self.assertEqual(asked, [file.as_uri()])

    def evaluated(self, drive=STREET / "street-query"):
        street_map, out = self.folder / "street.map", self.folder / "results"
        self.expect_done(self.build(STREET / "street-map", street_map, "--lab"))
        self.expect_done(run(CLIENT, "evaluate", "--map", street_map, "--drive", drive, "--out", out, "--method", *METHODS))
        return out

    def expect_drawn(self, page, plot, least_colours):
        """The canvas is not empty, and has at least this number of its layers' colours."""
        picture = page.picture(plot)
        drawn = {colour for _, colour in picture.getcolors(picture.width * picture.height) if colour[3] == 255}
        names = page.ask("return plots[arguments[0]].spec.layers.map((layer) => colour(layer.colour || 'ink'))", plot)
        wanted = {tuple(bytes.fromhex(name[1:7])) + (255,) for name in names}
        self.assertGreaterEqual(len(wanted & drawn), least_colours, page.ask("return plots[arguments[0]].spec.description", plot))

    def test_an_evaluation(self):
        out = self.evaluated()
        page = Page(self.driver, out / "report.html")
        self.assertEqual(page.ask("return document.title"), "street-query – milepost evaluation")
        self.assertEqual(page.ask("return [...document.querySelectorAll('figure h2')].map((node) => node.textContent)"), [
            "Error along the route", "Error of the lateral offset", "Matches per frame", "Errors by size", "Frames within an error",
            "On the map", "Latency per frame"])
        self.assertEqual(page.ask("return document.querySelectorAll('table tbody th').length"), 4)
        along, (plan,) = page.plots("frames"), page.plots("plan")
        self.assertEqual(page.ask("return plots[0].chart.data.datasets.map((each) => each.label).filter((label) => label)"),
                         ["milepost", "2σ against the map", "2σ of milepost in the world", "inverse-scale", "tracklet-regression"])
        # One slow frame of a busy machine presses the curves of the latency onto one another: the topmost is drawn.
        for plot, colours in enumerate((3, 1, 3, 3, 3, 2, 1)):
            self.expect_drawn(page, plot, colours)
        self.check_lanes(page)
        self.check_ticks(page)
        self.check_cursor(page, along, plan, rows_of(out / "fixes-milepost.csv")[FRAME])
        self.check_zoom(page, along)
        self.check_plan(page, plan)
        self.check_keys(page, along)
        self.expect_quiet(page, out / "report.html")

    def check_lanes(self, page):
        """The first frame of each method was not tracked: a pale mark in its lane, beneath the plotting area."""
        lanes, (left, bottom) = page.ask("""const {spec, chart: {chartArea: {left, bottom}}} = plots[0];
                                            return [spec.lanes, [left, bottom]]""")
        self.assertEqual([lane["marks"][0][2] for lane in lanes], ["initializing"] * len(METHODS))
        beneath = page.picture(0).crop((2 * int(left) - 4, 2 * int(bottom) + 8, 2 * int(left) + 6, 2 * int(bottom) + 8 + 18 * len(METHODS)))
        pale = [count for count, colour in beneath.getcolors(1 << 16) if abs(colour[3] - 102) < 3]
        self.assertGreater(sum(pale), 50 * len(METHODS))

    def check_ticks(self, page):
        """The ends of an axis have ticks, also where a binary fraction is a little short of a multiple."""
        ends = page.ask("""const axis = {min: -0.3, max: 0.3}; widen(axis); setRange(plots[0], 'y', [axis.min, axis.max]);
                           plots[0].chart.update('none'); const {ticks} = plots[0].chart.scales.y; reset(plots[0]);
                           return [ticks[0].label, ticks.at(-1).label]""")
        self.assertEqual(ends, ["−0.3", "0.3"])

    def check_cursor(self, page, along, plan, row):
        """The values of a frame are those of the table, whichever plot the pointer is in."""
        for plot in (along[0], along[-1], plan):
            page.mouse("mouseMoved", *page.place(plot, FRAME))
            page.settled()
            text = page.readout()
            self.assertIn(row["filename"], text)
            told = re.search(r"milepost\s+([+−]?[\d.]+) m", text)[1].replace("−", "-")
            self.assertAlmostEqual(float(told), float(row["error_m"]), delta=0.0006)
            marks = page.marks()
            for each in along:
                self.assertAlmostEqual(marks[each][0], page.ask(f"return place(plots[{each}], {FRAME})[0]"), delta=1)
            self.assertAlmostEqual(marks[plan][1], page.ask(f"return place(plots[{plan}], {FRAME})[1]"), delta=1)
        page.mouse("mouseMoved", 5, 5)
        self.assertIsNone(page.readout())
        self.assertEqual(set(map(str, page.marks())), {"None"})

    def check_zoom(self, page, along):
        before = [page.ranges(plot) for plot in range(7)]
        left, top, width, height = page.show(along[0])
        page.drag((left + width / 4, top + 50), (left + width / 2, top + 60))
        after = [page.ranges(plot) for plot in range(7)]
        (low, high), _ = before[along[0]]
        for plot in range(7):
            self.assertEqual(after[plot] != before[plot], plot in along)
        for plot in along:
            self.assertAlmostEqual(after[plot][0][0], low + (high - low) / 4, delta=0.2)
            self.assertAlmostEqual(after[plot][0][1], low + (high - low) / 2, delta=0.2)
        page.double_click(left + width / 2, top + 50)
        self.assertEqual([page.ranges(plot) for plot in range(7)], before)

    def check_plan(self, page, plan):
        def lengths(ranges):
            return [high - low for low, high in ranges]

        def metre_px(ranges, width, height):
            return [width / lengths(ranges)[0], height / lengths(ranges)[1]]

        before = page.ranges(plan)
        left, top, width, height = page.show(plan)
        across, upwards = metre_px(before, width, height)
        self.assertAlmostEqual(across / upwards, 1, delta=0.01)
        at = (left + width / 2, top + height / 3)
        page.mouse("mouseMoved", *at)
        page.mouse("mouseWheel", *at, deltaX=0, deltaY=-120)
        page.settled()
        near = page.ranges(plan)
        self.assertAlmostEqual(lengths(near)[0] * 1.2, lengths(before)[0], delta=0.01)
        self.assertAlmostEqual(lengths(near)[1] * 1.2, lengths(before)[1], delta=0.01)
        self.assertAlmostEqual((near[1][1] - before[1][0]) - lengths(near)[1] / 3, lengths(before)[1] * 2 / 3, delta=0.1)
        page.drag(at, (at[0] + 60, at[1] - 30))
        moved = page.ranges(plan)
        across, upwards = metre_px(near, width, height)
        self.assertAlmostEqual(near[0][0] - moved[0][0], 60 / across, delta=0.05)
        self.assertAlmostEqual(near[1][0] - moved[1][0], 30 / upwards, delta=0.05)
        page.ask("plots[arguments[0]].box.querySelector('.buttons button:last-child').click()", plan)
        self.assertEqual(page.ranges(plan), before)

    def check_keys(self, page, along):
        box = self.driver.find_elements("css selector", ".plot")[along[0]]
        page.show(along[0])
        page.mouse("mouseMoved", *page.place(along[0], FRAME))
        box.send_keys("\ue014")  # the right arrow
        self.assertEqual(page.ask("return cursor"), FRAME + 1)
        before = page.ranges(along[0])
        box.send_keys("+")
        self.assertNotEqual(page.ranges(along[0]), before)
        box.send_keys("\ue00c")  # escape
        self.assertEqual(page.ranges(along[0]), before)
        self.assertIsNone(page.readout())

    def test_names_are_texts_and_every_screen_will_do(self):
        query = self.copy_of(STREET / "street-query")
        edit_json(query / "drive.json", lambda drive: drive.update(name=HOSTILE, source=HOSTILE))
        file = self.evaluated(query) / "report.html"
        page = Page(self.driver, file)
        self.assertEqual(page.ask("return document.querySelector('h1').textContent"), HOSTILE)
        self.assertEqual(page.ask("return document.title"), f"{HOSTILE} – milepost evaluation")
        self.assertEqual(page.ask("return document.querySelectorAll('img').length"), 0)
        self.addCleanup(resize, self.driver, 1100, 900)
        resize(self.driver, 390, 800)
        page.settled()
        self.assertLessEqual(page.ask("return document.documentElement.scrollWidth"), 390)
        light = page.ask("return plots[0].chart.data.datasets.map((each) => each.borderColor)")
        self.addCleanup(self.driver.execute_cdp_cmd, "Emulation.setEmulatedMedia", {"features": []})
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": "dark"}]})
        page.settled()
        dark = page.ask("return plots[0].chart.data.datasets.map((each) => each.borderColor)")
        self.assertFalse(set(light) & set(dark))
        self.expect_drawn(page, 0, 3)
        self.expect_quiet(page, file)

    def test_without_scripts_it_says_what_it_needs(self):
        file = self.evaluated() / "report.html"
        self.addCleanup(self.driver.execute_cdp_cmd, "Emulation.setScriptExecutionDisabled", {"value": False})
        self.driver.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
        self.driver.get(file.as_uri())
        self.assertIn("needs a browser that runs it", self.driver.find_element("tag name", "body").text)

    def test_a_found_drive(self):
        walls, street_map, report = (self.folder / name for name in ("walls.geojson", "street.map", "report.html"))
        self.expect_done(run(SIMULATOR, "--seed", 3, "--walls", walls))
        self.expect_done(run(MAPPER, "aerial", "--footprints", walls, "--map", street_map))
        backdrop = self.folder / "town.png"
        Image.new("RGB", (100, 100), (0, 0, 255)).save(backdrop)
        (self.folder / "town.wld").write_text("1e-4\n0\n0\n-1e-4\n8.395\n49.005\n")
        self.expect_done(run(CLIENT, "find", "--map", street_map, "--drive", STREET / "street-query", "--out", self.folder / "found.csv",
                             "--report", report, "--backdrop", backdrop))
        page = Page(self.driver, report)
        self.driver.execute_async_script("const done = arguments[0]; if (picture.complete) done(); else picture.addEventListener('load', done)")
        page.settled()
        over_time, plans = page.plots("frames"), page.plots("plan")
        self.assertEqual(len(over_time), 3)
        self.assertGreaterEqual(len(plans), 3)
        for plot in over_time:
            self.expect_drawn(page, plot, 1)
        for plot in plans:
            self.expect_drawn(page, plot, 2)
            picture = page.picture(plot)  # 60 % of the one from above, which is larger than the plans
            beneath = sum(count for count, colour in picture.getcolors(1 << 24) if abs(colour[3] - 153) < 3)
            self.assertGreater(beneath, 0.3 * picture.width * picture.height)
        row = rows_of(self.folder / "found.csv")[FRAME]
        page.mouse("mouseMoved", *page.place(over_time[0], FRAME))
        page.settled()
        self.assertIn(row["filename"], page.readout())
        self.assertIn(f"{float(row['sigma_m']):.2f} m", page.readout())
        self.assertIn(row["status"], page.readout())
        marks = page.marks()
        self.assertTrue(all(marks[plot] for plot in [*over_time, plans[-1]]))
        left, top, width, _ = page.show(over_time[1])
        page.drag((left + width / 2, top + 20), (left + width - 5, top + 20))
        starts = {round(page.ranges(plot)[0][0], 3) for plot in over_time}
        self.assertEqual(len(starts), 1)
        self.assertGreater(min(starts), 1)
        self.expect_quiet(page, report)


commands.main() if __name__ == "__main__" else None

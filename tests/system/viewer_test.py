"""The viewer in a browser: it draws the network of a running server, and shows the segment that is clicked."""
import io
import json
import math
import pathlib
import re
import tempfile
import time
import urllib.request

from PIL import Image
from selenium.webdriver.common.keys import Keys

import commands
import longitude_180_test
from commands import MAPPER, SIMULATOR, STREET, CommandTest, Server, run
from proxies import proxied
from report_test import browser, resize

HOSTILE = "<img src=x onerror=\"document.title = 'run'\">"
WIDTH_PX, HEIGHT_PX = 1400, 900
STRETCH_M = 10
METRICS = r"""# HELP milepost_requests_total Requests by \"status\".
# TYPE milepost_requests_total counter
milepost_requests_total{status="200",path="a\"}b,c=\"\\"} 12
milepost_requests_total{status="404"} 3 1700000000
# TYPE milepost_connections gauge
milepost_connections 7
# a comment
not a sample
# TYPE milepost_answer_seconds histogram
milepost_answer_seconds_bucket{le="0.1"} 80
milepost_answer_seconds_bucket{le="1"} 100
milepost_answer_seconds_bucket{le="+Inf"} 100
milepost_answer_seconds_sum 4.5
milepost_answer_seconds_count 100
"""


def on_plane(latitude_deg, longitude_deg, zoom):
    """A position on the plane of Web Mercator, in pixels."""
    size_px = 256 * 2 ** zoom
    return (size_px * (longitude_deg + 180) / 360,
            size_px * (0.5 - math.asinh(math.tan(math.radians(latitude_deg))) / (2 * math.pi)))


class ViewerPage:
    """The viewer of a server, in the browser."""

    def __init__(self, driver, url, address="", asks=False):
        """Of a page that asks for a token, requests wait until it has one."""
        self.driver, self.url = driver, url
        driver.get_log("browser"), driver.get_log("performance")
        driver.get("about:blank")
        driver.get(f"{url}/{address}")
        if not asks:
            self.settle()

    def ask(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def until(self, condition, what):
        for _ in range(400):
            found = condition()
            if found:
                return found
            time.sleep(0.05)
        raise AssertionError(f"in vain: {what}; the page shows: {self.text('body')}")

    def settle(self):
        """Waits until no request has been in progress for longer than the page waits before it asks again."""
        idle = 0
        while idle < 8:
            time.sleep(0.05)
            idle = idle + 1 if self.ask("return document.getElementById('map').getAttribute('aria-busy') === 'false'") else 0
        self.driver.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")

    def text(self, selector):
        return self.ask("return document.querySelector(arguments[0])?.innerText ?? ''", selector).replace("\u00a0", " ")

    def facts(self):
        return self.ask("return Object.fromEntries([...document.querySelectorAll('#content dl div')].map((node) => [node.firstChild.innerText, node.lastChild.innerText.replaceAll('\u00a0', ' ')]))")

    def rows(self):
        """The tile index as it is shown."""
        return self.ask("return [...document.querySelectorAll('.tiles[open] tbody tr')].map((row) => [...row.children].map((cell) => cell.innerText))")

    def view(self):
        """Zoom, latitude and longitude of the map's middle."""
        return [float(part) for part in re.search(r"view=([-\d./]+)", self.driver.current_url)[1].split("/")]

    def in_window(self, latitude_deg, longitude_deg):
        zoom, middle_lat, middle_lng = self.view()
        turned = longitude_deg + 360 * round((middle_lng - longitude_deg) / 360)
        (x, y), (middle_x, middle_y) = on_plane(latitude_deg, turned, zoom), on_plane(middle_lat, middle_lng, zoom)
        left, top, width, height = self.ask("const r = document.getElementById('map').getBoundingClientRect(); return [r.left, r.top, r.width, r.height]")
        return left + width / 2 + x - middle_x, top + height / 2 + y - middle_y

    def mouse(self, kind, x, y, **more):
        self.driver.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": kind, "x": x, "y": y, **more})

    def click(self, x, y):
        self.mouse("mouseMoved", x, y)
        self.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
        self.mouse("mouseReleased", x, y, button="left", clickCount=1)
        self.settle()

    def press(self, selector):
        self.driver.find_element("css selector", selector).click()
        self.settle()

    def choose(self, name):
        """Presses the button with this name in the panel."""
        self.ask("[...document.querySelectorAll('#content button')].find((node) => node.innerText.startsWith(arguments[0])).click()", name)
        self.settle()

    def search(self, text):
        field = self.driver.find_element("id", "query")
        field.clear()
        field.send_keys(text, Keys.ENTER)
        self.settle()  # longer than the page waits for the next key

    def picture(self):
        return Image.open(io.BytesIO(self.driver.get_screenshot_as_png())).convert("RGB")

    def look(self, name):
        """A colour of the style sheet."""
        return tuple(bytes.fromhex(self.ask("return getComputedStyle(document.documentElement).getPropertyValue('--' + arguments[0])", name).strip()[1:7]))

    def count(self, name, within=0):
        """The pixels of the map, beside the legend, that have a colour of the style sheet: each channel within a distance."""
        left, top, right, bottom = self.ask("const r = document.getElementById('map').getBoundingClientRect(); return [r.left, r.top, r.right, r.bottom]")
        legend_right = self.ask("return document.getElementById('legend').getBoundingClientRect().right")
        area = self.picture().crop((int(max(left, legend_right)) + 12, int(top), int(right), int(bottom)))
        pixels = area.getcolors(area.width * area.height)
        wanted = self.look(name)
        return sum(number for number, colour in pixels if all(abs(a - b) <= within for a, b in zip(colour, wanted)))

    def complaints(self):
        return [entry["message"] for entry in self.driver.get_log("browser")]

    def requests(self):
        events = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        return [event["params"]["request"]["url"] for event in events if event["method"] == "Network.requestWillBeSent"]


class Viewer(CommandTest):
    @classmethod
    def setUpClass(cls):
        cls.driver = browser(WIDTH_PX, HEIGHT_PX)
        cls.addClassCleanup(cls.driver.quit)
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.maps, walls = pathlib.Path(folder.name) / "maps", pathlib.Path(folder.name) / "walls.geojson"
        cls.maps.mkdir()
        street, blocks = cls.maps / "street.map", cls.maps / "blocks.map"
        for words in ([MAPPER, "build", "--drive", STREET / "street-map", "--map", street], [SIMULATOR, "--seed", 3, "--walls", walls],
                      [MAPPER, "aerial", "--footprints", walls, "--map", blocks]):
            done = run(*words)
            if done.returncode:
                raise RuntimeError(done.stderr)

    def setUp(self):
        super().setUp()
        self.addCleanup(resize, self.driver, WIDTH_PX, HEIGHT_PX)

    def serve(self, maps):
        server = Server(maps)
        server.__enter__()
        self.addCleanup(lambda: server.process.poll() is None and server.__exit__())
        return server

    def get(self, server, path):
        with urllib.request.urlopen(server.url + path) as answer:
            return json.load(answer)

    def street(self, server):
        """The only segment of the street: its document, and its map's."""
        about = self.get(server, "/v1/maps/street")
        return self.get(server, f"/v1/maps/street/builds/{about['build']}/segments/{about['segments'][0]}"), about

    def vertex(self, segment, along_m):
        return min(segment["line"], key=lambda vertex: abs(vertex[3] - along_m))[:2]

    def expect_quiet(self, page):
        self.assertEqual(page.complaints(), [])
        asked = [url for url in page.requests() if not url.startswith(("data:", "about:"))]
        self.assertGreater(len(asked), 0)
        self.assertEqual([url for url in asked if not url.startswith(page.url + "/")], [])

    def expect_drawn(self, page, segment, name, stretches=None):
        """The middle of each stretch has this colour of the style sheet."""
        picture = page.picture()
        for stretch in stretches or range(math.ceil(segment["length_m"] / STRETCH_M)):
            place = page.in_window(*self.vertex(segment, min(STRETCH_M * stretch + 4, segment["length_m"] - 1)))
            self.assertEqual(picture.getpixel(tuple(map(int, place))), page.look(name), f"stretch {stretch}")

    def test_a_map_is_drawn_and_a_click_shows_its_segment(self):
        server = self.serve(self.maps)
        segment, about = self.street(server)
        page = ViewerPage(self.driver, server.url)
        self.assertEqual(page.ask("return document.title"), "milepost maps")
        self.assertEqual(page.ask("return [...document.querySelectorAll('.name')].map((node) => node.innerText)"), ["blocks", "street"])
        self.assertIn("58.0 m in 1 segment", page.text("#content"))
        self.assertIn("no segments, walls", page.text("#content"))
        page.choose("street")
        self.assertEqual(page.facts(), {"length": "58.0 m", "segments": "1", "layers": "tracklets", "build": about["build"][:12]})
        page.ask("document.getElementById('show-tiles').click()")  # their marks lie on the road
        self.expect_drawn(page, segment, "v0")
        page.click(*page.in_window(*self.vertex(segment, 27)))
        self.expect_segment(page, segment)
        zoom = page.view()[0]
        tile = segment["tiles"]["tracklets"][2]
        page.choose("2")
        page.until(lambda: page.view()[0] > zoom, "the map at the tile")
        middle = self.vertex(segment, (tile["from_m"] + tile["to_m"]) / 2)
        self.assertAlmostEqual(page.view()[1], middle[0], delta=2e-5)
        page.press(".back")
        self.assertEqual(page.text("#content h2"), "street")
        self.expect_quiet(page)

    def expect_segment(self, page, segment):
        """The panel has the numbers of the segment's document."""
        self.assertEqual(page.text("#content h2"), segment["segment"])
        tiles, length_m = segment["tiles"]["tracklets"], segment["length_m"]
        items, size = sum(tile["items"] for tile in tiles), sum(tile["bytes"] for tile in tiles)
        self.assertEqual(page.facts(), {
            "length": f"{length_m:.1f} m", "passes": str(len(segment["passes"])), "landmarks": f"{items}, {items / length_m:.1f} a metre",
            "size": f"{size / 1000:.1f} kB, {size / 1000 / length_m:.2f} kB/m",
            "position error (σ)": f"{segment['position_sigma_m']:.2f} m, assumed", "tiles": str(len(tiles))})
        self.assertEqual(page.rows(), [[str(tile["index"]), f"{tile['from_m']:.1f} – {tile['to_m']:.1f}", str(tile["items"]), str(tile["bytes"])] for tile in tiles])
        self.assertIn("street-map, 0.0 to 58.0 m of the drive", page.text("#content"))
        self.assertIn(f"segment={segment['segment']}", page.driver.current_url)

    def test_what_colours_the_road(self):
        server = self.serve(self.maps)
        segment, about = self.street(server)
        record = self.get(server, f"/v1/maps/street/builds/{about['build']}/mapping")["segments"][0]["stretches"]
        page = ViewerPage(self.driver, server.url, f"#map=street&segment={segment['segment']}")
        page.ask("document.getElementById('show-tiles').click()")
        limits = {"fit": [(-95, "v0"), (-85, "v1"), (-70, "v2"), (-50, "v3"), (math.inf, "v4")],
                  "reprojection": [(0.5, "v0"), (0.75, "v1"), (1, "v2"), (1.5, "v3"), (math.inf, "v4")]}
        values = {"fit": lambda each: -100 * each["fitting"] / each["followed"], "reprojection": lambda each: each["reprojection_px"]}
        for view in ("fit", "reprojection"):
            page.press(f".views label:has([value={view}])")
            for stretch, each in enumerate(record):
                name = next(name for limit, name in limits[view] if values[view](each) <= limit)
                self.expect_drawn(page, segment, name, [stretch])
        for view, name in (("passes", "q0"), ("sigma", "v2"), ("landmarks", "v0")):
            page.press(f".views label:has([value={view}])")
            self.expect_drawn(page, segment, name)
            self.assertEqual(f"colour={view}" in page.driver.current_url, view != "landmarks")
        self.expect_quiet(page)

    def test_zoom_and_what_is_seen_from_near(self):
        server = self.serve(self.maps)
        segment, _ = self.street(server)
        latitude, longitude = self.vertex(segment, 30)
        page = ViewerPage(self.driver, server.url, f"#view=15.5/{latitude}/{longitude}")
        self.assertEqual((page.count("m1", 80), page.count("wall") > 100), (0, True))
        self.assertIn("zoom in for tiles and landmarks", page.text("#legend"))
        for _ in range(5):
            page.press(".leaflet-control-zoom-in")
        self.assertEqual(page.view(), [20.5, round(latitude, 7), round(longitude, 7)])
        self.assertEqual(page.ask("return [...document.querySelectorAll('.tile-label')].map((node) => node.innerText)"), ["0", "1", "2"])
        self.assertIn("drawn where a map has them", page.text("#legend"))
        marks = page.count("m1", 80), page.count("wall")
        page.ask("document.getElementById('show-landmarks').click()")
        page.settle()
        self.assertGreater(marks[0], 100)
        self.assertEqual(page.count("m1", 80), 0)
        page.ask("document.getElementById('show-walls').click()")
        page.settle()
        self.assertLess(page.count("wall"), marks[1])
        x, y = page.in_window(latitude, longitude)
        page.mouse("mouseWheel", x, y, deltaX=0, deltaY=600)
        page.until(lambda: page.view()[0] < 20.5, "a smaller zoom")
        self.expect_quiet(page)

    def test_search_by_position_and_by_name(self):
        server = self.serve(self.maps)
        segment, _ = self.street(server)
        latitude, longitude = self.vertex(segment, 20)
        near = self.get(server, f"/v1/segments?near={latitude},{longitude + 0.0001}&radius_m=500")["segments"][0]
        page = ViewerPage(self.driver, server.url)
        page.search(f"{latitude}, {longitude + 0.0001}")
        self.assertEqual(page.view()[1:], [round(latitude, 7), round(longitude + 0.0001, 7)])
        self.assertIn(f"street: {near['distance_m']:.1f} m away, at {near['along_m']:.1f} m of {near['length_m']:.1f} m", page.text(".rows"))
        page.choose(segment["segment"])
        self.expect_segment(page, segment)
        page.search("-0.5 179.5")
        self.assertIn("No segment passes within 500.0 m", page.text("#content"))
        page.search("ock")
        self.assertEqual(page.ask("return [...document.querySelectorAll('.name')].map((node) => node.innerText)"), ["blocks"])
        page.search("91, 8")
        self.assertIn("No map has “91, 8” in its name", page.text("#content"))
        self.expect_quiet(page)

    def test_by_keys_alone(self):
        page = ViewerPage(self.driver, self.serve(self.maps).url)
        field = self.driver.find_element("id", "query")
        field.send_keys("street")
        page.until(lambda: page.ask("return document.querySelectorAll('.name').length") == 1, "the one map of this name")
        field.send_keys(Keys.TAB)
        self.driver.switch_to.active_element.send_keys(Keys.ENTER)
        page.until(lambda: page.text("#content h2") == "street", "the panel of the map")
        self.assertEqual(page.ask("return document.activeElement.innerText"), "street")
        page.settle()
        latitude = page.view()[1]
        self.driver.find_element("id", "map").send_keys(Keys.ARROW_UP)
        page.until(lambda: page.view()[1] > latitude, "a map that moved")
        self.driver.find_element("id", "map").send_keys(Keys.ESCAPE)
        page.until(lambda: page.text("#content h2") == "", "the catalog")
        self.expect_quiet(page)

    def test_a_telephone_in_the_dark(self):
        server = self.serve(self.maps)
        segment, _ = self.street(server)
        light = ViewerPage(self.driver, server.url).look("v0")
        resize(self.driver, 390, 844)
        self.addCleanup(self.driver.execute_cdp_cmd, "Emulation.setEmulatedMedia", {"features": []})
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": "dark"}]})
        page = ViewerPage(self.driver, server.url, "#map=street")
        self.assertLessEqual(page.ask("return document.documentElement.scrollWidth"), 390)
        self.assertNotEqual(page.look("v0"), light)
        page.ask("document.getElementById('show-tiles').click()")
        self.expect_drawn(page, segment, "v0")
        page.click(*page.in_window(*self.vertex(segment, 27)))
        self.expect_segment(page, segment)
        self.assertLessEqual(page.ask("return document.documentElement.scrollWidth"), 390)
        page.ask("window.scrollTo(0, 400)")
        self.assertEqual(page.ask("return [window.scrollY, document.getElementById('map').getBoundingClientRect().top]"), [400, 0])
        self.expect_quiet(page)

    def test_a_map_of_walls_alone(self):
        page = ViewerPage(self.driver, self.serve(self.maps).url, "#map=blocks")
        self.assertIn("The map has walls only", page.text("#content"))
        self.assertGreater(page.count("wall"), 1000)
        self.expect_quiet(page)

    def test_a_street_across_longitude_180(self):
        maps = self.folder / "maps"
        maps.mkdir()
        drive = longitude_180_test.Longitude180.eastward(self, "street-map", "east", -179.9997)
        self.expect_done(self.build(drive, maps / "street.map"))
        server = self.serve(maps)
        segment, _ = self.street(server)
        longitudes = [vertex[1] for vertex in segment["line"]]
        self.assertLess(min(longitudes) * max(longitudes), 0)
        page = ViewerPage(self.driver, server.url)
        self.assertGreater(page.view()[0], 17)
        page.ask("document.getElementById('show-tiles').click()")
        self.expect_drawn(page, segment, "v0")
        page.search(f"{segment['line'][-1][0]}, {segment['line'][-1][1]}")
        self.expect_drawn(page, segment, "v0")
        page.click(*page.in_window(*self.vertex(segment, 10)))
        self.assertEqual(page.text("#content h2"), segment["segment"])
        self.expect_quiet(page)

    def test_a_directory_without_maps(self):
        page = ViewerPage(self.driver, self.serve(self.folder).url)
        self.assertIn("The server has no maps yet.", page.text("#content"))
        self.expect_quiet(page)

    def test_a_server_that_is_away(self):
        server = self.serve(self.maps)
        page = ViewerPage(self.driver, server.url)
        server.__exit__()
        page.choose("street")
        page.ask("document.querySelector('.leaflet-control-zoom-out').click()")
        page.until(lambda: "The server does not answer." in page.text("#away"), "a note that the server is away")

    def answer(self, request, content_type, body):
        request.send_response(200)
        request.send_header("Content-Type", content_type)
        request.send_header("Content-Length", str(len(body)))
        request.end_headers()
        request.wfile.write(body)

    def changed(self, server, change, answers=lambda request: False):
        """The URL of a proxy that passes on change(path, body) for the server's bodies, as texts."""
        proxy = self.enterContext(proxied(server.url, answers, lambda request, _, body: change(request.path, body.decode()).encode()))
        return proxy.url

    def test_a_map_that_is_built_anew(self):
        server = self.serve(self.maps)
        segment, about = self.street(server)
        later = {}
        page = ViewerPage(self.driver, self.changed(server, lambda path, body: body.replace(about["build"], later.get(path, about["build"]))),
                          f"#map=street&segment={segment['segment']}")
        self.assertEqual(page.text("#content h2"), segment["segment"])
        later["/v1/maps"] = "0" * 32
        page.ask("document.dispatchEvent(new Event('visibilitychange'))")
        page.until(lambda: page.text("#notice") == "The map street was built anew.", "a note of the other build")
        self.assertNotIn("segment=", page.driver.current_url)

    def test_ten_thousand_maps(self):
        server, read = self.serve(self.maps), []
        _, about = self.street(server)
        names = [f"m{number:04}" for number in range(10000)]

        def answers(request):
            name = request.path.removeprefix("/v1/maps/")
            if name not in names:
                return False
            read.append(name)
            self.answer(request, "application/json", json.dumps({**about, "name": name}).encode())
            return True
        listed = json.dumps({"maps": [{"name": name, "build": about["build"]} for name in names]})
        page = ViewerPage(self.driver, self.changed(server, lambda path, body: listed if path == "/v1/maps" else body, answers))
        self.assertIn("10\u202f000 maps", page.text("#content"))
        self.assertIn("9976 more maps: write a part of the name above.", page.text("#content"))
        self.assertEqual(sorted(read), names[:24])
        page.search("m999")
        self.assertEqual(page.ask("return [...document.querySelectorAll('.name')].map((node) => node.innerText)"), names[9990:])
        self.assertEqual(sorted(read), names[:24] + names[9990:])

    def test_what_differs_from_an_older_build(self):
        server = self.serve(self.maps)
        segment, about = self.street(server)
        name, older = segment["segment"], "12ab" * 8
        tile = {"index": 1, "bytes": 9570, "digest": "0" * 32}
        told = {"map": "street", "from": older, "to": about["build"], "bytes": 15136, "segments": [
            {"segment": name, "change": "changed", "bytes": 2783, "digest": "1" * 32, "tiles": {"tracklets": {"changed": [tile], "removed": [3, 4]}}},
            {"segment": "side-0", "change": "removed"}], "areas": {"bytes": 12, "digest": "2" * 32, "cells": {"walls": {"changed": [], "removed": [1, 2]}}}}

        def change(path, body):
            return body.replace("  /healthz:", "  /v1/maps/{map}/changes:\n  /healthz:") if path == "/openapi.yaml" else body

        def changes(request):
            if not request.path.startswith("/v1/maps/street/changes"):
                return False
            self.asked = request.path
            self.answer(request, "application/json", json.dumps(told).encode())
            return True
        page = ViewerPage(self.driver, self.changed(server, change, changes))
        page.ask("localStorage.setItem('milepost.builds', JSON.stringify([['street', [{build: arguments[0], seen: '2026-01-02'}]]]))", older)
        page.choose("street")
        page.press("#changes summary")
        before = page.count("m2", 110)
        page.press("#changes [type=submit]")
        self.assertEqual(self.asked, f"/v1/maps/street/changes?from={older}")
        text = page.text("#changes")
        for part in ("2 segments differ, 15.1 kB to fetch", "Walls: 2 cells removed", f"{name}\nchanged: 1 tile new or changed, 9.6 kB, 2 tiles removed",
                     "side-0\nremoved"):
            self.assertIn(part, text)
        self.assertGreater(page.count("m2", 110), before + 500)  # the segment is marked
        page.ask("document.querySelector('#changes .rows button').click()")
        page.settle()
        self.expect_segment(page, segment)

    def test_live_metrics(self):
        read = []

        def change(path, body):
            return body.replace("  /healthz:", "  /metrics:\n  /healthz:") if path == "/openapi.yaml" else body

        def metrics(request):
            if request.path != "/metrics":
                return False
            read.append(request.path)
            self.answer(request, "text/plain", METRICS.replace(" 3 1700000000", f" {3 + 50 * (len(read) - 1)}").encode())
            return True
        page = ViewerPage(self.driver, self.changed(self.serve(self.maps), change, metrics))
        page.press("#metrics summary")
        self.assertIn("connections\t7", page.text("#metrics"))
        self.assertRegex(page.text("#metrics"), r"requests\s+–\s+15\b")
        self.assertRegex(page.text("#metrics"), r"answer\s+63 ms median, 955 ms p99\s+100\b")
        page.until(lambda: re.search(r"requests\s+[1-9][\d.]*/s\s+\d+\b", page.text("#metrics")), "a rate of requests")

    def test_an_operators_tiles(self):
        asked = []

        def tile(request):
            asked.append(request.path)
            content = io.BytesIO()
            Image.new("RGB", (256, 256), (120, 130, 90)).save(content, "PNG")
            self.answer(request, "image/png", content.getvalue())
            return True
        server = self.serve(self.maps)
        tiles = self.enterContext(proxied(server.url, answers=tile)).url + "/{z}/{x}/{y}.png"
        settings = [('name="tiles-url" content=""', f'name="tiles-url" content="{tiles}"'),
                    ('name="tiles-attribution" content=""', 'name="tiles-attribution" content="Ground by &lt;i&gt;us"')]

        def change(path, body):
            for before, after in settings if path == "/" else []:
                body = body.replace(before, after)
            return body
        page = ViewerPage(self.driver, self.changed(server, change), "#map=street")
        page.until(lambda: page.picture().getpixel((WIDTH_PX - 200, HEIGHT_PX - 100)) == (120, 130, 90), "a tile")
        self.assertRegex(asked[0], r"^/\d+/\d+/\d+\.png$")
        self.assertEqual(page.text(".leaflet-control-attribution"), "Ground by <i>us")
        self.expect_drawn(page, self.street(server)[0], "v0", [1])

    def test_names_are_texts(self):
        page = ViewerPage(self.driver, self.changed(self.serve(self.maps), lambda path, body: body.replace(
            '"layers":["tracklets"]', f'"datum":{json.dumps(HOSTILE)},"layers":["tracklets"]').replace(
            '"findings":[]', f'"findings":[{{"drive":"","where":"","what":{json.dumps(HOSTILE)},"hint":""}}]')))
        page.choose("street")
        page.press("#content details summary")
        self.assertEqual(page.facts()["datum"], HOSTILE)
        self.assertEqual(page.text(".findings").strip(), HOSTILE)
        page.search(HOSTILE)
        self.assertIn(f"No map has “{HOSTILE}” in its name", page.text("#content"))
        self.assertEqual(page.ask("return document.querySelectorAll('#panel img').length"), 0)
        self.assertEqual(page.ask("return document.title"), "milepost maps")

    def test_a_server_that_asks_for_a_token(self):
        with tempfile.TemporaryDirectory() as folder:
            tokens = pathlib.Path(folder) / "tokens.json"
            made = run(commands.SERVER, "token", "--tokens", tokens, "--add", "operator", "--all-maps")
            self.assertEqual(made.returncode, 0, made.stderr)
            with Server(self.maps, "--tokens", tokens) as server:
                page = ViewerPage(self.driver, server.url, asks=True)
                page.until(lambda: "those who have a token" in page.text("dialog"), "the question")
                page.driver.find_element("id", "token").send_keys("mp_wrong", Keys.ENTER)
                page.until(lambda: "is not known" in page.text("dialog"), "the question again")
                page.driver.find_element("id", "token").send_keys(made.stdout.strip(), Keys.ENTER)
                page.until(lambda: "street" in page.text("#content"), "the catalog")
                self.assertFalse(page.ask("return !!document.querySelector('dialog')"))
                page.driver.refresh()
                page.settle()
                self.assertIn("street", page.text("#content"))
                # The browser's log has what was refused, and nothing else.
                self.assertTrue(all("401" in line for line in page.complaints()))

    def test_metrics_are_read(self):
        page = ViewerPage(self.driver, self.serve(self.maps).url)
        families, half, most, total = self.driver.execute_async_script("""
            const [text, done] = arguments, script = document.querySelector('script').src;
            import(script.replace('app.js', 'prometheus.js')).then(({familiesOf, quantile, sumOf}) => {
              const families = familiesOf(text), answer = families.get('milepost_answer_seconds');
              done([[...families], quantile(answer, null, 0.5), quantile(answer, null, 0.9), sumOf(answer)]);
            });""", METRICS)
        families = dict(families)
        self.assertEqual(list(families), ["milepost_requests_total", "milepost_connections", "milepost_answer_seconds"])
        self.assertEqual([families[name]["type"] for name in families], ["counter", "gauge", "histogram"])
        requests = families["milepost_requests_total"]
        self.assertEqual([sample["value"] for sample in requests["samples"]], [12, 3])
        self.assertEqual(requests["samples"][0]["labels"], {"status": "200", "path": 'a"}b,c="\\'})
        self.assertEqual((half, most, total), (0.0625, 0.55, 100))


commands.main() if __name__ == "__main__" else None

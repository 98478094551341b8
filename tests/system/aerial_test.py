"""The command milepost-mapper aerial, called as by a user."""
import json
import random
import signal
import sqlite3
import struct
import subprocess

from commands import CommandTest, MAPPER, STREET, main, run, wait_until_caught

PIXEL_M = 0.2
MERCATOR = 3857
WEST_M, NORTH_M = 3628312.0, 39135.0  # of the images, in Web Mercator on the equator
GROUND, SHADOW, ROOF = (180, 150, 110), (54, 45, 33), (190, 80, 60)

SQUARE = [[8.4, 49.0], [8.4001, 49.0], [8.4001, 49.0001], [8.4, 49.0001], [8.4, 49.0]]


def footprints(*rings):
    return json.dumps({"type": "Polygon", "coordinates": rings})


def drawn_yard(width, height):
    """Rows of red, green and blue bytes: houses every 20 m, 12 by 8 m, that cast shadows to the south-east."""
    noise = random.Random(1)
    tints = [tuple(bytes(value + noise.randint(-4, 4) for value in colour) for _ in range(97))
             for colour in (GROUND, SHADOW, ROOF)]
    rows = []
    for y in range(height):
        y_m = y * PIXEL_M % 20
        row = bytearray()
        for x in range(width):
            x_m = x * PIXEL_M % 20
            kind = 0
            if 4 < x_m < 16 and 4 < y_m < 12:
                kind = 2
            elif max(x_m - 16, y_m - 12, 0) < min(x_m - 4, y_m - 4, 2):
                kind = 1
            row += tints[kind][(x * 31 + y * 17) % 97]
        rows.append(bytes(row))
    return rows


def write_tiff(file, rows, georeferenced=True, *, samples=3, alpha_tag=False, crs=MERCATOR, pixel=(PIXEL_M, PIXEL_M),
               corner=(WEST_M, NORTH_M)):
    """An uncompressed GeoTIFF of one strip. `crs` is an EPSG code, of metres or 4326; `pixel` and `corner` are in it."""
    width, height = len(rows[0]) // samples, len(rows)
    pixels = b"".join(rows)
    doubles = struct.pack("<3d", *pixel, 0) + struct.pack("<6d", 0, 0, 0, *corner, 0)
    kind, code = (2, 2048) if crs == 4326 else (1, 3072)
    keys = struct.pack("<16H", 1, 1, 0, 3, 1024, 0, 1, kind, 1025, 0, 1, 1, code, 0, 1, crs)
    extra_at = 8 + len(pixels) + len(pixels) % 2
    bits_at, doubles_at = extra_at, extra_at + 8
    keys_at = doubles_at + len(doubles)
    entries = [(256, 3, 1, width), (257, 3, 1, height), (258, 3, samples, bits_at), (259, 3, 1, 1), (262, 3, 1, 2),
               (273, 4, 1, 8), (277, 3, 1, samples), (278, 3, 1, height), (279, 4, 1, len(pixels))]
    if georeferenced:
        entries += [(33550, 12, 3, doubles_at), (33922, 12, 6, doubles_at + 24), (34735, 3, 16, keys_at)]
    if samples == 4:
        entries = sorted(entries + [(338, 3, 1, 2 if alpha_tag else 0)])
    directory = struct.pack("<H", len(entries)) + b"".join(struct.pack("<HHII", *entry) for entry in entries)
    directory_at = keys_at + len(keys)
    file.write_bytes(struct.pack("<2sHI", b"II", 42, directory_at) + pixels + b"\0" * (len(pixels) % 2) +
                     struct.pack("<4H", 8, 8, 8, 8) + doubles + keys + directory + struct.pack("<I", 0))


def with_fourth_band(rows, value_of):
    """The rows of three bands with a fourth one, whose values are value_of(x, y)."""
    return [b"".join(row[3 * x:3 * x + 3] + bytes((value_of(x, y),)) for x in range(len(row) // 3))
            for y, row in enumerate(rows)]


def near_infrared(x, y):
    return 60 + (x * 7 + y * 13) % 150


class Aerial(CommandTest):
    def setUp(self):
        super().setUp()
        self.map = self.folder / "town.map"

    def aerial(self, *words):
        return run(MAPPER, "aerial", "--map", self.map, *words)

    def walls(self):
        """The walls of the map, each its two ends [longitude, latitude]."""
        lines = self.folder / "walls.geojson"
        self.expect_done(run(MAPPER, "export", "--map", self.map, "--layer", "walls", "--geojson", lines))
        return [feature["geometry"]["coordinates"] for feature in json.loads(lines.read_text())["features"]]

    def yard(self, width=500, height=400):
        file = self.folder / "yard.tif"
        write_tiff(file, drawn_yard(width, height))
        return file

    def square(self, text=None):
        file = self.folder / "town.geojson"
        file.write_text(text or footprints(SQUARE))
        return file

    def in_map(self, query):
        with sqlite3.connect(f"file:{self.map}?immutable=1", uri=True) as database:
            return list(database.execute(query))

    def test_help_teaches(self):
        self.expect_teaches(run(MAPPER, "aerial", "--help"), "--image", "--footprints", "--sun-azimuth-deg", "--without",
                            "shadows", "Example:")
        self.expect_teaches(run(MAPPER, "--help"), "aerial")

    def test_walls_of_an_image(self):
        result = self.aerial("--image", self.yard())
        self.expect_done(result)
        self.assertRegex(result.stdout, r"sun at azimuth 3\d\d degrees \(estimated from the shadows\)")
        walls = self.walls()
        self.assertGreater(len(walls), 60)  # of 80
        (parameters,), = self.in_map("SELECT parameters FROM layers WHERE name = 'walls'")
        parameters = json.loads(parameters)
        self.assertEqual(parameters["items"], "walls")
        self.assertAlmostEqual(parameters["sun"]["azimuth_deg"], 315, delta=12)
        bounds = parameters["bounds"]
        for wall in walls:
            for longitude, latitude in wall:
                self.assertTrue(bounds["west_deg"] < longitude < bounds["east_deg"])
                self.assertTrue(bounds["south_deg"] < latitude < bounds["north_deg"])

    def test_the_same_map_on_any_number_of_threads(self):
        image = self.yard(1000, 200)
        maps = []
        for jobs in ("1", "3"):
            self.expect_done(self.aerial("--image", image, "--jobs", jobs))
            maps.append(self.map.read_bytes())
        self.assertEqual(*maps)

    def test_footprints_stay_as_they_are_and_the_image_adds_others(self):
        yard = self.yard()
        self.expect_done(self.aerial("--image", yard))
        of_image = len(self.walls())
        self.expect_done(self.aerial("--image", yard, "--footprints", self.square()))
        self.assertEqual(len(self.walls()), of_image + 4)
        self.expect_done(self.aerial("--footprints", self.square()))
        ends = [tuple(end) for wall in self.walls() for end in wall]
        self.assertEqual(set(ends), {tuple(corner) for corner in SQUARE})

    def test_all_else_in_the_map_is_kept(self):
        self.expect_done(self.build(STREET / "street-map", self.map))
        tiles = self.in_map("SELECT segment, layer, number, digest FROM tiles ORDER BY 1, 2, 3")
        self.expect_done(self.aerial("--footprints", self.square()))
        self.assertEqual(self.in_map("SELECT segment, layer, number, digest FROM tiles ORDER BY 1, 2, 3"), tiles)
        self.assertEqual(self.in_map("SELECT sum(items) FROM cells WHERE layer = 'walls'"), [(4,)])
        self.expect_done(self.aerial("--footprints", self.square(footprints(SQUARE, SQUARE))))
        self.assertEqual(self.in_map("SELECT sum(items) FROM cells WHERE layer = 'walls'"), [(8,)])

    def test_stages_left_out_and_drawn(self):
        pictures = self.folder / "pictures"
        self.expect_done(self.aerial("--image", self.yard(), "--without", "roofs", "--without", "closure",
                                     "--debug-images", pictures))
        (parameters,), = self.in_map("SELECT parameters FROM layers WHERE name = 'walls'")
        self.assertEqual(json.loads(parameters)["without"], ["roofs", "closure"])
        self.assertEqual({picture.name.split("-", 1)[1] for picture in pictures.iterdir()},
                         {"1-picture.png", "2-edges.png", "3-shadows.png", "4-clutter.png", "5-lines.png"})

    def expect_kept(self, *parts, words):
        """Refused with a line that contains each part; the map with its four walls is unchanged."""
        self.expect_done(self.aerial("--footprints", self.square()))
        before = self.map.read_bytes()
        self.expect_refused(self.aerial(*words), 1, *parts, "; ")
        self.assertEqual(self.map.read_bytes(), before)

    def test_footprints_without_walls_never_replace_walls(self):
        line = [[8.4, 49], [8.4001, 49], [8.4001, 49.0001], [8.4, 49]]
        features = [{"type": "Feature", "properties": {}, "geometry": {"type": kind, "coordinates": coordinates}}
                    for kind, coordinates in (("Point", [8.4, 49]), ("Point", [8.4, 49]), ("LineString", line))]
        topology = {"type": "Topology", "arcs": [line], "objects": {"b": {"type": "Polygon", "arcs": [[0]]}}}
        overpass = {"version": 0.6, "elements": [{"type": "way", "id": 1, "geometry": [{"lat": 49, "lon": 8.4}]}]}
        esri = {"geometryType": "esriGeometryPolygon", "features": [{"geometry": {"rings": [line]}}]}
        for document, parts in (
                ({"type": "FeatureCollection", "features": features}, ["2 Points", "1 LineString", "no Polygon"]),
                ({"type": "FeatureCollection", "features": []}, ["no features"]),
                ({"type": "MultiLineString", "coordinates": [line]}, ["1 MultiLineString"]),
                ({"type": "Feature", "geometry": None}, ["1 feature without a geometry"]),
                ({"type": "Polygon", "coordinates": []}, ["1 Polygon", "no wall"]),
                ({"type": "Polygon", "coordinates": [[[8.4, 49]] * 4]}, ["1 Polygon", "no wall"]),
                ({"type": "polygon", "coordinates": [line]}, ['"polygon" is written "Polygon"']),
                ({"type": "featurecollection", "features": []}, ['written "FeatureCollection"']),
                (topology, ["TopoJSON"]), (overpass, ["Overpass JSON"]), (esri, ["Esri JSON"])):
            with self.subTest(document=str(document)[:60]):
                file = self.folder / "other.geojson"
                file.write_text(json.dumps(document))
                self.expect_kept(str(file), *parts, words=("--footprints", file))

    def test_an_image_without_walls_never_replaces_walls(self):
        bare = self.folder / "bare.tif"
        write_tiff(bare, [bytes(GROUND) * 200] * 200)
        self.expect_kept(str(bare), "no wall", "--allow-empty", words=("--image", bare))
        clear = self.folder / "clear.tif"
        write_tiff(clear, with_fourth_band(drawn_yard(200, 200), lambda x, y: 0), samples=4, alpha_tag=True)
        self.expect_kept(str(clear), "transparent", "--bands", words=("--image", clear))

    def test_an_empty_layer_for_those_who_mean_it(self):
        self.expect_done(self.aerial("--footprints", self.square()))
        empty = self.square('{"type": "FeatureCollection", "features": []}')
        self.expect_done(self.aerial("--footprints", empty, "--allow-empty"))
        self.assertEqual(self.walls(), [])

    def test_near_infrared_is_not_transparency(self):
        yard = drawn_yard(300, 300)
        images = {name: self.folder / f"{name}.tif" for name in ("three", "infrared", "mask")}
        write_tiff(images["three"], yard)
        write_tiff(images["infrared"], with_fourth_band(yard, near_infrared), samples=4, alpha_tag=True)
        west_half = with_fourth_band(yard, lambda x, y: min(255, max(0, 255 - 25 * (x - 150))))  # with a feathered edge
        write_tiff(images["mask"], west_half, samples=4, alpha_tag=True)
        walls = {}
        for name, image in images.items():
            result = self.aerial("--image", image)
            self.expect_done(result)
            self.assertEqual("band 4 is treated as data" in result.stdout, name == "infrared", result.stdout)
            walls[name] = self.walls()
        self.assertEqual(walls["infrared"], walls["three"])
        self.assertTrue(0 < len(walls["mask"]) < 0.7 * len(walls["three"]))
        self.expect_done(self.aerial("--image", images["mask"], "--bands", "1,2,3"))
        self.assertEqual(self.walls(), walls["three"])
        self.expect_done(self.aerial("--image", images["infrared"], "--bands", "4", "--allow-empty"))  # grey
        (parameters,), = self.in_map("SELECT parameters FROM layers WHERE name = 'walls'")
        self.assertEqual(json.loads(parameters)["bands"], [4])
        self.expect_refused(self.aerial("--image", images["three"], "--bands", "1,2,5"), 1, "no band 5", "; ")

    def test_pixels_too_coarse_for_walls(self):
        rows = [bytes(range(30)) * 6] * 60
        for name, crs, pixel, corner, part in (
                ("world", 4326, (6, 3), (-180, 90), "at most 1.2 m"), ("sentinel", MERCATOR, (10, 10), (0, 5e6), "at most 1.2 m"),
                ("elsewhere", MERCATOR, (1, 1), (1e9, 5e6), "position on the Earth"),
                ("nothing", MERCATOR, (0, 1), (0, 5e6), "georeference"),
                ("nan", MERCATOR, (float("nan"), 1), (0, 5e6), "georeference")):
            with self.subTest(name):
                image = self.folder / f"{name}.tif"
                write_tiff(image, rows, crs=crs, pixel=pixel, corner=corner)
                self.expect_refused(self.aerial("--image", image), 1, str(image), part, "; ")

    def expect_readable(self, count=None):
        """The walls, read by our own readers; each spans less than 0.1 degrees."""
        walls = self.walls()
        for (begin, end) in walls:
            self.assertLess(max(abs(begin[0] - end[0]), abs(begin[1] - end[1])), 0.1)
        if count is not None:
            self.assertEqual(len(walls), count, walls)
        return walls

    def test_footprints_across_180_are_cut_there(self):
        def box(west, east):
            return [[west, -16.5], [east, -16.5], [east, -16.4999], [west, -16.4999], [west, -16.5]]
        halves = {"type": "MultiPolygon", "coordinates": [[box(179.9999, 180)], [box(-180, -179.9999)]]}
        for name, document in (("jumping", {"type": "Polygon", "coordinates": [box(179.9999, -179.9999)]}),
                               ("beyond", {"type": "Polygon", "coordinates": [box(179.9999, 180.0001)]}),
                               ("west of it", {"type": "Polygon", "coordinates": [box(-180.0001, -179.9999)]}),
                               ("cut already", halves)):
            with self.subTest(name):
                self.expect_done(self.aerial("--footprints", self.square(json.dumps(document))))
                walls = self.expect_readable(6)
                on_border = [end for wall in walls for end in wall if abs(end[0]) == 180]
                self.assertEqual(sorted({end[0] for end in on_border}), [-180, 180])
                self.assertEqual(len(on_border), 4)

    def test_an_image_across_180(self):
        image = self.folder / "island.tif"
        east_m = 20037508.342789244
        write_tiff(image, drawn_yard(400, 300), corner=(east_m - 43, NORTH_M))
        self.expect_done(self.aerial("--image", image))
        walls = self.expect_readable()
        self.assertGreater(sum(begin[0] > 0 for begin, _ in walls), 10)
        self.assertGreater(sum(begin[0] < 0 for begin, _ in walls), 5)
        (parameters,), = self.in_map("SELECT parameters FROM layers WHERE name = 'walls'")
        bounds = json.loads(parameters)["bounds"]
        self.assertTrue(bounds["west_deg"] > 179.99 and bounds["east_deg"] < -179.99, bounds)

    def test_footprints_about_a_pole(self):
        ring = [[longitude, -89.9995] for longitude in (0, 90, 180, -90, 0)]  # 80 m from corner to corner
        self.expect_done(self.aerial("--footprints", self.square(footprints(ring))))
        self.expect_readable()

    def test_documents_that_are_hostile(self):
        deep = self.folder / "deep.geojson"
        collections = '{"type": "GeometryCollection", "geometries": ['
        for text, part in (("[" * 100000 + "]" * 100000, "deep"), ('{"a":' * 100000 + "1" + "}" * 100000, "deep"),
                           (collections * 50000 + "]}" * 50000, "deep"), ("[" * 100000, "deep")):
            deep.write_text(text)
            self.expect_refused(self.aerial("--footprints", deep), 1, str(deep), part, "; ")
        for reference in ('"EPSG:4326"', '["EPSG:4326"]', "4326", "true", '{"type": "name", "properties": ["EPSG:4326"]}',
                          '{"properties": {"name": 4326}}', '{"properties": {"name": null}}', '{"type": "EPSG"}', "{}"):
            with self.subTest(reference=reference):
                file = self.square(f'{{"crs": {reference}, ' + footprints(SQUARE)[1:])
                self.expect_refused(self.aerial("--footprints", file), 1, str(file), "crs", "; ")
        lines = self.square("\n".join([footprints(SQUARE)] * 2))
        self.expect_refused(self.aerial("--footprints", lines), 1, str(lines), "per line", "GeoJSONSeq")
        self.assertFalse(self.map.exists())

    def test_wrong_calls(self):
        for words, part in (((), "--image or --footprints"), (("--image",), "--image"),
                            (("--image", "x.tif", "--without", "sleep"), "--without"),
                            (("--image", "x.tif", "--sun-azimuth-deg", "400"), "--sun-azimuth-deg"),
                            (("--image", "x.tif", "--metres-per-pixel", "0"), "--metres-per-pixel")):
            with self.subTest(words=words):
                self.expect_refused(self.aerial(*words), 2, part)
        self.expect_refused(run(MAPPER, "aerial", "--footprints", self.square()), 2, "--map")
        self.assertFalse(self.map.exists())

    def test_images_that_are_none(self):
        missing, text, nowhere = (self.folder / name for name in ("missing.tif", "text.tif", "nowhere.tif"))
        text.write_text("not an image")
        write_tiff(nowhere, drawn_yard(50, 50), georeferenced=False)
        for image, part in ((missing, "no such file"), (text, "not an image"), (nowhere, "no georeference")):
            with self.subTest(image=image.name):
                self.expect_refused(self.aerial("--image", image), 1, str(image), part, "; ")
        self.assertFalse(self.map.exists())

    def test_footprints_that_are_none(self):
        broken = [[8.4, 49.0], [8.4001, 49.0], [8.4001, "x"], [8.4, 49.0]]
        metres = [[935000, 6275000], [935010, 6275000], [935010, 6275010], [935000, 6275000]]
        for text, part in (("{", "not JSON"), (footprints(broken), "coordinates[0][2]"), (footprints(metres), "degrees"),
                           (footprints(SQUARE).replace("49.0001", "NaN"), "not JSON"), ("[]", "root")):
            with self.subTest(part=part):
                file = self.square(text)
                self.expect_refused(self.aerial("--footprints", file), 1, str(file), part, "; ")
        self.expect_refused(self.aerial("--footprints", self.folder / "none.geojson"), 1, "none.geojson", "no such file")
        self.assertFalse(self.map.exists())

    def test_a_map_that_is_none_stays(self):
        self.map.write_text("not a map")
        self.expect_refused(self.aerial("--footprints", self.square()), 1, str(self.map))
        self.assertEqual(self.map.read_text(), "not a map")

    def test_stopped_or_killed_it_leaves_the_old_map(self):
        self.expect_done(self.aerial("--footprints", self.square()))
        before = self.map.read_bytes()
        image = self.yard(2000, 1500)
        for stop, code in ((signal.SIGINT, 1), (signal.SIGKILL, -signal.SIGKILL)):
            with self.subTest(stop=stop.name):
                process = subprocess.Popen([MAPPER, "aerial", "--image", image, "--map", self.map],
                                           stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
                wait_until_caught(process, signal.SIGINT)
                self.assertIsNone(process.poll(), "it was done before it was stopped")
                process.send_signal(stop)
                _, said = process.communicate(timeout=120)
                self.assertEqual(process.returncode, code)
                self.assertEqual(said.count("\n"), 1 if stop == signal.SIGINT else 0, said)
                self.assertEqual(self.map.read_bytes(), before)
        self.assertEqual([file.name for file in self.folder.iterdir() if file.name.startswith(".")], [])


main() if __name__ == "__main__" else None

"""The command milepost-mapper aerial, as a user calls it."""
import json
import random
import signal
import sqlite3
import struct
import subprocess
import time

from commands import CommandTest, MAPPER, STREET, main, run

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


def write_tiff(file, rows, georeferenced=True):
    """A GeoTIFF without compression, one strip."""
    width, height = len(rows[0]) // 3, len(rows)
    pixels = b"".join(rows)
    doubles = struct.pack("<3d", PIXEL_M, PIXEL_M, 0) + struct.pack("<6d", 0, 0, 0, WEST_M, NORTH_M, 0)
    keys = struct.pack("<16H", 1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, MERCATOR)
    extra_at = 8 + len(pixels) + len(pixels) % 2
    bits_at, doubles_at = extra_at, extra_at + 6
    keys_at = doubles_at + len(doubles)
    entries = [(256, 3, 1, width), (257, 3, 1, height), (258, 3, 3, bits_at), (259, 3, 1, 1), (262, 3, 1, 2),
               (273, 4, 1, 8), (277, 3, 1, 3), (278, 3, 1, height), (279, 4, 1, len(pixels))]
    if georeferenced:
        entries += [(33550, 12, 3, doubles_at), (33922, 12, 6, doubles_at + 24), (34735, 3, 16, keys_at)]
    directory = struct.pack("<H", len(entries)) + b"".join(struct.pack("<HHII", *entry) for entry in entries)
    directory_at = keys_at + len(keys)
    file.write_bytes(struct.pack("<2sHI", b"II", 42, directory_at) + pixels + b"\0" * (len(pixels) % 2) +
                     struct.pack("<3H", 8, 8, 8) + doubles + keys + directory + struct.pack("<I", 0))


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
                time.sleep(1)
                self.assertIsNone(process.poll(), "it was done before it was stopped")
                process.send_signal(stop)
                _, said = process.communicate(timeout=120)
                self.assertEqual(process.returncode, code)
                self.assertEqual(said.count("\n"), 1 if stop == signal.SIGINT else 0, said)
                self.assertEqual(self.map.read_bytes(), before)
        self.assertEqual([file.name for file in self.folder.iterdir() if file.name.startswith(".")], [])


main() if __name__ == "__main__" else None

"""`milepost-mapper inspect` and `verify`: what a map holds, and whether it is what it claims."""
import json
import sqlite3
import unittest

from commands import MAPPER, STREET, CommandTest, run


class Inspect(CommandTest):
    def setUp(self):
        super().setUp()
        self.map = self.folder / "street.map"
        self.expect_done(self.build(STREET / "street-map", self.map))

    def altered(self, statement, *values):
        """A copy of the map changed by SQL, whose digests then no longer hold."""
        file = self.folder / "altered.map"
        file.write_bytes(self.map.read_bytes())
        with sqlite3.connect(file) as store:
            store.execute(statement, values)
        store.close()
        return file

    def contradictions_in(self, file):
        result = run(MAPPER, "verify", "--map", file, "--json")
        self.assertEqual(result.returncode, 1, result.stderr)
        return json.loads(result.stdout)["contradictions"]

    def test_what_a_map_holds(self):
        result = run(MAPPER, "inspect", "--map", self.map, "--json")
        self.expect_done(result)
        held = json.loads(result.stdout)
        layer, = held["layers"]
        segment, = held["segments"]
        with sqlite3.connect(self.map) as store:
            tiles, items, size = store.execute("SELECT count(*), sum(items), sum(bytes) FROM tiles").fetchone()
        store.close()
        self.assertEqual((layer["tiles"], layer["count"], layer["bytes"]), (tiles, items, size))
        self.assertEqual(segment["landmarks"], items)
        self.assertEqual(segment["passes"], ["street-map"])
        self.assertEqual((segment["position_sigma_m"], segment["assumed"]), (0.18, True))
        self.assertEqual(segment["gaps"], [])
        self.assertEqual(held["bytes"], self.map.stat().st_size)
        text = run(MAPPER, "inspect", "--map", self.map).stdout
        self.assertRegex(text, rf"layer tracklets: {items} landmarks in {tiles} tiles, 0\.4\d kB/m")
        self.assertRegex(text, r"segment street-map-0: \d+\.\d m, 1 pass, \d+\.\d landmarks per metre, "
                               r"positions to 0\.180 m \(assumed\), to no other segment")

    def test_stretches_with_few_landmarks(self):
        sparse = self.folder / "sparse.map"
        self.expect_done(self.build(STREET / "street-map", sparse, "--size-target-kb-per-m", 0.02))
        segment, = json.loads(run(MAPPER, "inspect", "--map", sparse, "--json").stdout)["segments"]
        self.assertTrue(segment["gaps"])
        self.assertIn("few landmarks from", run(MAPPER, "inspect", "--map", sparse).stdout)

    def test_a_sound_map(self):
        result = run(MAPPER, "verify", "--map", self.map)
        self.expect_done(result)
        self.assertRegex(result.stdout, r"street\.map: build [0-9a-f]{32}, every byte is as it was built\n$")

    def test_what_was_changed_is_named(self):
        for statement, kind, words in (
                ("UPDATE tiles SET items = items + 1 WHERE number = 1", "damage", "tile"),
                ("UPDATE frames SET frame = zeroblob(length(frame)) WHERE id = 1", "damage", "tile")):
            with self.subTest(statement):
                found = self.contradictions_in(self.altered(statement))
                self.assertTrue(any(each["kind"] == kind and words in each["where"] + each["what"] for each in found), found)

    def test_what_is_no_map(self):
        other = self.folder / "notes.map"
        other.write_text("no map")
        for command in ("inspect", "verify"):
            self.expect_refused(run(MAPPER, command, "--map", other), 1, "notes.map")
            self.expect_refused(run(MAPPER, command), 2, "--map")


if __name__ == "__main__":
    unittest.main(verbosity=2)

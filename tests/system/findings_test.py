"""What is told of drives that are recorded badly: `milepost-mapper build --dry-run`, and at the start of each build."""
import csv
import json
import random
import shutil
import unittest

from commands import MAPPER, SHARED, STREET, CommandTest, rows_of, run


class Findings(CommandTest):
    def spoilt(self, change, name="spoilt"):
        """The street's mapping drive with each row of its trajectory changed."""
        drive = self.folder / name
        shutil.copytree(STREET / "street-map", drive)
        rows = rows_of(drive / "trajectory.csv")
        chance = random.Random(5)
        rows = [row for row in (change(index, dict(row), chance) for index, row in enumerate(rows)) if row]
        with (drive / "trajectory.csv").open("w", newline="") as table:
            writer = csv.DictWriter(table, list(rows[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
        return drive

    def found_in(self, *drives, code=0):
        result = run(MAPPER, "build", "--dry-run", "--json", *(word for drive in drives for word in ("--drive", drive)))
        self.assertEqual(result.returncode, code, result.stderr)
        return json.loads(result.stdout)["findings"]

    def test_a_sound_drive_has_none_and_nothing_is_written(self):
        before = set(self.folder.iterdir())
        result = run(MAPPER, "build", "--dry-run", "--drive", STREET / "street-map", "--drive", STREET / "street-query")
        self.expect_done(result)
        self.assertEqual(result.stderr, "")
        self.assertRegex(result.stdout, r"^2 drives, \d+ frames, 0 findings; no map was written\n$")
        self.assertEqual(set(self.folder.iterdir()), before)

    def test_headings(self):
        def noise(_, row, chance):
            return {**row, "heading_deg": float(row["heading_deg"]) + chance.gauss(0, 5)}

        def reversed_by_180(_, row, __):
            return {**row, "heading_deg": float(row["heading_deg"]) + 180}
        finding, = self.found_in(self.spoilt(noise))
        self.assertEqual(finding["kind"], "heading_noise")
        self.assertTrue(finding["where"].endswith("spoilt/trajectory.csv"))
        self.assertEqual(finding["line"], 2)
        self.assertGreater(finding["count"], 20)
        self.assertIn("degrees", finding["what"])
        self.assertTrue(finding["hint"])
        finding, = self.found_in(self.spoilt(reversed_by_180, "reversed"), code=1)  # no road leads ahead
        self.assertEqual(finding["kind"], "reversed_camera")

    def test_positions(self):
        def exchanged(_, row, __):
            return {**row, "east_m": row["north_m"], "north_m": row["east_m"]}

        def altitudes(_, row, chance):
            return {**row, "up_m": float(row["up_m"]) + chance.gauss(0, 1)}

        def noise(_, row, chance):
            return {**row, "east_m": float(row["east_m"]) + chance.gauss(0, 0.3),
                    "north_m": float(row["north_m"]) + chance.gauss(0, 0.3)}

        def fifth(index, row, _):
            return row if index % 5 == 0 else None
        for change, kind in ((exchanged, "exchanged_axes"), (altitudes, "altitude_noise"), (noise, "position_noise"),
                             (fifth, "sparse_frames")):
            with self.subTest(kind):
                found = self.found_in(self.spoilt(change, kind), code=1 if kind == "exchanged_axes" else 0)
                self.assertIn(kind, [finding["kind"] for finding in found])

    def test_a_build_that_fails_is_one_line_that_names_them(self):
        def reversed_by_180(_, row, __):
            return {**row, "heading_deg": float(row["heading_deg"]) + 180}
        drive = self.spoilt(reversed_by_180)
        self.expect_refused(self.build(drive, self.folder / "street.map"), 1, "does not move forwards",
                            "--dry-run tells more: reversed_camera")
        result = run(MAPPER, "build", "--dry-run", "--drive", drive)
        self.expect_refused(result, 1, "does not move forwards")
        self.assertIn("the headings point against the direction of travel", result.stdout)

    def test_a_build_tells_them_and_goes_on(self):
        def noise(_, row, chance):
            return {**row, "heading_deg": float(row["heading_deg"]) + chance.gauss(0, 5)}
        file = self.folder / "street.map"
        result = run(MAPPER, "build", "--drive", self.spoilt(noise), "--map", file)
        self.expect_done(result)
        self.assertRegex(result.stderr, r"warning: .*spoilt/trajectory.csv, line 2: the headings vary by")
        self.assertTrue(file.exists())

    def test_the_images_are_the_witness(self):
        def altitudes(_, row, chance):
            return {**row, "up_m": float(row["up_m"]) + chance.gauss(0, 0.5)}
        file = self.folder / "street.map"

        def built(drive):
            result = run(MAPPER, "build", "--drive", drive, "--map", file, "--json")
            self.expect_done(result)
            told = json.loads(result.stdout)
            return told["drives"][0], [finding["kind"] for finding in told["findings"]], told["maps"]
        drive, kinds, maps = built(STREET / "street-map")
        self.assertEqual(kinds, [])
        self.assertLess(drive["plan_rms_m"], 0.02)
        self.assertLess(drive["up_rms_m"], 0.02)
        self.assertGreater(drive["fitting_share"], 0.9)
        self.assertEqual(maps[0]["file"], str(file))
        drive, kinds, _ = built(self.spoilt(altitudes))
        self.assertEqual(kinds, ["altitude_noise", "images_against_altitudes"])
        self.assertAlmostEqual(drive["up_rms_m"], 0.5, delta=0.15)
        self.assertLess(drive["plan_rms_m"], 0.05)

    def test_a_drive_that_does_not_fit_fails_and_the_old_map_stays(self):
        file = self.folder / "street.map"
        self.expect_done(self.build(STREET / "street-map", file))
        before = file.read_bytes()
        self.expect_refused(self.build(STREET / "street-map", file, "--min-fitting-share", 1), 1, "street-map",
                            "fewer than min-fitting-share: 100 %")
        self.assertEqual(file.read_bytes(), before)

    def test_times_in_milliseconds_are_refused(self):
        def late(_, row, __):
            return {**row, "timestamp_s": f"{1000 * float(row['timestamp_s']):.0f}"}
        result = run(MAPPER, "build", "--dry-run", "--drive", self.spoilt(late))
        self.expect_refused(result, 1, "trajectory.csv", "milliseconds", "give timestamp_s in seconds")

    def test_a_map_is_named_or_none_is_wanted(self):
        self.expect_refused(run(MAPPER, "build", "--drive", STREET / "street-map"), 2, "--map", "--dry-run")

    @unittest.skipUnless((SHARED / "drives").exists(), "skipped: there are no recorded drives beside the checkout")
    def test_recorded_drives_have_none(self):
        for drive in sorted((SHARED / "drives").iterdir()):
            if not (drive / "drive.json").exists():
                continue
            with self.subTest(drive.name):
                self.assertEqual(self.found_in(drive), [])


if __name__ == "__main__":
    unittest.main(verbosity=2)

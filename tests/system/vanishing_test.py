"""The command milepost-client vanishing, called as by a user."""
import json
import math

from commands import CLIENT, CommandTest, STREET, edit_json, main, run


class Vanishing(CommandTest):
    def setUp(self):
        super().setUp()
        drive = STREET / "street-map"
        self.camera = drive / "drive.json"
        frames = drive / json.loads(self.camera.read_text())["images"]
        self.images = sorted(frames.iterdir())[:2]
        self.out = self.folder / "found.json"

    def find(self, *words, camera=None, out=None):
        return run(CLIENT, "vanishing", "--camera", camera or self.camera, "--out", out or self.out, *words)

    def test_help_teaches(self):
        self.expect_teaches(run(CLIENT, "vanishing", "--help"), "--camera", "--out", "--method", "evidence", "clustering",
                            "vertical", "Example:")
        self.expect_teaches(run(CLIENT, "--help"), "vanishing")

    def test_one_object_an_image_the_same_each_time(self):
        for method in ("evidence", "clustering"):
            with self.subTest(method=method):
                self.expect_done(self.find(*self.images, "--method", method))
                entries = json.loads(self.out.read_text())
                self.assertEqual([entry["image"] for entry in entries], [str(image) for image in self.images])
                for entry in entries:
                    self.assertTrue(entry["directions"])
                    self.check_entry(entry)
                again = self.folder / "again.json"
                self.expect_done(self.find(*self.images, "--method", method, out=again))
                self.assertEqual(again.read_bytes(), self.out.read_bytes())

    def check_entry(self, entry):
        counts = [0] * len(entry["directions"])
        for line in entry["lines"]:
            self.assertEqual(len(line), 5)
            self.assertIn(line[4], range(-1, len(counts)))
            if line[4] >= 0:
                counts[line[4]] += 1
        self.assertEqual([direction["lines"] for direction in entry["directions"]], counts)
        for direction in entry["directions"]:
            self.assertAlmostEqual(math.hypot(*direction["direction"]), 1, places=9)
            self.assertIn(direction["orientation"], ("vertical", "horizontal"))
            if direction["orientation"] == "vertical":  # the street's camera is level
                self.assertLess(direction["direction"][1], -0.99)

    def test_wrong_calls(self):
        image = self.images[0]
        self.expect_refused(run(CLIENT, "vanishing", "--camera", self.camera, "--out", self.out), 2, "IMAGE")
        self.expect_refused(run(CLIENT, "vanishing", "--out", self.out, image), 2, "--camera")
        self.expect_refused(self.find(image, "--method", "guessing"), 2, "--method", "guessing")
        self.expect_refused(self.find(image, "--max-tilt-deg", "90"), 2, "--max-tilt-deg")
        self.assertFalse(self.out.exists())

    def test_images_that_are_none(self):
        missing, text = self.folder / "missing.png", self.folder / "text.png"
        text.write_text("not an image")
        self.expect_refused(self.find(self.images[0], missing), 1, str(missing), "there is no such file", "; ")
        self.expect_refused(self.find(self.images[0], text), 1, str(text), "cannot be decoded", "; replace")
        self.assertFalse(self.out.exists())

    def test_cameras_that_are_none(self):
        for change, parts in ((lambda drive: drive["camera"].pop("focal_px"), ("camera.focal_px", "is missing")),
                              (lambda drive: drive["camera"].update(focal_px=[0, 0]), ("camera.focal_px",)),
                              (lambda drive: drive["camera"].update(width_px=31), ("31x", "pixels", "drive.json"))):
            with self.subTest(parts=parts):
                camera = self.folder / "drive.json"
                camera.write_bytes(self.camera.read_bytes())
                edit_json(camera, change)
                self.expect_refused(self.find(self.images[0], camera=camera), 1, *parts)
        self.expect_refused(self.find(self.images[0], camera=self.folder / "none.json"), 1, "none.json")

    def test_of_drive_json_only_the_camera_is_needed(self):
        camera = self.folder / "camera.json"
        camera.write_text(json.dumps({"camera": json.loads(self.camera.read_text())["camera"]}))
        self.expect_done(self.find(self.images[0], camera=camera))

    def test_a_place_that_cannot_be_written(self):
        self.expect_refused(self.find(self.images[0], out=self.folder / "no" / "found.json"), 1, "found.json")


main() if __name__ == "__main__" else None

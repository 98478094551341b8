"""Vanishing directions in photographs of real buildings, against the York Urban Line Segment Database.

Each of an image's three true directions is compared with a found one: the assignment with the least sum of angles, one
found direction for at most one true one; a true direction without a match counts as 90 degrees. Skipped, saying
so, without the photographs, which cannot be part of the project.
"""
import itertools
import json
import math
import pathlib
import statistics
import time
import unittest

from commands import CLIENT, CommandTest, SHARED, main, run

PHOTOGRAPHS = SHARED / "aerial" / "york-urban"
NOT_FOUND_DEG = 90.0


def angle_deg(a, b):
    """The angle between two unit vectors or their opposites."""
    return math.degrees(math.acos(min(1.0, abs(sum(x * y for x, y in zip(a, b))))))


def errors_deg(true, found):
    """One error per true direction, for the best assignment of the found ones."""
    places = [*range(len(found)), *[None] * len(true)]
    assignments = ([NOT_FOUND_DEG if place is None else angle_deg(direction, found[place])
                    for direction, place in zip(true, chosen)]
                   for chosen in itertools.permutations(places, len(true)))
    return min(assignments, key=sum)


def y_down(direction):
    return [direction[0], -direction[1], direction[2]]


class Scoring(unittest.TestCase):
    def test_the_best_assignment_is_scored(self):
        x, y, z = [1, 0, 0], [0, 1, 0], [0, 0, 1]
        near_x = [math.cos(math.radians(3)), 0, math.sin(math.radians(3))]
        for found, expected in (([z, [-1, 0, 0], y], [0, 0, 0]), ([y, near_x], [3, 0, 90]), ([], [90, 90, 90]),
                                ([y, near_x, x, z], [0, 0, 0])):
            with self.subTest(found=found):
                for error, value in zip(errors_deg([x, y, z], found), expected, strict=True):
                    self.assertAlmostEqual(error, value, places=4)


@unittest.skipUnless((PHOTOGRAPHS / "ground_truth.json").is_file(), f"there are no photographs in {PHOTOGRAPHS}")
class YorkUrban(CommandTest):
    def errors_of(self, method):
        """All errors of a method, of which it also prints a summary line."""
        truth = json.loads((PHOTOGRAPHS / "ground_truth.json").read_text())
        camera, found_file = self.folder / "camera.json", self.folder / "found.json"
        camera.write_text(json.dumps({"camera": truth["camera"]}))
        started_s = time.monotonic()
        self.expect_done(run(CLIENT, "vanishing", "--camera", camera, "--out", found_file, "--method", method,
                             *(PHOTOGRAPHS / entry["image"] for entry in truth["images"])))
        frame_ms = 1000 * (time.monotonic() - started_s) / len(truth["images"])
        errors = []
        for entry, found in zip(truth["images"], json.loads(found_file.read_text()), strict=True):
            self.assertEqual(pathlib.Path(found["image"]).name, entry["image"])
            errors += errors_deg([y_down(direction) for direction in entry["vanishing_directions_camera"]],
                                 [direction["direction"] for direction in found["directions"]])
        shares = " ".join(f"{share_within(errors, limit):.1%} within {limit}," for limit in (2, 5, 10))
        print(f"{method}: median {statistics.median(errors):.2f} degrees, {shares} {frame_ms:.0f} ms a frame "
              f"({len(errors)} directions)")
        return errors

    def test_evidence(self):
        errors = self.errors_of("evidence")
        self.assertLess(statistics.median(errors), 1.2)
        self.assertGreater(share_within(errors, 5), 0.90)

    def test_clustering(self):
        self.assertLess(statistics.median(self.errors_of("clustering")), 1.6)


def share_within(errors, limit_deg):
    return sum(error <= limit_deg for error in errors) / len(errors)


main() if __name__ == "__main__" else None

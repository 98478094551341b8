"""The scoring of walls, and walls found in an orthoimage of a real settlement against its outlines.

The settlement is skipped, saying so, without the image, which cannot be part of the project.
"""
import os
import pathlib
import unittest

import numpy

from laboratory import walls

AERIAL = pathlib.Path(os.environ.get("MILEPOST_SHARED", "")) / "aerial"
MAPPER = os.environ.get("MILEPOST_MAPPER", "")
OUTLINES = AERIAL / "kampala-a-buildings.geojson"

BOX = {"west_deg": 0.0, "south_deg": 0.0, "east_deg": 0.001, "north_deg": 0.001}
DEG_PER_M = 1 / 111319.49  # of longitude, on the equator


def line(*ends_m):
    return [[x * DEG_PER_M, y * DEG_PER_M] for x, y in ends_m]


class Scoring(unittest.TestCase):
    outline = line((10, 50), (40, 50))

    def check(self, found, completeness, correctness):
        score = walls.score(found, [self.outline], BOX)
        self.assertAlmostEqual(score.completeness, completeness, delta=0.02)
        self.assertAlmostEqual(score.correctness, correctness, delta=0.02)
        return score

    def test_metres(self):
        east_m, north_m = walls.Frame(49.0, 8.4).metres([[8.401, 49.001]])[0]
        self.assertAlmostEqual(east_m, 73.17, places=2)
        self.assertAlmostEqual(north_m, 111.21, places=2)

    def test_what_is_near_and_parallel_is_met(self):
        self.assertAlmostEqual(self.check([line((10, 50.6), (40, 50.6))], 1, 1).f1, 1, delta=0.02)
        self.check([line((40, 49.5), (10, 49.5))], 1, 1)
        self.check([line((10, 51.5), (40, 51.5))], 0, 0)
        self.check([line((25, 40), (25, 60))], 0, 0)
        self.check([line((10, 50), (25, 50)), line((10, 80), (40, 80))], 0.52, 0.35)

    def test_nothing_found(self):
        self.assertEqual(self.check([], 0, 0).f1, 0)

    def test_outlines_beyond_the_image_are_not_missed(self):
        outside = line((90, 50), (150, 50))  # the image ends at 111 m
        score = walls.score([line((90, 50), (111, 50))], [outside], BOX)
        self.assertGreater(score.completeness, 0.99)

    def test_samples_keep_the_direction(self):
        points = walls.sampled([numpy.array([[0.0, 0.0], [1.0, 1.0]])])
        self.assertEqual(len(points.at_m), 6)
        self.assertAlmostEqual(points.angle_rad[0], numpy.pi / 4)


@unittest.skipUnless(OUTLINES.is_file(), f"there is no orthoimage in {AERIAL}")
class Settlement(unittest.TestCase):
    def score_of(self, image, *words):
        found = walls.scored(MAPPER, AERIAL / image, OUTLINES, *words)
        print(f"{image} {' '.join(words)}: {found.walls} walls, completeness {found.completeness:.3f}, "
              f"correctness {found.correctness:.3f}, F1 {found.f1:.3f}")
        return found

    def test_at_7_centimetres(self):
        self.assertGreater(self.score_of("kampala-a-7cm.tif").f1, 0.70)

    def test_at_15_centimetres(self):
        self.assertGreater(self.score_of("kampala-a-15cm.tif").f1, 0.67)

    def test_the_papers_stages_alone(self):
        score = self.score_of("kampala-a-7cm.tif", "--without", "roofs", "--without", "corners")
        self.assertGreater(score.f1, 0.45)


if __name__ == "__main__":
    unittest.main(verbosity=2)

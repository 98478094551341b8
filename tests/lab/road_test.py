"""Curvature and lateral offsets of lines that are known."""
import math
import unittest

import numpy as np

from laboratory.road import LocalFrame, Road, earth_centred, geodetic


def arc(radius_m, length_m=80.0, step_m=2.0):
    """A left bend."""
    along_m = np.arange(0, length_m + step_m / 2, step_m)
    angle = along_m / radius_m
    return Road(along_m, np.stack([radius_m * np.sin(angle), radius_m * (1 - np.cos(angle))], axis=-1))


class Curvature(unittest.TestCase):
    def test_of_an_arc_is_one_over_its_radius(self):
        for radius_m in (20, 60, 500):
            curvature = arc(radius_m).curvature_per_m(np.linspace(0, 80, 33))
            np.testing.assert_allclose(curvature, 1 / radius_m, rtol=0.02)

    def test_of_a_right_bend_is_negative(self):
        left = arc(50)
        right = Road(left.along_m, left.east_north_m * [1, -1])
        np.testing.assert_allclose(right.curvature_per_m(40.0), -1 / 50, rtol=0.02)

    def test_of_a_straight_line_is_nothing(self):
        road = Road([0, 10, 50, 100], [[0, 0], [6, 8], [30, 40], [60, 80]])
        np.testing.assert_allclose(road.curvature_per_m(np.linspace(0, 100, 11)), 0, atol=1e-9)

    def test_survives_positions_that_are_2_cm_off(self):
        along_m = np.arange(0, 200, 1.5)
        noise_m = np.random.default_rng(1).normal(0, 0.02, (len(along_m), 2))
        road = Road(along_m, np.stack([along_m, 0 * along_m], axis=-1) + noise_m)
        self.assertFalse(road.is_curved(along_m).any())

    def test_a_bend_of_less_than_100_m_is_curved(self):
        self.assertTrue(arc(90).is_curved(np.array([0.0, 40.0, 80.0])).all())
        self.assertFalse(arc(110).is_curved(np.array([0.0, 40.0, 80.0])).any())

    def test_a_line_shorter_than_the_window_has_one_curvature(self):
        np.testing.assert_allclose(arc(30, length_m=12).curvature_per_m(np.array([0.0, 6, 12])), 1 / 30, rtol=0.02)


class Lateral(unittest.TestCase):
    def test_left_is_positive_and_ends_are_points(self):
        road = Road([0, 10, 20], [[0, 0], [10, 0], [10, 10]])
        offsets_m = road.lateral_m([[5, 2], [5, -2], [8, 5], [13, 5], [-3, 4]])
        np.testing.assert_allclose(offsets_m, [2, -2, 2, -3, 5])


class Frames(unittest.TestCase):
    def test_a_degree_of_latitude_and_longitude(self):
        # Lengths of a degree at 49 degrees north on WGS84, by its published series.
        frame = LocalFrame(49, 8, 0)
        north_m = frame.from_earth(earth_centred(49.001, 8.0, 0.0))
        east_m = frame.from_earth(earth_centred(49.0, 8.001, 0.0))
        self.assertAlmostEqual(north_m[1], 111.2096, delta=0.003)
        self.assertAlmostEqual(east_m[0], 73.1722, delta=0.003)

    def test_latitude_longitude_and_height_come_back(self):
        for place in ((49.0, 8.4, 110.0), (-33.9, 151.2, -20.0), (0.0, 0.0, 0.0), (71.0, -156.8, 8000.0)):
            np.testing.assert_allclose(geodetic(earth_centred(*place)), place, rtol=0, atol=1e-8)

    def test_there_and_back(self):
        frame = LocalFrame(-33.9, 151.2, 40)
        positions_m = np.array([[100, -250, 3], [0, 0, 0], [-1000, 2000, 10]], float)
        np.testing.assert_allclose(frame.from_earth(frame.to_earth(positions_m)), positions_m, atol=1e-6)
        up_m = frame.from_earth(earth_centred(-33.9, 151.2, 47))
        np.testing.assert_allclose(up_m, [0, 0, 7], atol=1e-6)
        self.assertTrue(math.isclose(np.linalg.norm(frame.to_earth(np.zeros(3))), 6371e3, rel_tol=3e-3))


if __name__ == "__main__":
    unittest.main(verbosity=2)

"""Figures against values computed by hand."""
import math
import unittest

import numpy as np
from scipy import stats

from laboratory import statistics
from made_up import fixes

NAN = math.nan


class Figures(unittest.TestCase):
    def test_absolute_errors_of_localized_frames_of_all_pairs_together(self):
        figures = statistics.figures_of([fixes("a", "m", [0.1, -0.3, NAN]), fixes("b", "m", [0.8])])
        self.assertAlmostEqual(figures.mean_m, 0.4)
        self.assertAlmostEqual(figures.std_m, math.sqrt((0.09 + 0.01 + 0.16) / 3))
        self.assertAlmostEqual(figures.max_m, 0.8)
        self.assertAlmostEqual(figures.median_m, 0.3)
        self.assertEqual((figures.localized, figures.frames), (3, 4))

    def test_nothing_localized_has_no_figures(self):
        figures = statistics.figures_of([fixes("a", "m", [NAN, NAN])])
        self.assertTrue(math.isnan(figures.mean_m))
        self.assertEqual((figures.localized, figures.frames), (0, 2))

    def test_a_map_counts_once_and_by_its_length(self):
        same = {"kb_per_m": 2.0, "length_m": 100.0, "map_name": "one"}
        self.assertAlmostEqual(statistics.kb_per_m([fixes("a", "m", [0], **same), fixes("b", "m", [0], **same),
                                                    fixes("c", "m", [0], kb_per_m=5.0, length_m=50.0)]), 3.0)

    def test_calibration(self):
        shares = statistics.calibration([fixes("a", "m", [0.5, -1.5, 2.5, 3.5, NAN])])
        self.assertEqual(shares, (0.25, 0.5, 0.75))
        self.assertEqual([round(share, 4) for share in statistics.NORMAL_SHARES], [0.6827, 0.9545, 0.9973])


class Differences(unittest.TestCase):
    def test_of_means_and_variances_on_common_frames(self):
        a = [fixes("p", "a", [1, -2, NAN, 9])]
        b = [fixes("p", "b", [3, 4, 5, NAN])]
        mean, variance = statistics.paired_differences(a, b)
        self.assertEqual((mean.a, mean.b, mean.frames), (1.5, 3.5, 2))
        self.assertAlmostEqual(variance.a, 0.25)
        self.assertAlmostEqual(variance.b, 0.25)

    def test_a_constant_difference_has_no_spread(self):
        errors_m = np.random.default_rng(2).exponential(1, 300)
        mean, _ = statistics.paired_differences([fixes("p", "a", errors_m)], [fixes("p", "b", errors_m + 0.5)])
        self.assertAlmostEqual(mean.low, -0.5)
        self.assertAlmostEqual(mean.high, -0.5)
        self.assertTrue(mean.significant)

    def test_the_interval_of_independent_frames_is_that_of_the_mean(self):
        noise_m = np.abs(np.random.default_rng(3).normal(5, 1, 2000))
        mean, _ = statistics.paired_differences([fixes("p", "a", noise_m)], [fixes("p", "b", np.full(2000, 5.0))])
        self.assertAlmostEqual(mean.high - mean.low, 2 * 1.96 / math.sqrt(2000), delta=0.015)
        self.assertFalse(mean.significant)

    def test_frames_that_err_in_stretches_make_it_wider(self):
        stretches_m = np.repeat(np.abs(np.random.default_rng(4).normal(5, 1, 100)), 20)
        mean, _ = statistics.paired_differences([fixes("p", "a", stretches_m)], [fixes("p", "b", np.full(2000, 5.0))])
        self.assertGreater(mean.high - mean.low, 2 * 1.96 / math.sqrt(100) * 0.7)

    def test_pairs_keep_their_weight(self):
        a = [fixes("p", "a", np.full(30, 1.0)), fixes("q", "a", np.full(70, 2.0))]
        b = [fixes("p", "b", np.full(30, 0.0)), fixes("q", "b", np.full(70, 0.0))]
        mean, _ = statistics.paired_differences(a, b)
        self.assertAlmostEqual(mean.low, 1.7)
        self.assertAlmostEqual(mean.high, 1.7)

    def test_the_same_each_time(self):
        errors_m = np.random.default_rng(5).normal(0, 1, 200)
        pair = [fixes("p", "a", errors_m)], [fixes("p", "b", errors_m[::-1])]
        self.assertEqual(statistics.paired_differences(*pair), statistics.paired_differences(*pair))

    def test_kept_frames_only(self):
        curved = [True, False, True]
        mean, _ = statistics.paired_differences([fixes("p", "a", [1, 5, 3], curved=curved)],
                                                [fixes("p", "b", [0, 0, 0], curved=curved)], lambda each: each.curved)
        self.assertEqual((mean.a, mean.frames), (2.0, 2))
        self.assertIsNone(statistics.paired_differences([fixes("p", "a", [1])], [fixes("p", "b", [1])],
                                                        lambda each: each.curved))


class Normality(unittest.TestCase):
    def test_of_normal_quantiles(self):
        values = stats.norm.ppf((np.arange(2000) + 0.5) / 2000, 0.3, 2)
        normality = statistics.normality_of(values)
        self.assertAlmostEqual(normality.mean, 0.3, places=6)
        self.assertAlmostEqual(normality.std, 2, delta=0.01)
        self.assertAlmostEqual(normality.core_std, 2, delta=0.01)
        self.assertAlmostEqual(normality.skewness, 0, places=6)
        self.assertAlmostEqual(normality.excess_kurtosis, 0, delta=0.06)
        self.assertLess(normality.kolmogorov, 0.002)

    def test_distance_by_hand(self):
        # Two values at the mean: the sample steps from 0 to 1 where the normal is at a half.
        self.assertAlmostEqual(statistics.kolmogorov_distance(np.array([0.0, 0.0]), 0, 1), 0.5)
        self.assertAlmostEqual(statistics.kolmogorov_distance(np.array([-10.0, 10.0]), 0, 1), 0.5)
        # One value above all of the normal, and one below.
        self.assertAlmostEqual(statistics.kolmogorov_distance(np.array([10.0]), 0, 1), 1)
        self.assertAlmostEqual(statistics.kolmogorov_distance(np.array([-10.0]), 0, 1), 1)

    def test_of_an_even_distribution(self):
        normality = statistics.normality_of(np.linspace(-1, 1, 10001))
        self.assertAlmostEqual(normality.excess_kurtosis, -1.2, places=3)
        self.assertAlmostEqual(normality.kolmogorov, 0.0573, delta=0.002)

    def test_a_tail_shows_in_skewness_and_leaves_the_core(self):
        core = stats.norm.ppf((np.arange(1000) + 0.5) / 1000)
        normality = statistics.normality_of(np.concatenate([core, np.full(30, 20.0)]))
        self.assertGreater(normality.skewness, 3)
        self.assertAlmostEqual(normality.core_std, 1, delta=0.06)
        self.assertLess(normality.core_kolmogorov, normality.kolmogorov)


class LinearFit(unittest.TestCase):
    def test_by_hand(self):
        # Means 1 and 2: the slope is (-1 * -1 + 0 * -1 + 1 * 2) / 2.
        fit = statistics.linear_fit(np.array([0.0, 1, 2]), np.array([1.0, 1, 4]))
        self.assertAlmostEqual(fit.slope, 1.5)
        self.assertAlmostEqual(fit.intercept, 0.5)
        self.assertAlmostEqual(fit.r_squared, 0.75)  # residuals 0.5, -1, 0.5; deviations -1, -1, 2


class RunningMean(unittest.TestCase):
    def test_over_a_window_without_missing_values(self):
        means = statistics.running_mean(np.array([0.0, 1, 2, 10]), np.array([1, NAN, 3, 5]), 4)
        np.testing.assert_allclose(means, [2, NAN, 2, 5])


if __name__ == "__main__":
    unittest.main(verbosity=2)

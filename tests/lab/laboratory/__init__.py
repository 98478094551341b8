"""Measures every method of milepost on a list of map and query drives; see tests/lab/README.md."""

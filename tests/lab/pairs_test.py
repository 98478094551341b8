"""Lists of pairs, and what is said of wrong ones."""
import pathlib
import tempfile
import unittest

from laboratory.errors import LabError, WrongCall
from laboratory.pairs import Pair, Place, read_pairs, study_pairs


class Pairs(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        for drive in ("a-map", "a-query", "elsewhere/b-map", "elsewhere/b-query"):
            (self.folder / drive).mkdir(parents=True)
            (self.folder / drive / "drive.json").write_text("{}")

    def read(self, text):
        (self.folder / "list.txt").write_text(text)
        return read_pairs(self.folder / "list.txt")

    def expect_refused(self, text, kind, *parts):
        with self.assertRaises(kind) as refused:
            self.read(text)
        self.assertIs(type(refused.exception), kind)
        for part in parts:
            self.assertIn(part, str(refused.exception))

    def test_paths_are_relative_to_the_list_and_to_its_folder_of_drives(self):
        first, second = self.read("# comment\na a-map a-query\n\ndrives elsewhere\nb b-map b-query  # ours\n")
        self.assertEqual(first.place.folder / first.map_drive, self.folder / "a-map")
        self.assertEqual(second.place.folder / second.query_drive, self.folder / "elsewhere/b-query")

    def test_a_tag_tells_how_good_the_recorded_positions_are(self):
        self.assertEqual(Pair("a", Place(), "m", "q", frozenset({"truth-0.25m", "study"})).truth_sigma_m, 0.25)
        self.assertEqual(Pair("a", Place(), "m", "q", frozenset({"truth"})).truth_sigma_m, 0)

    def test_commas_part_words_too(self):
        (pair,) = self.read("a, a-map, a-query, curved, study\n")
        self.assertEqual((pair.name, pair.map_drive, pair.query_drive), ("a", "a-map", "a-query"))
        self.assertEqual(pair.tags, {"curved", "study"})

    def test_simulated_drives_need_not_be_there_yet(self):
        (pair,) = self.read("simulate --seed 7 --route street\ns street-map street-query\n")
        self.assertEqual(pair.place.simulate, ("--seed", "7", "--route", "street"))

    def test_studies_run_on_the_pairs_tagged_so_or_on_all(self):
        self.assertEqual([p.name for p in study_pairs(self.read("a a-map a-query\nb a-map a-query study\n"))], ["b"])
        self.assertEqual([p.name for p in study_pairs(self.read("a a-map a-query\nb a-map a-query\n"))], ["a", "b"])

    def test_what_is_missing_is_named_with_its_line(self):
        self.expect_refused("a a-map nowhere\n", LabError, "list.txt, line 1", "nowhere", "drive.json")
        self.expect_refused("\ndrives gone\na a-map a-query\n", LabError, "list.txt, line 2", "gone", "no such folder")

    def test_wrong_lists_are_wrong_calls(self):
        self.expect_refused("# nothing\n", WrongCall, "holds no pair")
        self.expect_refused("a a-map\n", WrongCall, "line 1", "NAME MAP_DRIVE QUERY_DRIVE")
        self.expect_refused("a a-map a-query\na a-map a-query\n", WrongCall, "line 2", "'a' already")
        self.expect_refused("../a a-map a-query\n", WrongCall, "line 1", "'../a'")
        with self.assertRaises(WrongCall):
            read_pairs(self.folder / "no-list.txt")


if __name__ == "__main__":
    unittest.main(verbosity=2)

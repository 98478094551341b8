"""Every fault of a drive is one line that names the file, the row and a hint, and leaves no map."""
import commands
from commands import CommandTest, STREET, edit_json, edit_lines


def set_cell(file, line, column, value):
    """Sets a cell; lines count from 1 as an editor does, columns from 0."""
    def change(lines):
        cells = lines[line - 1].split(",")
        cells[column] = value
        lines[line - 1] = ",".join(cells)
    edit_lines(file, change)


class BadDrive(CommandTest):
    def setUp(self):
        super().setUp()
        self.drive = self.copy_of(STREET / "street-map")
        self.trajectory = self.drive / "trajectory.csv"
        self.map = self.folder / "street.map"

    def frame(self, line):
        return self.drive / "frames" / self.trajectory.read_text().splitlines()[line - 1].split(",")[0]

    def expect_fault(self, *parts):
        self.expect_refused(self.build(self.drive, self.map), 1, *parts)
        self.assertEqual([p.name for p in self.folder.iterdir()], ["drive"])  # no map, no partial file

    def test_no_folder(self):
        result = self.build(self.folder / "nowhere", self.map)
        self.expect_refused(result, 1, "nowhere/drive.json", "no such file", "check the path")

    def test_missing_file(self):
        self.trajectory.unlink()
        self.expect_fault("trajectory.csv", "no such file")

    def test_wrong_column(self):
        edit_lines(self.trajectory, lambda lines: lines.__setitem__(0, lines[0].replace("north_m", "northing")))
        self.expect_fault("trajectory.csv, line 1", "'northing'", "'north_m'", "start the header with")

    def test_nan(self):
        set_cell(self.trajectory, 5, 2, "nan")
        self.expect_fault("trajectory.csv, line 5", "east_m is 'nan'", "correct or remove the row")

    def test_time_does_not_increase(self):
        time = self.trajectory.read_text().splitlines()[3].split(",")[1]
        set_cell(self.trajectory, 5, 1, time)
        self.expect_fault("trajectory.csv, line 5", "line 4")

    def test_position_jump(self):
        set_cell(self.trajectory, 6, 3, "99999")
        self.expect_fault("trajectory.csv, line 6", "m/s", "70")

    def test_missing_frame(self):
        frame = self.frame(7)
        frame.unlink()
        self.expect_fault("trajectory.csv, line 7", frame.name)

    def test_undecodable_frame(self):
        frame = self.frame(8)
        frame.write_bytes(b"this is no picture")
        self.expect_fault("trajectory.csv, line 8", frame.name)

    def test_truncated_frame(self):
        frame = self.frame(8)
        frame.write_bytes(frame.read_bytes()[:-2000])
        self.expect_fault("trajectory.csv, line 8", frame.name)

    def test_frames_are_judged_by_their_data(self):
        frame = self.frame(8)
        whole = frame.read_bytes()
        self.assertEqual(whole[-2:], b"\xff\xd9", "the street's frames are JPEGs")
        self.expect_done(self.build(self.drive, self.map))
        expected = self.map.read_bytes()
        frame.write_bytes(whole[:-2])  # cameras leave the end marker out
        result = self.build(self.drive, self.map)
        self.expect_done(result)
        self.assertEqual(result.stderr, "")
        self.assertEqual(self.map.read_bytes(), expected)
        frame.write_bytes(whole[:len(whole) // 2] + b"\xff\xd9")
        self.map.unlink()
        self.expect_fault("trajectory.csv, line 8", frame.name, "is truncated; copy the image again")

    def test_other_image_size(self):
        edit_json(self.drive / "drive.json", lambda drive: drive["camera"].__setitem__("width_px", 640))
        self.expect_fault("trajectory.csv, line 2", "600", "640", "500")

    def test_broken_json(self):
        (self.drive / "drive.json").write_text('{"name": "x",')
        self.expect_fault("drive.json")

    def test_a_query_is_checked_alike(self):
        self.expect_done(self.build(STREET / "street-map", self.map))
        query = self.copy_of(STREET / "street-query", "query")
        set_cell(query / "trajectory.csv", 4, 1, "inf")
        result = commands.run(commands.CLIENT, "localize", "--map", self.map, "--drive", query,
                              "--out", self.folder / "fixes.csv")
        self.expect_refused(result, 1, "query/trajectory.csv, line 4", "timestamp_s is 'inf'")
        self.assertFalse((self.folder / "fixes.csv").exists())

    def test_a_query_without_receiver_positions(self):
        self.expect_done(self.build(STREET / "street-map", self.map))
        query = self.copy_of(STREET / "street-query", "query")
        (query / "gps.csv").unlink()
        result = commands.run(commands.CLIENT, "localize", "--map", self.map, "--drive", query,
                              "--out", self.folder / "fixes.csv")
        self.expect_refused(result, 1, "query/gps.csv", "start from")


commands.main() if __name__ == "__main__" else None

#!/usr/bin/python3 -B
"""Starts in the middle of a drive: pieces of it, with one receiver position each; the laboratory calls it as a stage.

usage: starts.py CLIENT MAP DRIVE OUT METHOD...

Writes OUT/NNNN for the piece that begins with the drive's frame NNNN: what milepost-client evaluate writes.
"""
import pathlib
import subprocess
import sys
import tempfile

import altered_drive

FRAMES = 20   # of a piece
EVERY = 12    # frames a piece begins


def evaluate(client, map_file, drive, out, methods):
    command = [client, "evaluate", "--map", map_file, "--drive", drive, "--out", out, "--method", *methods]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(done.stderr.strip().splitlines()[-1])


def main(client, map_file, drive_folder, out, *methods):
    drive = altered_drive.read_drive(drive_folder)
    for first in range(0, len(drive.trajectory) - FRAMES, EVERY):
        with tempfile.TemporaryDirectory() as temporary:
            piece = pathlib.Path(temporary) / "drive"
            altered_drive.write_drive(altered_drive.started_at(drive, first, FRAMES), piece)
            evaluate(client, map_file, piece, pathlib.Path(out) / f"{first:04}", methods)


if __name__ == "__main__":
    main(*sys.argv[1:])

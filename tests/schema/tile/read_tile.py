#!/usr/bin/env python3
"""Reads a stored tile by FORMAT.md, without milepost's code, and prints its content.

usage: read_tile.py GENERATED TILE     GENERATED: folder of flatc's Python code for tile.fbs and
                                       landmark_tile.fbs
Exit code 77 if a Python module is missing.
"""
import sys

try:
    import flatbuffers
    import zstandard
except ImportError as missing:
    print(missing)
    sys.exit(77)

sys.path.insert(0, sys.argv[1])
from milepost.fbs.LandmarkTile import LandmarkTile  # noqa: E402
from milepost.fbs.TrackletTile import TrackletTile  # noqa: E402


def content_of(frame):
    """The size-prefixed FlatBuffer of a frame."""
    header = zstandard.get_frame_parameters(frame)
    assert header.has_checksum and header.content_size <= 16 << 20
    content = zstandard.ZstdDecompressor().decompress(frame)
    assert flatbuffers.util.GetSizePrefix(content, 0) == len(content) - 4
    return content


def tracklet_line(tile, i):
    """What text_of prints for tracklet i."""
    origin_m = tile.OriginM()
    size = tile.DescriptorBytes()
    descriptor = bytes(tile.Descriptors(j) for j in range(size * i, size * (i + 1)))
    return "%.17g %.9g %.9g %.9g %.17g %.17g %d %d %d %d %.9g %.9g %d %s" % (
        origin_m + tile.OffsetM(i), tile.Slope(i), tile.ScaleMinPx(i), tile.ScaleMaxPx(i),
        origin_m + tile.AlongBeginM(i), origin_m + tile.AlongEndM(i),
        tile.XMinPx(i), tile.XMaxPx(i), tile.YMinPx(i), tile.YMaxPx(i),
        tile.RSquared(i), tile.ResidualSigmaM(i), tile.Observations(i), descriptor.hex())


def print_tracklets(content):
    tile = TrackletTile.GetRootAs(content, 4)
    print(tile.Segment().decode(), tile.Index(), tile.Model())
    for i in range(tile.SlopeLength()):
        print(tracklet_line(tile, i))


def landmark_line(tile, i):
    """What text_of prints for landmark i."""
    count = tile.ObservationsLength()

    def metres(plane):
        at = plane * count + i
        low_high = bytes((tile.PositionLow(at), tile.PositionHigh(at)))
        return int.from_bytes(low_high, "little", signed=True) / 100

    begin_m = tile.OriginM() + sum(tile.BeginDm(j) for j in range(i + 1)) / 10
    descriptor = bytes(tile.Descriptors(k * count + i) & 0xFF for k in range(tile.DescriptorValues()))
    return "%.2f %.2f %.2f %.6g %.6g %.3f %.4f %.4f %d %s" % (
        metres(0), metres(1), metres(2), 100 / 1.05 ** tile.DepthSigma(i), 100 / 1.05 ** tile.Size(i),
        tile.SizeSigma(i) / 250, begin_m, begin_m + tile.LengthDm(i) / 10, tile.Observations(i),
        descriptor.hex())


def print_landmarks(content):
    tile = LandmarkTile.GetRootAs(content, 4)
    print(tile.Segment().decode(), tile.Index(), "%.17g" % tile.OriginM())
    for i in range(tile.ObservationsLength()):
        print(landmark_line(tile, i))


def main():
    with open(sys.argv[2], "rb") as file:
        content = content_of(file.read())
    identifier = flatbuffers.util.GetBufferIdentifier(content, 0, size_prefixed=True)
    {b"MPT1": print_tracklets, b"MPL1": print_landmarks}[identifier](content)


if __name__ == "__main__":
    main()

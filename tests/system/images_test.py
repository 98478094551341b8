"""Images as they come: the street's mapping drive with its frames written in other kinds gives the same map as the plain
ones, or is refused by a message that names the image and its kind."""
import io
import re
import unittest

import numpy
from PIL import Image

from commands import STREET, CommandTest, edit_json, edit_lines, rows_of

FRAMES = 14


def written(image, form, **options):
    out = io.BytesIO()
    image.save(out, form, **options)
    return out.getvalue()


def deep(image, bits):
    """Grey values of so many bits in 16, of which the lowest are noise that a shift takes away."""
    values = numpy.asarray(image).astype(numpy.uint16) << (bits - 8)
    noise = numpy.arange(values.size, dtype=numpy.uint16).reshape(values.shape) % (1 << (bits - 8))
    return values + noise


def netpbm(values, most):
    kind, (height, width) = ("P5" if values.ndim == 2 else "P6"), values.shape[:2]
    raw = values.astype(">u2") if most > 255 else values.astype("u1")
    return f"{kind}\n{width} {height}\n{most}\n".encode() + raw.tobytes()


def tiff(values):
    """16 bits without a declared greatest value."""
    return written(Image.fromarray(values), "TIFF")


def exif_of(orientation):
    exif = Image.Exif()
    exif[0x0112] = orientation
    return exif


def in_color(image):
    return Image.merge("RGB", [image] * 3)


def in_palette(image):
    """A palette of all grey values, in another order."""
    order = list(range(255, -1, -1))
    turned = Image.fromarray(255 - numpy.asarray(image), "P")
    turned.putpalette([value for value in order for _ in range(3)])
    return turned


# Name of a kind: the ending, and the bytes of a grey image.
LOSSLESS = {
    "grey png": ("png", lambda image: written(image, "PNG")),
    "color png": ("png", lambda image: written(in_color(image), "PNG")),
    "png with transparency": ("png", lambda image: written(in_color(image).convert("RGBA"), "PNG")),
    "png with a palette": ("png", lambda image: written(in_palette(image), "PNG")),
    "bmp": ("bmp", lambda image: written(image, "BMP")),
    "tiff": ("tif", lambda image: written(image, "TIFF", compression="tiff_lzw")),
    "webp": ("webp", lambda image: written(in_color(image), "WEBP", lossless=True)),
    "pgm of 8 bits": ("pgm", lambda image: netpbm(numpy.asarray(image), 255)),
    "ppm of 8 bits": ("ppm", lambda image: netpbm(numpy.asarray(in_color(image)), 255)),
    "pgm of 12 bits": ("pgm", lambda image: netpbm(deep(image, 12), 4095)),
    "pgm of 16 bits": ("pgm", lambda image: netpbm(deep(image, 16), 65535)),
    "png of 12 bits": ("png", lambda image: written(Image.fromarray(deep(image, 12)), "PNG")),
    "png of 16 bits": ("png", lambda image: written(Image.fromarray(deep(image, 16)), "PNG")),
    "tiff of 16 bits": ("tif", lambda image: tiff(deep(image, 16))),
    "turned by exif": ("png", lambda image: written(image.transpose(Image.Transpose.ROTATE_90), "PNG", exif=exif_of(6))),
    "upside down by exif": ("tif", lambda image: written(image.transpose(Image.Transpose.ROTATE_180), "TIFF",
                                                         tiffinfo={274: 3})),
}

# All of the same coefficients.
JPEG = {
    "grey jpeg": lambda image: written(image, "JPEG", quality=95),
    "progressive jpeg": lambda image: written(image, "JPEG", quality=95, progressive=True),
    "color jpeg": lambda image: written(in_color(image), "JPEG", quality=95),
    "progressive color jpeg": lambda image: written(in_color(image), "JPEG", quality=95, progressive=True, subsampling=0),
}

# And what the message says of the kind.
REFUSED = {
    "cmyk jpeg": ("jpg", lambda image: written(in_color(image).convert("CMYK"), "JPEG", quality=95), "CMYK"),
    "floating point tiff": ("tif", lambda image: written(image.convert("F"), "TIFF"), "not whole numbers"),
    "gif": ("gif", lambda image: written(image, "GIF"), "cannot be decoded"),
    "turned without a sign of it": ("png", lambda image: written(image.transpose(Image.Transpose.ROTATE_90), "PNG"), "pixels"),
}


class Images(CommandTest):
    def setUp(self):
        super().setUp()
        self.frames = [STREET / "street-map" / "frames" / row["filename"]
                       for row in rows_of(STREET / "street-map" / "trajectory.csv")[:FRAMES]]

    def drive_of(self, kind, ending, encode):
        """The drive's begin with its frames in another kind, and the result of mapping it."""
        drive = self.folder / kind.replace(" ", "-")
        (drive / "frames").mkdir(parents=True)
        for name in ("drive.json", "trajectory.csv", "gps.csv"):
            (drive / name).write_bytes((STREET / "street-map" / name).read_bytes())
        edit_json(drive / "drive.json", lambda description: description.update(images="frames"))
        edit_lines(drive / "trajectory.csv", lambda lines: lines.__setitem__(
            slice(1, None), [re.sub(r"\.[a-z]+,", f".{ending},", line, count=1) for line in lines[1:FRAMES + 1]]))
        for frame in self.frames:
            (drive / "frames" / f"{frame.stem}.{ending}").write_bytes(encode(Image.open(frame).convert("L")))
        return drive

    def build_of(self, kind, ending, encode):
        result = self.build(self.drive_of(kind, ending, encode), self.folder / "one.map")
        self.assertEqual(result.returncode, 0, f"{kind}: {result.stderr}")
        return re.search(r"build (\w{32})", result.stdout)[1]

    def test_kinds_without_loss_give_one_map(self):
        plain = self.build_of("plain", *LOSSLESS["grey png"])
        for kind, (ending, encode) in LOSSLESS.items():
            with self.subTest(kind):
                self.assertEqual(self.build_of(kind, ending, encode), plain)

    def test_jpegs_of_one_picture_give_one_map(self):
        builds = {kind: self.build_of(kind, "jpg", encode) for kind, encode in JPEG.items()}
        self.assertEqual(len(set(builds.values())), 1, builds)

    def test_other_kinds_are_refused_by_name(self):
        for kind, (ending, encode, word) in REFUSED.items():
            with self.subTest(kind):
                drive = self.drive_of(kind, ending, encode)
                file = self.folder / "none.map"
                self.expect_refused(self.build(drive, file), 1, f"{self.frames[0].stem}.{ending}", word)
                self.assertFalse(file.exists())


if __name__ == "__main__":
    unittest.main(verbosity=2)

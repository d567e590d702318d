"""Images of other programs: the defects of tests/inputs/README.md, each in a file of a few hundred bytes that is made here. The number of
voxels that plan counts in a small domain shows what was read, and a domain that contains only a corner of the image shows how it was
rotated."""

import json
import os
import re
import struct
import sys

import numpy
import OpenImageIO as oiio

sys.dont_write_bytecode = True
from script import *

# Heights (m) of the four quarters of the image as seen, 8 x 8 pixels each, so that a corner of 4 x 4 pixels is level.
TOP_LEFT, TOP_RIGHT, LEFT, RIGHT = 1, 3, 5, 9
QUARTERS = numpy.kron(numpy.array([[TOP_LEFT, TOP_RIGHT], [LEFT, RIGHT]]), numpy.ones((8, 8)))
LEVEL = numpy.full((16, 16), 5.0)
EXTENT = {"min_m": [0, 0, 0], "max_m": [16, 16, 1]}
METRES = {**EXTENT, "scale_m": 1}
CORNER = [4, 4, 16]  # a domain that contains the bottom left corner of the image
UTM = [1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 32616]
POINTS = [*UTM[:11], 2, *UTM[12:]]
DEGREES = [1, 1, 0, 2, 1024, 0, 1, 2, 2048, 0, 1, 4326]
GEO_SCALE, GEO_TIE, GEO_KEYS, GDAL_META, GDAL_NODATA = 33550, 33922, 34735, 42112, 42113


# ---- files

def tiff(path, pixels, tags={}, bits=None, mask=None):
    """Writes an uncompressed TIFF with any tags, {number: text or numbers (floats become doubles)}. `mask`: a second image, marked as a mask."""
    parts = [(pixels, dict(tags), bits)] + ([(mask, {254: [4], 262: [4]}, None)] if mask is not None else [])
    out = bytearray(struct.pack("<2sHI", b"II", 42, 8))
    for i, (a, more, depth) in enumerate(parts):
        data = a.astype(a.dtype.newbyteorder("<")).tobytes()
        if depth == 12:
            data = bytes(b for p, q in a.reshape(-1, 2) for b in (int(p) >> 4, (int(p) & 15) << 4 | int(q) >> 8, int(q) & 255))
        n = a.shape[2] if a.ndim == 3 else 1
        kind = {"u": 1, "i": 2, "f": 3}[a.dtype.kind]
        entry = {256: [a.shape[1]], 257: [a.shape[0]], 258: [depth or 8 * a.dtype.itemsize] * n, 259: [1], 262: [1], 277: [n], 278: [a.shape[0]],
                 279: [len(data)], 339: [kind] * n, **more}
        entry[273] = [0]
        at = len(out) + 2 + 12 * len(entry) + 4
        table, behind = struct.pack("<H", len(entry)), b""
        coded = {}
        for tag, v in sorted(entry.items()):
            if isinstance(v, str):
                coded[tag] = (2, len(v) + 1, v.encode() + b"\0")
            elif any(isinstance(x, float) for x in v):
                coded[tag] = (12, len(v), struct.pack(f"<{len(v)}d", *v))
            else:
                big = max(v) > 65535 or tag in (273, 279)
                coded[tag] = (4 if big else 3, len(v), struct.pack(f"<{len(v)}{'I' if big else 'H'}", *v))
        start = at + sum(len(c[2]) + len(c[2]) % 2 for c in coded.values() if len(c[2]) > 4)
        coded[273] = (4, 1, struct.pack("<I", start))
        for tag, (form, count, value) in coded.items():
            if len(value) > 4:
                table += struct.pack("<HHII", tag, form, count, at + len(behind))
                behind += value + b"\0" * (len(value) % 2)
            else:
                table += struct.pack("<HHI4s", tag, form, count, value)
        end = start + len(data) + len(data) % 2
        out += table + struct.pack("<I", end if i + 1 < len(parts) else 0) + behind + data + b"\0" * (len(data) % 2)
    with open(path, "wb") as file:
        file.write(out)


def picture(path, *parts, part_names=None, **attributes):
    """Writes an EXR with OpenImageIO. Each part is pixels (rows, columns, channels), channel names, x and y of the data window, display window."""
    specs = []
    for pixels, names, x, y, window in parts:
        kind = {"f": oiio.FLOAT, "u": {1: oiio.UINT8, 2: oiio.UINT16}.get(pixels.dtype.itemsize, oiio.UINT32)}[pixels.dtype.kind]
        spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], kind)
        spec.channelnames = names
        spec.x, spec.y = x, y
        spec.full_x, spec.full_y, spec.full_width, spec.full_height = window
        if "A" in names:
            spec.alpha_channel = names.index("A")
        for name, value in attributes.items():
            spec.attribute(name.replace("__", ":"), value)
        if part_names:
            spec.attribute("oiio:subimagename", part_names[len(specs)])
        specs.append(spec)
    out = oiio.ImageOutput.create(path)
    assert out.open(path, tuple(specs) if len(specs) > 1 else specs[0]), out.geterror()
    for i, (pixels, *_) in enumerate(parts):
        assert i == 0 or out.open(path, specs[i], "AppendSubimage"), out.geterror()
        assert out.write_image(pixels), out.geterror()
    out.close()


def f32(pixels):
    return pixels.astype("float32")


def exr(path, pixels, x=0, y=0, window=None, names=["Y"]):
    pixels = f32(pixels)
    pixels = pixels[:, :, None] if pixels.ndim == 2 else pixels
    picture(path, (pixels, names, x, y, window or (0, 0, pixels.shape[1], pixels.shape[0])))


def with_exif(path, orientation):
    """Inserts an eXIf chunk after the header of a PNG."""
    import zlib

    body = b"eXIf" + struct.pack(">2sHIHHHII", b"MM", 42, 8, 1, 274, 3, 1, orientation << 16) + b"\0\0\0\0"
    with open(path, "rb") as file:
        png = file.read()
    with open(path, "wb") as file:
        file.write(png[:33] + struct.pack(">I", len(body) - 4) + body + struct.pack(">I", zlib.crc32(body)) + png[33:])


# ---- cases

tried = set()


def plan(file, keys, domain, shape="heightfield", **more):
    job = {"hoodoo": 1, "name": "picture", "frames": "1", "domain": {"size_m": domain, "spacing_m": 1}, "scene": {shape: {"file": file, **keys}}, **more}
    with open("job.json", "w") as out:
        json.dump(job, out)
    code, said = hoodoo("plan", "job.json", "--device", "none", "--json")
    found = re.search(r'"particles": (\d+)', said)
    return code, int(found[1]) if found else None, said


def case(name, file, keys, wanted, says=None, domain=[16, 16, 16], fault=None, never=None, **more):
    """`wanted`: voxels of rock, or the negative exit code of a refusal. The log or refusal must contain `says` and must not contain `never`."""
    tried.add((fault or name).split(",")[0])
    code, voxels, said = plan(file, keys, domain, **more)
    good = code == -wanted if wanted < 0 else code == 0 and voxels == wanted
    ok(good and (says is None or says in said) and (never is None or never not in said), name, f"exit {code}, {voxels} voxels, wanted {wanted} and {says!r}",
       said[-1500:])


# Windows of EXR: 16 x 16 pixels; the bottom left quarter is 5 m, the other quarters are black.
quarter = numpy.where(QUARTERS == LEFT, 5.0, 0.0)
exr("full.exr", quarter)
_, full, _ = plan("full.exr", EXTENT, [16, 16, 16])
exr("crop.exr", quarter[8:, :8], 0, 8, (0, 0, 16, 16))
case("exr-crop", "crop.exr", EXTENT, full, "192 of 256 pixels are outside of its data window and are black")
exr("over.exr", numpy.pad(quarter, 4, constant_values=7), -4, -4, (0, 0, 16, 16))
case("exr-overscan", "over.exr", EXTENT, full)
exr("origin.exr", quarter[8:, :8], -30, 28, (-30, 20, 16, 16))
case("exr-origin", "origin.exr", EXTENT, full)
exr("away.exr", LEVEL[:12], 3, 4, (0, 0, 16, 16))
case("exr-outside-fill", "away.exr", {**EXTENT, "nodata": "fill"}, 16 * 16 * 5)

# No data.
gap = LEVEL.copy()
gap[4:8, 2:7] = -9999
tiff("nodata.tif", f32(gap), {GDAL_NODATA: "-9999"})
case("nodata-tag", "nodata.tif", METRES, -3, "pixel (2, 4) from the top left is -9999, which the file declares as no data; of 256 pixels 20 have no value")
case("nodata-fill", "nodata.tif", {**METRES, "nodata": "fill"}, 256 * 5)
tiff("high.tif", f32(numpy.where(gap < 0, 3.4028234663852886e38, gap)), {GDAL_NODATA: "3.40282e+38"})
case("nodata-above", "high.tif", {**METRES, "nodata": "empty"}, (256 - 20) * 5)
tiff("nan.tif", f32(numpy.where(gap < 0, numpy.nan, gap)), {GDAL_NODATA: "nan"})
case("nodata-nan", "nan.tif", METRES, -3, "pixel (2, 4) from the top left is nan")
tiff("named.tif", f32(LEVEL), {GDAL_NODATA: "nan"})
case("nodata-named-nan", "named.tif", METRES, 256 * 5)
tiff("untold.tif", gap.astype("int16"))
case("nodata-untold", "untold.tif", {**METRES, "nodata": "empty", "nodata_value": -9999}, (256 - 20) * 5)
tiff("mask.tif", LEVEL.astype("uint16"), mask=numpy.where(gap < 0, 0, 255).astype("uint8"))
case("mask", "mask.tif", {**METRES, "nodata": "empty"}, (256 - 20) * 5, "20 of 256 pixels", never="several parts")
bands = numpy.stack([LEVEL] * 5 + [numpy.where(gap < 0, 0, 255)], 2).astype("uint8")
tiff("alpha.tif", bands, {262: [2], 338: [0, 0, 2]})
case("alpha", "alpha.tif", {**METRES, "nodata": "empty"}, (256 - 20) * 5)
case("alpha, ignored", "alpha.tif", {**METRES, "alpha": "ignore"}, 256 * 5, fault="alpha")

# Orientation: the stored pixels that show the quarters after orientation 6, a rotation by 90 degrees clockwise.
stored_for_6 = numpy.rot90(QUARTERS)
tiff("turned.tif", f32(numpy.ascontiguousarray(stored_for_6)), {274: [6]})
case("orientation", "turned.tif", METRES, 16 * LEFT, domain=CORNER)  # unit/test_scene_image tests all eight
grey = (stored_for_6 * 20).astype("uint8")[:, :, None]
whole = (0, 0, 16, 16)
picture("turned.jpg", (numpy.ascontiguousarray(numpy.kron(grey[:, :, 0], numpy.ones((2, 2), "uint8"))[:, :, None]), ["Y"], 0, 0, (0, 0, 32, 32)), Orientation=6)
case("orientation-jpeg", "turned.jpg", {**EXTENT, "max_m": [16, 16, 255 / 20 * 0.999]}, 16 * LEFT, domain=CORNER)
picture("turned.png", (numpy.ascontiguousarray(grey), ["Y"], 0, 0, whole))
with_exif("turned.png", 6)
case("orientation-png", "turned.png", {**METRES, "scale_m": 0.05}, 16 * LEFT, domain=CORNER)

# Numbers.
picture("deep.png", (numpy.full((16, 16, 1), 40001, "uint16"), ["Y"], 0, 0, whole))
case("png-16-bits", "deep.png", {**METRES, "scale_m": 200, "offset_m": -200 * 40000 - 195}, 256 * 5)
tiff("signed.tif", numpy.full((16, 16), -9500, "int16"))
case("int16", "signed.tif", {**METRES, "offset_m": 9505}, 256 * 5)
tiff("wide.tif", numpy.full((16, 16), 100_000_005, "uint32"))
case("int32", "wide.tif", {**METRES, "offset_m": -100_000_000}, 256 * 5)
tiff("bright.tif", f32(LEVEL))
case("float-above-1", "bright.tif", EXTENT, 256 * 5)
tiff("twelve.tif", numpy.full((16, 16), 4005, "uint16"), bits=12)
case("twelve-bits", "twelve.tif", {**METRES, "offset_m": -4000}, 256 * 5)
items = '<GDALMetadata><Item name="OFFSET" sample="{0}" role="offset">{1}</Item><Item name="SCALE" sample="{0}" role="scale">{2}</Item></GDALMetadata>'
place = {GEO_SCALE: [1.0, 1.0, 0.0], GEO_TIE: [0.0, 0.0, 0.0, 500000.0, 4000000.0, 0.0], GEO_KEYS: UTM}
tiff("scaled.tif", numpy.full((16, 16), 1050, "int16"), {**place, GDAL_META: items.format(0, -100, 0.1)})
case("scale-offset", "scaled.tif", {}, 256 * 5, "-100 + 0.1 times the stored numbers")
two = numpy.stack([numpy.full((16, 16), 3), numpy.full((16, 16), 50)], 2).astype("int16")
tiff("bands.tif", two, {**place, 338: [0], GDAL_META: items.format(1, 0, 0.1)})
case("scale-of-band", "bands.tif", {"channel": 1, "scale_m": 2}, 256 * 10)
tiff("broken.tif", two[:, :, 0], {**place, GDAL_META: items.format(0, 0, "abc")})
case("scale-malformed", "broken.tif", {}, -3, "in its metadata is not a number: set scale_m")

# Maps.
tiff("point.tif", f32(LEVEL), {**place, GEO_KEYS: POINTS})
case("pixel-is-point", "point.tif", {}, 256 * 5, "bottom left corner is at (499999.5, 3999984.5)")
tiff("map.tif", f32(LEVEL), {**place, GEO_SCALE: [0.5, 0.25, 0.0]})
case("map-extent", "map.tif", {"scale_m": 2}, 8 * 4 * 10, "16 x 16 pixels of 0.5 x 0.25 m")
case("map-extent, from a place", "map.tif", {"origin_m": [499996.0, 3999994.0]}, 8 * 4 * 5, "x 4 to 12, y 2 to 6 m", fault="map-extent")
tiff("south.tif", f32(QUARTERS[::-1]), {**place, GEO_SCALE: [1.0, -1.0, 0.0]})
case("map-south-up", "south.tif", {}, 16 * LEFT, domain=CORNER)
tiff("degrees.tif", f32(LEVEL), {GEO_SCALE: [1 / 3600, 1 / 3600, 0.0], GEO_TIE: [0.0, 0.0, 0.0, 7.0, 46.0, 0.0], GEO_KEYS: DEGREES})
case("map-degrees", "degrees.tif", {}, -2, "gdalwarp -t_srs EPSG:326NN")
case("map-none", "bright.tif", {}, -2, "does not say how large its pixels are")

# Channels and parts.
exr("xyz.exr", numpy.stack([LEVEL, LEVEL * 3, LEVEL * 2], 2), names=["X", "Y", "Z"])
case("exr-xyz", "xyz.exr", EXTENT, 256 * 5)
exr("layers.exr", numpy.stack([LEVEL * 0, LEVEL * 0, LEVEL * 0, LEVEL], 2), names=["R", "G", "B", "height.Y"])
case("exr-channel", "layers.exr", {**EXTENT, "channel": "height.Y"}, 256 * 5)
case("exr-channel, no such", "layers.exr", {**EXTENT, "channel": "hieght.Y"}, -2, "the file has 4: R, G, B, height.Y", fault="exr-channel")
same = (f32(LEVEL)[:, :, None], ["Y"], 0, 0, whole)
picture("parts.exr", (f32(LEVEL * 0)[:, :, None], ["Y"], 0, 0, whole), same, part_names=["beauty", "height"])
case("exr-part", "parts.exr", {**EXTENT, "part": 1}, 256 * 5)
picture("colour.png", (numpy.full((16, 16, 3), (100, 200, 50), "uint8"), ["R", "G", "B"], 0, 0, whole))
case("colours-differ", "colour.png", {**METRES, "scale_m": 0.05}, 256 * 5, "its red, green and blue differ")
case("colours-differ, luminance", "colour.png", {**EXTENT, "max_m": [16, 16, 7.99], "channel": "luminance"}, 256 * 4, fault="colours-differ")
picture("srgb.png", (numpy.full((16, 16, 1), 128, "uint8"), ["Y"], 0, 0, whole), oiio__ColorSpace="sRGB")
case("srgb-heights", "srgb.png", {**EXTENT, "max_m": [16, 16, 9.96]}, 256 * 5)

# Raw heights.
(QUARTERS * 1000).astype("<u2").tofile("square.r16")
case("raw-square", "square.r16", {**METRES, "scale_m": 0.001}, 16 * LEFT, domain=CORNER)
numpy.full((8, 32), 5000, "<u2").tofile("long.r16")
case("raw-size", "long.r16", {**METRES, "scale_m": 0.001, "size_px": [32, 8]}, 256 * 5)
case("raw-size, wrong", "long.r16", {**METRES, "scale_m": 0.001, "size_px": [32, 9]}, -2, "size_px 32 x 9 with raw values of 2 bytes makes 576 bytes, but the file has 512", fault="raw-size")
LEVEL[:8].astype("<f4").tofile("floats.r32")
case("raw-floats", "floats.r32", {**METRES, "size_px": [16, 8]}, 256 * 5)
case("raw-floats, no square", "floats.r32", METRES, -2, "set size_px", fault="raw-floats")
with open("odd.pgm", "wb") as file:
    file.write(b"P5\n# 1 2 3\n16 16\n1000\n" + numpy.full(256, 405, ">u2").tobytes())
case("pgm-16-bits", "odd.pgm", {**METRES, "offset_m": -400}, 256 * 5)

# Formats that only GDAL reads.
with open("grid.asc", "w") as file:
    file.write("ncols 16\nnrows 16\nxllcorner 500000\nyllcorner 4000000\ncellsize 1\nNODATA_value -9999\n")
    file.writelines(" ".join(f"{v:g}" for v in row) + "\n" for row in gap)
void = numpy.full((1201, 1201), 5, ">i2")
void[600, 700] = -32768
void.tofile("N46E007.hgt")
away = {**os.environ, "PATH": "/nowhere"}
code, said = ask(HOODOO, "plan", "job.json", "--device", "none", "--set", "scene.heightfield.file=grid.asc", env=away)
ok(code == 3 and "gdal_translate, which is not installed (Debian: gdal-bin)" in said, "without gdal_translate a grid is refused with what to do", code, said)
if any(os.access(os.path.join(p, "gdal_translate"), os.X_OK) for p in os.environ["PATH"].split(":")):
    case("asc-grid", "grid.asc", {"nodata": "empty"}, (256 - 20) * 5)
    case("hgt-void", "N46E007.hgt", METRES, -3, "pixel (700, 600) from the top left is -32768, which the file declares as no data")
    with open("bad.asc", "w") as file:
        file.write("ncols 99999999\nnrows 99999999\ncellsize 1\n")
    case("asc-grid, hostile", "bad.asc", METRES, -3, "bad.asc", fault="asc-grid")
else:
    tried |= {"asc-grid", "hgt-void"}
    ok(True, "grids of GDAL # skip gdal_translate is not installed")

# Masks: transparent pixels and pixels without data paint nothing.
half = numpy.stack([numpy.full((16, 16), 255), numpy.where(QUARTERS == LEFT, 255, 0)], 2).astype("uint8")
picture("half.png", (numpy.ascontiguousarray(half), ["Y", "A"], 0, 0, whole))
case("mask-alpha", "half.png", {"min_m": [0, 0, 0], "max_m": [16, 16, 5]}, 8 * 8 * 5, shape="jointmap")

with open(os.path.join(TOP, "tests/inputs/README.md")) as file:
    listed = set(re.findall(r"^\| `([a-z0-9-]+)` \|", file.read(), re.M))
ok(listed == tried, "tests/inputs/README.md lists the pictures that are tried", sorted(listed ^ tried))
finish()

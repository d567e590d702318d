"""The image reader of bundles, which uses the libraries of PNG, JPEG, TIFF and OpenEXR, gives the answers of the one that uses OpenImageIO,
byte for byte: values, messages and refusals. Of some 500 requests twelve are drawn, since the libraries of OpenImageIO take a fifth of a
second to load; tests/long/image_formats.sh makes all."""

import os
import random
import subprocess
import sys

import numpy
import OpenImageIO as oiio

sys.dont_write_bytecode = True
from script import *

BUILD = os.environ["HOODOO_LIBEXEC"]
ASK = {"form": "file", "channel": "", "part": "", "nodata": "", "alpha": "coverage", "outside": "black", "use": "height", "values": "stored",
       "scale": "1", "offset": "0", "width": "0", "height": "0"}
numbers = numpy.random.default_rng(5)


def answer(program, path, **asked):
    fd = os.memfd_create("answer", 0)
    with os.fdopen(fd, "r+b") as file:
        code = subprocess.call([program, "image", path, *{**ASK, **asked}.values()], preexec_fn=lambda: os.dup2(fd, 3), close_fds=False)
        file.seek(0)
        return code, file.read()


def message(data):
    return data[16:1040].split(b"\0")[0].decode(errors="replace")


def same(path, **asked):
    """Both readers' answers, without the words that are the libraries' own."""
    (a, ours), (b, theirs) = (answer(os.path.join(BUILD, p), path, **asked) for p in ("bundle/hoodoo-read-image", "hoodoo-read-image"))
    good = a == b == 0 and len(ours) == len(theirs)
    if good and message(theirs):
        good = message(ours).split(":")[:2] == message(theirs).split(":")[:2]
    elif good:
        good = ours == theirs
    return good, f"{path} {asked}: exit codes {a} and {b}, {len(ours)} and {len(theirs)} bytes; '{message(ours)}' and '{message(theirs)}'"


def picture(path, shape, kind, channels=None, tile=0, **attributes):
    values = numbers.integers(0, 2 ** (8 * min(numpy.dtype(kind).itemsize, 4)) - 1, shape, dtype="uint32")
    pixels = values.astype(kind) if numpy.dtype(kind).kind == "u" else values.astype("int64").astype(kind) if numpy.dtype(kind).kind == "i" \
        else (numbers.standard_normal(shape) * 1000).astype(kind)
    of = {"uint8": oiio.UINT8, "int8": oiio.INT8, "uint16": oiio.UINT16, "int16": oiio.INT16, "uint32": oiio.UINT32, "int32": oiio.INT32,
          "float16": oiio.HALF, "float32": oiio.FLOAT, "float64": oiio.DOUBLE}
    spec = oiio.ImageSpec(shape[1], shape[0], shape[2], of[kind])
    if channels:
        spec.channelnames = channels
        spec.alpha_channel = channels.index("A") if "A" in channels else -1
    if tile:
        spec.tile_width = spec.tile_height = tile
    for name, value in attributes.items():
        if name in ("x", "y", "full_x", "full_y", "full_width", "full_height"):
            setattr(spec, name, value)
        else:
            spec.attribute(name.replace("__", ":"), value)
    out = oiio.ImageOutput.create(path)
    assert out.open(path, spec) and out.write_image(pixels), out.geterror()
    out.close()


made = []


def add(path, *of, ask=({},), **attributes):
    picture(path, *of, **attributes)
    made.append((path, ask))


every = ({}, {"channel": "1"}, {"alpha": "ignore"}, {"channel": "luminance"}, {"channel": "A"}, {"channel": "nothing"}, {"part": "1"}, {"values": "unit"})
for kind in ("uint8", "uint16"):
    for n in (1, 2, 3, 4):
        add(f"{kind}{n}.png", (37, 53, n), kind, {2: ["Y", "A"], 4: ["R", "G", "B", "A"]}.get(n), ask=every)
add("gamma.png", (9, 7, 3), "uint8", ask=every, oiio__ColorSpace="linear", oiio__Gamma=1.0)
for n, more in ((1, {}), (3, {}), (3, {"jpeg__subsampling": "4:2:0"}), (1, {"Orientation": 6})):
    add(f"{n}{len(more)}{list(more)[:1]}.jpg", (37, 53, n), "uint8", ask=every, **more)
for kind in ("uint8", "int8", "uint16", "int16", "uint32", "int32", "float16", "float32", "float64"):
    for compression in ("none", "lzw", "zip", "packbits"):
        add(f"{kind}-{compression}.tif", (70, 51, 1), kind, compression=compression)
    if kind != "float64":  # of which OpenImageIO 2.4.7 reads wrong values
        add(f"{kind}-tiles.tif", (70, 51, 3), kind, tile=16, ask=every)
    add(f"{kind}-planes.tif", (70, 51, 4), kind, ask=every, planarconfig="separate")
    add(f"{kind}-planes-tiles.tif", (70, 51, 3), kind, tile=32, ask=every, planarconfig="separate")
for bits in (1, 2, 4, 10, 12, 14):
    add(f"{bits}.tif", (19, 53, 1), "uint8" if bits < 8 else "uint16", oiio__BitsPerSample=bits)
add("strips.tif", (70, 51, 3), "uint16", ask=every, tiff__RowsPerStrip=7, compression="zip")
add("associated.tif", (7, 5, 4), "uint16", ["R", "G", "B", "A"], ask=every)
add("unassociated.tif", (7, 5, 4), "uint16", ["R", "G", "B", "A"], ask=every, oiio__UnassociatedAlpha=1)
add("jpeg.tif", (64, 48, 3), "uint8", ask=every, compression="jpeg")
for orientation in range(1, 9):
    add(f"turned{orientation}.tif", (7, 5, 1), "float32", Orientation=orientation)
for kind in ("float16", "float32", "uint32"):
    for compression in ("none", "rle", "zip", "zips", "piz", "pxr24"):
        add(f"{kind}-{compression}.exr", (70, 51, 2), kind, ["Y", "depth.Z"], compression=compression, ask=({}, {"channel": "depth.Z"}))
    add(f"{kind}-tiles.exr", (70, 51, 4), kind, ["R", "G", "B", "A"], tile=16, ask=every)
add("dwaa.exr", (70, 51, 3), "float16", ["R", "G", "B"], compression="dwaa", ask=every)
add("window.exr", (20, 30, 1), "float32", ["Y"], x=-4, y=6, full_x=0, full_y=0, full_width=16, full_height=16, ask=({}, {"outside": "none"}))
names = ["b.Z", "b.X", "b.Y", "a.B", "a.R", "Z", "AR", "velocity", "G", "R", "B", "A", "a.real"]
add("layers.exr", (5, 4, len(names)), "float32", names, ask=(*every, *({"channel": n} for n in (*names, "3", "7", "12"))))
requests = [(path, asked) for path, asks in made for asked in asks]
if not os.environ.get("HOODOO_FORMATS"):
    requests = random.Random(3).sample(requests, 12)
wrong = [why for good, why in (same(path, **asked) for path, asked in requests) if not good]
ok(not wrong, f"both readers agree on {len(requests)} requests", "\n".join(wrong[:20]))

# Damaged files: neither reader may give values where the other refuses.
wrong = []
for path in ("uint161.png", "30[].jpg", "uint16-lzw.tif", "float32-tiles.tif", "float32-zip.exr", "float16-tiles.exr"):
    with open(path, "rb") as file:
        whole = file.read()
    for share in (0.02, 0.3, 0.9):
        with open("cut-" + path, "wb") as file:
            file.write(whole[: int(len(whole) * share)])
        code, data = answer(os.path.join(BUILD, "bundle/hoodoo-read-image"), "cut-" + path)
        if code != 0 or not message(data).startswith("cut-"):
            wrong.append(f"{path} cut at {share}: exit {code}, '{message(data)}'")
ok(not wrong, "truncated files are refused by name", "\n".join(wrong))
finish()

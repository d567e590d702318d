"""EXR files as other programs read them: the tools of OpenEXR and OpenImageIO list the documented layers, Nuke's rule for splitting channel
names gives the same layers in both layouts, and Cryptomattes decode by their specification to the id pictures."""
import json
import os
import re
import struct
import subprocess
import sys

import numpy as np
import OpenImageIO

HOODOO, TOP = os.environ["HOODOO"], os.environ["HOODOO_TOP"]
failed = False


def check(good, what, *notes):
    global failed
    failed |= not good
    print(("ok " if good else "not ok ") + what)
    for note in notes if not good else ():
        print("# " + str(note)[:800].replace("\n", "\n# "))


def tool(*words):
    done = subprocess.run(words, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


# The documented layers and their channels.
LAYERS = {"rgba": "R G B A", "depth": "Z", "N": "X Y Z", "P": "X Y Z", "stress": "trace von_mises", "viability": "Y", "erodibility": "Y",
          "discharge": "Y", "wind": "speed", "vegetation": "Y", "layer": "id", "phase": "id"}
MATTES = {f"{kind}{rank:02d}": "R G B A" for kind in ("CryptoStrata", "CryptoPhase") for rank in range(3)}
FULL = [c if layer in ("rgba", "depth") else f"{layer}.{c}" for layer, names in {**LAYERS, **MATTES}.items() for c in names.split()]


def nuke(channel):
    """Layer and channel by the rule of the Foundry's ExrChannelNameToNuke: a name is split at dots into at most three parts of letters,
    digits and _, without leading digits; the last part is the channel and the others are the layer. Colours get their long names."""
    pieces = [re.sub("[^0-9A-Za-z]", "_", p.lstrip("0123456789")) for p in channel.split(".")]
    pieces = [p for p in pieces if p]
    if len(pieces) > 3:
        pieces = pieces[:2] + ["_".join(pieces[2:])]
    layer, name = "_".join(pieces[:-1]), pieces[-1]
    if layer == "" and name.lower() in ("z", "depth", "depth.z"):
        return "depth", "Z"
    colours = {"r": "red", "g": "green", "b": "blue", "a": "alpha", "red": "red", "green": "green", "blue": "blue", "alpha": "alpha"}
    return layer or "rgba", colours.get(name.lower(), name)


def parts(path):
    """[(name of the part, {channel: plane}, attributes)]"""
    file, out, part = OpenImageIO.ImageInput.open(path), [], 0
    while file.seek_subimage(part, 0):
        spec = file.spec()
        planes = {}
        for c, name in enumerate(spec.channelnames):
            kind = OpenImageIO.UINT if spec.channelformat(c) == OpenImageIO.UINT else OpenImageIO.FLOAT
            planes[name] = file.read_image(part, 0, c, c + 1, kind)[:, :, 0]
        out.append((spec.getattribute("name"), planes, {a.name: a.value for a in spec.extra_attribs}))
        part += 1
    return out


def murmur3(name):
    data, h, mask = name.encode(), 0, 0xFFFFFFFF
    rotate = lambda x, by: ((x << by) | (x >> (32 - by))) & mask
    whole = len(data) // 4 * 4
    for i in range(0, whole, 4):
        h ^= rotate(int.from_bytes(data[i:i + 4], "little") * 0xCC9E2D51 & mask, 15) * 0x1B873593 & mask
        h = (rotate(h, 13) * 5 + 0xE6546B64) & mask
    h ^= rotate(int.from_bytes(data[whole:], "little") * 0xCC9E2D51 & mask, 15) * 0x1B873593 & mask
    h ^= len(data)
    h = (h ^ h >> 16) * 0x85EBCA6B & mask
    h = (h ^ h >> 13) * 0xC2B2AE35 & mask
    return h ^ h >> 16


assert murmur3("hello") == 0x248BFA47 and murmur3("abc") == 0xB3DD93FA  # published values


def as_float(name):
    """uint32_to_float32: exponents of all zeros or all ones are changed."""
    bits = murmur3(name)
    if bits >> 23 & 255 in (0, 255):
        bits ^= 1 << 23
    return struct.unpack("<f", struct.pack("<I", bits))[0]


def mattes(attributes):
    """{name of the matte: names in its manifest}, from the metadata. Raises on any deviation from the specification."""
    found = {}
    for key, value in attributes.items():
        m = re.fullmatch("cryptomatte/([0-9a-f]{7})/name", key)
        if not m:
            continue
        get = lambda what: attributes[f"cryptomatte/{m.group(1)}/{what}"]
        assert m.group(1) == f"{murmur3(value):08x}"[:7], "the key is not the name's hash"
        assert get("hash") == "MurmurHash3_32" and get("conversion") == "uint32_to_float32"
        manifest = json.loads(get("manifest"))
        for name, said in manifest.items():
            assert struct.unpack("<f", struct.pack("<I", int(said, 16)))[0] == as_float(name), f"{name}: {said} is not its hash"
        found[value] = list(manifest)
    return found


def coverage(planes, matte, name):
    """The coverage of a name per pixel: ranks are pairs of id and coverage in RG and BA of matte00, matte01, ..."""
    wanted, total, rank = np.float32(as_float(name)), 0, 0
    while f"{matte}{rank:02d}.R" in planes:
        for i, c in (("R", "G"), ("B", "A")):
            total = total + np.where(planes[f"{matte}{rank:02d}.{i}"] == wanted, planes[f"{matte}{rank:02d}.{c}"], 0)
        rank += 1
    return total


for layout in ("multi", "single"):
    code, said = tool(HOODOO, "run", TOP + "/tests/restart/twelve.yaml", "--frames", "1001-1004", "--out", layout, "--progress", "none", "--set",
                      "output.aov.layout=" + layout, "--set", "output.aov.cryptomatte=true")
    check(code == 0, f"{layout}: a run", said)
    path = f"{layout}/aov/twelve.1004.exr"
    # oiiotool and exrheader prefix channel names with the name of the part
    for words in (("oiiotool", "--info", "-v", "-a", path), ("exrheader", path), ("exrinfo", "-v", path)):
        code, said = tool(*words)
        if words[0] == "exrinfo": # OpenEXR 3.1.5's exits with a number that it never sets (valgrind); its words count
            code = 0
        lacking = [c for c in FULL if not re.search(r"(?<![\w.])" + re.escape(c) + r"(?![\w.])", said)]
        check(code == 0 and not lacking and "error" not in said.lower() and "invalid" not in said.lower(), f"{layout}: {words[0]} reads it and names every channel",
              lacking, said)
    found = parts(path)
    planes = {name: plane for _, channels, _ in found for name, plane in channels.items()}
    check(sorted(planes) == sorted(FULL), f"{layout}: exactly the documented channels", set(planes) ^ set(FULL))
    if layout == "multi":
        names = [name for name, _, _ in found]
        check(len(set(names)) == len(names) and names[:len(LAYERS)] == list(LAYERS), f"multi: a part for each layer, in the documented order: {names}")
    layers = {}
    for name in planes:
        layer, channel = nuke(name)
        layers.setdefault(layer, set()).add(channel)
    long = {"R": "red", "G": "green", "B": "blue", "A": "alpha"}
    expected = {layer: {long.get(c, c) if len(names.split()) == 4 else c for c in names.split()} for layer, names in {**LAYERS, **MATTES}.items()}
    check(layers == expected, f"{layout}: Nuke's layers are the documented ones: {' '.join(layers)}", layers, expected)

    attributes = {}
    for _, _, a in found:
        attributes.update(a)
    try:
        known = mattes(attributes)
    except (AssertionError, KeyError, ValueError) as error:
        known = {}
        check(False, f"{layout}: Cryptomatte metadata", error)
    check(set(known) == {"CryptoStrata", "CryptoPhase"}, f"{layout}: two mattes: {known}")
    rock = planes["A"] > 0
    for matte, plane, which in (("CryptoStrata", "layer.id", lambda n: int(n.rsplit("_", 1)[1])),
                                ("CryptoPhase", "phase.id", ["rock", "deposit", "falling_block"].index)):
        ids, met = planes[plane], 0
        for name in known.get(matte, ()):
            mask = coverage(planes, matte, name)
            want = rock & (ids == which(name))
            met += int(want.any())
            check((mask == want).all(), f"{layout}: {matte}'s {name} is exactly where {plane} says ({int(want.sum())} px)", np.abs(mask - want).max())
        check(met >= (2 if matte == "CryptoStrata" else 1), f"{layout}: {met} of {matte}'s names are in the picture")
a, b = (parts(f"{layout}/aov/twelve.1004.exr") for layout in ("multi", "single"))
a, b = ({name: plane for _, channels, _ in p for name, plane in channels.items()} for p in (a, b))
check(all((a[name] == b[name]).all() for name in a), "both layouts hold the same values")
sys.exit(failed)

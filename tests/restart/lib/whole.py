"""Is a file complete? Checked by independent readers where they exist: OpenVDB's vdb_print, OpenImageIO, ffprobe, plain parsers."""
import hashlib
import html.parser
import json
import os
import re
import struct
import subprocess

import OpenImageIO

HOODOO = os.environ["HOODOO"]


def quiet(*words):
    done = subprocess.run(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    return done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")


def read(path):
    with open(path, "rb") as file:
        return file.read()


def vdb(path):
    code, _, said = quiet("vdb_print", "-l", path)
    return code == 0 and "error" not in said.lower() and hoodoo(path)


def hoodoo(path):
    return quiet(HOODOO, "inspect", path)[0] == 0


def picture(path):
    file = OpenImageIO.ImageInput.open(path)
    if not file:
        return False
    part, good = 0, True
    while good and file.seek_subimage(part, 0):
        good = file.read_image(part, 0, 0, file.spec().nchannels, OpenImageIO.FLOAT) is not None and not file.geterror()
        part += 1
    file.close()
    if not good:
        return False
    ends = {"png": b"IEND\xaeB`\x82", "jpg": b"\xff\xd9"}
    return part > 0 and read(path).endswith(ends.get(path.rsplit(".", 1)[1], b""))


SIZES = {"char": 1, "uchar": 1, "short": 2, "ushort": 2, "int": 4, "uint": 4, "float": 4, "double": 8}


def ply(path):
    """The file is as long as its header says, and triangles refer to existing vertices."""
    head, found, body = read(path).partition(b"end_header\n")
    elements = []  # name, count, bytes before the list, bytes after it
    for line in head.decode().split("\n"):
        words = line.split()
        if words[:1] == ["element"]:
            elements.append([words[1], int(words[2]), 0, None])
        elif words[:2] == ["property", "list"]:
            elements[-1][3] = 0
        elif words[:1] == ["property"]:
            elements[-1][2 if elements[-1][3] is None else 3] += SIZES[words[1]]
    at, n = 0, elements[0][1]
    for name, count, before, after in elements:
        if after is None:
            at += count * before
            continue
        row = before + 13 + after
        corners = [struct.unpack_from("<B3I", body, at + row * i + before) for i in range(count)]
        if not all(c[0] == 3 and max(c[1:]) < n for c in corners):
            return False
        at += row * count
    return bool(found) and elements[0][0] == "vertex" and n > 0 and len(body) == at


def obj(path):
    text = read(path).decode()
    lines = text.split("\n")
    n = sum(line.startswith("v ") for line in lines)
    faces = [line for line in lines if line.startswith("f ")]
    return text.endswith("\n") and n > 0 and n == sum(line.startswith("vn ") for line in lines) and bool(faces) and all(
        len(f.split()) == 4 and max(int(c.split("//")[1]) for c in f.split()[1:]) <= n for f in faces) and closed(faces)


def closed(faces):
    """A closed surface uses each edge equally often in both directions. A truncated file has open edges."""
    edges = {}
    for face in faces:
        c = [int(w.split("//")[0]) for w in face.split()[1:]]
        for a, b in zip(c, c[1:] + c[:1]):
            edges[min(a, b), max(a, b)] = edges.get((min(a, b), max(a, b)), 0) + (1 if a < b else -1)
    return not any(edges.values())


def usdc(path):
    data = read(path)
    at, = struct.unpack_from("<q", data, 16)
    n, = struct.unpack_from("<Q", data, at)
    sections = [struct.unpack_from("<16sqq", data, at + 8 + 32 * i) for i in range(n)]
    names = {name.rstrip(b"\0") for name, _, _ in sections}
    return data[:8] == b"PXR-USDC" and len(data) == at + 8 + 32 * n and {b"TOKENS", b"SPECS", b"PATHS"} <= names and all(
        0 < start and start + size <= at for _, start, size in sections)


def usda(path):
    text = read(path).decode()
    bare = re.sub(r'@[^@]*@|"[^"]*"', "", text)
    balanced = all(bare.count(a) == bare.count(b) for a, b in ("{}", "()", "[]"))
    named = re.findall(r"@([^@]+)@", text)
    folder = os.path.dirname(path)
    return text.startswith("#usda") and text.rstrip().endswith("}" if "clips.usda" not in path else ("}", ")")) and balanced and all(
        "#" in name or os.path.exists(os.path.join(folder, name)) for name in named)


def mp4(path):
    code, out, said = quiet("ffprobe", "-v", "error", "-count_frames", "-select_streams", "v", "-show_entries",
                            "stream=nb_frames,nb_read_frames", "-of", "csv=p=0", path)
    counts = out.strip().split(",")
    return code == 0 and said == "" and len(counts) == 2 and counts[0] == counts[1] and int(counts[0]) > 0


class Page(html.parser.HTMLParser):
    def __init__(self, folder):
        super().__init__()
        self.folder, self.open, self.good = folder, [], True

    def handle_starttag(self, tag, attributes):
        if tag not in ("meta", "img", "br", "input", "link", "source", "hr", "path", "line", "rect", "circle", "col"):
            self.open.append(tag)
        for key, value in attributes:
            if key == "src" and value and not value.startswith("data:"):
                self.good &= os.path.exists(os.path.join(self.folder, value))

    def handle_endtag(self, tag):
        if tag in self.open:
            self.good &= self.open.pop() == tag


def page(path):
    text = read(path).decode()
    reader = Page(os.path.dirname(path))
    reader.feed(text)
    return text.rstrip().endswith("</html>") and reader.good and not reader.open


def stacks(path):
    """The header gives the number of columns and layers, and each column has as many layers as its count says."""
    data = read(path)
    nx, ny, layers = *struct.unpack_from("<2i", data, 16), *struct.unpack_from("<Q", data, 32)
    counts = struct.unpack_from(f"<{nx * ny}I", data, 56)
    return data.startswith(b"hoodoo.stck") and len(data) == 56 + 4 * (nx * ny + layers) + 8 and sum(counts) == layers


def lines(path):
    return read(path).endswith(b"\n")


def job(path):
    """A truncated job can be valid YAML and even a valid job with defaults, so its last key must be present."""
    return lines(path) and read(path).splitlines()[-1].lstrip().startswith(b"label:") and quiet(HOODOO, "plan", path, "--rehearse", "0", "--json")[0] == 0


READERS = {"vdb": vdb, "exr": picture, "png": picture, "jpg": picture, "ply": ply, "obj": obj, "usdc": usdc, "usda": usda, "mp4": mp4,
           "html": page, "json": lambda path: json.loads(read(path)) is not None, "yaml": job, "ckpt": hoodoo, "stacks": stacks,
           "pov": lines, "inc": lines, "sh": lines, "mtl": lines, "mark": os.path.exists}
# Logs, which grow line by line, and the lock may end anywhere; their readers tolerate that.
LOOSE = ("log/", "lock", "report/log", "preview/log", "turntable/log")


known = {}  # digests of files known to be complete
ALONE = READERS.keys() - {"usda", "html"}  # these refer to other files


def is_whole(path, kind):
    if kind not in ALONE:
        return READERS[kind](path)
    key = kind, hashlib.sha256(read(path)).digest()
    if key not in known:
        known[key] = READERS[kind](path)
    return known[key]


def files(root):
    return sorted(os.path.relpath(os.path.join(at, name), root) for at, _, names in os.walk(root) for name in names)


def wrong(root, seen=None):
    """The paths of incomplete files in the folder. `seen` counts the kinds of files that were read."""
    bad = []
    for path in files(root):
        if path.startswith(LOOSE) or ".tmp-" in path or path.endswith((".log", ".jsonl")):
            continue
        kind = path.rsplit(".", 1)[-1] if "." in os.path.basename(path) else path
        try:
            good = is_whole(os.path.join(root, path), kind)
        except Exception as error:  # any error of a reader
            good, path = False, f"{path} ({type(error).__name__}: {error})"
        if seen is not None:
            seen[kind] = seen.get(kind, 0) + 1
        if not good:
            bad.append(path)
    return bad

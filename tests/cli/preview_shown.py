"""Values as colours with a legend, and the strip below pictures of hoodoo preview, measured in the pictures."""
import json
import os
import struct
import subprocess
import sys

HOODOO = os.environ["HOODOO"]
W, H = 320, 180
failed = False


def check(good, what):
    global failed
    failed |= not good
    print(("ok " if good else "not ok ") + what)


def hoodoo(*words):
    done = subprocess.run([HOODOO, *words, "--progress", "none"], capture_output=True, text=True, errors="replace")
    return done.returncode, done.stderr


def pixels(path, width=W, height=H):
    raw = subprocess.run(["ffmpeg", "-loglevel", "error", "-i", path, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
                         capture_output=True, check=True).stdout
    assert len(raw) == 3 * width * height, (path, len(raw))
    return [[tuple(raw[3 * (y * width + x):3 * (y * width + x) + 3]) for x in range(width)] for y in range(height)]


def made_how(path):
    """The text with the keyword "hoodoo" in any chunk."""
    with open(path, "rb") as f:
        data = f.read()
    at = 8
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"tEXt" and body.startswith(b"hoodoo\0"):
            return body.split(b"\0", 1)[1].decode()
        at += 12 + size
    return ""


def near(a, b, by=3):
    return all(abs(x - y) <= by for x, y in zip(a, b))


def linear(c):
    return (c / 255 / 12.92 if c <= 10 else ((c / 255 + 0.055) / 1.055) ** 2.4)


def same_hue(pixel, color):
    """Is the pixel a shade of the colour?"""
    a, b = [linear(c) for c in pixel], [linear(c) for c in color]
    scale = sum(a) / sum(b)
    return scale > 0.2 and all(abs(x - scale * y) < 0.04 + 0.08 * scale * y for x, y in zip(a, b))


def bar(picture):
    """The colour bar, from top to bottom: the column with the most distinct colours near the right edge, without other pixels."""
    right = range(int(0.6 * W), W)
    middle = [max(right, key=lambda x: sum(picture[y][x] != picture[y + 1][x] and max(picture[y][x]) - min(picture[y][x]) > 30
                                            for y in range(10, 130)))][0]
    rows = [y for y in range(5, 150) if max(picture[y][middle]) - min(picture[y][middle]) > 30]
    return [picture[y][middle] for y in range(rows[0], rows[-1] + 1)] if rows else []


VIRIDIS = {0: (68, 1, 84), 0.5: (33, 145, 140), 1: (253, 231, 37)}
TENSION, NONE, COMPRESSION = (59, 76, 192), (221, 221, 221), (180, 4, 38)
DRAFT = ("--preset", "draft", "--resolution", f"{W}x{H}", "--only", "stills")

# A block before any erosion: viability is 1 on all its faces.
job = {"hoodoo": 1, "name": "block", "frames": "1001-1002", "clock": {"years_per_frame": 1500}, "domain": {"size_m": [16, 16, 16], "spacing_m": 1},
       "scene": {"box": {"min_m": [3, 3, 0], "max_m": [13, 13, 14]}}, "strata": [{"to_m": 16, "weak_m_per_kyr": 0.1, "strong_m_per_kyr": 0.1, "interlock_MPa": 0.2}], "wind": {"speed_m_s": 10},
       "cameras": {"front": {"position_m": [8, -40, 9], "target_m": [8, 4, 7]}}}
with open("block.json", "w") as file:
    json.dump(job, file)
code, said = hoodoo("run", "block.json", "--out", "o")
check(code == 0, f"the job runs {said}")

# ---- the strip
code, said = hoodoo("preview", "o", *DRAFT, "--no-slate")
bare = pixels("o/preview/block.1001.png")
code2, said2 = hoodoo("preview", "o", *DRAFT)
slated = pixels("o/preview/block.1001.png")
check(code == code2 == 0, f"stills with a strip and without {said}{said2}")
changed = [sum(a != b for a, b in zip(p, q)) for p, q in zip(bare, slated)]
first = next(y for y in range(H) if changed[y] > 0.9 * W)
strip = slated[first:]
check(first > 0.88 * H and all(n > 0.98 * W for n in changed[first:]), f"the strip is the lowest {H - first} rows, all of them")
# 5 m, in a camera 48 m from the box's middle, with a film of 36 mm behind a lens of 35 mm.
above = [(x, y) for y in range(first) for x in range(W) if bare[y][x] != slated[y][x]]
length = max(sum(min(slated[y][x]) > 225 and min(bare[y][x]) < 225 for x in range(W // 2)) for y in range(first - 20, first))
check(all(x < W / 5 and y > first - 24 for x, y in above) and abs(length - 5 * 0.5 * W / (18 / 35) / 48) < 2.5,
      f"over it nothing but the scale bar, which is 5 m long: {length} px")
bright = [x for row in strip for x, p in enumerate(row) if min(p) > 180]
check(sum(x < W / 2 for x in bright) > 30 and sum(x > 0.75 * W for x in bright) > 20 and not any(min(p) > 180 for row in bare[first:] for p in row),
      f"with words on the left and on the right ({len(bright)} bright pixels)")
check("slate=yes" in made_how("o/preview/block.1001.png"), f"the file says how it was made: {made_how('o/preview/block.1001.png')}")
code, _ = hoodoo("preview", "o", *DRAFT[:-2], "--only", "sheet")
sheet = pixels("o/block.contact.png", 2 * W + 4, H)
check([row[:W] for row in sheet] == slated, "stills with a strip are not labelled again on the sheet")
os.remove("o/preview/block.1002.png")
hoodoo("preview", "o", *DRAFT, "--frames", "1002", "--no-slate")
plain = pixels("o/preview/block.1002.png")
hoodoo("preview", "o", *DRAFT[:-2], "--only", "sheet")
sheet = pixels("o/block.contact.png", 2 * W + 4, H)
label = sum(a != b for row, other in zip(sheet, plain) for a, b in zip(row[W + 4:], other))
check(label > 50 and [row[:W] for row in sheet] == slated, f"those without are ({label} pixels)")

# ---- values
code, said = hoodoo("preview", "o", *DRAFT, "--show", "viability", "--frames", "1001")
picture = pixels("o/preview/block.viability.1001.png")
colors = bar(picture)
check(code == 0 and len(colors) > 0.45 * H, f"the bar is {len(colors)} pixels high {said}")
for t, color in VIRIDIS.items():
    got = colors[round((1 - t) * (len(colors) - 1))]
    check(near(got, color, 8), f"viridis at {t}: {got}, {color} expected")
face = [picture[y][x] for y in range(70, 130, 6) for x in range(145, 172, 5)]
check(all(same_hue(p, VIRIDIS[1]) for p in face), f"untouched rock has the colour of 1: {face[20]}")
for span, t in (("0:2", 0.5), ("1.5:3", 0), ("0.1:0.5", 1)):
    code, said = hoodoo("preview", "o", *DRAFT, "--show", "viability", "--frames", "1001", "--range", span)
    picture = pixels("o/preview/block.viability.1001.png")
    face = [picture[y][x] for y in range(70, 130, 6) for x in range(145, 172, 5)]
    check(code == 0 and all(same_hue(p, VIRIDIS[t]) for p in face), f"--range {span}: the colour at {t}, {face[20]} {said}")

code, said = hoodoo("preview", "o", *DRAFT, "--show", "erodibility", "--frames", "1001", "--range", "0.01:1")
picture = pixels("o/preview/block.erodibility.1001.png")
face = [picture[y][x] for y in range(70, 130, 6) for x in range(145, 172, 5)]
check(code == 0 and all(same_hue(p, VIRIDIS[0.5]) for p in face), f"rock that retreats 0.1 m/kyr is half way from 0.01 to 1: {face[20]} {said}")
os.remove("o/preview/block.erodibility.1001.png")
code, said = hoodoo("preview", "o", *DRAFT, "--show", "stress")
picture = pixels("o/preview/block.stress.1001.png")
column = next(x for x in range(int(0.6 * W), W) if sum(near(picture[y][x], COMPRESSION, 10) for y in range(H)) > 1) + 2
right = [(y, picture[y][column]) for y in range(H)]
ends = [[y for y, p in right if near(p, color, 10)] for color in (COMPRESSION, TENSION)]
check(code == 0 and all(ends) and max(ends[0]) < min(ends[1]), f"stress: compression's red on top, tension's blue below {said}")
top, low = min(ends[0]), max(ends[1])
zero = [y for y, p in right if near(p, NONE, 8) and top < y < low]
share = (low - sum(zero) / max(len(zero), 1)) / (low - top)
check(abs(share - 1 / 6) < 0.04, f"and none where zero is, a sixth above the lower end: {share:.3f}")
foot, head = picture[128][158], picture[66][158]
check(foot[0] > foot[2] + 25 and foot[0] - foot[2] > head[0] - head[2] + 20, f"the foot of a column is pressed more than its head: {foot}, {head}")

# ---- one range
one = [made_how(f"o/preview/block.stress.{frame}.png") for frame in (1001, 1002)]
os.remove("o/preview/block.stress.1002.png")
hoodoo("preview", "o", *DRAFT, "--show", "stress", "--frames", "1002")
check(one[0] == one[1] == made_how("o/preview/block.stress.1002.png") and "show=stress -" in one[0],
      f"frames have one range, also when made apart: {one[0].split(';')[0]}")
hoodoo("preview", "o", *DRAFT, "--show", "stress", "--range", "data")
data = [made_how(f"o/preview/block.stress.{frame}.png") for frame in (1001, 1002)]
check(data[0] == data[1] != one[0], f"that of the data of all: {data[0].split(';')[0]}")
low, high = (float(x) for x in data[0].split(";")[0].split(" ")[1].split(":"))
weight = 2300 * 9.81 * 14 * 1e-6
check(low <= 0 and 0.5 * weight < high < 4 * weight, f"about what a column of that height weighs: {high} of {weight:.3f} MPa")
code, said = hoodoo("preview", "o", "--turntable", "--views", "3", "--preset", "draft", "--show", "von_mises", "--resolution", f"{W}x{H}")
views = {made_how(f"o/turntable/block.von_mises.1002.{v:03}.png").split(";")[0] for v in range(3)}
check(code == 0 and len(views) == 1 and os.path.exists("o/block.von_mises.turntable.mp4"), f"all views of a turntable have one: {views} {said}")
subprocess.run(["ffmpeg", "-loglevel", "error", "-ss", "0.1", "-i", "o/block.von_mises.turntable.mp4", "-frames:v", "1", "v.png"], check=True)
colors = bar(pixels("v.png"))
middle = colors[len(colors) // 2] if colors else (0, 0, 0)
check(len(colors) > 0.4 * H and near(middle, VIRIDIS[0.5], 45), f"and the legend is in the video: {middle} in its middle")
names = sorted(os.listdir("o/preview")) + sorted(os.listdir("o/turntable"))
check(names == ["block.1001.png", "block.1002.png", "block.stress.1001.png", "block.stress.1002.png", "block.viability.1001.png"] +
      [f"block.von_mises.1002.{v:03}.png" for v in range(3)], f"each has files of its own, and nothing else is left: {names}")

for words, code_wanted, why in ((("--range", "0:1"), 2, "--show"), (("--show", "stress", "--range", "2:1"), 2, "LO:HI in MPa"),
                                (("--show", "stress", "--range", "0:nan"), 2, "LO:HI"), (("--show", "stress", "--range", "1"), 2, "LO:HI"),
                                (("--show", "discharge", "--range", "0:10"), 2, "above 0"), (("--show", "colour"), 2, "colour"),
                                (("--show", "vegetation"), 3, "vegetation")):
    code, said = hoodoo("preview", "o", *words)
    check(code == code_wanted and said.count("\n") == 1 and why in said, f"{' '.join(words)}: {code}, {said.strip()}")
sys.exit(failed)

"""Previews show a world in metres: light, textures and ground have the positions and sizes that the job defines, whatever else is in the
picture. Measured in the pictures."""
import json
import math
import os
import re
import subprocess
import sys

sys.dont_write_bytecode = True
from script import finish, hoodoo, ok


def made(*words):
    code, said = hoodoo(*words, "--progress", "none")
    if code:
        ok(False, f"hoodoo {' '.join(words)}", said)
        finish()


def run(name, job):
    with open(f"{name}.json", "w") as file:
        json.dump({"hoodoo": 1, "name": name, **job}, file)
    made("run", f"{name}.json", "--out", name)


def linear(byte):
    c = byte / 255
    return c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4


LINEAR = [linear(byte) for byte in range(256)]


def still(name, frame, width, height, *words):
    """Rows of (r, g, b)."""
    made("preview", name, "--frames", str(frame), "--only", "stills", "--no-slate", "--resolution", f"{width}x{height}", *words)
    raw = subprocess.run(["ffmpeg", "-loglevel", "error", "-i", f"{name}/preview/{name}.{frame}.png", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
                         capture_output=True, check=True).stdout
    return [[tuple(raw[3 * (y * width + x):3 * (y * width + x) + 3]) for x in range(width)] for y in range(height)]


def bright(pixel):
    return sum(LINEAR[c] for c in pixel) / 3


def layer(name, frame, part):
    """Rows of (x, y, z) or (r, g, b) of an EXR's part."""
    subprocess.run(["oiiotool", f"{name}/aov/{name}.{frame}.exr", "--subimage", part, "-d", "float", "-o", "part.exr"], check=True)
    text = subprocess.run(["oiiotool", "--dumpdata", "part.exr"], check=True, capture_output=True, text=True).stdout
    rows = {}
    for x, y, values in re.findall(r"Pixel \((\d+), (\d+)\): ([^\n]*)", text):
        rows.setdefault(int(y), {})[int(x)] = tuple(float(v) for v in values.split()[:3])
    return [[row[x] for x in range(len(row))] for _, row in sorted(rows.items())]


# ---- the sun: the shadow of a tower on a slab, in the preview and in rgba, shows its direction
AZIMUTH, ELEVATION, W, H = 205, 40, 160, 120
TOWER = {"box": {"min_m": [7, 7, 0], "max_m": [9, 9, 5]}}
run("sundial", {"frames": "1001-1001", "domain": {"size_m": [16, 16, 8], "spacing_m": 0.25},
                "scene": {"union": [{"box": {"min_m": [0.5, 0.5, 0], "max_m": [15.5, 15.5, 1]}}, TOWER]},
                "light": {"sun": {"azimuth_deg": AZIMUTH, "elevation_deg": ELEVATION}},
                "cameras": {"main": {"orbit": {"target_m": [8, 8, 1], "distance_m": 26, "azimuth_deg": -80, "elevation_deg": 55}, "resolution": [W, H]}},
                "output": {"up": "z", "aov": {"cameras": ["main"], "layers": ["rgba", "P"]}}})
where = layer("sundial", 1001, "P")
seen = {"rgba": [[sum(p) / 3 for p in row] for row in layer("sundial", 1001, "rgba")],
        "preview": [[bright(p) for p in row] for row in still("sundial", 1001, W, H, "--preset", "draft")]}
floor = [(y, x) for y in range(H) for x in range(W) if abs(where[y][x][2] - 1) < 0.12 and max(abs(where[y][x][k] - 8) for k in (0, 1)) < 7]
found = []
for what, light in seen.items():
    values = sorted(light[y][x] for y, x in floor)
    lit = values[3 * len(values) // 4]
    # The shadow points away from the sun: the mean of the dark pixels, seen from the middle of the tower.
    dark = [(where[y][x][0] - 8, where[y][x][1] - 8) for y, x in floor if light[y][x] < 0.55 * lit]
    dark = [d for d in dark if math.hypot(*d) > 2]
    away = math.degrees(math.atan2(sum(d[1] for d in dark), sum(d[0] for d in dark)))
    c, s = math.cos(math.radians(away)), math.sin(math.radians(away))
    # The shadow of the middle of the upper edge ends 1 m farther than the height of the tower suggests.
    reach = sorted(c * d[0] + s * d[1] for d in dark if abs(s * d[0] - c * d[1]) < 0.5)
    high = math.degrees(math.atan2(4, reach[-3] - 1 / max(abs(c), abs(s))))
    turned = (away + 180 - AZIMUTH + 180) % 360 - 180
    found.append((turned, high))
    # Edges are rounded by about one spacing, which shortens shadows.
    ok(abs(turned) < 2.5 and abs(high - ELEVATION) < 6.5,
          f"{what}: the sun stands at azimuth {AZIMUTH + turned:.1f}, elevation {high:.1f}; {AZIMUTH} and {ELEVATION} were asked for")

ok(all(abs(a - b) < 4 for a, b in zip(*found)), "the same in both")

# ---- unchanged parts are identical pixel by pixel: an edit carves another rock and leaves a fragment far outside
W, H = 160, 90
STILL = {"to_m": 20, "weak_m_per_kyr": 0, "strong_m_per_kyr": 0}
run("edited", {"frames": "1001-1002", "domain": {"size_m": [30, 12, 10], "spacing_m": 0.5}, "strata": [STILL],
               "scene": {"union": [{"box": {"min_m": [3, 4, 0], "max_m": [7, 8, 7]}}, {"box": {"min_m": [20, 4, 0], "max_m": [24, 8, 6]}}]},
               "edits": [{"frame": 1002, "carve": {"sphere": {"center_m": [22, 4, 5], "radius_m": 1.5}}, "add": [{"shape": {"box": {"min_m": [28, 0.5, 0], "max_m": [29.5, 2, 1.5]}}}]}],
               "light": {"sun": {"azimuth_deg": 230, "elevation_deg": 35}},
               "cameras": {"main": {"position_m": [15, -32, 7], "target_m": [15, 6, 4]}}})
for preset in ("draft", "preview"):
    one, other = (still("edited", frame, W, H, "--preset", preset) for frame in (1001, 1002))
    # The left half contains ground, a tower, sky and horizon, but neither the change nor its shadow.
    most = max(abs(a - b) for p, q in zip(one, other) for x in range(W // 2) for a, b in zip(p[x], q[x]))
    moved = sum(p[x] != q[x] for p, q in zip(one, other) for x in range(W // 2, W))
    ok(most == 0 and moved > 50, f"{preset}: pixels of rock, ground and sky that nothing has changed differ by {most}/255; {moved} have changed elsewhere")

# ---- the foot: no dark line between the rock and the ground where both are in the sun
picture, columns, gaps = still("edited", 1001, 320, 180, "--preset", "draft"), range(57, 83), []
for x in columns:
    light = [bright(row[x]) for row in picture]
    gaps.append(light)
# From the middle of the front of the tower down to the ground in front of it.
least = []
for light in gaps:
    wall, ground = sorted(light[80:100])[10], sorted(light[150:170])[10]
    least.append(min(light[100:150]) / min(wall, ground))
least.sort()
ok(least[len(least) // 2] > 0.65, f"between wall and ground it is never darker than {least[len(least) // 2]:.2f} of both")

# ---- attitude: the preview and rgba show the same strata where beds are tilted, folded, faulted and unconformable
W, H = 120, 68
RED, PALE = [0.5, 0.08, 0.05], [0.6, 0.5, 0.4]
run("tilted", {"frames": "1001-1001", "domain": {"size_m": [40, 30, 24], "spacing_m": 1},
               "strata": [{"to_m": 0, "color": RED}, {"to_m": 4, "color": PALE}, {"to_m": 11, "color": RED}, {"to_m": 15, "color": PALE}, {"to_m": 40, "color": RED}],
               "attitude": {"dip_deg": 18, "dip_azimuth_deg": 20, "folds": [{"wavelength_m": 30, "amplitude_m": 1.5, "axis_deg": 90}],
                            "unconformities": [{"at_m": 8, "dip_deg": 25, "dip_azimuth_deg": 160, "eroded_m": 1}],
                            "faults": [{"strike_deg": 90, "dip_deg": 65, "throw_m": 4, "point_m": [20, 15, 12]}, {"strike_deg": 70, "dip_deg": 80, "throw_m": -3, "point_m": [26, 15, 8]}]},
               "scene": {"box": {"min_m": [6, 8, 0], "max_m": [34, 22, 20]}}, "light": {"sun": {"azimuth_deg": -100, "elevation_deg": 40}},
               "cameras": {"main": {"orbit": {"target_m": [20, 15, 9], "distance_m": 55, "azimuth_deg": -70, "elevation_deg": 9}, "resolution": [W, H]}},
               "output": {"aov": {"cameras": ["main"], "layers": ["rgba"]}}})
rgba, picture = layer("tilted", 1001, "rgba"), still("tilted", 1001, W, H, "--preset", "draft")
red = [(rgba[y][x][0] > 3 * rgba[y][x][1], LINEAR[picture[y][x][0]] > 2.1 * LINEAR[picture[y][x][1]]) for y in range(H) for x in range(W) if rgba[y][x][0] > 0.2]
alike = sum(a == b for a, b in red) / len(red)
ok(alike > 0.87 and 0.2 < sum(a for a, _ in red) / len(red) < 0.8, f"beds that are tilted, folded, faulted twice and laid on others: {100 * alike:.1f} % of {len(red)} pixels show the same one")

# ---- a cliff between walls continues beyond the domain on both sides, without a gap; at open sides it ends
for side, want in (("wall", 1), ("open", 0)):
    run(side, {"frames": "1001-1001", "strata": [STILL], "domain": {"size_m": [16, 8, 10], "spacing_m": 0.5, "sides": {"x_min": side, "x_max": side, "y_max": side}},
               "scene": {"box": {"min_m": [-1, 4, 0], "max_m": [17, 9, 8]}}, "light": {"sun": {"azimuth_deg": -110, "elevation_deg": 40}},
               "cameras": {"main": {"position_m": [8, -30, 4], "target_m": [8, 4, 4]}}})
    row = still(side, 1001, W, H, "--preset", "draft")[H // 2 - 4]
    rock = sum(LINEAR[p[0]] > 1.15 * LINEAR[p[2]] for p in row) / W
    ok(rock == 1 if want else 0.3 < rock < 0.6, f"{side} sides: rock across {rock:.2f} of the picture, half way up")

# ---- texture in metres: the same wall, seen from the same distance, in rocks of 26 cm, 7 m and 45 m
waves = {}
for size, spacing in ((0.26, 0.01), (7, 0.25), (45, 1.5)):
    name, middle = f"block{round(100 * size)}", [size / 2 + 0.4 * size, 0.25 * size, 0.45 * size]
    run(name, {"frames": "1001-1001", "domain": {"size_m": [1.8 * size, 1.5 * size, 1.1 * size], "spacing_m": spacing}, "strata": [dict(STILL, to_m=1000)],
               "scene": {"box": {"min_m": [0.4 * size, 0.25 * size, 0], "max_m": [1.4 * size, 1.25 * size, size]}},
               "light": {"sun": {"azimuth_deg": -120, "elevation_deg": 40}},
               "cameras": {"main": {"position_m": [middle[0], middle[1] - 0.6, middle[2]], "target_m": middle, "focal_mm": 90}}})
    picture = still(name, 1001, 96, 96, "--preset", "preview")
    # 0.24 m are 96 px. The ratio of red to green, top to bottom, is independent of light and shade.
    ratio = [[math.log((LINEAR[p[0]] + 0.01) / (LINEAR[p[1]] + 0.01)) for p in row] for row in picture]
    tone = [[math.log(bright(p) + 0.01) for p in row] for row in picture]
    flat = [v for row in tone for v in row]
    mean = sum(flat) / len(flat)
    spread = sum((v - mean) ** 2 for v in flat) / len(flat)
    slope = sum((tone[y + 1][x] - tone[y][x]) ** 2 for y in range(95) for x in range(96)) / (95 * 96)
    waves[size] = 2 * math.pi * 0.24 / 96 * math.sqrt(spread / slope)
    ok(math.sqrt(spread) > 0.04, f"a rock of {size} m has texture: {math.sqrt(spread):.3f}, of a wave {1000 * waves[size]:.1f} mm long")
ok(max(waves.values()) < 2 * min(waves.values()), "the same in all three, in metres: " + ", ".join(f"{1000 * w:.1f} mm" for w in waves.values()))
finish()

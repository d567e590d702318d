"""The library of forms in jobs/: each comes about at its own spacing, by a number measured on its surface. FORMS ("mushroom cave"): these
alone. SEED and SPACING: another seed, another spacing (times the job's). Prints the table of jobs' measures."""
import os
import sys
import time

sys.path = [p for p in sys.path if p]
import numpy
import pyopenvdb
from scipy import ndimage

sys.dont_write_bytecode = True
from script import TOP, finish, hoodoo, ok

SEED, SPACING = os.environ.get("SEED"), float(os.environ.get("SPACING", 1))
OWN = {"mushroom": 0.5, "hoodoos": 1, "vegetated_hill": 1, "edited_block": 0.75, "bruthans_arch": 0.006, "jones_pair": 1, "cave": 1, "natural_bridge": 1, "slot_canyon": 1, "arcade": 0.75}
rows = []


class Rock:
    """The last frame's volumes as arrays over one box: `solid`, and others by name. z up, m."""

    def __init__(self, path):
        self.path = path
        surface = pyopenvdb.read(path, "surface")
        low, high = surface.evalActiveVoxelBoundingBox()
        self.low, high = numpy.array(low) - 2, numpy.array(high) + 2
        self.shape = high - self.low + 1
        self.h = surface.transform.voxelSize()[0]
        self.origin = numpy.array(surface.transform.indexToWorld(tuple(float(v) for v in self.low)))
        self.distance = self.array(surface)
        self.solid = self.distance < 0
        self.z = self.origin[2] + self.h * numpy.arange(self.shape[2])

    def array(self, grid):
        if isinstance(grid, str):
            grid = pyopenvdb.read(self.path, grid)
        a = numpy.zeros(self.shape, numpy.float32)
        grid.copyToArray(a, ijk=tuple(int(v) for v in self.low))
        return a

    def index(self, axis, x):
        return int(round((x - self.origin[axis]) / self.h))

    def sections(self, height):
        """Pieces of rock at a height, larger than a square of two voxels."""
        s = self.solid[:, :, self.index(2, height)]
        labels, n = ndimage.label(s)
        return int(sum(ndimage.sum(s, labels, range(1, n + 1)) >= 4)) if n else 0

    def windows(self, axis):
        """Areas (m2) of the openings that one sees through along an axis, with rock above."""
        seen = self.solid.any(axis)
        above = numpy.cumsum(seen[:, ::-1], 1)[:, ::-1] > 0
        beside = (numpy.cumsum(seen, 0) > 0) & (numpy.cumsum(seen[::-1], 0)[::-1] > 0)
        hole = ~seen & above & beside
        hole[:, : self.index(2, 0) + 1] = False
        labels, n = ndimage.label(hole)
        return sorted((float(a) * self.h**2 for a in ndimage.sum(hole, labels, range(1, n + 1))), reverse=True) if n else []

    def radius_below(self, height):
        """Widths (m) of circles of the sections' areas, for each height up to this one."""
        return numpy.sqrt(4 / numpy.pi * self.solid.sum((0, 1)) * self.h**2)


def run(name, wedge=None, *more):
    out = name + (f"_{wedge}" if wedge else "")
    words = ["run", f"{TOP}/jobs/{name}.yaml", "--out", out, "--progress", "none", "--set", "output.up=z", "--set", "output.vdb.points=none", "--set", "output.usd.points=none",
             "--set", "output.vdb.every=100000", "--set", "output.aov.cameras=[]", *more]
    if wedge:
        words += ["--wedge", str(wedge)]
    if SEED:
        words += ["--set", f"seed={SEED}"]
    if SPACING != 1:
        words += ["--set", f"domain.spacing_m={OWN[name] * SPACING}"]
    began = os.times()
    code, said = hoodoo(*words, timeout=3600)
    ended = os.times()
    if not ok(code == 0, f"{name}: runs", said):
        return None
    rows.append([name, ended.children_user + ended.children_system - began.children_user - began.children_system])
    files = sorted(os.listdir(f"{out}/volumes"))
    return Rock(f"{out}/volumes/{files[-1]}")


def measured(name, good, what):
    rows[-1].append(what)
    ok(good, f"{name}: {what}")


def mushroom(name):
    r = run(name)
    if not r:
        return
    wide = r.radius_below(99)
    top = numpy.nonzero(wide)[0].max()
    cap = wide[(r.z > 0.65 * r.z[top])].max()
    neck = wide[(r.z > 0.2 * r.z[top]) & (r.z < 0.75 * r.z[top])].min()
    measured(name, neck <= 0.6 * cap, f"a neck {neck:.1f} m wide below a cap of {cap:.1f} m, {r.z[top]:.1f} m high")


def hoodoos(name):
    r = run(name)
    if r:
        n = max(r.sections(z) for z in numpy.arange(6, 14, 0.5))
        measured(name, n >= 12, f"{n} separate pillars")


def vegetated_hill(name):
    r = run(name)
    if not r:
        return
    plants, deposit = r.array("vegetation"), r.array("deposit")
    skin = numpy.abs(r.distance) < r.h
    high = skin & (r.z > 14)[None, None, :]
    foot = skin & (deposit > 0.5)
    top, new = plants[high].mean(), plants[foot].mean() if foot.any() else 0
    measured(name, top > 0.3 and new > 0.2, f"plants cover {100 * top:.0f} % of the top after 24 kyr, and {100 * new:.0f} % of the deposits")


def edited_block(name):
    r = run(name)
    if r:
        holes, columns = r.windows(1), r.sections(27)
        measured(name, holes and holes[0] > 4 and columns == 2, f"a window of {holes[0] if holes else 0:.0f} m2 and {columns} columns on top")


def bruthans_arch(name):
    r = run(name)
    if not r:
        return
    seen = r.solid.any(1)
    x = r.origin[0] + r.h * numpy.arange(seen.shape[0])
    points = []
    for i in range(seen.shape[0]):
        rock = numpy.nonzero(seen[i])[0]
        if len(rock) and r.z[rock[0]] > 0.012:
            points.append((x[i], r.z[rock[0]]))
    p = numpy.array(points) if len(points) > 6 else numpy.zeros((0, 2))
    if not len(p):
        measured(name, False, "no opening")
        return
    fit = numpy.polyval(numpy.polyfit(p[:, 0], p[:, 1], 2), p[:, 0])
    rms = float(numpy.sqrt(numpy.mean((fit - p[:, 1]) ** 2)) / p[:, 1].max())
    measured(name, rms <= 0.1, f"a lower contour {100 * p[:, 1].max():.1f} cm high, {100 * rms:.1f} % off a parabola")


def jones_pair(name):
    with_stress = run(name, 1)
    without = run(name, 2)
    if with_stress and without:
        holes = with_stress.windows(1)
        volume = [r.solid.sum() * r.h**3 for r in (with_stress, without)]
        measured(name, holes and holes[0] > 50 and volume[0] > 3 * volume[1], f"with stress an arch of {holes[0] if holes else 0:.0f} m2 and {volume[0]:.0f} m3, without {volume[1]:.0f} m3")


def passage(r, start, end):
    """The radius (m) of the largest ball that can go from one place to the other."""
    far = ndimage.distance_transform_edt(~r.solid) * r.h
    at = [tuple(max(0, min(r.index(a, p[a]), r.shape[a] - 1)) for a in range(3)) for p in (start, end)]
    radius = 0
    while True:
        labels, _ = ndimage.label(far >= radius + 0.25)
        # Its middle may keep off the walls of the place itself.
        near = [labels[tuple(slice(max(0, i - 2), i + 3) for i in p)] for p in at]
        if not set(numpy.unique(near[0])) & set(numpy.unique(near[1])) - {0}:
            return radius
        radius += 0.25


def cave(name):
    r = run(name)
    if not r:
        return
    first = Rock(f"{name}/volumes/{sorted(os.listdir(f'{name}/volumes'))[0]}")
    voids = []
    for rock in (first, r):
        rock.solid[:, :, rock.index(2, 24) :] = True  # a ball must not go around, over the plateau
        inside = ~rock.solid[rock.index(0, 4) : rock.index(0, 50), rock.index(1, 2) : rock.index(1, 46), rock.index(2, 1) : rock.index(2, 24)]
        voids.append(float(inside.sum()) * rock.h**3)
    radius = min(passage(r, start, (58, 28, 6)) for start in ((12, 13.3, 12.3), (12, 36, 13.2)))
    measured(name, radius >= 1 and voids[1] >= 3 * voids[0], f"a ball of {radius:.1f} m goes from either sink to the cliff; the void has grown from {voids[0]:.0f} to {voids[1]:.0f} m3")


def natural_bridge(name):
    r = run(name)
    if r:
        holes = r.windows(1)
        way = passage(r, (32.5, 40, 6.5), (34.5, 20, 6.5))
        measured(name, way >= 1.5 and holes and holes[0] > 25, f"an opening of {holes[0] if holes else 0:.0f} m2 through the wall, at the stream's level")


def slot_canyon(name):
    r = run(name)
    if not r:
        return
    # Across the canyon, at each x: how deep it is below the plateau, and how wide at half that depth.
    depths, widths = [], []
    for x in numpy.arange(10, 40, 2):
        cut = r.solid[r.index(0, x), r.index(1, 8) : r.index(1, 32)]
        top = cut.shape[1] - 1 - numpy.argmax(cut[:, ::-1], 1)
        lowest = int(numpy.argmin(top))
        rim = numpy.median(top)
        depth = (rim - top[lowest]) * r.h
        half = top < rim - 0.5 * depth / r.h
        labels, _ = ndimage.label(half)
        depths.append(depth)
        widths.append((labels == labels[lowest]).sum() * r.h if half[lowest] else 0)
    depth, width = numpy.median(depths), numpy.median(widths)
    measured(name, depth >= 10 and depth >= 3 * width, f"{depth:.0f} m deep and {width:.1f} m wide at half its depth")


def arcade(name):
    r = run(name)
    if not r:
        return
    holes = [a for a in r.windows(1) if a > 1]
    stress = r.array("stress")
    skin = numpy.abs(r.distance) < r.h
    low = skin & ((r.z > 4) & (r.z < 9))[None, None, :]
    seen = r.solid.any(1)
    pillar = numpy.zeros_like(seen)
    for k in range(r.index(2, 4), r.index(2, 9)):
        gaps = numpy.nonzero(~seen[:, k])[0]
        if len(gaps) > 1:
            pillar[gaps[0] : gaps[-1] + 1, k] = seen[gaps[0] : gaps[-1] + 1, k]
    between = low & pillar[:, None, :]
    high = skin & ((r.z > 13) & (r.z < 18))[None, None, :]
    ratio = float(numpy.median(stress[between]) / numpy.median(stress[high])) if between.any() else 0
    measured(name, len(holes) >= 3 and ratio >= 2, f"{len(holes)} openings right through, and pillars between them under {ratio:.1f} times the wall's stress")


FORMS = [mushroom, hoodoos, vegetated_hill, edited_block, bruthans_arch, jones_pair, cave, natural_bridge, slot_canyon, arcade]
chosen = os.environ.get("FORMS", "").split()
for form in FORMS:
    if not chosen or form.__name__ in chosen:
        form(form.__name__)
print("# | job | CPU (s) | measured |\n# |---|---|---|")
for name, seconds, *what in rows:
    print(f"# | {name} | {seconds:.0f} | {'; '.join(what)} |")
finish()

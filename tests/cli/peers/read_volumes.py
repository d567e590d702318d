"""read_volumes.py FILE y|z: is the sample frame's ball where it belongs, as another program reads it?"""
import math
import sys

import numpy
import pyopenvdb as vdb

CENTRE, RADIUS = (7.25, 5.5, 6.0), 4.0  # tests/unit/sample_frame.h
path, up = sys.argv[1:]


def in_simulator(x):
    return x if up == "z" else (x[0], -x[2], x[1])


def distance(x):
    return math.dist(in_simulator(x), CENTRE) - RADIUS


def stress(x):
    s = in_simulator(x)
    return 1e5 + 2e3 * s[0] - 3e3 * s[1] + 5e3 * s[2]


grids = {g.name: g for g in vdb.readAllGridMetadata(path)}
assert set(grids) == {"surface", "density", "stress", "vel"}, grids.keys()
metadata = vdb.readMetadata(path)
assert metadata["up_axis"] == up.upper() and metadata["frame"] == 1001 and metadata["meters_per_unit"] == 1
assert metadata["creator"].startswith("Houdini") == (up == "y")

surface, density, pressure, wind = (vdb.read(path, n) for n in ("surface", "density", "stress", "vel"))
voxel = surface.transform.voxelSize()[0]
band = 3 * voxel
assert surface.gridClass == vdb.GridClass.LEVEL_SET and density.gridClass == vdb.GridClass.FOG_VOLUME
assert abs(surface.background - band) < 1e-6 and density.background == 0

n = 0
for item in surface.citerOnValues():
    x = surface.transform.indexToWorld(item.min)
    assert item.count == 1 and item.value == numpy.float32(distance(x)), (x, item.value, distance(x))
    n += 1
assert n > 1000, n
# inside and outside, far from the surface: the background and its negative
file_centre = CENTRE if up == "z" else (CENTRE[0], CENTRE[2], -CENTRE[1])
at = surface.getConstAccessor()
centre = tuple(round(c) for c in surface.transform.worldToIndex(file_centre))
assert at.probeValue(centre) == (-surface.background, False)
assert at.probeValue((1000, 0, 0)) == (surface.background, False)

filled = pressure_sum = 0
stress_at = pressure.getConstAccessor()
for item in density.citerOnValues():
    for i in range(item.min[0], item.max[0] + 1, 3):
        ijk = (i, item.min[1], item.max[2])
        x = density.transform.indexToWorld(ijk)
        assert distance(x) < voxel / 2 + 1e-6
        assert stress_at.probeValue(ijk) == (numpy.float32(stress(x)), True), x
    filled += item.count * item.value
volume = filled * voxel**3
assert abs(volume / (4 / 3 * math.pi * RADIUS**3) - 1) < 0.01, volume

for item in wind.citerOnValues():
    x = wind.transform.indexToWorld(item.min)
    assert distance(x) > 0
    assert numpy.allclose(in_simulator(item.value), (1, 2, in_simulator(x)[2])), (x, item.value)

"""A DEM that a Debian package ships, with pixels of no data (Luxembourg, in r-cran-terra): as much rock as numpy counts in what GDAL reads of it."""

import glob
import json
import sys

import numpy

sys.dont_write_bytecode = True
from script import *

code, said = ask("apt-get", "-qq", "download", "r-cran-terra")
package = glob.glob("r-cran-terra_*.deb")
if code or not package:
    ok(True, "a DEM as it comes # skip the package cannot be had here", said)
    finish()
ask("dpkg-deb", "-x", package[0], "package")
dem = glob.glob("package/**/elev.tif", recursive=True)[0]
code, said = ask("gdal_translate", "-q", "-of", "AAIGrid", dem, "dem.asc")
ok(code == 0, "GDAL reads it", said)
with open("dem.asc") as file:
    head = dict(line.split() for line in (file.readline() for _ in range(7)) if line[0].isalpha())
heights = numpy.loadtxt([line for line in open("dem.asc") if not line[0].isalpha()])
lost = heights == float(head["NODATA_value"])
ok(lost.any() and not lost.all(), f"{lost.sum()} of {lost.size} pixels have no data")

for nodata in ("refuse", "empty", "fill"):
    rows, columns = heights.shape
    with open("dem.json", "w") as file:
        json.dump({"hoodoo": 1, "name": "dem", "frames": "1", "model": "goblins", "goblins": {"floats": True}, "strata": [{"to_m": 600, "bubble": {"radius_m": 15}}],
                   "domain": {"size_m": [columns * 10, rows * 10, 560], "spacing_m": 10},
                   "scene": {"heightfield": {"file": dem, "max_m": [columns * 10, rows * 10, 0.5], "scale_m": 1, "nodata": nodata}}}, file)
    code, said = hoodoo("run", "dem.json", "--out", nodata, "--progress", "none")
    if nodata == "refuse":
        ok(code == 3 and f"{lost.sum()} have no value" in said and "-32768" in said, "without a choice it is refused", said)
        continue
    with open(f"{nodata}/frames/dem.0001.json") as file:
        volume = json.load(file)["statistics"]["volume_m3"]
    wanted = heights[~lost].sum() * 100
    if nodata == "empty":
        ok(code == 0 and abs(volume / wanted - 1) < 1e-3, f"left empty it has {volume:.0f} m3, and numpy counts {wanted:.0f}", said)
    else:
        ok(code == 0 and volume > wanted and abs(volume / (heights[~lost].mean() * heights.size * 100) - 1) < 0.1, "filled it is about as high everywhere", said)
finish()

#!/bin/sh
# Pixar's USD opens a run's stage: metres, axes, time, volumes, points, cameras, rocks in piles; for both up axes of files, and half done.
set -u
python=$HOODOO_TOP/build/venv-usd/bin/python
job=$HOODOO_TOP/tests/peers/lib/usd.yaml
for up in y z; do
    "$HOODOO" run "$job" --frames 1001-1003 --set "output.up=$up" --out "out_$up" --progress none >log 2>&1 || {
        echo "not ok a run with output.up $up"
        sed 's/^/# /' log
        exit 1
    }
    "$python" "$HOODOO_TOP/tests/peers/lib/in_usd.py" "out_$up" "$up" 1003
done
cp out_y/9-arches.usda before.usda
"$HOODOO" run "$job" --out out_y --progress none >log 2>&1 || echo "not ok the rest of the run"
"$python" "$HOODOO_TOP/tests/peers/lib/in_usd.py" out_y y 1005
rm -r out_z
"$HOODOO" run "$job" --out out_z --progress none >log 2>&1 || echo "not ok the run in one go"
if cmp -s out_y/9-arches.usda out_z/9-arches.usda && ! cmp -s out_y/9-arches.usda before.usda; then echo "ok"; else echo "not ok"; fi | sed 's/$/ a run in two parts has the stage of one in one go/'
cp out_y/9-arches.usda before.usda && rm out_y/9-arches.usda
"$HOODOO" run "$job" --out out_y --progress none >log 2>&1
if cmp -s out_y/9-arches.usda before.usda; then echo "ok"; else echo "not ok"; fi | sed 's/$/ a stage that was removed comes back without a frame made anew/'
rocks=$HOODOO_TOP/tests/peers/lib/usd_rocks.yaml
for up in y z; do
    "$HOODOO" run "$rocks" --set "output.up=$up" --out "rocks_$up" --progress none >log 2>&1 || sed 's/^/not ok rocks: /' log
    "$python" "$HOODOO_TOP/tests/peers/lib/in_usd_rocks.py" "rocks_$up" "$up"
done
for up in y z; do
    "$HOODOO" mesh "out_$up" --progress none >log 2>&1 || sed 's/^/not ok meshes: /' log
    "$python" "$HOODOO_TOP/tests/peers/lib/in_usd_mesh.py" "out_$up" "$up"
done
shot=$HOODOO_TOP/tests/gpu/falling.yaml
"$HOODOO" run "$shot" --out shot --set output.up=z --progress none >log 2>&1 && "$HOODOO" mesh shot --progress none >>log 2>&1 || sed 's/^/not ok a shot: /' log
"$python" - <<'EOF'
import numpy as np
from pxr import Usd, UsdGeom
stage = Usd.Stage.Open("shot/falling.usda")
for prim in (UsdGeom.Points(stage.GetPrimAtPath("/falling/points")), UsdGeom.Mesh(stage.GetPrimAtPath("/falling/surface"))):
    v, at = np.array(prim.GetVelocitiesAttr().Get(1003)), np.array(prim.GetPointsAttr().Get(1003))
    block = (at[:, 0] > 9.6) & (at[:, 2] > 0.6)
    good = len(v) == len(at) and np.abs(v).max() < 30 and v[block][:, 2].mean() != 0
    print("ok" if good else "not ok", prim.GetPrim().GetName(), "of a shot have velocities")
EOF

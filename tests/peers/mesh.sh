#!/bin/sh
# Meshes as others read them: plyfile every property, trimesh solids of the right volume and colour, Blender colours and axes.
set -u
python=$HOODOO_TOP/build/venv-usd/bin/python
"$HOODOO" run "$HOODOO_TOP/tests/restart/twelve.yaml" --frames 1001-1004 --out out --progress none >log 2>&1 &&
    "$HOODOO" mesh out --frames 1004 >>log 2>&1 || {
    echo "not ok a run and its mesh"
    sed 's/^/# /' log
    exit 1
}
"$python" "$HOODOO_TOP/tests/peers/lib/in_trimesh.py" out/mesh/twelve.1004
blender --background --factory-startup --python-exit-code 1 --python "$HOODOO_TOP/tests/peers/lib/mesh_in_blender.py" -- \
    "$PWD/out/mesh/twelve.1004" >log 2>&1 </dev/null
code=$?
grep -E '^(ok|not ok|#) ' log
if [ $code != 0 ] && ! grep -q '^not ok' log; then
    echo "not ok blender: exit code $code"
    sed 's/^/# /' log
fi

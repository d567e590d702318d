#!/bin/sh
# Blender loads a run's volumes: every grid, and the rock where it stands in the simulator, for both up axes of files.
set -u
job=$HOODOO_TOP/tests/restart/twelve.yaml
for up in y z; do
    "$HOODOO" run "$job" --frames 1001-1001 --set "output.up=$up" --out "out_$up" --progress none >log 2>&1 || {
        echo "not ok a run with output.up $up"
        sed 's/^/# /' log
        exit 1
    }
    blender --background --factory-startup --python-exit-code 1 --python "$HOODOO_TOP/tests/peers/lib/in_blender.py" -- \
        "$PWD/out_$up/volumes/twelve.1001.vdb" "$up" >log 2>&1 </dev/null
    code=$?
    grep -E '^(ok|not ok|#) ' log
    if [ $code != 0 ] && ! grep -q '^not ok' log; then
        echo "not ok blender with output.up $up: exit code $code"
        sed 's/^/# /' log
    fi
done

# The mesh, through the camera an EXR carries, covers the pixels that the picture has rock in.
for up in y z; do
    "$HOODOO" run "$job" --frames 1001-1004 --set "output.up=$up" --set 'cameras.main.resolution=[320, 180]' --out "seen_$up" \
        --progress none >log 2>&1 &&
        "$HOODOO" mesh "seen_$up" --frames 1004 --progress none >>log 2>&1 &&
        /usr/bin/python3 "$HOODOO_TOP/tests/peers/lib/alpha.py" camera "seen_$up/aov/twelve.1004.exr" camera.json >>log 2>&1 || {
        echo "not ok a mesh and its camera with output.up $up"
        sed 's/^/# /' log
        exit 1
    }
    blender --background --factory-startup --python-exit-code 1 --python "$HOODOO_TOP/tests/peers/lib/silhouette.py" -- \
        "$PWD/seen_$up" twelve 1004 "$PWD/camera.json" "$PWD/seen_$up.png" >log 2>&1 </dev/null || {
        echo "not ok blender draws the mesh with output.up $up"
        sed 's/^/# /' log
        exit 1
    }
    grep '^# ' log
    /usr/bin/python3 "$HOODOO_TOP/tests/peers/lib/alpha.py" compare "seen_$up/aov/twelve.1004.exr" "seen_$up.png" "output.up: $up"
done

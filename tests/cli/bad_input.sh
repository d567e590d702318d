#!/bin/sh
# Errors before and outside the simulation: each has the exit code of its kind and one line that names the cause.
set -u
job=$HOODOO_TOP/tests/restart/twelve.yaml

# check NAME COMMAND...: ok if the command succeeds.
. "$HOODOO_TOP/tests/lib/check.sh"

# refused CODE TEXT ARGUMENT...: hoodoo exits with CODE, its last line contains TEXT, and other lines are information.
refused() {
    want=$1
    text=$2
    shift 2
    timeout 60 "$HOODOO" "$@" >stdout 2>err </dev/null
    code=$?
    grep -vE '^hoodoo: (frames [0-9-]+(x[0-9]+)?, [0-9]+/[0-9]+$|about [0-9]+ particles)' err >errors
    [ $code = "$want" ] || { echo "# exit code $code, not $want"; return 1; }
    [ "$(wc -l <errors)" = 1 ] || { echo "# not one line"; return 1; }
    grep -q '^hoodoo: ' errors && grep -qF -- "$text" errors || { echo "# does not say: $text"; return 1; }
}

# job_with SED: bad.yaml, the job edited
job_with() {
    sed "$1" "$job" >bad.yaml
    ! cmp -s bad.yaml "$job" || echo "not ok the edit '$1' does something"
}

# line KEY[+N]: the line number of the key in the job.
line() {
    echo $(($(grep -n "^${1%+*}:" "$job" | cut -d: -f1) + $(case $1 in *+*) echo "${1#*+}" ;; *) echo 0 ;; esac)))
}

no_frames() {
    [ -z "$(find "$1" -name '*.json' -o -name '*.vdb' -o -name '*.exr' -o -name '*.ckpt' 2>/dev/null)" ]
}

# ---- the job

check "no such job" refused 3 "nothing.yaml: No such file" run nothing.yaml
check "a folder for a job" refused 3 "$HOODOO_TOP: not a regular file" run "$HOODOO_TOP"
: >empty.yaml
check "an empty job" refused 2 "empty.yaml" run empty.yaml
job_with 's/^noise: {amplitude/noise: {amplitud/'
check "an unknown key" refused 2 "bad.yaml:$(line noise):9: noise.amplitud: unknown key; did you mean amplitude?" run bad.yaml
job_with 's/spacing_m: 0.5/spacing_m: half/'
check "a wrong type" refused 2 "bad.yaml:$(line domain):42: domain.spacing_m: 'half'" run bad.yaml
job_with 's/^seed: 3/seed: 3\nseed: 4/'
check "a key given twice" refused 2 "bad.yaml:$(line seed+1):1: seed: given twice (first on line $(line seed))" run bad.yaml
job_with 's/abrasion: 0.55/abrasion: .nan/'
check "not a number" refused 2 "wind.abrasion: '.nan' is not a finite" run bad.yaml
job_with 's/abrasion: 0.55/abrasion: 1e999/'
check "beyond all numbers" refused 2 "wind.abrasion: '1e999'" run bad.yaml
job_with 's/spacing_m: 0.5/spacing_m: -1/'
check "out of range" refused 2 "domain.spacing_m" run bad.yaml
job_with 's/^frames: .*/frames: 1012-1001/'
check "frames backwards" refused 2 "frames" run bad.yaml
job_with 's/^scene:/scene: [/'
check "broken YAML" refused 2 "bad.yaml:" run bad.yaml
job_with 's/to_m: 6,/to_m: *six,/'
check "an alias" refused 2 "bad.yaml:$(line strata+1):12: anchors (&) and aliases (*) are not allowed" run bad.yaml
printf 'name: \000\377' >bad.yaml
check "bytes that are no text" refused 2 "bad.yaml:" run bad.yaml
job_with 's/cameras: \[main\]/cameras: [mian]/'
check "an unknown camera" refused 2 "output.aov.cameras" run bad.yaml
check "--set of an unknown key" refused 2 "--set wind.abrasionn: unknown key; did you mean abrasion?" run "$job" --set wind.abrasionn=3
check "--set of a wrong type" refused 2 "--set seed: 'x'" run "$job" --set seed=x
check "--set without a value" refused 2 "--set" run "$job" --set seed

# ---- the scene

job_with 's/max_m: \[[0-9]*, 6, [0-9]*\]/min_m: [20, 20, 20], max_m: [21, 21, 21]/; s/min_m: \[[0-9]*, 2, [0-9]*\], //'
check "no rock in the domain" refused 2 "scene: there is no rock in the domain" run bad.yaml --out empty
check "it leaves nothing that claims the folder" no_frames empty
job_with 's/\(min_m: \[[0-9]*, 2, \)0\]/\11.5]/'
check "rock in the air" refused 2 "scene: the rock floats in the air" run bad.yaml --out air
for model in arenite goblins; do
    for shape in "cylinder: {from_m: [8, 8, 0], to_m: [8, 8, 8], radius_m: 0.01, top_radius_m: 4}" "box: {min_m: [4, 4, 0.4], max_m: [12, 12, 8]}"; do
        printf '%s\n' "{hoodoo: 1, name: tip, frames: 1, model: $model, domain: {size_m: [16, 16, 12], spacing_m: 0.5}, scene: {$shape}}" >tip.yaml
        check "rock of which less than half a voxel touches the ground, $model" refused 2 "scene: the rock floats in the air: the lowest rock is at z = 0.5 m" run tip.yaml --out tip
    done
done
check "the corrected job may have the folder" sh -c '"$1" run "$2" --out air --frames 1001-1001 >stdout 2>err' - "$HOODOO" "$job"
job_with 's/- box: {min_m: \[2, 2, 0\].*/- mesh: {file: lost.obj}/'
check "a mesh that is not there" refused 3 "scene.union.1.mesh.file: $PWD/lost.obj: No such file" run ./bad.yaml
echo "v 0 0 zero" >lost.obj
check "a mesh that is none" refused 3 "lost.obj" run ./bad.yaml
job_with 's/- box: {min_m: \[2, 2, 0\].*/- heightfield: {file: lost.obj, min_m: [0, 0, 0], max_m: [16, 8, 4]}/'
check "an image that is none" refused 3 "lost.obj" run ./bad.yaml

# ---- options

check "frames outside the job" refused 2 "--frames 1010-1013: the job's frames are 1001-1012" run "$job" --out outside --frames 1010-1013
check "frames before the job" refused 2 "--frames 1-3: the job's frames are 1001-1012" run "$job" --out outside --frames 1-3
check "an unknown option" refused 2 "unknown option --outt; did you mean --out?" run "$job" --outt x
check "an unknown word for an option" refused 2 "--resume" run "$job" --resume maybe
check "--resume require, and nothing there" refused 7 "--resume require" run "$job" --out require --resume require
check "a block without the one before it" refused 7 "run the preceding block of frames first" run "$job" --out block --frames 1005-1008

# ---- the device

check "no Vulkan driver" env VK_ICD_FILENAMES=/nonexistent VK_DRIVER_FILES=/nonexistent sh -c '
    "$1" run "$2" --out driver --progress none 2>err; [ $? = 6 ] && [ "$(wc -l <err)" = 1 ] && grep -q "no Vulkan driver" err' - "$HOODOO" "$job"
check "no Vulkan driver: devices says so too" env VK_ICD_FILENAMES=/nonexistent VK_DRIVER_FILES=/nonexistent sh -c '
    "$1" devices 2>err; [ $? = 6 ] && [ "$(wc -l <err)" = 1 ]' - "$HOODOO"
check "no such device" refused 6 "--device 77: there is no such device; devices here: 0: " run "$job" --out device --device 77
check "no such device: uuid" refused 6 "--device uuid:00ff" run "$job" --out device --device uuid:00ff
check "no such device: pci" refused 6 "--device pci:0000:ff:00.0" run "$job" --out device --device pci:0000:ff:00.0
check "a device by a word" refused 2 "--device fastest: write auto" run "$job" --out device --device fastest
if "$HOODOO" devices --json | grep -qE '"type": "(discrete|integrated|virtual)"'; then
    echo "ok Slurm without a GPU # skipped: there is one here"
else
    check "Slurm without a GPU" env SLURM_JOB_GPUS=0 sh -c '
        "$1" run "$2" --out device --device slurm --progress none 2>err
        [ $? = 6 ] && [ "$(wc -l <err)" = 1 ] && grep -q -- "--device slurm: no GPU is visible" err' - "$HOODOO" "$job"
fi

# ---- memory

# refused_lean: refused as above, within 10 s and 1 GB
refused_lean() {
    /usr/bin/python3 - "$HOODOO" "$@" <<'END_PYTHON'
import resource, subprocess, sys, time
hoodoo, code, text, *arguments = sys.argv[1:]
start = time.monotonic()
done = subprocess.run([hoodoo, *arguments], stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
took, most = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1e6
open("err", "w").write(done.stderr)
lines = [line for line in done.stderr.splitlines() if not line.startswith("hoodoo: frames ")]
print(f"# {took:.1f} s, {most:.2f} GB")
sys.exit(not (done.returncode == int(code) and len(lines) == 1 and text in lines[0] and took < 10 and most < 1))
END_PYTHON
}
check "more memory than there is: both numbers, and what would fit" refused_lean 5 "particles in 1778 x 890 x 1334 voxels need " \
    run "$job" --out large --set domain.spacing_m=0.009
check "it says what would fit" grep -qE 'need [0-9]+\.[0-9] GB .*are free; domain\.spacing_m: 0\.[0-9]+ would fit$' err
check "no frame was begun" no_frames large
check "more voxels than can be counted" refused_lean 2 "domain.spacing_m above" run "$job" --out large --set domain.spacing_m=0.005
fits=$("$HOODOO" run "$job" --out large --set domain.spacing_m=0.009 2>&1 | sed -n 's/.*domain\.spacing_m: \([0-9.]*\) would fit$/\1/p')
check "what would fit is not refused by plan" sh -c '"$1" plan "$2" --set "domain.spacing_m=$3" >stdout 2>err' - "$HOODOO" "$job" "$fits"

# ---- the output folder

: >file
check "an output folder below a file" refused 4 "file" run "$job" --out file/out
check "an output folder that is a file" refused 4 "file" run "$job" --out file
check "an output folder below a device" refused 4 "/dev/null" run "$job" --out /dev/null/out
mkdir -p mounted
if mount -t tmpfs -o size=64k tmpfs mounted 2>/dev/null; then
    mount -o remount,ro mounted
    check "a disk that is read-only" refused 4 "mounted/out: cannot create the folder: Read-only" run "$job" --out mounted/out
    mount -o remount,rw mounted
    mkdir -p mounted/out/points mounted/out/volumes mounted/out/aov mounted/out/frames mounted/out/checkpoint mounted/out/log
    mount -o remount,ro mounted
    check "a folder that became read-only" refused 4 "mounted/out/" run "$job" --out mounted/out
    mount -o remount,rw mounted
    dd if=/dev/zero of=mounted/filler bs=1k 2>/dev/null
    check "a disk that is full from the start" refused 4 "No space left on device" run "$job" --out mounted/out
    umount mounted
else
    echo "ok read-only and full disks # skipped: no tmpfs can be mounted here"
fi
if [ "$(id -u)" != 0 ]; then
    mkdir -p locked && chmod 555 locked
    check "a folder without permission" refused 4 "locked" run "$job" --out locked/out
fi

#!/bin/sh
# A disk that fills: exit code 4, one line that names the file, and no partial file under a final name. Once there is space,
# the same command finishes with the same bytes. Needs root to mount a small tmpfs.
set -u
job=$HOODOO_TOP/tests/restart/twelve.yaml
. "$HOODOO_TOP/tests/lib/check.sh"
tree() {
    (cd "$1" && find . -type f ! -path './log/*' -exec sha256sum {} + | sort -k 2)
}

mkdir -p disk
if ! mount -t tmpfs -o size=4k tmpfs disk 2>/dev/null; then
    echo "ok a full disk # skipped: no tmpfs can be mounted here"
    exit 0
fi
trap 'umount disk' EXIT
"$HOODOO" run "$job" --out whole --progress none 2>err
check "an uninterrupted run" [ $? = 0 ]
tree whole >whole.sums
whole_kb=$(du -sk whole | cut -f 1)

tried=0
for share in 1 2 8 22 43 74 94; do
    tried=$((tried + 1))
    kb=$((whole_kb * share / 100))
    umount disk
    mount -t tmpfs -o "size=${kb}k" tmpfs disk
    "$HOODOO" run "$job" --out disk/out --progress none 2>err
    code=$?
    grep -vE '^hoodoo: (about|continuing|device time) ' err >errors
    check "$kb kB: exit code 4" [ $code = 4 ]
    check "$kb kB: one line" [ "$(wc -l <errors)" = 1 ]
    check "$kb kB: it names the file and says why" grep -qE '^hoodoo: disk/out/[^ :]*: .*No space left on device' errors
    cp errors "errors.$kb"
    tree disk/out >part.sums
    # A file under its final name equals that of the whole run, or is a checkpoint that the whole run removed later, or the
    # complete stage of the frames so far, or its record.
    check "$kb kB: nothing half-written" [ -z "$(grep -vxFf whole.sums part.sums | grep -v -e ' ./checkpoint/twelve\.10[01][0-9]\.ckpt$' \
        -e ' ./\(records/\)\{0,1\}twelve\.usda\(\.json\)\{0,1\}$')" ]
    [ ! -e disk/out/twelve.usda ] || check "$kb kB: the stage is whole" [ "$(tail -n 1 disk/out/twelve.usda)" = "}" ]
    for c in disk/out/checkpoint/*.ckpt; do
        [ ! -e "$c" ] || check "$kb kB: $(basename "$c") is sound" sh -c '"$1" inspect "$2" >/dev/null 2>err' - "$HOODOO" "$c"
    done
    mount -o remount,size=16m disk
    "$HOODOO" run "$job" --out disk/out --progress none 2>err
    check "$kb kB, then room: it finishes" [ $? = 0 ]
    tree disk/out >part.sums
    check "$kb kB, then room: the same bytes" cmp -s whole.sums part.sums
done
fault "disks that fill while a run writes" $tried "exit code 4, one message, no partial file; once there is space, the same bytes"

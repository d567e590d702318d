#!/bin/sh
# Unusual environments: closed descriptors, a limit on file sizes, a cache on a full disk, ignored signals. Frames are the
# same, or the exit code says why there are none.
set -u
job=$HOODOO_TOP/tests/restart/twelve.yaml
. "$HOODOO_TOP/tests/lib/check.sh"
run() { "$HOODOO" run "$job" --frames 1001-1002 --progress plain --out "$@"; }
same() {
    (cd "$1" && find . -type f ! -path './log/*' -exec sha256sum {} + | sort -k 2) >sums
    cmp -s sums whole.sums
}

: >err
run whole 2>err
check "a run" [ $? = 0 ]
same whole
cp sums whole.sums

run a <&-
check "without standard input: exit code 0" [ $? = 0 ]
check "without standard input: the same files" same a
run b >&- 2>&-
check "without standard output and error: exit code 0" [ $? = 0 ]
check "without standard output and error: the same files" same b
run c <&- >&- 2>&-
check "without any of them: exit code 0" [ $? = 0 ]
check "without any of them: the same files" same c
"$HOODOO" status whole >&- 2>err
check "what standard output should have had is an error where there is none" [ $? = 4 ]

(ulimit -f 8 && exec "$HOODOO" run "$job" --out d --progress none) 2>err
check "a limit on files' sizes: exit code 4" [ $? = 4 ]
check "a limit on files' sizes: one line names the file" sh -c \
    '[ "$(grep -cvE "^hoodoo: about " err)" = 1 ] && grep -q "^hoodoo: d/.*: .*File too large" err'

(trap '' HUP && exec "$HOODOO" run "$job" --frames 1001-1002 --out e --progress plain 2>err) &
until grep -q 'frame 1001' err 2>/dev/null; do sleep 0.05; done
kill -HUP $!
wait $!
check "a hangup that is ignored: exit code 0" [ $? = 0 ]
check "a hangup that is ignored: the same files" same e

# Existing files are read by a separate process, and files of a few kilobytes are read ahead.
cat >small.yaml <<END
hoodoo: 1
name: small
model: arches
frames: 1-2
domain: {size_m: [16, 12, 10], spacing_m: 1}
scene: {box: {min_m: [0, 0, 0], max_m: [16, 12, 7]}}
arches: {maps: true}
cameras: {main: {orbit: {target_m: [300, 6, 4], distance_m: 30}, resolution: [32, 24]}}
output: {aov: {cameras: [main]}}
END
"$HOODOO" run small.yaml --out small --progress none 2>err
check "small pictures and maps" [ $? = 0 ]
"$HOODOO" verify small >out 2>err
check "small pictures and maps are sound" [ $? = 0 ]
"$HOODOO" verify small <&- 2>&- >out
check "readers are started without descriptors" [ $? = 0 ]

mkdir disk
if mount -t tmpfs -o size=16k tmpfs disk 2>/dev/null; then
    dd if=/dev/zero of=disk/full bs=1k 2>/dev/null
    (unset MESA_SHADER_CACHE_DIR && XDG_CACHE_HOME=$PWD/disk run f 2>err)
    check "a cache on a full disk: exit code 0" [ $? = 0 ]
    check "a cache on a full disk: the same files" same f
    umount disk
else
    echo "ok a cache on a full disk # skipped: no tmpfs can be mounted here"
fi
(HOODOO_CACHE=$PWD/cache run h 2>err)
check "a cache of our own is made" [ -f cache/mesa_shader_cache/index ]

#!/bin/sh
# status, verify and inspect on the folder of a small run, first complete and then damaged.
set -u
. "$HOODOO_TOP/tests/lib/check.sh"

says() {
    want=$1
    shift
    "$HOODOO" "$@" >out 2>err </dev/null
    code=$?
    [ $code = "$want" ] || { echo "# exit code $code"; return 1; }
}

one_line() {
    [ "$(wc -l <err)" = 1 ] && grep -q '^hoodoo: ' err
}

cat >small.yaml <<'END'
hoodoo: 1
name: small
frames: 1001-1003
clock: {years_per_frame: 1000}
domain: {size_m: [8, 8, 8], spacing_m: 1}
scene: {box: {min_m: [2, 2, 0], max_m: [6, 6, 6]}}
strata: [{to_m: 8, weak_m_per_kyr: 0.2, strong_m_per_kyr: 0.002, interlock_MPa: 0.9}]
checkpoint: {every: 1, keep: 2}
END
check "a small run" says 0 run small.yaml --out out_small --progress plain
o=out_small
check "status" says 0 status $o
check "status: all done" grep -qE '^frames done +1001-1003$' out
check "status: two checkpoints" grep -qE '^checkpoints +1003 1002$' out
check "status --json" says 0 status $o --json
check "status --json is JSON" /usr/bin/python3 -c '
import json
s = json.load(open("out"))
assert (s["done"], s["missing"], s["damaged"], s["checkpoints"]) == (3, 0, 0, [1003, 1002]), s'
check "each frame's time is in the log" [ "$(grep -c '"seconds":' $o/log/frames.jsonl)" = 3 ]
# The rate comes from the log, whatever the times of files: the median, without lines that were cut.
printf '{"frame": 1001, "seconds": 2}\n{"frame": 1002, "seconds": 900}\n{"frame": 1003, "seconds": 2}\n{"frame": 1004, "sec' >$o/log/frames.jsonl
touch -d '2001-01-01' $o/frames/small.1001.json
check "status: a rate" says 0 status $o --json
check "status: the rate is that of the log" grep -qE '"frames_per_second": 0.5,' out
check "verify: all well" says 0 verify $o
check "verify --frames" says 0 verify $o --frames 1002-1003
for file in checkpoint/small.1003.ckpt volumes/small.1002.vdb frames/small.1002.json run.json; do
    check "inspect $file" says 0 inspect $o/$file
    check "inspect --json $file" says 0 inspect --json $o/$file
    check "that is JSON" /usr/bin/python3 -m json.tool out /dev/null
done

printf X | dd of=$o/checkpoint/small.1002.ckpt bs=1 seek=100 conv=notrunc 2>/dev/null
truncate -s -1 $o/volumes/small.1002.vdb
rm $o/frames/small.1003.json
check "status sees what needs no reading" says 0 status $o
check "status: damaged" grep -qE '^frames damaged +1002$' out
check "status: missing" grep -qE '^frames missing +1003$' out
check "verify fails" says 3 verify $o
check "verify: one line on stderr" one_line
check "verify names the checkpoint" grep -q '^damaged checkpoint/small.1002.ckpt: ' out
check "verify names the volumes" grep -q '^damaged volumes/small.1002.vdb: ' out
check "verify names the frame" grep -q '^missing frames/small.1003.json' out
check "verify names nothing else" [ "$(grep -cE '^(damaged|missing) ' out)" = 3 ]
check "verify --json" says 3 verify $o --json
check "verify --json has the same" /usr/bin/python3 -c '
import json
v = json.load(open("out"))
assert (v["damaged"], v["missing"], len(v["problems"])) == (2, 1, 3), v'
check "inspect refuses the damaged checkpoint" says 7 inspect $o/checkpoint/small.1002.ckpt
check "and the damaged volumes" says 3 inspect $o/volumes/small.1002.vdb

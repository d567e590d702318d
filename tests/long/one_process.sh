#!/bin/sh
# A process is six files: its own three, its keys with its row, what it has on the device, and its place in the frame. A copy of the
# tree gets one more that way, exfoliation; it must be in every place where processes are, with nothing else changed.
set -u
. "$HOODOO_TOP/tests/long/lib/tree.sh"
own=$HOODOO_TOP/tests/long/one_process
mkdir tree/src/exfoliation tree/shaders/exfoliation
cp "$own/exfoliation.c" "$own/exfoliation.h" tree/src/exfoliation
cp "$own/shed.comp.glsl" tree/shaders/exfoliation

keys=tree/src/job/keys.def
sed -i '/^    PROCESS(BLOCKS, blocks,/i \    PROCESS(EXFOLIATION, exfoliation, OF_MODEL(ARENITE), 8, "#6f7f4f", "sheets that come off", "skin that bare rock sheds") \\' $keys
sed -i '/^SECTION(deposition,/i SECTION(exfoliation, "bare rock that sheds its skin in sheets")\
CURVE(exfoliation, share_per_kyr, SIM, "1/kyr", 0, 0, 1000, "share of what is left of it that comes off", "")\
END(exfoliation)\
' $keys
sed -i '/^SUB(job, deposition,/i SUB(job, exfoliation, exfoliation, "exfoliation")' $keys
state=tree/src/model/arenite.h
sed -i 's|^#include "model/collapse.h"|#include "exfoliation/exfoliation.h"\n&|' $state
sed -i '/^    PART(collapse, LASTS_ROCK,/i \    PART(exfoliation, LASTS_ROCK, arenite_ever(job, exfoliation_wanted) ? exfoliation_bytes(n) : 0, \\\
         arenite_ever(a->m.whole, exfoliation_wanted) \\\
             ? exfoliation_create(a->m.gpu, a->particles.n_max, \&a->exfoliation) : OK) \\' $state
frame=tree/src/model/arenite.c
sed -i '/^\/\* One part of a step\. The stress/i \/* What comes off by itself. */\
static void exfoliate(struct arenite *a, double kyr)\
{\
    if (!exfoliation_wanted(a->m.job))\
        return;\
    gpu_stage(a->m.gpu, "exfoliation");\
    budget_before(a, PROCESS_EXFOLIATION);\
    exfoliation_step(a->m.gpu, \&a->exfoliation, a->m.job, a->m.frame, kyr, \&a->particles);\
    budget_after(a, PROCESS_EXFOLIATION);\
}\
' $frame
sed -i '/^    TRY(crumble(a, &n_eroded));/i \    exfoliate(a, kyr);' $frame

: >touched
for folder in Makefile src shaders render farm jobs; do
    diff -rqN "$HOODOO_TOP/$folder" "tree/$folder" | sed 's/^.* and tree.\([^ ]*\) differ$/\1/' >>touched
done
sed 's/^/# /' touched
[ "$(wc -l <touched)" = 6 ]
say $? "six files are touched"

build_tree process
make -C tree reference >make.log 2>&1 && grep -q '^| `exfoliation` | arenite | sheets that come off | skin that bare rock sheds |$' tree/jobs/README.md
say $? "the page of jobs lists it"

cat >block.yaml <<'J'
hoodoo: 1
name: block
frames: 1-5
clock: {years_per_frame: 1000}
domain: {size_m: [12, 10, 10], spacing_m: 0.5}
scene: {box: {min_m: [3, 3, 0], max_m: [9, 7, 8]}}
strata: [{weak_m_per_kyr: 0.1, interlock_MPa: 0.1}]
checkpoint: {every: 2}
J
try() {
    name=$1
    shift
    "$hoodoo" "$@" >log 2>&1
    code=$?
    [ $code = 0 ] || sed 's/^/# /' log
    say $code "$name"
}
try "it runs" run block.yaml --out o --progress none --set exfoliation.share_per_kyr=0.2
try "in pieces, too" run block.yaml --out pieces --progress none --frames 1-3 --set exfoliation.share_per_kyr=0.2
try "and goes on from a checkpoint" run block.yaml --out pieces --progress none --set exfoliation.share_per_kyr=0.2
for folder in points volumes frames; do
    diff -r o/$folder pieces/$folder
    say $? "continued from a checkpoint, $folder has the same bytes"
done
try "it runs without" run block.yaml --out off --progress none
try "it begins with an edit" run block.yaml --out late --progress none --set 'edits=[{frame: 4, set: {exfoliation.share_per_kyr: 0.2}}]'
try "the report is made" report o
grep -q 'sheets that come off' o/report/index.html && grep -q '#6f7f4f' o/report/index.html
say $? "the report names and draws it"
! "$hoodoo" run block.yaml --out no --set exfoliation.share_per_kyr=-1 >log 2>&1 && grep -q 'exfoliation.share_per_kyr' log
say $? "its key has a range"
for on in 0 0.2; do
    "$hoodoo" plan block.yaml --device none --json --set exfoliation.share_per_kyr=$on >plan.$on || say 1 "plan"
done
"$HOODOO" plan block.yaml --device none --json >plan.before || say 1 "plan"

/usr/bin/python3 - <<'P'
import json


def check(good, what):
    print("ok" if good else "not ok", what)


def frames(folder):
    return [json.load(open(f"{folder}/frames/block.000{f}.json")) for f in range(1, 6)]


def total(folder, process):
    return [frame["change_m3"][process] for frame in frames(folder)]


shed = total("o", "exfoliation")
check(shed[0] == 0 and all(x < -0.5 for x in shed[1:]), f"manifests have it: {shed}")
check(total("off", "exfoliation") == [0] * 5, "and nothing where it is off")
late = total("late", "exfoliation")
check(late[:3] == [0] * 3 and late[3] < 0 and late[4] < 0, f"and from an edit's frame on: {late}")
worst = 0
for now, before in zip(frames("o")[1:], frames("o")):
    lost = now["statistics"]["volume_m3"] - before["statistics"]["volume_m3"]
    worst = max(worst, abs(sum(now["change_m3"].values()) / lost - 1))
check(worst < 1e-6, f"the processes add up to the change, within {worst:.1e} of it")
order = list(frames("o")[0]["change_m3"])
check(order == ["edits", "deflation", "abrasion", "water", "deposition", "exfoliation", "blocks", "collapse"], f"in the table's order: {order}")
stages = {s["name"]: s["dispatches"] for line in open("o/log/timing.jsonl") for s in json.loads(line)["stages"]}
check(stages.get("exfoliation", 0) >= 3 * 4, f"timers have its stage: {stages}")
off = {s["name"] for line in open("off/log/timing.jsonl") for s in json.loads(line)["stages"]}
check("exfoliation" not in off, "and no such stage where it is off")
plan = {on: json.load(open(f"plan.{on}")) for on in ("before", "0", "0.2")}
check(plan["before"]["device_bytes"] == plan["0"]["device_bytes"], "a plan without it is what it was")
more = plan["0.2"]["device_bytes"] - plan["0"]["device_bytes"]
check(more == 4 * plan["0.2"]["particles"] > 0, f"a plan counts what it has on the device: {more} bytes")
P

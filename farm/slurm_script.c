#include "farm/slurm_script.h"

#include <stdlib.h>

#include "base/memory.h"
#include "base/version.h"
#include "base/visible.h"
#include "farm/command.h"
#include "farm/needs.h"
#include "farm/tries.h"

/* The commands of the batch, by their place in the array. */
static status put_cases(const struct farm *f, const struct farm_task *first, size_t n, const char *device,
                        struct text *t)
{
    status st = OK;
    struct farm_command *c = NULL;
    struct farm_needs needs;
    struct path log, tries;
    TRY(memory_alloc(1, sizeof *c, "a command", &c));
    text_add(t, "case ${SLURM_ARRAY_TASK_ID:-0} in\n");
    for (size_t i = 0; i < n; i++) {
        farm_needs(f, &first[i], device, &needs);
        TRY(farm_command(f, &first[i], device, needs.cpus, c));
        TRY(farm_log_path(f, &first[i], &log));
        TRY(tries_path(f, &first[i], &tries));
        text_add(t, "%zu)\n    task=%s\n    log=", i, first[i].name);
        farm_quote(t, log.text);
        text_add(t, "\n    tries=");
        farm_quote(t, tries.text);
        text_add(t, "\n    set --");
        for (size_t k = 0; k < c->n; k++) {
            text_add(t, " ");
            farm_quote(t, c->argv[k]);
        }
        text_add(t, "\n    ;;\n");
    }
    text_add(t, "*)\n    echo \"no task $SLURM_ARRAY_TASK_ID here\" >&2\n    exit %d\n    ;;\nesac\n",
             E_USAGE);
    TRY(text_status(t));
done:
    free(c);
    return st;
}

/* A job whose nodes are all excluded would be pending for ever, so it fails.
 *
 * Slurm signals only the batch script: USR1 before the time limit (--signal=B:), TERM to cancel, preempt or requeue. After TERM
 * Slurm decides what comes next, otherwise the script does. A signal interrupts `wait`, which is then started again.
 *
 * A requeue ends the script by TERM, so it ignores signals from there on. The job is pending then, which is when Slurm lets its
 * excluded nodes be changed. */
static const char body[] =
    "node=${SLURMD_NODENAME:-$(hostname)}\n"
    "say() { echo \"$(date +%Y-%m-%dT%H:%M:%S) hoodoo farm: $task on $node: $*\"; }\n"
    "note() { printf '{\"event\": %s}\\n' \"$1\" >>\"$tries\"; }\n"
    "exclude() {\n"
    "    note \"\\\"excluded\\\", \\\"node\\\": \\\"$node\\\"\"\n"
    "    bad=$(awk -F'\"' '/\"submitted\"/ { s = \"\" } /\"excluded\"/ { s = s (s == \"\" ? \"\" : \",\") $8 } END { print s }' \"$tries\")\n"
    "}\n"
    "none_left() {\n"
    "    own=$(scontrol show job \"$id\" | sed -n 's/.*ExcNodeList=\\([^ ]*\\).*/\\1/p' | sed '/(null)/d')\n"
    "    out=,$bad,$(scontrol show hostnames \"$own\" | tr '\\n' ,)\n"
    "    all=$(sinfo --noheader --Node --format=%N --partition=\"$SLURM_JOB_PARTITION\")\n"
    "    [ -n \"$all\" ] || return 1\n"
    "    for n in $all; do case $out in *,\"$n\",*) ;; *) return 1 ;; esac; done\n"
    "    note '\"stranded\"'\n"
    "    say \"failed: exit $rc; every node of partition $SLURM_JOB_PARTITION is excluded ($bad could not run it)\"\n"
    "}\n"
    "id=${SLURM_ARRAY_JOB_ID:+${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID}\n"
    "id=${id:-$SLURM_JOB_ID}\n"
    "pid= got= term= bad=\n"
    "pass() { got=1; [ -z \"$pid\" ] || kill -TERM \"$pid\" 2>/dev/null; }\n"
    "trap 'pass' USR1\n"
    "trap 'term=1; pass' TERM INT\n"
    "exec >>\"$log\" 2>&1\n"
    "say \"job $id, start $((${SLURM_RESTART_COUNT:-0} + 1)), GPU ${SLURM_JOB_GPUS:-none}\"\n"
    "note \"\\\"start\\\", \\\"node\\\": \\\"$node\\\", \\\"job\\\": \\\"$id\\\", \\\"time\\\": $(date +%s)\"\n"
    "begun=$SECONDS\n"
    "\"$@\" &\n"
    "pid=$!\n"
    "[ -z \"$got\" ] || kill -TERM \"$pid\" 2>/dev/null\n"
    "while :; do\n"
    "    got=\n"
    "    wait \"$pid\"\n"
    "    rc=$?\n"
    "    [ -n \"$got\" ] || break\n"
    "done\n"
    "note \"\\\"end\\\", \\\"exit\\\": $rc, \\\"seconds\\\": $((SECONDS - begun))\"\n"
    "case $rc in\n"
    "0)\n"
    "    say done\n"
    "    exit 0\n"
    "    ;;\n"
    "85)\n"
    "    [ -z \"$term\" ] || { say \"saved and stopped by Slurm\"; exit 85; }\n"
    "    say \"saved and stopped; queued again\"\n"
    "    ;;\n"
    "7)\n"
    "    tail -n 5 \"$log\" | grep -q -e '--resume other-' && bad=other\n"
    "    n=$(awk '/\"submitted\"/ { n = 0 } /\"excluded\"/ { n++ } END { print n + 0 }' \"$tries\")\n"
    "    [ -n \"$bad\" ] && [ \"$n\" -lt \"$retries\" ] || { say \"failed: exit 7; not tried again, as that cannot help\"; exit 7; }\n"
    "    exclude\n"
    "    ! none_left || exit 7\n"
    "    say \"exit 7: another device, driver or build than that of the frames; queued again without $bad\"\n"
    "    ;;\n"
    "2 | 8)\n"
    "    say \"failed: exit $rc; not tried again, as that cannot help\"\n"
    "    exit \"$rc\"\n"
    "    ;;\n"
    "126 | 127)\n"
    "    exclude\n"
    "    ! none_left || exit \"$rc\"\n"
    "    say \"exit $rc: this node cannot run $1; queued again without $bad\"\n"
    "    ;;\n"
    "*)\n"
    "    [ -z \"$term\" ] || { say \"stopped by Slurm: exit $rc\"; exit \"$rc\"; }\n"
    "    n=$(awk '/\"submitted\"/ { n = 0 } /\"exit\": / && !/\"exit\": (0|7|85|126|127),/ { n++ } END { print n + 0 }' \"$tries\")\n"
    "    [ \"$n\" -le \"$retries\" ] || { say \"failed $n times, the last with exit $rc\"; exit \"$rc\"; }\n"
    "    say \"exit $rc; queued again (try $((n + 1)) of $((retries + 1)))\"\n"
    "    ;;\n"
    "esac\n"
    "trap '' TERM INT USR1\n"
    "scontrol requeue \"$id\" || say \"scontrol could not requeue: left to RequeueExit=85\"\n"
    "if [ -n \"$bad\" ]; then\n"
    "    scontrol update JobId=\"$id\" ExcNodeList=\"$bad${own:+,$own}\" || say \"scontrol could not exclude $bad\"\n"
    "fi\n"
    "exit 85\n";

status slurm_script(const struct farm *f, const struct farm_task *task, size_t n, const char *device,
                    struct text *t)
{
    status st = OK;
    struct farm_needs needs;
    farm_needs(f, task, device, &needs);
    text_add(
        t,
        "#!/bin/bash\n# Written by hoodoo %s submit --to slurm. It can be run again at any time: what is done is not done twice.\nretries=%d\n",
        hoodoo_version, farm_retries(f, task));
    text_add(t, "export HOODOO_DISK_DELAY=${HOODOO_DISK_DELAY:-%d}\n", VISIBLE_DELAY_S);
    text_add(t, "export OMP_NUM_THREADS=${OMP_NUM_THREADS:-%d}\n", needs.cpus);
    if (!needs.gpu)
        text_add(t, "export LP_NUM_THREADS=${LP_NUM_THREADS:-%d}\n", needs.cpus);
    TRY(put_cases(f, task, n, device, t));
    text_add(t, "%s", body);
    TRY(text_status(t));
done:
    return st;
}

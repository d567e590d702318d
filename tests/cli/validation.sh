#!/bin/sh
# Two frames under the Khronos validation layer, with its default checks and with synchronisation validation, give no message.
set -u
job=$HOODOO_TOP/tests/restart/twelve.yaml
layer=VK_LAYER_KHRONOS_validation

check() {
    name=$1
    shift
    if "$@"; then echo "ok $name"; else
        echo "not ok $name"
        grep -E 'Validation|SYNC|UNASSIGNED|VUID|^hoodoo: ' log | head -n 20 | sed 's/^/# /'
    fi
}

# validated PROGRAM ARGUMENT...: runs under the layer with the settings in $settings; output goes to log.
validated() {
    env VK_INSTANCE_LAYERS=$layer VK_LAYER_ENABLES="$settings" VK_LOADER_DEBUG=layer "$@" >log 2>&1
}
complaints='Validation (Error|Warning)|SYNC-HAZARD|UNASSIGNED-|VUID-'

for settings in "" VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT; do
    kind=${settings:+synchronisation}
    kind=${kind:-core}
    validated "$HOODOO" run "$job" --frames 1001-1003 --out "$kind"
    check "$kind validation: the run succeeds" [ $? = 0 ]
    check "$kind validation: the layer was in place" grep -q "Inserted device layer \"$layer\"" log
    check "$kind validation: not one complaint" sh -c '! grep -qE "$1" log' - "$complaints"
    validated "$HOODOO" run "$job" --frames 1001-1002 --out "$kind-flow" --set wind.flow.solver=sph --set wind.flow.spacing_m=2 \
        --set wind.flow.flushes=0.1 --set erosion.max_step=1 --set rain.m_per_yr=0.4 --set rain.erosion=2
    check "$kind validation: the run with flowing wind and water succeeds" [ $? = 0 ]
    check "$kind validation: not one complaint about the flow" sh -c '! grep -qE "$1" log' - "$complaints"
    validated "$HOODOO" run "$HOODOO_TOP/tests/gpu/falling.yaml" --frames 1001-1003 --out "$kind-falling"
    check "$kind validation: the run of falling rock succeeds" [ $? = 0 ]
    check "$kind validation: not one complaint about falling rock" sh -c '! grep -qE "$1" log' - "$complaints"
    validated "$HOODOO" run "$job" --frames 1001-1002 --out "$kind-blocks" --set collapse.blocks=fall --set collapse.joints_m=2 \
        --set stress.solver=mpm --set 'scene={union: [{box: {min_m: [2, 2, 0], max_m: [8, 6, 3]}}, {box: {min_m: [3, 3, 5], max_m: [6, 5, 7]}}]}'
    check "$kind validation: the run of blocks that fall succeeds" [ $? = 0 ]
    check "$kind validation: not one complaint about blocks that fall" sh -c '! grep -qE "$1" log' - "$complaints"
    # A faulty program, to check that messages are detected.
    validated "$(dirname "$HOODOO")/tests/gpu/test_validation" wrongly
    check "$kind validation: it complains where there is reason to" grep -qE "$complaints" log
    check "$kind validation: what is not given back is a reason" grep -q VUID-vkDestroyDevice-device log
done
check "synchronisation validation: a missing barrier is a reason" grep -q SYNC-HAZARD-WRITE-AFTER-WRITE log
check "the layer changes no bytes" diff -r -x log core synchronisation
# Best practices. Buffers of the smallest jobs are small, each has its own memory, and command buffers are reset one by one, since three are in
# use in turn; the loader asks for device properties without a count. (long/gpu_assisted.sh has the checks that are compiled into kernels.)
known='small-allocation|small-dedicated-allocation|CreateCommandPool-command-buffer-reset|DevLimit-(MissingQueryCount|CountMismatch)'
printf 'khronos_validation.%s\n' 'debug_action = VK_DBG_LAYER_ACTION_LOG_MSG' 'report_flags = error,warn,perf' 'log_filename = stdout' \
    'enables = VK_VALIDATION_FEATURE_ENABLE_BEST_PRACTICES_EXT' >vk_layer_settings.txt
for file in "$job" "$HOODOO_TOP/tests/gpu/falling.yaml"; do
    name=$(basename "$file" .yaml)
    VK_LAYER_SETTINGS_PATH=$PWD VK_INSTANCE_LAYERS=$layer VK_LOADER_DEBUG=layer "$HOODOO" run "$file" --frames 1001 --device cpu \
        --out "best-$name" --progress none >log 2>&1
    check "best practices, $name: the run succeeds under the layer" sh -c '[ $1 = 0 ] && grep -q "Inserted device layer" log' - $?
    check "best practices, $name: nothing but what is known" sh -c '! grep -E "$1" log | grep -vE "$2" | grep -q .' - "$complaints" "$known"
done

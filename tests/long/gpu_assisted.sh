#!/bin/sh
# A frame of each model under the validation layer's GPU-assisted checks, which are compiled into the kernels: no access outside a buffer.
# Each kernel is compiled anew with the checks: minutes for each model.
set -u
. "$HOODOO_TOP/tests/lib/check.sh"
layer=VK_LAYER_KHRONOS_validation
printf 'khronos_validation.%s\n' 'debug_action = VK_DBG_LAYER_ACTION_LOG_MSG' 'report_flags = error,warn' 'log_filename = stdout' \
    'enables = VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_EXT' >vk_layer_settings.txt
for job in restart/twelve gpu/falling; do
    VK_LAYER_SETTINGS_PATH=$PWD VK_INSTANCE_LAYERS=$layer VK_LOADER_DEBUG=layer "$HOODOO" run "$HOODOO_TOP/tests/$job.yaml" --frames 1001 \
        --device cpu --out "$(basename $job)" --progress none >log 2>&1
    check "$job: the run succeeds under the layer" sh -c '[ $1 = 0 ] && grep -q "Inserted device layer" log' - $?
    check "$job: no complaint" sh -c '! grep -qE "Validation (Error|Warning)|UNASSIGNED-|VUID-" log'
done

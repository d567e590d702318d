#!/bin/sh
# lint.sh PACKAGE...: both compilers' warnings, the layout, headers that stand alone, and the walls between folders.
set -u
sh tests/deps.sh "$@" || exit 1
bad=0
say() {
    echo "lint: $*"
    bad=1
}
flags="-std=c11 -D_GNU_SOURCE -Isrc -Ishaders -I. -Ibuild/gen -Itests -isystem /usr/include/OpenEXR -isystem /usr/include/Imath"
warnings="-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror"
make -s build/gen/gpu/kernels.h build/gen/gpu/kernels.c || exit 1
for f in $(git ls-files 'src/*.c' 'render/*.c' 'farm/*.c'); do
    extra=
    [ "$f" = src/base/version.c ] && extra='-DHOODOO_VERSION="" -DHOODOO_COMMIT=""'
    # shellcheck disable=SC2086 # lists of flags
    gcc $flags $warnings $extra -fopenmp -fsyntax-only "$f" || say "gcc warns of $f"
    # shellcheck disable=SC2086
    clang $flags $warnings $extra -Wno-unknown-pragmas -fsyntax-only "$f" || say "clang warns of $f"
done
for h in $(git ls-files 'src/*.h' 'render/*.h' 'farm/*.h'); do
    # shellcheck disable=SC2086
    printf '#include "%s"\n' "$h" | gcc $flags $warnings -fsyntax-only -x c - || say "$h does not stand alone"
done
files=$(git ls-files '*.c' '*.h' '*_shim.cpp' '*.hpp')
# shellcheck disable=SC2086
clang-format --dry-run --Werror $files || say "the layout differs; run make format"
git grep -nE '\bVk[A-Z]|\bvk[A-Z]' -- 'src/*.c' 'src/*.h' 'render' ':!src/gpu' && say "Vulkan outside src/gpu"
git grep -nE 'std::|openvdb::' -- '*.c' '*.h' && say "C++ outside *_shim.cpp"
# Includes point down: a folder may include those of lower rank, and itself.
rank() {
    case $1 in
    base) echo 0 ;; gpu | job | mesh) echo 1 ;; particles | stacks) echo 2 ;;
    scene | stress | erosion | blocks | mpm | voxels | field | output | checkpoint | wind | water | deposit | plants | piles) echo 3 ;;
    frame) echo 4 ;; model) echo 5 ;; run) echo 6 ;; farm) echo 7 ;; render) echo 8 ;; cli) echo 9 ;; *) echo 10 ;;
    esac
}
for f in $(git ls-files 'src/*/*.c' 'src/*/*.h' 'src/*/*_shim.cpp' 'farm/*.c' 'farm/*.h' 'render/*.c' 'render/*.h'); do
    own=$(basename "$(dirname "$f")")
    for other in $(sed -n 's|^#include "\([a-z]*\)/.*|\1|p' "$f" | sort -u); do
        case $other in "$own" | shared) continue ;; esac
        [ "$(rank "$other")" -lt "$(rank "$own")" ] || echo "$f includes $other/"
    done
done >build/lint-includes
[ -s build/lint-includes ] && cat build/lint-includes && say "includes that do not point down"
for f in $(git ls-files '*.sh'); do sh -n "$f" || say "$f"; done
[ $bad = 0 ] && echo "lint: nothing to say"
exit $bad

#!/bin/sh
# lint.sh: a TAP line for each rule: warnings of both compilers, the layout, headers that compile alone, boundaries between
# folders, and the prose of pages (prose.py). Exits with 1 if a rule fails. Needs DEV_PACKAGES of the Makefile, build/gen and
# build/hoodoo.
set -u
cd "$(dirname "$0")/.." || exit 1
flags="-std=c11 -D_GNU_SOURCE -Isrc -Ishaders -I. -Ibuild/gen -Itests -isystem /usr/include/OpenEXR -isystem /usr/include/Imath"
warnings="-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror"
# shellcheck disable=SC2089 # the quotes are the compiler's
version='-DHOODOO_VERSION="" -DHOODOO_COMMIT="" -DHOODOO_BUILD=""'
said=$(mktemp)
failed=0
trap 'rm -f "$said"' EXIT

# rule NAME COMMAND...: the rule holds if the command succeeds without output.
rule() {
    name=$1
    shift
    if "$@" >"$said" 2>&1 && [ ! -s "$said" ]; then
        echo "ok $name"
    else
        echo "not ok $name"
        failed=1
        sed 's/^/# /' "$said"
    fi
}
# each COMMAND...: runs the command for each file name on stdin, on all cores.
each() {
    xargs -P "$(nproc)" -n 1 "$@"
}
none() {
    ! "$@"
}

sources() {
    # shellcheck disable=SC2086,SC2090 # lists of flags
    git ls-files 'src/*.c' 'render/*.c' 'farm/*.c' | each "$@" $flags $warnings $version -fsyntax-only
}
[ -n "$(git ls-files 'src/*.c')" ] || { echo "not ok git lists the files"; exit 1; }
rule "no warnings from gcc" sources gcc -fopenmp
rule "no warnings from clang" sources clang -Wno-unknown-pragmas

headers() {
    git ls-files 'src/*.h' 'render/*.h' 'farm/*.h' | FLAGS="$flags $warnings" each sh -c \
        'printf "#include \"%s\"\nextern int standing_alone;\n" "$1" | gcc $FLAGS -fsyntax-only -x c - || echo "of $1"' -
}
rule "every header compiles alone" headers

layout() {
    git ls-files '*.c' '*.h' '*_shim.cpp' '*.hpp' | xargs -P "$(nproc)" -n 40 clang-format --dry-run --Werror
}
rule "the layout is that of .clang-format (run make format)" layout

rule "no Vulkan outside src/gpu" none git grep -InE '\bVk[A-Z]|\bvk[A-Z]' -- 'src/*.c' 'src/*.h' 'render' ':!src/gpu'
rule "only src/base/path.c formats file names and joins paths" none git grep -nE \
    '%04d|char [a-z_]*(path|root|folder|file|name|from|to|out)\[[0-9]{4}\]|%\.[34][0-9]{3}s' -- src render farm ':!src/base/path.c'
rule "properties of models are looked up with job_model()" none git grep -nE 'model *[!=]=|[!=]= *MODEL_' -- '*.c' '*.h'
rule "no C++ outside *_shim.cpp" none git grep -nE 'std::|openvdb::' -- '*.c' '*.h'

# A folder may include folders of lower rank, and itself. A folder that is not named here is a process, a solver or writes files: 7.
rank() {
    case $1 in
    base) echo 0 ;; text) echo 1 ;; system) echo 2 ;; gltf) echo 3 ;; gpu | job | mesh | reader) echo 4 ;;
    particles | stacks | geology | image | meshinput) echo 5 ;; shape) echo 6 ;; usd | checkpoint) echo 8 ;; frame) echo 9 ;;
    resample) echo 8 ;; model) echo 10 ;; run) echo 11 ;; farm) echo 12 ;; render) echo 13 ;; look | selftest) echo 14 ;; cli) echo 15 ;; *) echo 7 ;;
    esac
}
includes() {
    for f in $(git ls-files 'src/*/*.c' 'src/*/*.h' 'src/*/*_shim.cpp' 'farm/*.c' 'farm/*.h' 'render/*.c' 'render/*.h'); do
        own=$(basename "$(dirname "$f")")
        for other in $(sed -n 's|^#include "\([a-z]*\)/.*|\1|p' "$f" | sort -u); do
            case $other in "$own" | shared) continue ;; esac
            [ "$(rank "$other")" -lt "$(rank "$own")" ] || echo "$f includes $other/"
        done
    done
}
rule "includes point down" includes

scripts() {
    git ls-files '*.sh' | each sh -n
}
rule "shell scripts parse" scripts

/usr/bin/python3 tests/prose.py build/hoodoo || failed=1
exit $failed

#!/bin/sh
# tidy.sh: clang-tidy and cppcheck on all C of the product: minutes of CPU time (`make tidy`). Exits with 1 if one finds something.
# Not asked for: swappable parameters (a matter of taste), reserved identifiers (_GNU_SOURCE), and the functions of C11's Annex K, which no
# library has. cppcheck cannot expand the list macros of base/choice.h; readdir() is safe on a directory of one's own.
set -u
cd "$(dirname "$0")/.." || exit 1
checks='-*,clang-analyzer-*,bugprone-*,-bugprone-easily-swappable-parameters,-bugprone-reserved-identifier,-clang-analyzer-security.insecureAPI.*'
found=$(mktemp)
trap 'rm -f "$found"' EXIT
git ls-files 'src/*.c' 'farm/*.c' 'render/*.c' | CHECKS=$checks xargs -P "$(nproc)" -n 6 sh -c 'clang-tidy --quiet "--checks=$CHECKS" "$@" -- \
    -std=c11 -D_GNU_SOURCE -DHOODOO_VERSION=\"\" -DHOODOO_COMMIT=\"\" -DHOODOO_BUILD=\"\" -Isrc -Ishaders -I. -Ibuild/gen -isystem /usr/include/OpenEXR \
    -isystem /usr/include/Imath' - 2>/dev/null | grep -E 'warning:|error:' | sort -u >>"$found"
cppcheck -j "$(nproc)" --std=c11 --enable=warning,performance,portability --inline-suppr --quiet --library=posix -Isrc -Ishaders -I. -Ibuild/gen \
    --suppress=missingIncludeSystem --suppress=preprocessorErrorDirective:src/base/choice.h --suppress=readdirCalled \
    --suppress=legacyUninitvar:render/png.c --suppress=legacyUninitvar:src/gpu/buffer.c --template='{file}:{line}: {id}: {message}' \
    src farm render >>"$found" 2>&1
cat "$found"
[ ! -s "$found" ] && echo "ok clang-tidy and cppcheck find nothing"

#!/bin/sh
# tidy.sh: clang-tidy and cppcheck on all C of the product: minutes of CPU time (`make tidy`). Exits with 1 if one finds something.
# Not asked for: matters of taste (swappable parameters, parentheses of macros' arguments), what -Wconversion or a test says better
# (conversions, widening, memcmp() where bits are meant), _GNU_SOURCE, Annex K, which no library has, vfork(), as it is used by the book, and
# clang's analysis of values: it assumes that functions in other files fail without an error, or succeed without a result. cppcheck cannot
# expand the list macros of base/choice.h, and some compound literals; readdir() is safe on a directory of one's own.
set -u
cd "$(dirname "$0")/.." || exit 1
checks='-*,bugprone-*,clang-analyzer-deadcode.*,clang-analyzer-unix.*,-clang-analyzer-unix.Vfork,-bugprone-easily-swappable-parameters'
checks=$checks',-bugprone-reserved-identifier,-bugprone-macro-parentheses,-bugprone-sizeof-expression,-bugprone-narrowing-conversions'
checks=$checks',-bugprone-implicit-widening-of-multiplication-result,-bugprone-suspicious-memory-comparison,-bugprone-integer-division'
checks=$checks',-bugprone-signed-char-misuse,-bugprone-misplaced-widening-cast'
found=$(mktemp)
trap 'rm -f "$found"' EXIT
git ls-files 'src/*.c' 'farm/*.c' 'render/*.c' | CHECKS=$checks xargs -P "$(nproc)" -n 6 sh -c 'clang-tidy --quiet "--checks=$CHECKS" "$@" -- \
    -std=c11 -D_GNU_SOURCE -DHOODOO_VERSION=\"\" -DHOODOO_COMMIT=\"\" -DHOODOO_BUILD=\"\" -Isrc -Ishaders -I. -Ibuild/gen -isystem /usr/include/OpenEXR \
    -isystem /usr/include/Imath' - 2>/dev/null | grep -E 'warning:|error:' | sort -u >>"$found"
cppcheck -j "$(nproc)" --std=c11 --enable=warning,performance,portability --inline-suppr --quiet --library=posix -Isrc -Ishaders -I. -Ibuild/gen \
    --suppress=missingIncludeSystem --suppress=preprocessorErrorDirective:src/base/choice.h --suppress=readdirCalled \
    --suppress=legacyUninitvar:render/png.c --suppress=legacyUninitvar:src/gpu/buffer.c --suppress=internalAstError:src/gpu/record.c --template='{file}:{line}: {id}: {message}' \
    src farm render >>"$found" 2>&1
cat "$found"
[ ! -s "$found" ] && echo "ok clang-tidy and cppcheck find nothing"

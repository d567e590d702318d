#!/bin/sh
# The hash of a build is independent of its folder and of comments, and changes with compiler flags.
set -u
say() {
    [ "$1" = 0 ] && echo "ok - $2" || echo "not ok - $2"
}
mkdir top
for part in Makefile src shaders farm render tests; do
    cp -r "$HOODOO_TOP/$part" top || exit 1
done
# A few object files represent all.
hash() {
    build=$1
    shift
    env -u MAKEFLAGS -u MAKELEVEL make -C top BUILD="$build" COMPUTES="$build/src/base/hash.o $build/src/text/text.o $build/src/job/curve.o" "$@" "$build/gen/build" >log 2>&1 || cat log
    cat "top/$build/gen/build"
}
first=$(hash build)
[ ${#first} = 16 ]
say $? "it is 16 digits"
[ "$first" = "$(hash build-elsewhere/and/deeper)" ]
say $? "another folder: the same"
[ "$first" = "$(hash build-bare OPT=-O2)" ]
say $? "without debug information: the same"
for file in src/base/hash.c src/text/text.c src/job/curve.c; do
    sed -i '1i /* a word more */' "top/$file"
done
[ "$first" = "$(hash build-comments)" ]
say $? "other comments: the same"
[ "$first" != "$(hash build-flags OPT=-O1)" ]
say $? "other flags: another"
[ "$first" != "$(hash build-version VERSION=9.9.9)" ]
say $? "another version: another"

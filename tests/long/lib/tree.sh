# For a script that changes the tree: ./tree is a copy of it with what was built of it. Once changed, build_tree.
say() {
    if [ "$1" = 0 ]; then echo "ok $2"; else echo "not ok $2"; fi
}
mkdir tree
(cd "$HOODOO_TOP" && cp -a Makefile src shaders render farm jobs tests "$OLDPWD/tree") || exit 1
cp -a "$(dirname "$HOODOO")" tree/build || exit 1

# build_tree WHAT: with one more of what; $hoodoo is then its program
build_tree() {
    make -C tree build/hoodoo >make.log 2>&1 || {
        grep -E 'error|warning' make.log | head -20
        echo "not ok the tree builds with one more $1"
        exit 1
    }
    ! grep -q warning make.log
    say $? "the tree builds with one more $1, without warnings"
    hoodoo=$PWD/tree/build/hoodoo
    export HOODOO_LIBEXEC="$PWD/tree/build" # what stands beside it is of its build
}

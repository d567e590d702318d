# For shell tests. check NAME COMMAND...: prints a TAP line; if the command fails, also the last lines of the files `out`, `err` and
# `log`, if they exist.
checks_failed=0
check() {
    name=$1
    shift
    if "$@"; then
        echo "ok $name"
        return
    fi
    echo "not ok $name"
    checks_failed=$((checks_failed + 1))
    for said in out err log; do
        [ ! -f "$said" ] || tail -n 20 "$said" | sed "s/^/# $said: /"
    done
}

# fault KIND TRIED WHAT: prints a row of the table in tests/README.md, as fault() in script.py.
fault() {
    echo "# fault | $1 | $2 | $3 | $checks_failed |"
}

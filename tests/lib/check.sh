# For tests in sh. check NAME COMMAND...: a TAP line; where the command fails, with the last that `out`, `err` and `log` say, those
# that there are.
check() {
    name=$1
    shift
    if "$@"; then
        echo "ok $name"
        return
    fi
    echo "not ok $name"
    for said in out err log; do
        [ ! -f "$said" ] || tail -n 20 "$said" | sed "s/^/# $said: /"
    done
}

#!/bin/sh
# Help texts, and messages about wrong command lines.
set -u
VERBS="run check new keys plan submit status verify mesh preview inspect devices selftest"

# check NAME COMMAND...: ok if the command succeeds.
. "$HOODOO_TOP/tests/lib/check.sh"

# says CODE COMMAND...: runs hoodoo; true if it exits with CODE
says() {
    want=$1
    shift
    "$HOODOO" "$@" >out 2>err </dev/null
    code=$?
    [ $code = "$want" ] || { echo "# exit code $code"; return 1; }
}

one_line() {
    [ "$(wc -l <err)" = 1 ] && grep -q '^hoodoo: ' err
}

help_is_good() {
    says 0 "$@" && [ ! -s err ] && grep -q '^usage: hoodoo' out && ! grep -n '.\{81\}' out
}

refused() {
    hint=$1
    shift
    says 2 "$@" && one_line && grep -qF -- "$hint" err
}

for option in -h --help help; do
    check "hoodoo $option" help_is_good $option
done
check "the help lists every exit code" grep -q '^  85 ' out
for verb in $VERBS; do
    check "the help lists $verb" grep -q "^  $verb " out
done
for verb in $VERBS; do
    check "$verb -h" help_is_good "$verb" -h
    check "$verb --help" help_is_good "$verb" --help
    check "$verb refuses an unknown option" refused "unknown option --jsonn" "$verb" --jsonn x
done
check "the nearest option is named" refused "did you mean --json?" status --jsonn x
check "the nearest verb is named" refused "did you mean 'hoodoo run'?" rnu job.yaml
check "far verbs are not" refused "'hoodoo --help' lists" sandcastle
check "a missing operand" refused "OUT is missing" status
check "an operand too many" refused "unexpected argument 'b'" status a b
check "a missing value" refused "--frames requires a value" status --frames
check "a bad range" refused "not a frame range" status --frames 1..5 x
check "no verb: help, but not success" says 2
check "no verb: one line on stderr" one_line
check "--version" says 0 --version
check "--version names it" grep -qE '^hoodoo [0-9]+\.[0-9]+\.[0-9]+ \(' out
printf 'terminal \033[31mred\n' >"$(printf 'odd\033name')"
check "inspect refuses other files" says 3 inspect "$(printf 'odd\033name')"
check "and lets no control characters through" sh -c '! grep -q "$(printf "\033")" err'
check "inspect refuses folders" says 3 inspect .
check "inspect refuses what is not there" says 3 inspect nothing.vdb
check "status refuses what is no output folder" says 3 status .
check "verify refuses what is no output folder" says 3 verify .
if [ -w /dev/full ]; then
    "$HOODOO" --help >/dev/full 2>err
    check "a full disk behind stdout is noticed" [ $? = 4 ]
fi

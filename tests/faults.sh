#!/bin/sh
# faults.sh ROWS: the rows that campaigns of faults have printed are those of the table in tests/README.md, or they are said, and a line of
# counts for run.sh says that it failed. With HOODOO_FAULTS=write they are put there instead (`make faults`). Other efforts than the
# usual one try other numbers, and are not compared.
set -u
rows=$1 page=$(dirname "$0")/README.md
[ -s "$rows" ] || exit 0
if [ "${HOODOO_FAULTS:-}" = write ]; then
    # A row is its command's: those that were not run stay.
    awk -F '|' 'NR == FNR { fresh[$6] = fresh[$6] $0 "\n"; next }
        /^\| .*sh tests\/run.sh build/ { if (!($6 in fresh)) print; else if (!($6 in done)) { printf "%s", fresh[$6]; done[$6] } ; next }
        /^<!-- end of the table -->/ { for (c in fresh) if (!(c in done)) printf "%s", fresh[c] }
        { print }' "$rows" "$page" >"$page.new" && mv "$page.new" "$page"
    exit 0
fi
[ "${HOODOO_TEST_EFFORT:-1}" = 1 ] || exit 0
grep -vxFf "$page" "$rows" >"$rows.new" || exit 0
sed 's/^/not in tests\/README.md, or otherwise: /' "$rows.new" >&2
echo "0 1 0 faults 0"

#!/bin/sh
# What tests draw at random, five times as often, and the cases that they leave out of their lists (tests/effort.h).
export HOODOO_TEST_EFFORT=5
for source in $(cd "$HOODOO_TOP/tests" && grep -lE 'effort(_of|_takes)?\(|damage_(fuzz|flip)' unit/*.c gpu/*.c physics/*.c); do
    "$(dirname "$HOODOO")/tests/${source%.c}" 2>&1 || echo "not ok ${source%.c} ends well"
done

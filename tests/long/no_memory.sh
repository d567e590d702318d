#!/bin/sh
# Every allocation of a command finds no memory once, where it has an asker of its own. Takes hours.
NO_MEMORY=all /usr/bin/python3 "$HOODOO_TOP/tests/restart/no_memory.py"

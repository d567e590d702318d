#!/bin/sh
# All requests of tests/cli/image_formats.py.
HOODOO_FORMATS=all exec /usr/bin/python3 "$HOODOO_TOP/tests/cli/image_formats.py"

#!/bin/sh
# embed.sh FILE...: the files as C, each an array of lines ending in NULL: a/sandstone.inc becomes scene_sandstone,
# a/report.html, a/style.css and a/script.js become page_report, page_style and page_script.
# Lines, not one text: C compilers need not take literals of more than 4095 bytes.
set -eu
echo '/* Made by render/embed.sh. */'
echo '#include "render/page_parts.h"'
echo '#include "render/scene_parts.h"'
for file; do
    name=$(basename "$file")
    case $name in *.inc) name=scene_${name%.inc} ;; *) name=page_${name%.*} ;; esac
    echo
    echo "const char *const $name[] = {"
    sed -e 's/\\/\\\\/g' -e 's/"/\\"/g' -e 's/^/    "/' -e 's/$/\\n",/' "$file"
    echo '    NULL};'
done

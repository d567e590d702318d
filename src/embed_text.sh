#!/bin/sh
# embed_text.sh FILE...: prints the files as C, each as an array of lines that ends with NULL. a/sandstone.inc becomes
# scene_sandstone; a/report.html, a/style.css and a/script.js become page_report, page_style and page_script; jobs become rows of
# job_examples. The text is split into lines because C compilers need not accept literals of more than 4095 bytes.
set -eu
echo '/* Made by src/embed_text.sh. */'
for file; do
    case $file in
    *.yaml) echo '#include "cli/examples.h"' ;;
    *.inc) echo '#include "render/scene_parts.h"' ;;
    *) echo '#include "render/page_parts.h"' ;;
    esac
done | sort -u
rows=
for file; do
    name=$(basename "$file")
    case $name in
    *.inc) array="const char *const scene_${name%.inc}" ;;
    *.yaml)
        array="static const char *const job_${name%.yaml}"
        rows="$rows    {\"${name%.yaml}\", job_${name%.yaml}},
"
        ;;
    *) array="const char *const page_${name%.*}" ;;
    esac
    echo
    echo "$array[] = {"
    sed -e 's/\\/\\\\/g' -e 's/"/\\"/g' -e 's/^/    "/' -e 's/$/\\n",/' "$file"
    echo '    NULL};'
done
[ -z "$rows" ] || printf '\nconst struct job_example job_examples[] = {\n%s    {NULL, NULL}};\n' "$rows"

#!/bin/sh
# gallery.sh HOODOO [JOB...]: draws the jobs in this folder (all of them, or those named) into gallery/NAME.jpg, and writes
# GALLERY.md from all pictures and the first comment of each job.
set -eu
cd "$(dirname "$0")"
hoodoo=$1
shift
mkdir -p gallery
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for job in ${*:-*.yaml}; do
    name=${job%.yaml}
    wedges=
    grep -q '^wedge:' "$job" && wedges="1 2"
    for wedge in ${wedges:-0}; do
        picture=$name
        [ "$wedge" = 0 ] || picture=${name}_$wedge
        if [ "$wedge" = 0 ]; then set -- ; else set -- --wedge "$wedge"; fi
        "$hoodoo" look "$job" --quality draft --gizmos none --figure --progress none "$@" --out "$work/picture.png"
        oiiotool "$work/picture.png" --resize 480x0 --quality 86 -o "gallery/$picture.jpg"
    done
done
{
    echo '# Gallery of the jobs'
    echo
    echo '`make gallery` writes this page from `hoodoo look` and the first lines of each job. To start from one of these'
    echo 'jobs, copy it with `hoodoo new NAME --like EXAMPLE`; `hoodoo look NAME.yaml --watch` draws your copy again at each'
    echo 'save. The pictures in [`render/gallery`](../render/gallery) are sharper, with detail below the spacing.'
    echo '`tests/long/forms.py` measures what each form has to show.'
    for job in *.yaml; do
        name=${job%.yaml}
        printf '\n## [%s](%s)\n\n' "$name" "$job"
        for picture in gallery/"$name".jpg gallery/"$name"_[0-9].jpg; do
            [ -f "$picture" ] && printf '![%s](%s)\n' "$name" "$picture"
        done
        # The paragraphs of the first comment, without commands and the line for editors.
        printf '\n'
        sed -n '/^#/!q; /yaml-language-server/d; s/^#  *hoodoo .*//; s/^# \{0,1\}//; p' "$job" | cat -s |
            sed -E 's/[a-z_]+(\.[A-Za-z0-9_]+)+/`&`/g' | sed -e :a -e '/^\n*$/{$d;N;ba' -e '}'
    done
} >GALLERY.md

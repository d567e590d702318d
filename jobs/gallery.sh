#!/bin/sh
# gallery.sh HOODOO [JOB...]: looks at the jobs beside it (all, or those named), and writes jobs/gallery/NAME.jpg and the page
# jobs/GALLERY.md of their pictures and of what their first lines say.
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
    echo '# The jobs, seen'
    echo
    echo 'Made by `make gallery`, from `hoodoo look` and the first lines of each job. `hoodoo new NAME --like FORM` begins a job of your own with one of them;'
    echo '`hoodoo look` draws it again at each save. Sharper pictures, with detail below the spacing, are in [`render/gallery`](../render/gallery). What each form'
    echo 'has to show is measured by `tests/long/forms.py`.'
    for job in *.yaml; do
        name=${job%.yaml}
        printf '\n## [%s](%s)\n\n' "$name" "$job"
        for picture in gallery/"$name".jpg gallery/"$name"_[0-9].jpg; do
            [ -f "$picture" ] && printf '![%s](%s)\n' "$name" "$picture"
        done
        # The comment's paragraphs, without commands and what editors read.
        printf '\n'
        sed -n '/^#/!q; /yaml-language-server/d; s/^#  *hoodoo .*//; s/^# \{0,1\}//; p' "$job" | cat -s | sed -e :a -e '/^\n*$/{$d;N;ba' -e '}'
    done
} >GALLERY.md

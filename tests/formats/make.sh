#!/bin/sh
# make.sh VERSION: writes the files of a release with the hoodoo of this tree. Only for a release that has not been published yet.
set -e
cd "$(dirname "$0")"
hoodoo=${HOODOO:-../../build/hoodoo}
for model in arenite goblins arches; do
    to=$1/$model out=$(mktemp -d)
    "$hoodoo" run "$to/$model.yaml" --out "$out" --frames 1 --progress none
    for file in "checkpoint/$model.0001.ckpt" "frames/$model.0001.json" run.json; do
        cp "$out/$file" "$to/$file"
    done
    [ "$model" != arches ] || cp "$out/stacks/$model.0001.stacks" "$to/stacks/"
    if [ "$model" = arenite ]; then
        cp "$out/job.yaml" "$to/resolved.yaml"
        cp "$out/records/$model.usda.json" "$to/records/"
    fi
    rm -r "$out"
done

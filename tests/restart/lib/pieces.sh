# Helpers for shell tests that run job.yaml in several parts. Output goes to `log`.
say() {
    [ "$1" = 0 ] && echo "ok - $2" && return
    echo "not ok - $2"
    tail -n 5 log | sed 's/^/# /'
}

# same ONE OTHER: compares the frames' files in two folders, with pictures if the job has a camera.
same() {
    kinds="points volumes"
    if grep -q '^cameras:' job.yaml; then kinds="$kinds aov"; fi
    for folder in $kinds; do
        diff -r "$1/$folder" "$2/$folder" >>log 2>&1
        say $? "$2: $folder has the same bytes"
    done
}

# Runs the job at once, into `whole`, and in two parts.
in_pieces() {
    "$HOODOO" run job.yaml --out whole --progress none >log 2>&1
    say $? "in one run"
    "$HOODOO" run job.yaml --out pieces --frames 1-2 --progress none >>log 2>&1 &&
        "$HOODOO" run job.yaml --out pieces --progress none >>log 2>&1
    say $? "in two pieces"
    same whole pieces
}

#!/bin/sh
# man.sh HOODOO: the manual page hoodoo(1), from what the program says of itself.
set -eu
hoodoo=$1
text() {
    sed -e 's/\\/\\e/g' -e "s/^\\([.']\\)/\\\\\&\\1/" -e 's/-/\\-/g'
}
version=$("$hoodoo" --version | cut -d' ' -f2)
cat <<EOF
.TH HOODOO 1 "" "hoodoo $version" "User commands"
.SH NAME
hoodoo \\- erodes sandstone, frame by frame, for render farms
.SH SYNOPSIS
.B hoodoo
.I VERB
.RI [ OPTIONS "] ..."
.SH VERBS
.nf
EOF
"$hoodoo" --help | sed -n '/^  [a-z]/,/^$/p' | sed '/^$/,$d' | text
echo .fi
for verb in $("$hoodoo" --help | sed -n 's/^  \([a-z]\{3,\}\) .*/\1/p'); do
    printf '.SH HOODOO %s\n.nf\n' "$(echo "$verb" | tr a-z A-Z)"
    "$hoodoo" "$verb" --help | text
    echo .fi
done
printf '.SH EXIT STATUS\n.nf\n'
"$hoodoo" --help | sed -n '/Exit codes:/,$p' | sed 1d | text
cat <<'EOF'
.fi
.SH ENVIRONMENT
.TP
.B HOODOO_DEVICE
what
.B \-\-device
is where it is left out
.TP
.B HOODOO_CACHE
the folder where compiled shaders are kept
.TP
.B HOODOO_LIBEXEC
where the programs and libraries stand that read and write other formats
.SH JOB FILES
.B hoodoo keys
says what may stand in a job,
.B hoodoo new
makes one to begin with.
EOF

#!/bin/sh
# man.sh HOODOO: writes the manual page hoodoo(1), composed from the program's help texts.
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
default of
.B \-\-device
.TP
.B HOODOO_CACHE
folder for compiled shaders and the states of hoodoo look; default: ~/.cache/hoodoo
.TP
.B HOODOO_TMP
folder for temporary files of hoodoo selftest; default: that of TMPDIR, or /tmp
.TP
.B HOODOO_DISK_DELAY
seconds after which a shared disk shows what another machine wrote
.TP
.B HOODOO_LIBEXEC
folder of the helper programs and libraries for other file formats
.SH JOB FILES
.B hoodoo keys
describes the keys of a job,
.B hoodoo new
writes one to start from.
EOF

#!/bin/sh
# deb.sh BUILD VERSION: packs what `make install` installs as BUILD/hoodoo_VERSION-1_ARCHITECTURE.deb. The dependencies are those of
# the libraries that the programs are linked with. The same sources give the same bytes. DEBFULLNAME and DEBEMAIL name the maintainer.
set -eu
build=$1
version=$2-1
name=${DEBFULLNAME:-hoodoo maintainers}
email=${DEBEMAIL:-$(git config user.email 2>/dev/null || echo "$(id -un)@$(hostname)")}
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || stat -c %Y CHANGELOG.md)}
export SOURCE_DATE_EPOCH LC_ALL=C
date=$(date -u -R -d "@$SOURCE_DATE_EPOCH")
architecture=$(dpkg --print-architecture)
stage=$build/deb/hoodoo
rm -rf "$build/deb"
mkdir -p "$stage/DEBIAN" "$build/deb/debian"
umask 022
make --no-print-directory install BUILD="$build" DESTDIR="$stage" PREFIX=/usr >/dev/null

# Programs without symbols; the folder of zsh is another in Debian; pages are compressed.
strip --strip-unneeded --remove-section=.comment --remove-section=.note "$stage/usr/bin/hoodoo" "$stage"/usr/libexec/hoodoo/*
mv "$stage/usr/share/zsh/site-functions" "$stage/usr/share/zsh/vendor-completions"
gzip -9n "$stage/usr/share/man/man1/hoodoo.1"
doc=$stage/usr/share/doc/hoodoo
gzip -9nc "$doc/CHANGELOG.md" >"$doc/changelog.gz"
rm "$doc/CHANGELOG.md" "$doc/LICENSE"
sed -n 's/^## \[\([0-9.]*\)\]\( - \)*\(.*\)/\1 \3/p' CHANGELOG.md | while read -r release when; do
    case $when in
    unreleased) released=$date ;;
    [0-9]*) released=$(date -u -R -d "$when") ;;
    *) echo "deb.sh: CHANGELOG.md has no date for version $release" >&2; exit 1 ;;
    esac
    printf 'hoodoo (%s-1) unstable; urgency=medium\n\n  * Version %s; changelog.gz lists what changed.\n\n -- %s <%s>  %s\n\n' \
        "$release" "$release" "$name" "$email" "$released"
done >"$doc/changelog.Debian"
gzip -9n "$doc/changelog.Debian"
cat >"$doc/copyright" <<EOF
Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: hoodoo

Files: *
Copyright: 2026 the authors of hoodoo
License: Apache-2.0

License: Apache-2.0
 Licensed under the Apache License, Version 2.0. On Debian systems its full text is in /usr/share/common-licenses/Apache-2.0.
EOF

# dpkg-shlibdeps wants a source package.
printf 'Source: hoodoo\n\nPackage: hoodoo\nArchitecture: any\n' >"$build/deb/debian/control"
depends=$(cd "$build/deb" && dpkg-shlibdeps -O hoodoo/usr/bin/hoodoo hoodoo/usr/libexec/hoodoo/* 2>/dev/null | sed -n 's/^shlibs:Depends=//p')
[ -n "$depends" ] || { echo "deb.sh: dpkg-shlibdeps finds no dependencies" >&2; exit 1; }
cat >"$stage/DEBIAN/control" <<EOF
Package: hoodoo
Version: $version
Architecture: $architecture
Maintainer: $name <$email>
Installed-Size: $(du -sk --apparent-size --exclude=DEBIAN "$stage" | cut -f1)
Depends: $depends
Recommends: mesa-vulkan-drivers | vulkan-icd, povray, povray-includes, ffmpeg, fonts-dejavu-core
Suggests: gdal-bin, slurm-client
Section: graphics
Priority: optional
Description: simulator of eroding sandstone for film
 hoodoo erodes sandstone over thousands of years, frame by frame, on any Vulkan
 device or on the CPU. A job in YAML describes rock, layers, wind and water; the
 frames are OpenVDB, OpenEXR and USD files for Houdini, Blender and Nuke. Runs
 resume to the same bytes, and farms share them as tasks.
EOF
(cd "$stage" && find usr -type f -print0 | sort -z | xargs -0 md5sum) >"$stage/DEBIAN/md5sums"
find "$stage" -exec touch -h -d "@$SOURCE_DATE_EPOCH" {} +
dpkg-deb --root-owner-group -Zxz --build "$stage" "$build/hoodoo_${version}_$architecture.deb" >/dev/null
echo "$build/hoodoo_${version}_$architecture.deb"

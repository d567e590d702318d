"""make deb: a package that lintian has nothing to say about, twice with the same bytes; unpacked, it holds all that a user needs."""

import hashlib
import os
import subprocess
import sys

from script import TOP, ask, finish, ok

sys.dont_write_bytecode = True
PACKAGER = {**os.environ, "DEBFULLNAME": "The Packager", "DEBEMAIL": "packager@hoodoo.org"}


def pack():
    code, said = ask("make", "-C", TOP, "deb", env=PACKAGER)
    if not ok(code == 0, "make deb", said):
        finish()
    return os.path.join(TOP, said.splitlines()[-2] if said.splitlines()[-1].startswith("make") else said.splitlines()[-1])


def digest(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


path = pack()
first = digest(path)
ok(digest(pack()) == first, "the same bytes again")
code, said = ask("lintian", "--allow-root", "--fail-on", "error,warning", path)
ok(code == 0 and not [line for line in said.splitlines() if line[:2] in ("E:", "W:")], "lintian finds nothing", said)
code, said = ask("dpkg-deb", "--field", path)
ok(code == 0 and "libvulkan1" in said and "libopenvdb" in said and "libopenimageio" in said and "Maintainer: The Packager" in said, "its dependencies", said)
subprocess.run(["dpkg-deb", "--extract", path, "root"], check=True)
for name in ("bin/hoodoo", "libexec/hoodoo/hoodoo-read-mesh", "share/man/man1/hoodoo.1.gz", "share/bash-completion/completions/hoodoo",
             "share/fish/vendor_completions.d/hoodoo.fish", "share/zsh/vendor-completions/_hoodoo", "share/doc/hoodoo/copyright", "share/hoodoo/jobs/demo.yaml"):
    ok(os.path.isfile(f"root/usr/{name}"), f"it holds {name}")
code, said = ask("root/usr/bin/hoodoo", "--version")
ok(code == 0 and said.startswith("hoodoo "), "hoodoo runs", said)
with open("cube.obj", "w") as file:
    file.write("".join(f"v {x} {y} {z}\n" for x in (2, 6) for y in (2, 6) for z in (0, 6)))
    file.write("f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n")
with open("job.yaml", "w") as file:
    file.write("hoodoo: 1\nname: a\nframes: 1-2\ndomain: {size_m: [8, 8, 8], spacing_m: 1}\nscene: {mesh: {file: cube.obj}}\n")
code, said = ask("root/usr/bin/hoodoo", "run", "job.yaml", "--progress", "none", "--out", "out")
ok(code == 0 and os.path.isfile("out/volumes/a.0002.vdb"), "with its helpers: a mesh is read, volumes are written", said)
finish()

"""collect.py STAGE ARCHIVE: completes the folder that `make install` filled, and packs it. See README.md.

Every library that the programs need is copied, with its package's licence. The archive's bytes depend on the files alone: no times, owners or
order of the file system."""

import hashlib
import os
import re
import shutil
import subprocess
import sys

stage, archive = sys.argv[1:]
PROGRAMS, LIBRARIES, GLIBC, GCC = (os.path.join(stage, p) for p in ("lib/programs", "lib", "lib/glibc", "lib/gcc"))
LOADED_LATER = ["libmicrohttpd.so.12"]  # `hoodoo look --serve`
C_LIBRARY = """ld-linux-x86-64.so.2 libc.so.6 libm.so.6 libmvec.so.1 libpthread.so.0 libdl.so.2 librt.so.1 libutil.so.1 libresolv.so.2 libanl.so.1
    libnss_files.so.2 libnss_dns.so.2 libnss_compat.so.2 libBrokenLocale.so.1""".split()
CXX_LIBRARY = ["libstdc++.so.6", "libgcc_s.so.1"]
FOLDERS = ["/lib/x86_64-linux-gnu", "/usr/lib/x86_64-linux-gnu", "/lib64"]


def ask(*argv):
    return subprocess.run(argv, check=True, stdout=subprocess.PIPE, text=True).stdout


def needed(path):
    return re.findall(r"\(NEEDED\).*\[(.*)\]", ask("readelf", "-dW", path))


def find(name):
    for folder in FOLDERS:
        path = os.path.join(folder, name)
        if os.path.exists(path):
            return path
    sys.exit(f"collect.py: {name} is not installed")


def package_of(path):
    """Debian lists files of /lib with or without /usr."""
    for candidate in (os.path.realpath(path), os.path.realpath(path).removeprefix("/usr"), path):
        done = subprocess.run(["dpkg-query", "-S", candidate], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        if done.returncode == 0:
            return done.stdout.split(": ")[0].split(",")[0]
    sys.exit(f"collect.py: no package contains {path}")


def copy(source, to):
    os.makedirs(os.path.dirname(to), exist_ok=True)
    shutil.copyfile(source, to)
    os.chmod(to, 0o755)


def collect():
    """Copies the libraries, and returns {path in the bundle: path on this machine}."""
    folder = {**dict.fromkeys(C_LIBRARY, GLIBC), **dict.fromkeys(CXX_LIBRARY, GCC)}
    programs = [os.path.join(PROGRAMS, name) for name in os.listdir(PROGRAMS)] + [os.path.join(stage, "libexec/hoodoo/hoodoo-vdb.so")]
    wanted, found = [n for p in programs for n in needed(p)] + LOADED_LATER + C_LIBRARY, {}
    while wanted:
        name = wanted.pop()
        to = os.path.join(folder.get(name, LIBRARIES), name)
        if to in found:
            continue
        found[to] = find(name)
        copy(found[to], to)
        wanted += needed(to)
    return found


def check_probe():
    """The probe of the C++ library must need the newest version that the bundled one defines."""
    newest = {path: sorted(set(re.findall(r"GLIBCXX_([\d.]+)", ask("objdump", "-T", path))), key=lambda v: [int(n) for n in v.split(".")])[-1]
              for path in (os.path.join(GCC, "libstdc++.so.6"), os.path.join(PROGRAMS, "host-libstdc++"))}
    if len(set(newest.values())) > 1:
        sys.exit(f"collect.py: host_libstdcxx_shim.cpp must call a function of the newest C++ library: {newest}")


def licences(found):
    """Writes the licences of the packages, and the addresses of their sources."""
    rows, common = [], set()
    to = os.path.join(stage, "share/doc/hoodoo/licences")
    os.makedirs(to)
    packages = {}
    for path, source in found.items():
        packages.setdefault(package_of(source), []).append(os.path.relpath(path, stage))
    for package, files in sorted(packages.items()):
        version, source, of = ask("dpkg-query", "-W", "-f", "${Version} ${source:Package} ${source:Version}", package).split()
        name = package.split(":")[0]
        with open(f"/usr/share/doc/{name}/copyright", encoding="utf-8", errors="replace") as file:
            text = file.read()
        common |= set(re.findall(r"/usr/share/common-licenses/([A-Za-z0-9.+-]*[A-Za-z0-9])", text))
        with open(os.path.join(to, name + ".txt"), "w", encoding="utf-8") as file:
            file.write(text)
        rows.append(f"| {', '.join(sorted(files))} | {name} {version} | <https://snapshot.debian.org/package/{source}/{of}/> |")
    for name in sorted(common):
        if os.path.isfile(f"/usr/share/common-licenses/{name}"):
            shutil.copyfile(f"/usr/share/common-licenses/{name}", os.path.join(to, "common-" + name))
    with open(os.path.join(to, "README.md"), "w", encoding="utf-8") as file:
        file.write("# Libraries of this bundle\n\nThey are those of Debian 12, unchanged. Each has its licence in this folder, as PACKAGE.txt; texts that\n"
                   "these refer to are the files named common-LICENCE. Debian keeps the sources.\n\n| files | package | sources |\n|---|---|---|\n")
        file.write("\n".join(rows) + "\n")


def manifest():
    rows = []
    for folder, _, names in os.walk(stage):
        for name in names:
            path = os.path.join(folder, name)
            with open(path, "rb") as file:
                rows.append((os.path.relpath(path, stage), hashlib.sha256(file.read()).hexdigest()))
    with open(os.path.join(stage, "MANIFEST.sha256"), "w", encoding="utf-8") as file:
        file.writelines(f"{digest}  {path}\n" for path, digest in sorted(rows))


def pack():
    for folder, _, names in os.walk(stage):
        os.chmod(folder, 0o755)
        for name in names:
            path = os.path.join(folder, name)
            os.chmod(path, 0o755 if os.access(path, os.X_OK) else 0o644)
    tar = subprocess.Popen(["tar", "--create", "--sort=name", "--format=gnu", "--mtime=@0", "--owner=0", "--group=0", "--numeric-owner",
                            "-C", os.path.dirname(stage), os.path.basename(stage)], stdout=subprocess.PIPE)
    subprocess.run(["zstd", "-12", "--long=27", "-T2", "--quiet", "--force", "-o", archive], stdin=tar.stdout, check=True)
    if tar.wait() != 0:
        sys.exit("collect.py: tar failed")


found = collect()
check_probe()
licences(found)
manifest()
pack()
print(f"{archive}: {os.path.getsize(archive) / 2**20:.1f} MiB, {len(found)} libraries")

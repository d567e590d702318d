"""The bundle and folders that serve as the root of another machine, for tests that run as root."""

import contextlib
import glob
import os
import subprocess

from script import TOP, ask


BUILD = os.path.dirname(os.path.abspath(os.environ["HOODOO"]))


def pack():
    """Runs `make bundle`, and returns the path of the archive."""
    code, said = ask("make", "-C", TOP, "BUILD=" + os.path.relpath(BUILD, TOP), "bundle")
    assert code == 0, said
    return archive()


def archive():
    """The archive that `make bundle` left beside the program; packed if there is none."""
    found = glob.glob(BUILD + "/hoodoo-*-linux-x86_64.tar.zst")
    return found[0] if found else pack()


def unpack(folder):
    os.makedirs(folder, exist_ok=True)
    subprocess.run(["tar", "-xf", archive(), "-C", folder], check=True)
    return glob.glob(folder + "/hoodoo-*-linux-x86_64")[0]


@contextlib.contextmanager
def root(folder):
    """Gives the folder /proc and /dev/null, which programs need, and removes them in the end. None, if this is not allowed here."""
    os.makedirs(folder + "/proc", exist_ok=True)
    os.makedirs(folder + "/dev", exist_ok=True)
    open(folder + "/dev/null", "a").close()
    mounted = []
    for argv, at in ((["mount", "-t", "proc", "proc"], "/proc"), (["mount", "--bind", "/dev/null"], "/dev/null")):
        if subprocess.run([*argv, folder + at], stderr=subprocess.DEVNULL).returncode == 0:
            mounted.append(folder + at)
    try:
        yield folder if len(mounted) == 2 else None
    finally:
        for at in mounted:
            subprocess.run(["umount", at], check=True)


def inside(folder, *argv, cwd="/", **environment):
    """Exit code and output of a command in that root, as an ordinary user without a home."""
    def enter():
        os.chroot(folder)
        os.chdir(cwd)
        os.setgroups([])
        os.setgid(65534)
        os.setuid(65534)
    return ask(*argv, preexec_fn=enter, env={"PATH": "/usr/bin:/bin", **environment})

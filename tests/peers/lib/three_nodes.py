"""Three nodes of a Slurm on this machine, a, b and c, each with a view of its own of the shared folder, in which names and attributes that other
nodes change appear seconds late, as over NFS. Node c has another driver: lavapipe with vectors of another width."""

import os
import shutil
import signal
import subprocess
import sys
import time

from one_node import OneNode
from script import HOODOO

DELAY_S = 3
# A node's own view of the disk is a mount namespace; its caches are those of a FUSE file system.
VIEW = f'bindfs -o attr_timeout={DELAY_S},entry_timeout={DELAY_S},negative_timeout={DELAY_S} "$0" "$1" && '
OTHER = 'mount --bind "$2" "$3" && '


def why_not():
    """Why this cannot be tried here, or None."""
    if os.getuid() != 0:
        return "needs root"
    if not shutil.which("bindfs") or not os.path.exists("/dev/fuse"):
        return "needs bindfs and /dev/fuse"
    os.makedirs("probe/a", exist_ok=True)
    os.makedirs("probe/b", exist_ok=True)
    done = subprocess.run(["unshare", "--mount", "sh", "-c", VIEW + "true", os.path.abspath("probe/a"), os.path.abspath("probe/b")], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return None if done.returncode == 0 else "FUSE is not allowed here: " + done.stdout.strip()


def begin():
    """Ends the test here with a skip if it cannot be tried. The environment of all nodes' tasks: one core each, and patience with the disk."""
    reason = why_not()
    if reason:
        print("ok three nodes # skip", reason)
        sys.exit(0)
    os.environ["LP_NUM_THREADS"] = "1"
    os.environ["HOODOO_DISK_DELAY"] = str(4 * DELAY_S)


class ThreeNodes(OneNode):
    """`shared` is the folder's path on the nodes; on this machine its files are in `disk`."""

    def __init__(self, shared, disk):
        self.shared, self.disk = os.path.abspath(shared), os.path.abspath(disk)
        os.makedirs(self.shared, exist_ok=True)
        os.makedirs(self.disk, exist_ok=True)
        build = os.path.dirname(os.path.abspath(HOODOO))
        real = os.path.abspath("hoodoo.real")
        shutil.copy(HOODOO, real)
        with open("hoodoo.c", "w") as file:
            file.write(f'#!/bin/sh\nHOODOO_LIBEXEC={build} LP_NATIVE_VECTOR_WIDTH=128 exec {real} "$@"\n')
        os.chmod("hoodoo.c", 0o755)
        view = (self.disk, self.shared)
        wrapped = {n: ("unshare", "--mount", "sh", "-c", VIEW + 'shift && exec "$@"', *view) for n in "ab"}
        wrapped["c"] = ("unshare", "--mount", "sh", "-c", VIEW + OTHER + 'shift 3 && exec "$@"', *view, os.path.abspath("hoodoo.c"), os.path.abspath(HOODOO))
        super().__init__(requeue_exit=False, nodes=("a", "b", "c"), wrapped=wrapped)
        self.more += "SlurmdTimeout=9\n"

    def space(self, pid):
        try:
            return os.readlink(f"/proc/{pid}/ns/mnt")
        except OSError:
            return None

    def processes(self, node):
        """Of the node: all in its mount namespace."""
        slurmd = self.children[2 + self.nodes.index(node)]
        space = self.space(slurmd.pid)
        return [int(p) for p in os.listdir("/proc") if p.isdigit() and space and self.space(p) == space and space != self.space("self")]

    def kill(self, node):
        """The node loses power: all its processes end at once, and nothing that they had not written remains."""
        for pid in self.processes(node):
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass

    def boot(self, node):
        """Starts a killed node again."""
        at = 2 + self.nodes.index(node)
        self.children[at].wait()
        self.start(*self.wrapped[node], "slurmd", "-D", "-N", node, "-f", self.dir + "/slurm.conf")
        self.children[at] = self.children.pop()
        self.ask("scontrol", "update", f"NodeName={node}", "State=RESUME")

    def open(self, *nodes):
        """Only these nodes take tasks."""
        for node in self.nodes:
            self.ask("scontrol", "update", f"NodeName={node}", *(["State=RESUME"] if node in nodes else ["State=DRAIN", "Reason=test"]))

    def queue(self):
        return self.ask("squeue", "--noheader", "--array", "--format=%j %T %N").splitlines()

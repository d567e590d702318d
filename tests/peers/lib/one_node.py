"""A Slurm on this machine, of one node with two stand-in GPUs or more nodes without, in a folder of its own, started and stopped with a `with`."""

import os
import signal
import socket
import subprocess
import time

CONF = """ClusterName=hoodoo
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={port}
AuthType=auth/munge
AuthInfo=cred_expire=5,socket={dir}/munge.socket
SlurmUser=root
SlurmdUser=root
StateSaveLocation={dir}/state
SlurmdSpoolDir={dir}/spool.%n
SlurmctldPidFile={dir}/ctld.pid
SlurmdPidFile={dir}/d.%n.pid
SlurmctldLogFile={dir}/ctld.log
SlurmdLogFile={dir}/d.%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
GresTypes=gpu
{more}KillWait=5
{nodes}PartitionName=farm Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def free_ports(n):
    """The first of n that follow each other."""
    for port in range(27817, 28800, n):
        try:
            for p in range(port, port + n):
                with socket.socket() as s:
                    s.bind(("127.0.0.1", p))
            return port
        except OSError:
            pass
    raise RuntimeError("no free ports")


class OneNode:
    """`requeue_exit`: whether the site has RequeueExit=85. `nodes`: names of several nodes; `wrapped`: {node: the command that its slurmd is started by}.
    `mail`: a program that is called for mail."""

    def __init__(self, requeue_exit, nodes=(), wrapped=None, mail=""):
        self.dir = os.path.abspath("slurm")
        self.more = ("RequeueExit=85\n" if requeue_exit else "") + (f"MailProg={mail}\n" if mail else "")
        self.nodes, self.wrapped = nodes, wrapped or {}
        self.children = []

    def __enter__(self):
        os.makedirs(self.dir + "/state")
        host = socket.gethostname().split(".")[0]
        nodes = self.nodes or (host,)
        port = free_ports(1 + len(nodes))
        text = ""
        for i, node in enumerate(nodes):
            os.makedirs(f"{self.dir}/spool.{node}")
            text += f"NodeName={node} NodeHostname={host} NodeAddr=127.0.0.1 Port={port + 1 + i} CPUs=2 RealMemory=1000 {'' if self.nodes else 'Gres=gpu:2 '}State=UNKNOWN\n"
        for i, device in enumerate(("null", "zero")):
            os.symlink("/dev/" + device, f"{self.dir}/gpu{i}")
        with open(self.dir + "/slurm.conf", "w") as f:
            f.write(CONF.format(dir=self.dir, host=host, port=port, nodes=text, more=self.more))
        with open(self.dir + "/gres.conf", "w") as f:
            f.write("" if self.nodes else f"NodeName={host} Name=gpu File={self.dir}/gpu[0-1]\n")
        key = self.dir + "/munge.key"
        with open(key, "wb") as f:
            f.write(os.urandom(128))
        os.chmod(key, 0o600)
        os.environ["SLURM_CONF"] = self.dir + "/slurm.conf"
        self.start("munged", "--foreground", "--force", "--key-file=" + key, "--socket=" + self.dir + "/munge.socket",
                   "--pid-file=" + self.dir + "/munge.pid", "--log-file=" + self.dir + "/munge.log", "--seed-file=" + self.dir + "/seed")
        self.wait_for(lambda: os.path.exists(self.dir + "/munge.socket"), "munged")
        self.start("slurmctld", "-D", "-c", "-f", self.dir + "/slurm.conf")
        for node in nodes:
            self.start(*self.wrapped.get(node, ()), "slurmd", "-D", "-N", node, "-f", self.dir + "/slurm.conf")
        self.wait_for(lambda: self.ask("sinfo", "--noheader", "--Node", "--format=%T").split() == ["idle"] * len(nodes), "the nodes")
        return self

    def start(self, *argv):
        with open(self.dir + "/" + argv[0] + ".out", "w") as out:
            self.children.append(subprocess.Popen(argv, stdout=out, stderr=out, stdin=subprocess.DEVNULL))

    def wait_for(self, condition, what, seconds=60):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if condition():
                return
            time.sleep(0.2)
        logs = []
        for name in ("munged.out", "slurmctld.out", "slurmd.out"):
            if os.path.exists(self.dir + "/" + name):
                logs.append(open(self.dir + "/" + name).read()[-1500:])
        raise RuntimeError(f"waited {seconds} s for {what}\n" + "\n".join(logs))

    @staticmethod
    def ask(*argv):
        return subprocess.run(argv, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL, text=True).stdout

    def __exit__(self, *_):
        self.ask("scancel", "--user=root", "--signal=KILL")
        self.ask("scancel", "--user=root")
        time.sleep(1)
        for child in reversed(self.children):
            child.send_signal(signal.SIGTERM)
        for child in self.children:
            try:
                child.wait(20)
            except subprocess.TimeoutExpired:
                child.kill()
                child.wait()
        os.environ.pop("SLURM_CONF", None)

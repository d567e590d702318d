"""jobs/TUTORIAL.md, as a reader follows it in an empty folder: every command in its shell blocks succeeds, and every file that it names
exists in the end."""

import os
import re

from script import HOODOO, TOP, ask, finish, ok

with open(os.path.join(TOP, "jobs/TUTORIAL.md")) as file:
    page = file.read()
blocks = re.findall(r"^```sh\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
commands = [line for block in blocks for line in re.findall(r"^hoodoo .*", block, re.MULTILINE)]
verbs = {command.split()[1] for command in commands}
ok({"new", "keys", "check", "look", "plan", "run", "status", "inspect", "preview", "mesh", "verify", "submit", "report"} <= verbs,
   "the tutorial uses the verbs of a first hour", verbs)

os.mkdir("bin")
os.symlink(HOODOO, "bin/hoodoo")
# Cached states of looks are separate; compiled kernels, which take seconds, stay in the folder that run.sh sets.
environment = {**os.environ, "PATH": os.path.abspath("bin") + ":" + os.environ["PATH"], "XDG_CACHE_HOME": os.path.abspath("cache")}
environment.pop("HOODOO_CACHE", None)
os.mkdir("work")
for block in blocks:
    code, output = ask("sh", "-e", "-c", block, cwd="work", env=environment)
    ok(code == 0, "; ".join(block.splitlines())[:100], code, output)

# Paths that the text names in backticks, apart from links and commands.
text = re.sub(r"^```.*?^```$", "", page, flags=re.MULTILINE | re.DOTALL)
named = set(re.findall(r"`((?:out/[\w./-]+|[\w.-]+\.(?:png|yaml)))`", text))
missing = sorted(path for path in named if not os.path.exists(os.path.join("work", path)))
ok(len(named) >= 10 and not missing, "the files that the tutorial names exist", missing, sorted(named))
ok(os.path.isfile("work/out/sweep/w0002/volumes/rock_w0002.1009.vdb"), "the last frame of the second wedge exists")
finish()

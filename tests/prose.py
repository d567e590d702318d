#!/usr/bin/env python3
"""prose.py HOODOO: a TAP line for each rule that pages (Markdown) and the comments of jobs/*.yaml must obey. Commands and
options are compared with `hoodoo VERB -h`, keys with `hoodoo keys --list`, targets with the Makefile, paths with git."""

import os
import re
import shutil
import subprocess
import sys

HOODOO = os.path.abspath(sys.argv[1])
os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
WIDTH = 120
# Generated or recorded text, whose lines are as wide as what they quote.
WIDE = {"jobs/README.md", "tests/bench/selftest-llvmpipe.md"}


def output(*argv):
    return subprocess.run(argv, stdout=subprocess.PIPE, text=True, check=True).stdout


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


FILES = set(output("git", "ls-files").splitlines()) | set(output("git", "ls-files", "-o", "--exclude-standard").splitlines())
FILES = {path for path in FILES if os.path.exists(path)}
FOLDERS = {path[:at] for path in FILES for at in range(len(path)) if path[at] == "/"}
NAMES = {os.path.basename(path) for path in FILES}
PAGES = {path: read(path) for path in sorted(FILES) if path.endswith(".md")}
JOBS = {path: "\n".join(line if line.lstrip().startswith("#") else "" for line in read(path).splitlines())
        for path in sorted(FILES) if re.fullmatch(r"jobs/\w+\.yaml", path)}


failed = False


def rule(name, problems):
    """Prints a TAP line; problems are (path, line number, text)."""
    global failed
    failed |= bool(problems)
    print("not ok" if problems else "ok", name)
    for path, number, text in problems:
        print(f"# {path}:{number}: {text}")


def lines(texts):
    for path, text in texts.items():
        for number, line in enumerate(text.splitlines(), 1):
            yield path, number, line


def spans(texts):
    """What stands between backticks outside blocks of code, also across the end of a line."""
    for path, text in texts.items():
        text = re.sub(r"^```.*?^```", lambda block: re.sub(r"[^\n]", "", block.group()), text, flags=re.MULTILINE | re.DOTALL)
        for found in re.finditer(r"`([^`]+)`", text):
            yield path, text.count("\n", 0, found.start()) + 1, " ".join(found.group(1).split())


def commands():
    """Lines of code blocks, spans, and lines of job comments that begin with hoodoo or make."""
    for path, text in PAGES.items():
        inside = False
        for number, line in enumerate(text.splitlines(), 1):
            if line.startswith("```"):
                inside = not inside
            elif inside:
                yield path, number, line
    yield from spans(PAGES)
    yield from ((path, number, line.lstrip("# ")) for path, number, line in lines(JOBS))


def options(verb):
    return set(re.findall(r"(?<![\w-])--?[a-z][a-z-]*", output(HOODOO, verb, "-h")))


KINDS = {"hoodoo frame", "hoodoo product"}  # of manifests and records
VERBS = re.findall(r"^  ([a-z]+) ", output(HOODOO, "-h").split("Exit codes")[0], re.MULTILINE)
OPTIONS = {verb: options(verb) for verb in VERBS}
ALL_OPTIONS = set().union(*OPTIONS.values()) | {"--version"}
TARGETS = set(re.findall(r"^([a-z-]+):", read("Makefile"), re.MULTILINE))


def unknown_commands():
    for path, number, text in commands():
        text = re.sub(r"(^|\s)#\s.*", "", text)
        found = re.match(r"(?:\$ )?hoodoo (\S+)(.*)", text)
        if found and re.fullmatch(r"[a-z]+", found.group(1)) and text not in KINDS:
            verb, rest = found.groups()
            if verb not in OPTIONS:
                yield path, number, f"hoodoo has no verb {verb}"
                continue
            for option in re.findall(r"(?<=\s)--[a-z][a-z-]*", rest.split(" -- ")[0]):
                if option not in OPTIONS[verb]:
                    yield path, number, f"hoodoo {verb} has no option {option}"
        elif re.match(r"--[a-z]", text) and not inside_other_program(text):
            option = re.match(r"--[a-z-]+", text).group()
            if option not in ALL_OPTIONS:
                yield path, number, f"no verb of hoodoo has the option {option}"
        for target in re.findall(r"(?:^|=\S+ )make ([a-z][a-z-]*)(?![\w/-])", text):
            if target not in TARGETS:
                yield path, number, f"the Makefile has no target {target}"


def inside_other_program(text):
    """Options of sbatch, which pages name as well."""
    return re.match(r"--(gres|requeue|open-mode|signal|partition|mem|cpus-per-task|time|mail-type|mail-user|qos)\b", text)


KEYS = set()
for key in output(HOODOO, "keys", "--list").split():
    parts = key.split(".")
    for form in (parts, [part for part in parts if part not in ("N", "NAME")], parts[1:] if parts[0] == "scene" else parts):
        KEYS |= {".".join(form[:n]) for n in range(1, len(form) + 1)}
KEYS |= {key.replace("deposition.", "arches.") for key in KEYS if key.startswith("deposition.piles")}
KEYS |= {key.replace("farm.sim", f"farm.{kind}") for key in KEYS if key.startswith("farm.sim") for kind in ("derive", "preview", "finish")}
SECTIONS = {key.split(".")[0] for key in KEYS if "." in key}
# Names with a dot that are not keys: the layers of pictures, and members of structures.
OTHER = set(re.findall(r"`([a-z_]+\.[A-Za-z_]+)`", read("jobs/README.md").split("## Values")[-1]))
OTHER |= {"erosion.intensity", "voxels.left", "voxels.state", "voxels.x", "voxels.y", "voxels.z"}
FILE_ENDINGS = (".yaml", ".png", ".vdb", ".exr", ".usda", ".json")
KEY = r"[a-z_]+(?:\[\])?(?:\.[A-Za-z0-9_]+(?:\[\])?)+"


def is_key(text):
    text = re.sub(r"^edits\.\w+\.(paint\.|set\.)", lambda found: "" if found.group(1) == "set." else "paint.", text)
    generic = re.sub(r"\.\d+(?=\.|$)", ".N", text.replace("[]", ".N"))
    named = re.sub(r"^(cameras|arches\.materials)\.[A-Za-z]\w*", r"\1.NAME", generic)
    return generic in KEYS or named in KEYS


def unknown_keys():
    pages = {path: text for path, text in PAGES.items() if path != "CHANGELOG.md"}  # it names keys of old versions, too
    places = [*spans(pages), *((path, number, line) for path, number, line in lines(JOBS) if "#" in line)]
    for path, number, text in places:
        for found in re.finditer(rf"(?<![\w./<-])({KEY})(?![\w/(*-])", text):
            key = found.group(1)
            section = key.split(".")[0].removesuffix("[]")
            if section in SECTIONS and key not in OTHER | NAMES and not key.endswith(FILE_ENDINGS) and not is_key(key):
                yield path, number, f"no key {key}"


def missing_links():
    for path, number, line in lines(PAGES):
        for target in re.findall(r'(?:\]\(|src=")([^)"\s]+)', line):
            if re.match(r"[a-z]+:", target):
                continue
            file, _, anchor = target.partition("#")
            there = os.path.normpath(os.path.join(os.path.dirname(path), file)) if file else path
            if there not in FILES and there not in FOLDERS:
                yield path, number, f"the link leads nowhere: {target}"
            elif anchor and anchor not in headings(there):
                yield path, number, f"{there} has no heading for #{anchor}"


def headings(path):
    titles = re.findall(r"^#+ +(.*)", PAGES.get(path, ""), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", title.lower()).strip().replace(" ", "-") for title in titles}


TOP = {path.split("/")[0] for path in FILES if "/" in path}


def missing_files():
    for path, number, text in spans(PAGES):
        if text.startswith("hoodoo "):
            continue  # in an output folder
        for name in re.findall(r"(?<![\w./-])((?:[\w.-]+/)+[\w.-]*)(?![\w*/{<])", text):
            if name.split("/")[0] in TOP and name.rstrip("/.") not in FILES | FOLDERS and not is_test(name):
                yield path, number, f"there is no {name}"


def is_test(name):
    """A program of tests without its .c, as run.sh takes it; and folders that a build or a run makes."""
    return f"{name}.c" in FILES or f"tests/{name}.c" in FILES


def misspelt():
    said = subprocess.run(["codespell", "-I", ".codespell-ignore", *sorted(FILES - {path for path in FILES if not is_text(path)})],
                          stdout=subprocess.PIPE, text=True).stdout
    for line in said.splitlines():
        path, number, text = line.split(":", 2)
        yield path, number, text.strip()


def is_text(path):
    return path.endswith((".md", ".c", ".h", ".cpp", ".hpp", ".glsl", ".py", ".sh", ".def", ".yaml", ".html", ".inc", ".js", ".css")) or path == "Makefile"


rule(f"no line of a page is over {WIDTH} columns (tables and addresses may be)",
     [(path, number, f"{len(line)} columns") for path, number, line in lines(PAGES)
      if len(line) > WIDTH and path not in WIDE and not line.startswith("|") and "https://" not in line])
rule("every link of a page leads to a file and a heading", list(missing_links()))
rule("every path of the tree that a page names exists", list(missing_files()))
rule("every command, option and target of a page exists", list(unknown_commands()))
rule("every key of a page and of a job's comments exists", list(unknown_keys()))
if shutil.which("codespell"):
    rule("spelling", list(misspelt()))
else:
    print("ok spelling # skip codespell is not installed")
sys.exit(failed)

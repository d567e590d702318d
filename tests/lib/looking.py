"""Running `hoodoo look`, with its states in a folder of the test, and asking its page."""
import atexit
import http.client
import json
import os
import struct
import subprocess
import urllib.parse

from script import HOODOO, hoodoo

# Compiled kernels are shared, since they cost seconds; states have separate folders.
KERNELS = os.environ.get("HOODOO_CACHE") or os.path.join(os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"), "hoodoo")


def png_size(path):
    with open(path, "rb") as file:
        head = file.read(24)
    return struct.unpack(">II", head[16:24]) if head[:8] == b"\x89PNG\r\n\x1a\n" else None


def with_cache(folder):
    environment = dict(os.environ, XDG_CACHE_HOME=os.path.abspath(folder), MESA_SHADER_CACHE_DIR=KERNELS)
    environment.pop("HOODOO_CACHE", None)
    return environment


def look(job, *words, cache="kept"):
    """Exit code and output, parsed if it is JSON."""
    code, said = hoodoo("look", job, "--json", "--progress", "none", "--no-slate", *words, env=with_cache(cache))
    lines = [line for line in said.splitlines() if line.startswith("{")]
    return code, json.loads(lines[-1]) if lines else said


def write(text, path="edits.yaml"):
    with open(path, "w") as file:
        file.write(text)


class Page:
    """The page of a job, until the test ends."""

    def __init__(self, job, *words, cache="kept"):
        self.process = subprocess.Popen([HOODOO, "look", job, "--serve", *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=with_cache(cache))
        atexit.register(self.process.kill)
        address = urllib.parse.urlsplit(self.process.stdout.readline().strip())
        self.server, self.token = (address.hostname, address.port), urllib.parse.parse_qs(address.query)["token"][0]

    def fetch(self, path, method="GET", host=None, **query):
        """Status, content type, X-Look and body."""
        asked = http.client.HTTPConnection(*self.server, timeout=120)
        asked.request(method, path + "?" + urllib.parse.urlencode(query), headers={"Host": host or f"{self.server[0]}:{self.server[1]}"})
        answer = asked.getresponse()
        return answer.status, answer.headers.get("Content-Type", ""), answer.headers.get("X-Look"), answer.read()

    def json(self, path, **query):
        """The answer in JSON to a request with the token."""
        return json.loads(self.fetch(path, token=self.token, **query)[3])

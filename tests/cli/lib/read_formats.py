"""Readers of checkpoints, stacks, manifests and records, written from the pages src/*/FORMAT.md alone."""
import ctypes
import ctypes.util
import json
import struct

xx = ctypes.CDLL(ctypes.util.find_library("xxhash"))
xx.XXH3_64bits.restype = ctypes.c_uint64
xx.XXH3_64bits.argtypes = [ctypes.c_char_p, ctypes.c_size_t]
zstd = ctypes.CDLL(ctypes.util.find_library("zstd"))
zstd.ZSTD_decompress.restype = ctypes.c_size_t
zstd.ZSTD_decompress.argtypes = [ctypes.c_char_p, ctypes.c_size_t, ctypes.c_char_p, ctypes.c_size_t]


def digest(data):
    return xx.XXH3_64bits(data, len(data))


def hexed(data):
    return f"{digest(data):016x}"


def unpacked(data, n, item):
    out = ctypes.create_string_buffer(n)
    assert zstd.ZSTD_decompress(out, n, data, len(data)) == n
    shuffled, count = out.raw, n // item
    return b"".join(shuffled[b * count + i:b * count + i + 1] for i in range(count) for b in range(item))


def checkpoint(path):
    """Returns the index, and the raw bytes of each section by name."""
    with open(path, "rb") as file:
        data = file.read()
    index_at, index_size, whole, end = struct.unpack("<QQQ8s", data[-32:])
    assert data[:12] == b"hoodoo.ckpt\0" and struct.unpack("<I", data[12:16]) == (1,) and end == b"ckpt.end"
    assert digest(data[:-32]) == whole and index_at + index_size == len(data) - 32
    index, sections, at = json.loads(data[index_at:index_at + index_size]), {}, 16
    for s in index["sections"]:
        raw, left = b"", s["item"] * s["count"]
        most = (4 << 20) // s["item"] * s["item"]
        for offset, size in zip(s["chunks"][::2], s["chunks"][1::2]):
            assert offset == at
            raw += unpacked(data[offset:offset + size], min(most, left), s["item"])
            left, at = left - min(most, left), offset + size
        assert left == 0 and hexed(raw) == s["hash"]
        sections[s["name"]] = raw
    assert at == index_at
    return index, sections


def stacks(path):
    """Returns nx, ny, cell, quantum, and the layers of each stack as (top, material)."""
    with open(path, "rb") as file:
        data = file.read()
    magic, form, nx, ny, solid, zero, n, cell, quantum = struct.unpack("<12sIIIIIQdd", data[:56])
    assert magic == b"hoodoo.stck\0" and form == 1 and zero == 0 and digest(data[:-8]) == struct.unpack("<Q", data[-8:])[0]
    counts = struct.unpack(f"<{nx * ny}I", data[56:56 + 4 * nx * ny])
    words = struct.unpack(f"<{n}I", data[56 + 4 * nx * ny:-8])
    found, at = [], 0
    for count in counts:
        layers = [(w >> 4, w & 15) for w in words[at:at + count]]
        assert all(a[0] < b[0] and a[1] != b[1] for a, b in zip(layers, layers[1:])) and (not layers or layers[-1][1] != 0)
        found.append(layers)
        at += count
    assert at == n
    return nx, ny, cell, quantum, found


def sealed(path):
    """Reads a manifest or record and checks its hash."""
    with open(path, "rb") as file:
        data = file.read()
    seal = data.index(b',\n  "self_xxh3": ')
    value = json.loads(data)
    assert list(value)[-1] == "self_xxh3" and hexed(data[:seal]) == value["self_xxh3"]
    return value

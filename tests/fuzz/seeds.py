#!/usr/bin/env python3
"""seeds.py WORK OUT: takes checkpoints in WORK apart into the seeds of the targets that read parts of them."""
import json
import struct
import sys
from array import array
from math import prod
from pathlib import Path

work, out = Path(sys.argv[1]), Path(sys.argv[2])


def read(path):
    """The header of a safetensors file, and the bytes of its tensors by name."""
    data = path.read_bytes()
    size = struct.unpack("<Q", data[:8])[0]
    header = json.loads(data[8:8 + size])
    places = {name: entry["data_offsets"] for name, entry in header.items() if name != "__metadata__"}
    return header, {name: data[8 + size + begin:8 + size + end] for name, (begin, end) in places.items()}


def one_line(header):
    return json.dumps(header, separators=(",", ":")).encode() + b"\n"


def safetensors(metadata, tensors):
    """A header and bytes, of tensors by name: (type, shape, bytes)."""
    header, data = {"__metadata__": metadata} if metadata else {}, b""
    for name, (kind, shape, values) in tensors.items():
        header[name] = {"dtype": kind, "shape": shape, "data_offsets": [len(data), len(data) + len(values)]}
        data += values
    return header, data


# Checkpoints: whole ones that are small enough, and the headers of others.
header, tensors = read(Path("tests/data/v1/checkpoint.safetensors"))
(out / "checkpoint" / "v1").write_bytes(one_line(header))
for name in ["grid", "kitchen", "ppo"]:
    header, _ = read(work / f"{name}.ckpt")
    only_metadata = {"__metadata__": header["__metadata__"]}
    (out / "checkpoint" / f"{name}-metadata").write_bytes(one_line(only_metadata))

# Safetensors: every type, in several shapes.
sizes = {"F16": 2, "F32": 4, "F64": 8, "I32": 4, "I64": 8, "U8": 1, "U64": 8}
for number, shape in enumerate([[2, 3], [], [0], [1, 1, 4]]):
    tensors = {f"t{i}": (kind, shape, bytes(prod(shape) * size)) for i, (kind, size) in enumerate(sizes.items())}
    header, data = safetensors({"a": "b"} if number else {}, tensors)
    head = one_line(header)
    (out / "safetensors" / f"types{number}").write_bytes(struct.pack("<Q", len(head)) + head + data)

# What a resumed training has kept.
names = ["memory/episodes", "memory/serials", "memory/added", "running/episodes", "running/running", "running/next",
         "lanes/episodes", "lanes/numbers", "lanes/rewards"]
for world, (state, lanes) in enumerate([("grid", "ppo"), ("kitchen", None)]):
    kept = {name.removeprefix("train/"): value for name, value in read(work / f"{state}.ckpt")[1].items()}
    if lanes:
        kept |= {name.removeprefix("train/ppo/"): value for name, value in read(work / f"{lanes}.ckpt")[1].items()}
    seed = bytes([world])
    for name in names:
        value = kept.get(name, b"")[:65535]
        seed += struct.pack("<H", len(value)) + value
    (out / "resumed_state" / state).write_bytes(seed)

# Plans of kitchens, from the checkpoint that holds them.
header, _ = read(work / "kitchen.ckpt")
for env in json.loads(header["__metadata__"]["envs"])[:4]:
    (out / "kitchen_plan" / env["name"]).write_text(env["content"], encoding="utf-8")

# A scene in which everything looks the same: one row of features.
for path in (work / "scenes").glob("*.scene.safetensors"):
    header, tensors = read(path)
    kinds = {name: (header[name]["dtype"], header[name]["shape"], value) for name, value in tensors.items()}
    view = array("i", tensors["view"])
    kinds["view"] = ("I32", header["view"]["shape"], array("i", [min(row, 0) for row in view]).tobytes())
    del kinds["features"]
    kinds["features"] = ("F16", [1, 2048], b"")
    header, data = safetensors(header["__metadata__"], kinds)
    begin = header["features"]["data_offsets"][0]
    header["features"]["data_offsets"] = [begin, begin + 2 * 2048]
    (out / "scene" / path.name).write_bytes(one_line(header) + data)

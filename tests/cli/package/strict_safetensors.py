"""strict_safetensors.py FILE...: reads safetensors files as the format's public description has them, with what the
oldest of its loaders takes, and prints of each the types of its tensors and how many of each there are."""
import collections
import json
import struct
import sys

MOST_HEADER = 100_000_000
WIDTHS = {"BOOL": 1, "U8": 1, "I8": 1, "I16": 2, "F16": 2, "BF16": 2, "I32": 4, "F32": 4, "I64": 8, "F64": 8}


def once(pairs):
    names = [name for name, _ in pairs]
    assert len(set(names)) == len(names), "a name stands twice"
    return dict(pairs)


def check(path):
    with open(path, "rb") as file:
        (size,) = struct.unpack("<Q", file.read(8))
        assert size <= MOST_HEADER, "header of %d bytes" % size
        text = file.read(size)
        data = len(file.read())
    assert text[:1] == b"{", "the header begins with %r" % text[:1]
    header = json.loads(text.decode(), object_pairs_hook=once)
    metadata = header.pop("__metadata__", {})
    assert all(type(word) is str for pair in metadata.items() for word in pair), "metadata that are no strings"
    at = 0
    for name, tensor in sorted(header.items(), key=lambda item: item[1]["data_offsets"]):
        assert sorted(tensor) == ["data_offsets", "dtype", "shape"], name
        assert tensor["dtype"] in WIDTHS, "%s: type %s" % (name, tensor["dtype"])
        width = WIDTHS[tensor["dtype"]]
        begin, end = tensor["data_offsets"]
        assert begin == at, "%s: begins at %d, the one before ends at %d" % (name, begin, at)
        assert (8 + size + begin) % width == 0, "%s: not aligned" % name
        for extent in tensor["shape"]:
            assert type(extent) is int and extent >= 0, name
            width *= extent
        assert end - begin == width, "%s: %d bytes, its shape has %d" % (name, end - begin, width)
        at = end
    assert at == data, "%d bytes of tensors, %d in the file" % (at, data)
    return collections.Counter(tensor["dtype"] for tensor in header.values())


for path in sys.argv[1:]:
    print(path, *("%s:%d" % item for item in sorted(check(path).items())))

"""synpo's files and worlds in Python. One file; it needs numpy, and torch where a policy is to act.

    import synpo

    matrix = synpo.read_matrix("synpo.tsv")             # {column: array}
    log = synpo.read_log("run.log")                     # {column: array}, NaN where the log has NA
    for episode in synpo.read_trajectories("e.jsonl"):  # one dict each
        print(episode["env"], episode["actions"])
    checkpoint = synpo.read_checkpoint("synpo.ckpt")    # .metadata, .tensors, .envs, .tasks

    env = synpo.Env("gridworld", pairs="pairs.tsv")     # as Gymnasium has it, which need not be there
    policy = synpo.load_policy("synpo.ckpt")            # a torch.nn.Module whose outputs are synpo's scores
    observation, info = env.reset(seed=1)
    while True:
        action = policy.act(observation, info["env"], info["task"])
        observation, reward, terminated, truncated, info = env.step(action)
        if terminated or truncated:
            break

The formats are described in synpo-matrix(5), synpo-log(5), synpo-trajectory(5), synpo-checkpoint(5) and
synpo-play(5). A file that is not as they say is refused with ValueError, which names it and the place.
"""
import json
import math
import os
import re
import struct
import subprocess

import numpy as np

try:
    import torch
except ImportError:
    torch = None
try:
    import gymnasium
except ImportError:
    gymnasium = None

__all__ = ["read_matrix", "rates", "read_log", "read_trajectories", "Checkpoint", "read_checkpoint", "read_safetensors",
           "load_policy", "export_onnx", "Server", "Env", "BatchEnv"]


# --- what all formats have -----------------------------------------------------------------------------------

_MOST_LINE = 2**24  # bytes
_CONTROL = re.compile("[\x00-\x1f\x7f-\x9f]")


def _expect(holds, what, found, expected):
    if not holds:
        raise ValueError(f"{what}: found {json.dumps(found)[:80]}, expected {expected}")


def _is_name(value):
    return isinstance(value, str) and 1 <= len(value.encode("utf-8")) <= 255 and not _CONTROL.search(value)


def _is_hash(value):
    return isinstance(value, str) and re.fullmatch("[0-9a-f]{16}", value)


def _is_whole(value, low, high):
    return type(value) is int and low <= value <= high


def _are_whole(values, low, high):
    return (isinstance(values, list) and set(map(type, values)) <= {int} and
            low <= min(values, default=low) and max(values, default=high) <= high)


# Python reads more than the formats have: 1_000, blanks, digits of other scripts, infinity.
_WHOLE, _REAL = set("-0123456789"), set("-+.0123456789eE")


def _whole(text, low, high):
    number = int(text) if _WHOLE.issuperset(text) else None
    if number is None or not low <= number <= high:
        raise ValueError(text)
    return number


def _real(text, low=-math.inf, high=math.inf):
    number = float(text) if _REAL.issuperset(text) and not text.startswith("+") else math.nan
    if not (low <= number <= high and abs(number) < math.inf):
        raise ValueError(text)
    return number


def _no_number(text):
    raise ValueError(f"found {text}, which is no number of JSON")


def _object(members):
    found = {}
    for name, value in members:
        if name in found:
            raise ValueError(f"the name {json.dumps(name)} twice in one object")
        found[name] = value
    return found


def _look_through(value, levels):
    inside = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    kinds = set(map(type, inside))
    if kinds and levels == 0:
        raise RecursionError
    if float in kinds and (math.inf in inside or -math.inf in inside):
        raise ValueError("a number that is too large")
    if dict in kinds or list in kinds:
        for one in inside:
            _look_through(one, levels - 1)


def _parse_json(text, levels=8):
    """As json.loads(), but a ValueError for all that the programs refuse: NaN, numbers that are too large, a name
    twice in an object, halves of characters, and what is nested in more levels."""
    try:
        value = json.loads(text, parse_constant=_no_number, object_pairs_hook=_object)
        _look_through(value, levels)
    except RecursionError:
        raise ValueError("nested too deep") from None
    if "\\u" in text:
        json.dumps(value, ensure_ascii=False).encode("utf-8")
    return value


# --- tables ------------------------------------------------------------------------------------------------

def _read_table(path):
    """The header and the columns of a tab-separated table, as texts, and what comes after the last LF."""
    with open(path, "rb") as file:
        data, header_ends, cut_off = file.read().rpartition(b"\n")
    if not header_ends:
        raise ValueError(f"{path}: no header line")
    try:
        lines = data.decode("utf-8").split("\n")
    except UnicodeDecodeError as error:
        number = data.count(b"\n", 0, error.start) + 1
        raise ValueError(f"{path}: line {number}: found invalid UTF-8 ({error.reason})") from None
    for number, line in enumerate(lines, 1):
        if line.endswith("\r"):
            raise ValueError(f"{path}: line {number}: ends in CR LF, expected LF alone")
        control = _CONTROL.search(line.replace("\t", " "))
        if control:
            raise ValueError(f"{path}: line {number}: found the control character {control[0]!r}, expected UTF-8 text")
        if len(line) > _MOST_LINE:
            raise ValueError(f"{path}: line {number}: longer than {_MOST_LINE} bytes")
    header = lines[0].split("\t")
    if header[0].startswith("\ufeff"):
        raise ValueError(f"{path}: line 1: found a byte order mark, expected none")
    if len(header) > 1000:
        raise ValueError(f"{path}: line 1: found {len(header)} columns, expected at most 1000")
    for name in header:
        if header.count(name) > 1 or not name:
            raise ValueError(f"{path}: line 1: found the column '{name}', expected names, each of them once")
    rows = [line.split("\t") for line in lines[1:]]
    for number, row in enumerate(rows, 2):
        if len(row) != len(header):
            raise ValueError(f"{path}: line {number}: found {len(row)} fields, expected {len(header)}")
    return header, list(zip(*rows)) if rows else [()] * len(header), cut_off


def _values(path, name, fields, read, expected):
    """What `read` makes of the fields of a column; it refuses one with ValueError."""
    known = {}
    for field in dict.fromkeys(fields):
        try:
            known[field] = read(field)
        except ValueError:
            raise ValueError(f"{path}: line {fields.index(field) + 2}, column '{name}': found '{field}', "
                             f"expected {expected}") from None
    return [known[field] for field in fields]


def _text(holds):
    def read(field):
        if not holds(field):
            raise ValueError(field)
        return field
    return read


def _whole_column(low, high):
    return lambda field: _whole(field, low, high), np.int64, f"a whole number from {low} to {high}"


# How a field is read, the type of the column, and what is expected in it.
_COUNT, _LONG, _FLAG = _whole_column(0, 10**12), _whole_column(0, 2**63 - 1), _whole_column(0, 1)
_MATRIX_COLUMNS = {
    "window": _COUNT, "first_episode": _COUNT, "episodes": _whole_column(1, 10**12), "successes": _COUNT,
    "wrong": _COUNT, "timeouts": _COUNT, "length": _COUNT, "seed": _LONG, "updates": _LONG, "eval_seed": _LONG,
    "seen": _FLAG, "new": _FLAG,
    "reward": (lambda field: _real(field, -1e15, 1e15) if field else math.nan, float,
               "a number from -1e15 to 1e15, or nothing"),
    # -0 is 0: one run.
    "temperature": (lambda field: _real(field, 0) + 0.0 if field else math.nan, float,
                    "a number, at least 0, or nothing"),
    "env": (_text(_is_name), object, "a name of 1 to 255 bytes"),
    "task": (_text(_is_name), object, "a name of 1 to 255 bytes"),
    "method": (_text(lambda field: not field or _is_name(field)), object, "a name of at most 255 bytes"),
    "part": (_text({"P", "Q", "rest", ""}.__contains__), object, "P, Q, rest or nothing"),
}


def read_matrix(path):
    """A success matrix as {column: array}: counts are int64, reward and temperature float64 with NaN where the field is
    empty, all else text. pandas.DataFrame() takes it as it is."""
    header, columns, cut_off = _read_table(path)
    if cut_off:
        raise ValueError(f"{path}: the last line has no end")
    for column in ("env", "task", "episodes", "successes"):
        if column not in header:
            raise ValueError(f"{path}: no column '{column}'")
    if not 1 <= len(columns[0]) <= 10**6:
        raise ValueError(f"{path}: found a header and {len(columns[0])} rows, expected 1 to 1000000")
    matrix = {}
    for column, fields in zip(header, columns):
        read, kind, expected = _MATRIX_COLUMNS.get(column, (str, object, ""))
        matrix[column] = np.array(_values(path, column, fields, read, expected), kind)
    _check_rows(path, matrix)
    return matrix


def _check_rows(path, matrix):
    missing = np.zeros(len(matrix["env"]), np.int64)
    ends = sum(matrix.get(column, missing) for column in ("successes", "wrong", "timeouts"))
    for wrong, fault in (
            (ends > matrix["episodes"], "successes, wrong picks and timeouts that are more than the row's episodes"),
            (matrix.get("seen", missing) & matrix.get("new", missing), "a pair that is both seen and new")):
        if wrong.any():
            raise ValueError(f"{path}: line {int(wrong.argmax()) + 2}: found {fault}")
    line_of = {}
    for line, row in enumerate(zip(_runs_and_pairs(matrix), matrix.get("first_episode", missing).tolist()), 2):
        if line_of.setdefault(row, line) != line:
            raise ValueError(f"{path}: line {line}: found the run, the pair and the first episode of line "
                             f"{line_of[row]} once more")


def _runs_and_pairs(matrix):
    """What the episodes of each row are of: run, temperature, eval_seed and pair."""
    def column(name):
        return matrix[name].tolist() if name in matrix else [None] * len(matrix["env"])

    settings = zip(*map(column, ("world", "window", "method", "seed", "updates")))
    runs = [run or setting for run, setting in zip(column("run"), settings)]
    return zip(runs, map(str, column("temperature")), *map(column, ("eval_seed", "env", "task")))


def rates(matrix):
    """Success rates of a matrix as an array [tasks, envs], with the names of both in the order of their appearance;
    NaN where a pair has no row. Rows of one pair are added up, whatever their runs; a ValueError where rows of one run
    and eval_seed share episodes."""
    first = np.asarray(matrix.get("first_episode", np.zeros(len(matrix["env"]), np.int64)))
    rows, counted = list(_runs_and_pairs(matrix)), {}
    for row in np.argsort(first, kind="stable"):
        if first[row] < counted.get(rows[row], 0):
            raise ValueError(f"episode {first[row]} of the pair '{matrix['env'][row]}', '{matrix['task'][row]}' twice "
                             "in one run")
        counted[rows[row]] = first[row] + matrix["episodes"][row]
    envs, tasks = list(dict.fromkeys(matrix["env"])), list(dict.fromkeys(matrix["task"]))
    successes, episodes = np.zeros((2, len(tasks), len(envs)))
    at = [tasks.index(task) for task in matrix["task"]], [envs.index(env) for env in matrix["env"]]
    np.add.at(successes, at, matrix["successes"])
    np.add.at(episodes, at, matrix["episodes"])
    with np.errstate(invalid="ignore"):
        return successes / episodes, tasks, envs


def _log_column(name):
    if name == "update":
        return _LONG
    if name.endswith("success") or name.startswith("right_") or name == "wrong":
        return lambda field: math.nan if field == "NA" else _real(field, 0, 1), float, "a rate from 0 to 1, or NA"
    return lambda field: math.nan if field == "NA" else _real(field), float, "a number or NA"


def read_log(path):
    """A run log as {column: float64 array}, NaN where it has NA. A resumed run does updates again: of all rows from
    such an update on, the later ones count. A last row that is cut off is left out."""
    header, columns, _ = _read_table(path)
    if "update" not in header:
        raise ValueError(f"{path}: line 1: no column 'update'")
    log = {}
    for column, fields in zip(header, columns):
        read, _, expected = _log_column(column)
        log[column] = _values(path, column, fields, read, expected)
    updates, kept = log["update"], []
    for row, update in enumerate(updates):
        while kept and updates[kept[-1]] >= update:
            kept.pop()
        kept.append(row)
    return {column: np.array(values, float)[kept] for column, values in log.items()}


# --- trajectories ------------------------------------------------------------------------------------------

def _is_start(value):
    return (isinstance(value, dict) and len(value) <= 64 and
            all(_are_whole(place, -2**20, 2**20) and len(place) == 2 for place in value.values()))


def _are_actions(value):
    return isinstance(value, list) and 1 <= len(value) <= 300 and _are_whole(value, 0, 255)


def _are_rewards(value):
    if not isinstance(value, list) or not set(map(type, value)) <= {int, float}:
        return False
    cents = 100 * np.array(value, float)
    return (np.abs(cents) < 1e6).all() and (np.abs(cents - np.rint(cents)) <= 1e-3).all()


def _are_scores(value):
    return isinstance(value, list) and all(
        isinstance(row, list) and len(row) == len(value[0]) and set(map(type, row)) <= {int, float, type(None)}
        for row in value)


def _from_to(low, high):
    return lambda value: _is_whole(value, low, high), f"a whole number from {low} to {high}"


_NAME = _is_name, "a name of 1 to 255 bytes without control characters"
_ACTIONS = _are_actions, "an array of 1 to 300 whole numbers from 0 to 255"
_SCORES = _are_scores, "an array of as many numbers for each step"
_TRUTH = lambda value: isinstance(value, bool), "true or false"
# What a field must be; those of a step stand first.
_TRAJECTORY_ARRAYS = {"actions": np.int64, "labels": np.int64, "rewards": np.float64, "scores": np.float32,
                      "probabilities": np.float64}
_TRAJECTORY_FIELDS = {
    "actions": _ACTIONS, "labels": _ACTIONS, "rewards": (_are_rewards, "an array of multiples of 0.01"),
    "scores": _SCORES, "probabilities": _SCORES,
    "world": _NAME, "rules": _from_to(0, 2**31 - 1), "env": _NAME, "task": _NAME,
    "env_hash": (_is_hash, "16 hexadecimal digits"), "window": _from_to(0, 1000), "seed": _from_to(0, 2**64 - 1),
    "episode": _from_to(0, 2**63 - 1), "start": (_is_start, "an object of places [row, column]"),
    "success": _TRUTH, "terminated": _TRUTH, "truncated": _TRUTH,
}


def _check_trajectory(episode):
    """Refuses what is not as synpo-trajectory(5) has it, and makes arrays."""
    episode.setdefault("labels", episode["actions"])
    for field, (holds, expected) in _TRAJECTORY_FIELDS.items():
        if field in ("scores", "probabilities") and field not in episode:
            continue
        _expect(holds(episode[field]), f"field '{field}'", episode[field], expected)
        if field in _TRAJECTORY_ARRAYS and len(episode[field]) != len(episode["actions"]):
            raise ValueError(f"'{field}' and 'actions' differ in length")
    for field, kind in _TRAJECTORY_ARRAYS.items():
        if field in episode:
            episode[field] = np.array(episode[field], kind)


def read_trajectories(source):
    """The episodes of a file (by its name, or an open one) one by one, each the dict of its line with arrays for
    actions, labels, rewards and, where they were recorded, scores (float32) and probabilities. Labels are always
    there. A stream that says its end is refused there where something is missing. Episodes are not played: whether the
    world has such a start, such actions and such rewards, `synpo-gen-expert --relabel` knows."""
    if isinstance(source, (str, os.PathLike)):
        with open(source, "rb") as file:
            yield from read_trajectories(file)
        return
    name = getattr(source, "name", "the stream")
    count, said = 0, None
    for number, line in enumerate(source, 1):
        try:
            text = (line.decode("utf-8") if isinstance(line, bytes) else line).removesuffix("\n")
            if len(text) > _MOST_LINE:
                raise ValueError(f"longer than {_MOST_LINE} bytes")
            episode = _parse_json(text)
            if not isinstance(episode, dict) or episode.get("format") not in ("synpo-trajectory", "synpo-end"):
                raise ValueError("not a synpo trajectory")
            if not _is_whole(episode["version"], 1, 1):
                raise ValueError(f"version {episode['version']}, this reader knows 1")
            if episode["format"] == "synpo-end":
                most = 2**63 - 1 - (said or 0)
                _expect(_is_whole(episode["trajectories"], 0, most), "field 'trajectories'",
                        episode["trajectories"], f"a whole number from 0 to {most}")
                said = (said or 0) + episode["trajectories"]
                continue
            count += 1
            _check_trajectory(episode)
        except (ValueError, TypeError, OverflowError) as error:
            raise ValueError(f"{name}: line {number}: {error}") from None
        except KeyError as error:
            raise ValueError(f"{name}: line {number}: no field {error}") from None
        yield episode
    if said is not None and said != count:
        raise ValueError(f"{name}: found {count} trajectories, its end says {said}")


# --- checkpoints -------------------------------------------------------------------------------------------

_TYPES = {"F64": "<f8", "F32": "<f4", "F16": "<f2", "BF16": "<u2", "I64": "<i8", "I32": "<i4", "U64": "<u8", "U8": "u1"}
_MOST_HEADER = 100_000_000
_MOST_BYTES = 2**34  # of a tensor


def read_safetensors(path):
    """(metadata, {name: array}) of a safetensors file. BF16 comes as float32; numpy does not have it."""
    with open(path, "rb") as file:
        head = file.read(8)
        if len(head) < 8:
            raise ValueError(f"{path}: it ends at byte {len(head)}, expected a safetensors header")
        size, = struct.unpack("<Q", head)
        if not 2 <= size <= _MOST_HEADER:
            raise ValueError(f"{path}: not a safetensors file (header length {size})")
        text = file.read(size)
        if len(text) < size:
            raise ValueError(f"{path}: it ends at byte {8 + len(text)}, in the middle of the header")
        try:
            header = _parse_json(text.decode("utf-8"), 4)
            _expect(isinstance(header, dict), "the header", header, "an object")
            metadata = header.pop("__metadata__", {})
            _expect(isinstance(metadata, dict) and all(isinstance(word, str) for word in metadata.values()),
                    "metadata", metadata, "an object of strings")
        except ValueError as error:
            raise ValueError(f"{path}: not a safetensors file ({error})") from None
        data = file.read()
    try:
        return metadata, _tensors(header, data)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _tensors(header, data):
    for name, entry in header.items():
        what = f"tensor '{name}'"
        _expect(isinstance(entry, dict) and {"dtype", "shape", "data_offsets"} <= entry.keys(), what, entry,
                "dtype, shape and data_offsets")
        _expect(isinstance(entry["dtype"], str) and entry["dtype"] in _TYPES, what + ": type", entry["dtype"],
                ", ".join(_TYPES))
        _expect(_are_whole(entry["shape"], 0, _MOST_BYTES) and len(entry["shape"]) <= 8, what + ": shape",
                entry["shape"], "at most 8 whole numbers")
        _expect(_are_whole(entry["data_offsets"], 0, 2**64 - 1) and len(entry["data_offsets"]) == 2,
                what + ": data_offsets", entry["data_offsets"], "two whole numbers")
    tensors, at = {}, 0
    for name, entry in sorted(header.items(), key=lambda item: item[1]["data_offsets"]):
        begin, end = entry["data_offsets"]
        if begin != at or not begin <= end <= len(data):
            raise ValueError(f"tensor '{name}': found bytes {begin} to {end}, expected {at} to {len(data)}")
        if math.prod(entry["shape"]) * np.dtype(_TYPES[entry["dtype"]]).itemsize != end - begin:
            raise ValueError(f"tensor '{name}': found {end - begin} bytes for the shape {entry['shape']}")
        array = np.frombuffer(data[begin:end], _TYPES[entry["dtype"]]).reshape(entry["shape"])
        if entry["dtype"] == "BF16":
            array = (array.astype("<u4") << 16).view("<f4")
        tensors[name] = array
        at = end
    if at != len(data):
        raise ValueError("bytes follow the last tensor")
    return tensors


def _are_names(value):
    return isinstance(value, list) and all(map(_is_name, value))


def _are_envs(value):
    return isinstance(value, list) and all(
        isinstance(env, dict) and {"name", "hash", "content"} <= env.keys() and _is_name(env["name"]) and
        _is_hash(env["hash"]) and all(isinstance(word, str) for word in env.values()) for env in value)


_METADATA_WHOLE = {"version": 2**63 - 1, "rules": 2**63 - 1, "window": 2**63 - 1, "updates": 2**53, "states": 2**53,
                   "seed": 2**63 - 1}
_METADATA_JSON = {
    "shape": (lambda value: isinstance(value, dict) and _are_whole(list(value.values()), -2**63, 2**64 - 1),
              "an object of whole numbers"),
    "options": (lambda value: isinstance(value, dict) and all(isinstance(word, str) for word in value.values()),
                "an object of strings"),
    "tasks": (_are_names, "an array of names"),
    "seen": (lambda value: isinstance(value, list) and all(_are_names(pair) and len(pair) == 2 for pair in value),
             "an array of pairs of names"),
    "envs": (_are_envs, "an array of objects with name, hash and content"),
}


class Checkpoint:
    """A policy with its world. `metadata` is as synpo-checkpoint(5) has it, with numbers and structures parsed;
    `tensors` are arrays by name; `envs` and `tasks` are names in the order of their embeddings, `seen` is a list of
    pairs of names."""

    def __init__(self, metadata, tensors, path="checkpoint"):
        if metadata.get("format") != "synpo-checkpoint":
            raise ValueError(f"{path}: not a synpo checkpoint")
        self.path, self.tensors, self.metadata = path, tensors, dict(metadata)
        try:
            for key, most in _METADATA_WHOLE.items():
                self._parse(key, lambda text: _whole(text, 0, most), f"a whole number from 0 to {most}")
            if self.metadata["version"] != 1:
                raise ValueError(f"version {metadata['version']}, this reader knows 1")
            for key in ("method", "world"):
                _expect(_is_name(metadata[key]), f"metadata '{key}'", metadata[key], _NAME[1])
            for key, (holds, expected) in _METADATA_JSON.items():
                self._parse(key, _parse_json, expected)
                _expect(holds(self.metadata[key]), f"metadata '{key}'", self.metadata[key], expected)
        except KeyError as error:
            raise ValueError(f"{path}: no metadata {error}") from None
        except (ValueError, TypeError) as error:
            raise ValueError(f"{path}: {error}") from None
        self.method, self.world, self.window = metadata["method"], metadata["world"], self.metadata["window"]
        self.envs = [env["name"] for env in self.metadata["envs"]]
        self.tasks, self.shape = self.metadata["tasks"], self.metadata["shape"]
        self.seen = [(env, task) for env, task in self.metadata["seen"]]

    def _parse(self, key, parse, expected):
        try:
            self.metadata[key] = parse(self.metadata[key])
        except ValueError as error:
            raise ValueError(f"metadata '{key}': {error}, expected {expected}") from None


def read_checkpoint(path):
    return Checkpoint(*read_safetensors(path), path)


# --- the policy --------------------------------------------------------------------------------------------

STRIDES = (2, 2, 2, 1)
HISTORY = 4  # views in an observation
HAND = 16    # numbers after those of a kitchen's views

if torch is not None:
    from torch import nn
    from torch.nn import functional as F

    # Modules are made without memory, which they are given when the file's tensors are known to have their shapes.
    _UNMADE = {"device": "meta"}

    def _unmade(*shape):
        return nn.Parameter(torch.zeros(*shape, **_UNMADE))

    class _Block(nn.Module):
        def __init__(self, inputs, outputs, stride, first):
            super().__init__()
            self.conv1 = nn.Conv2d(inputs, outputs, 3, stride, 1, bias=False, **_UNMADE)
            self.norm1 = nn.BatchNorm2d(outputs, **_UNMADE)
            self.conv2 = nn.Conv2d(outputs, outputs, 3, 1, 1, bias=False, **_UNMADE)
            self.norm2 = nn.BatchNorm2d(outputs, **_UNMADE)
            self.first = first
            if first:
                self.shortcut = nn.Conv2d(inputs, outputs, 1, stride, bias=False, **_UNMADE)
                self.shortcut_norm = nn.BatchNorm2d(outputs, **_UNMADE)

        def forward(self, x):
            y = self.norm2(self.conv2(F.relu(self.norm1(self.conv1(x)))))
            return F.relu(y + (self.shortcut_norm(self.shortcut(x)) if self.first else x))

    class _Pictures(nn.Module):
        """psi of pictures, [N, side, side, 12] from 0 to 255 -> [N, d]."""

        def __init__(self, shape):
            super().__init__()
            inputs = 3 * HISTORY
            for s, stride in enumerate(STRIDES, 1):
                outputs = shape[f"channels{s}"]
                self.add_module(f"stage{s}", nn.ModuleDict({"block1": _Block(inputs, outputs, stride, True),
                                                            "block2": _Block(outputs, outputs, 1, False)}))
                inputs = outputs
            self.fc = nn.Linear(4 * inputs, shape["feature"], **_UNMADE)
            self.normalises = bool(shape["normalise_input"])
            if self.normalises:
                self.input = nn.Module()
                self.input.register_buffer("mean", torch.zeros(3 * HISTORY, **_UNMADE))
                self.input.register_buffer("variance", torch.ones(3 * HISTORY, **_UNMADE))

        def forward(self, x):
            x = x.to(self.fc.weight.dtype).permute(0, 3, 1, 2)
            if self.normalises:
                x = F.batch_norm(x, self.input.mean, self.input.variance, eps=1e-5)
            else:
                x = x / 64
            for s in range(1, 5):
                for block in getattr(self, f"stage{s}").values():
                    x = block(x)
            return self.fc(x.permute(0, 2, 3, 1).flatten(1))

    class _Features(nn.Module):
        """psi of a kitchen's features, [N, 4 * view + 16] -> [N, d]."""

        def __init__(self, shape):
            super().__init__()
            self.view = shape["view"]
            self.conv1 = nn.Conv1d(shape["view"], shape["view_channels"], 3, 2, 1, **_UNMADE)
            self.conv2 = nn.Conv1d(shape["view_channels"], shape["view_channels"], 3, 2, 1, **_UNMADE)
            self.object = _unmade(shape["objects"], shape["object_embedding"])
            self.fc = _Mlp(shape["view_channels"] + shape["object_embedding"], shape["view_hidden"], shape["feature"])

        def forward(self, x):
            x = x.to(self.object.dtype)
            views = x[:, :HISTORY * self.view].reshape(-1, HISTORY, self.view).transpose(1, 2)
            y = F.relu(self.conv2(F.relu(self.conv1(views)))).flatten(1)
            return self.fc(torch.cat([y, self.object[x[:, -HAND].long()]], 1))

    class _Mlp(nn.Module):
        def __init__(self, inputs, hidden, outputs):
            super().__init__()
            self.hidden = nn.Linear(inputs, hidden, **_UNMADE)
            self.out = nn.Linear(hidden, outputs, **_UNMADE)

        def forward(self, x):
            return self.out(F.relu(self.hidden(x)))

    class Policy(nn.Module):
        """A policy of any method. forward() takes observations [N, ...] as Env gives them, and the positions of
        environment and task [N] in `envs` and `tasks`; it gives synpo's scores [N, actions]. Parameters have synpo's
        names, in torch's layouts."""

        def __init__(self, checkpoint):
            super().__init__()
            shape = self.shape = checkpoint.shape
            self.method, self.envs, self.tasks = checkpoint.method, checkpoint.envs, checkpoint.tasks
            for name, size in shape.items():
                if type(size) is not int or not 0 <= size < 2**24:
                    raise ValueError(f"{checkpoint.path}: shape: found '{name}' {size}, expected 0 to {2**24 - 1}")
            if (shape.get("envs"), shape.get("tasks")) != (len(self.envs), len(self.tasks)):
                raise ValueError(f"{checkpoint.path}: the shape is of other environments or tasks than the world")
            try:
                self.normalises = bool(shape["normalise_embeddings"])
                self.encoder = (_Features if "view" in shape else _Pictures)(shape)
                if self.method != "modulenet":
                    names = ["task"] if self.method == "mtl" else ["env", "task"]
                    self.embedding = nn.ParameterDict(
                        {name: _unmade(shape[name + "s"], shape["embedding"]) for name in names})
                self._make_head(shape)
            except KeyError as error:
                raise ValueError(f"{checkpoint.path}: the shape has no {error}") from None
            except RuntimeError as error:
                raise ValueError(f"{checkpoint.path}: no network has this shape: {error}") from None
            self._load(checkpoint)
            self.eval()

        def _make_head(self, shape):
            feature, embedding, actions = shape["feature"], shape["embedding"], shape["actions"]
            wide, both = shape.get("head_hidden", 1024), feature + 2 * embedding
            if self.method in ("synpo", "mtl"):
                inputs, mixed = len(self.embedding) * embedding, shape.get("action_embedding", 0)
                self.alpha = _Mlp(inputs, shape["hidden"], shape["basis"])
                self.beta = _Mlp(inputs, shape["hidden"], shape["basis"])
                self.theta = _unmade(mixed or actions, feature, shape["basis"])
                if mixed:
                    self.phi = _unmade(actions, mixed)
                self.policy = nn.ParameterDict({"bias": _unmade(actions)})
                self.reward = nn.ParameterDict({"bias": _unmade(actions)})
                for name in self.embedding:
                    self.add_module("f_" + name, _Mlp(shape["basis"], shape["hidden"], embedding))
            elif self.method == "mlp":
                self.policy, self.reward = _Mlp(both, wide, actions), _Mlp(both, wide, actions)
                self.f_env = _Mlp(feature, shape["hidden"], embedding)
                self.f_task = _Mlp(feature, shape["hidden"], embedding)
            elif self.method == "modulenet":
                seam = shape.get("seam", 32)
                modules = {f"task{i}": _Mlp(feature, wide, seam) for i in range(shape["tasks"])}
                modules.update({f"env{i}": _Mlp(seam, wide, actions) for i in range(shape["envs"])})
                self.module = nn.ModuleDict(modules)
            elif self.method == "sf":
                self.phi, self.psi = _Mlp(feature, wide, actions * embedding), _Mlp(both, wide, actions * embedding)
            else:
                raise ValueError(f"method '{self.method}', this reader knows synpo, mtl, mlp, modulenet and sf")

        def _load(self, checkpoint):
            state = {}
            for name, own in self.state_dict().items():
                if name.endswith("num_batches_tracked"):
                    continue
                file_name = _file_name(name)
                if file_name not in checkpoint.tensors:
                    raise ValueError(f"{checkpoint.path}: no tensor '{file_name}'")
                tensor = torch.from_numpy(checkpoint.tensors[file_name].astype(np.float32))
                if name.endswith(".weight") and "norm" not in name:  # the inputs stand before the outputs in the file
                    if own.dim() > 2 and tensor.dim() == 2:
                        tensor = tensor[(None,) * (own.dim() - 2)]
                    order = tuple(range(tensor.dim()))
                    tensor = tensor.permute(*order[-1:], *order[-2:-1], *order[:-2])
                if tensor.shape != own.shape:
                    raise ValueError(f"{checkpoint.path}: tensor '{file_name}': found shape "
                                     f"{list(checkpoint.tensors[file_name].shape)}, expected that of the metadata")
                state[name] = tensor.contiguous()
            self.to_empty(device="cpu")
            state.update({name: torch.zeros((), dtype=torch.long) for name in self.state_dict()
                          if name.endswith("num_batches_tracked")})
            self.load_state_dict(state)

        def of_pair(self, env, task):
            """The policy of one pair, by names or positions, as a module that takes observations alone: for
            export_onnx()."""
            return _OfPair(self, self._positions(env, self.envs, 1), self._positions(task, self.tasks, 1))

        def _embedded(self, name, index):
            rows = self.embedding[name][index]
            if not self.normalises:
                return rows
            return rows * torch.sqrt(rows.shape[1] / (rows.square().sum(1, keepdim=True) + 1e-12))

        def matrices(self):
            """theta of every action, [actions, d, K], of the methods synpo and mtl."""
            return torch.einsum("ac,cik->aik", self.phi, self.theta) if hasattr(self, "phi") else self.theta

        def forward(self, observations, env, task):
            psi = self.encoder(observations)
            if self.method == "modulenet":
                rows = [self.module[f"env{e}"](self.module[f"task{t}"](row))
                        for e, t, row in zip(env.tolist(), task.tolist(), psi)]
                return torch.stack(rows)
            index = {"env": env, "task": task}
            z = torch.cat([self._embedded(name, index[name]) for name in ("env", "task") if name in self.embedding], 1)
            if self.method == "mlp":
                unit = psi / torch.sqrt(psi.square().sum(1, keepdim=True) + 1e-12)
                return self.policy(torch.cat([unit, z], 1))
            if self.method == "sf":
                features = self.psi(torch.cat([psi, z], 1)).view(len(psi), self.shape["actions"], -1)
                return (features * self._embedded("task", task)[:, None]).sum(2)
            return torch.einsum("ni,aik,nk->na", psi, self.matrices(), self.alpha(z)) + self.policy["bias"]

        @torch.no_grad()
        def scores(self, observations, env, task):
            """forward() of one observation or of many, as an array; env and task are names or positions, one for all
            or one for each."""
            observations = np.asarray(observations)
            single = observations.ndim == (1 if "view" in self.shape else 3)
            many = observations[None] if single else observations
            out = self(torch.as_tensor(many), self._positions(env, self.envs, len(many)),
                       self._positions(task, self.tasks, len(many))).numpy()
            return out[0] if single else out

        def act(self, observation, env, task, temperature=0, generator=None):
            """The best action for one observation or, with a temperature, one drawn by the numpy generator."""
            scores = self.scores(observation, env, task).astype(np.float64)
            if temperature == 0:
                return int(scores.argmax())
            p = np.exp((scores - scores.max()) / temperature)
            return int((generator or np.random.default_rng()).choice(len(p), p=p / p.sum()))

        @staticmethod
        def _positions(which, names, count):
            which = [which] * count if np.ndim(which) == 0 else list(which)
            for name in which:
                if isinstance(name, str) and name not in names:
                    raise ValueError(f"the policy does not know '{name}'")
            return torch.tensor([names.index(name) if isinstance(name, str) else int(name) for name in which])

    class _OfPair(nn.Module):
        """What a pair fixes is worked into the weights: psi goes through layers that are dense."""

        @torch.no_grad()
        def __init__(self, policy, env, task):
            super().__init__()
            self.encoder, self.unit, feature = policy.encoder, policy.method == "mlp", policy.shape["feature"]
            self.register_buffer("ones", torch.ones(feature, feature))
            index, method = {"env": env, "task": task}, policy.method
            if method != "modulenet":
                z = torch.cat([policy._embedded(name, index[name]) for name in ("env", "task")
                               if name in policy.embedding], 1)
            if method in ("synpo", "mtl"):
                matrix = (policy.matrices() * policy.alpha(z)[0]).sum(2)
                self.layers = nn.Sequential(_dense(matrix, policy.policy["bias"]))
            elif method == "modulenet":
                first, second = policy.module[f"task{int(task)}"], policy.module[f"env{int(env)}"]
                self.layers = nn.Sequential(first.hidden, nn.ReLU(), first.out, second.hidden, nn.ReLU(), second.out)
            else:
                head = policy.policy if method == "mlp" else policy.psi
                weight, out = head.hidden.weight, head.out
                hidden = _dense(weight[:, :feature], head.hidden.bias + weight[:, feature:] @ z[0])
                if method == "sf":  # the task's row is the last factor of every value
                    row = policy._embedded("task", task)[0]
                    out = _dense(torch.einsum("ach,c->ah", out.weight.view(policy.shape["actions"], len(row), -1), row),
                                 out.bias.view(-1, len(row)) @ row)
                self.layers = nn.Sequential(hidden, nn.ReLU(), out)

        def forward(self, observations):
            psi = self.encoder(observations)
            if self.unit:
                psi = psi / torch.sqrt((psi * psi) @ self.ones + 1e-12)  # without broadcasting, which OpenCV lacks
            return self.layers(psi)

    def _dense(weight, bias):
        layer = nn.Linear(weight.shape[1], weight.shape[0])
        layer.weight, layer.bias = nn.Parameter(weight.contiguous()), nn.Parameter(bias.contiguous())
        return layer

    _NORM_NAMES = {"weight": "scale", "bias": "shift", "running_mean": "mean", "running_var": "variance"}

    def _file_name(name):
        head, _, last = name.rpartition(".")
        return f"{head}.{_NORM_NAMES[last]}" if "norm" in head.rpartition(".")[2] else name


def load_policy(checkpoint):
    """The policy of a checkpoint, or of the file of that name, as a torch.nn.Module (class Policy)."""
    if torch is None:
        raise ImportError("load_policy needs torch (Debian: python3-torch)")
    return Policy(checkpoint if isinstance(checkpoint, Checkpoint) else read_checkpoint(checkpoint))


def export_onnx(checkpoint, env, task, path):
    """Writes the policy of a checkpoint of the mazes, for one pair, as an ONNX network: from "observations", float32
    [N, 16, 16, 12] as Env gives them, to synpo's "scores" [N, actions]. OpenCV's dnn module runs it."""
    policy = load_policy(checkpoint)
    if "view" in policy.shape:
        raise ValueError("a policy of the kitchens, expected one of the mazes")
    torch.onnx.export(policy.of_pair(env, task), torch.zeros(1, 16, 16, 3 * HISTORY), path,
                      input_names=["observations"], output_names=["scores"], opset_version=11,
                      dynamic_axes={"observations": {0: "N"}, "scores": {0: "N"}})


# --- the worlds --------------------------------------------------------------------------------------------

_STARTS = ("expert", "evaluation", "training")
_SUCCESS, _TERMINATED, _TRUNCATED = 1, 2, 4


class Server:
    """synpo-gen-expert --play, asked in the protocol of synpo-play(5). Episodes go on in places, numbered from 0."""

    def __init__(self, world="gridworld", pairs=None, window=1, program="synpo-gen-expert"):
        command = [program, "--play", "-w", world, "--window", str(window)] + (["-p", str(pairs)] if pairs else [])
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        greeting = self._process.stdout.readline()
        if not greeting:
            self._fail()
        greeting = json.loads(greeting)
        if greeting["format"] != "synpo-play" or greeting["version"] != 1:
            raise ValueError(f"{program}: found the protocol {greeting['format']} {greeting['version']}, "
                             "expected synpo-play 1")
        self.world, self.window, self.step_limit = greeting["world"], greeting["window"], greeting["step_limit"]
        self.envs = [env["name"] for env in greeting["envs"]]
        self.env_hashes = {env["name"]: env["hash"] for env in greeting["envs"]}
        self.tasks, self.actions = greeting["tasks"], greeting["actions"]
        self.pairs = [tuple(pair) for pair in greeting["pairs"]]
        view = greeting["observation"]
        self._bytes = view["bytes"]
        if "palette" in view:
            self._palette = np.array(view["palette"], np.uint8)
            self._codes = (view["side"], view["side"], view["history"])
            self.observation_shape, self.observation_type = self._codes[:2] + (3 * view["history"],), np.uint8
        else:
            self._palette = None
            self.observation_shape, self.observation_type = (self._bytes // 4,), np.float32

    def reset(self, place, env, task, seed=1, episode=0, starts="expert"):
        """An episode starts in a place; env and task are positions. Returns the observation."""
        try:
            request = struct.pack("<cIIIQQB", b"r", place, env, task, seed, episode, _STARTS.index(starts))
        except struct.error as error:
            raise ValueError(f"found the place {place}, the pair {env}, {task}, the seed {seed} and the episode "
                             f"{episode}: {error}") from None
        return self._observations(self._ask(request, self._bytes), 1)[0]

    def step(self, places, actions):
        """Steps in some places: observations [n, ...], rewards [n], success, terminated and truncated [n]."""
        places, actions = np.asarray(places, "<u4"), np.asarray(actions)
        whole = actions.size == 0 or actions.dtype.kind in "biu"
        if actions.shape != places.shape or not whole or ((actions < 0) | (actions >= len(self.actions))).any():
            raise ValueError(f"found actions {actions}, expected {len(places)} from 0 to {len(self.actions) - 1}")
        n = len(places)
        request = struct.pack("<cI", b"s", n) + places.tobytes() + actions.astype(np.uint8).tobytes()
        answer = self._ask(request, n * (5 + self._bytes))
        rewards = np.frombuffer(answer, "<i4", n) / 100
        flags = np.frombuffer(answer, np.uint8, n, 4 * n)
        return (self._observations(answer[5 * n:], n), rewards, (flags & _SUCCESS) > 0, (flags & _TERMINATED) > 0,
                (flags & _TRUNCATED) > 0)

    def expert(self, places):
        """What the expert would do in each of these places [n]."""
        places = np.asarray(places, "<u4")
        answer = self._ask(struct.pack("<cI", b"x", len(places)) + places.tobytes(), len(places))
        return np.frombuffer(answer, np.uint8).astype(np.int64)

    def close(self):
        try:
            self._process.stdin.close()
        except BrokenPipeError:
            pass  # it has ended, and said why
        self._process.stdout.close()
        self._process.wait()
        self._process.stderr.close()

    def _ask(self, request, size):
        if self._process.stdin.closed:
            raise RuntimeError(f"{self._process.args[0]} has ended")
        try:
            self._process.stdin.write(request)
            self._process.stdin.flush()
            answer = self._process.stdout.read(size)
        except BrokenPipeError:
            answer = b""
        if len(answer) < size:
            self._fail()
        return answer

    def _fail(self):
        message = self._process.stderr.read().decode(errors="replace").strip()
        self.close()
        raise RuntimeError(message or f"{self._process.args[0]} ended with {self._process.returncode}")

    def _observations(self, data, count):
        if self._palette is None:
            return np.frombuffer(data, "<f4").reshape(count, -1).copy()
        codes = np.frombuffer(data, np.uint8).reshape((count,) + self._codes)
        return self._palette[codes].reshape((count,) + self.observation_shape)


class BatchEnv:
    """Episodes in n places side by side, of pairs drawn at random from the server's.

    Where one ends, the next one starts in the same step: the observation is the new one's, and info["final"] has those
    that were last, by place. Episode k of a seed is the same whatever n is: of the pair and from the start that Env
    gives it."""

    def __init__(self, count, world="gridworld", pairs=None, window=1, program="synpo-gen-expert"):
        self.server = Server(world, pairs, window, program)
        self.count, self._places = count, np.arange(count)
        self.pairs = np.zeros((count, 2), np.int64)  # (env, task) of each place, by position
        self._seed, self._next = None, 0

    def reset(self, seed=None):
        if seed is not None or self._seed is None:
            self._seed, self._next = _seed(seed), 0
        observations = np.stack([self._start(place) for place in range(self.count)])
        return observations, {"env": self.pairs[:, 0].copy(), "task": self.pairs[:, 1].copy()}

    def step(self, actions):
        observations, rewards, success, terminated, truncated = self.server.step(self._places, actions)
        info = {"success": success, "final": {}}
        for place in np.flatnonzero(terminated | truncated):
            info["final"][int(place)] = observations[place].copy()
            observations[place] = self._start(int(place))
        info["env"], info["task"] = self.pairs[:, 0].copy(), self.pairs[:, 1].copy()
        return observations, rewards, terminated, truncated, info

    def expert(self):
        return self.server.expert(self._places)

    def close(self):
        self.server.close()

    def _start(self, place):
        self.pairs[place] = _drawn_pair(self.server, self._seed, self._next)
        self._next += 1
        return self.server.reset(place, *map(int, self.pairs[place]), self._seed, self._next - 1)


class Env(gymnasium.Env if gymnasium else object):
    """One episode after the other, as gymnasium.Env has it; gymnasium need not be there.

    Observations are colours, uint8 [16, 16, 12], in the mazes, and float32 [8208] in the kitchens: what the network
    of synpo-checkpoint(5) is given. The task is in the info, by name and by position."""

    metadata = {"render_modes": []}
    render_mode = None

    def __init__(self, world="gridworld", pairs=None, window=1, program="synpo-gen-expert"):
        self.server = Server(world, pairs, window, program)
        self._seed, self._next, self._info, self._goes_on = None, 0, {}, False
        if gymnasium:
            pictures = self.server.observation_type is np.uint8
            self.observation_space = gymnasium.spaces.Box(
                0 if pictures else -np.inf, 255 if pictures else np.inf, self.server.observation_shape,
                self.server.observation_type)
            self.action_space = gymnasium.spaces.Discrete(len(self.server.actions))

    def reset(self, *, seed=None, options=None):
        """Starts an episode. With a seed, that seed's first; without, the next one of the same seed.

        Options: `env` and `task`, by name or position, in place of a pair drawn at random; `episode`, its number in
        the seed; `starts`, one of expert (the starts of synpo-gen-expert, the default), evaluation (of synpo-eval) and
        training (of its --starts training). A record of these programs has all of these numbers and names."""
        options = dict(options or {})
        if gymnasium:
            super().reset(seed=seed)
        if seed is not None or self._seed is None:
            self._seed, self._next = _seed(seed), 0
        episode = int(options.pop("episode", self._next))
        if not 0 <= episode < 2**63:
            raise ValueError(f"found the episode {episode}, expected one from 0 to 2^63 - 1")
        self._next = episode + 1
        env, task = _drawn_pair(self.server, self._seed, episode)
        env = _position(options.pop("env", env), self.server.envs)
        task = _position(options.pop("task", task), self.server.tasks)
        starts = options.pop("starts", "expert")
        if options:
            raise ValueError(f"found the options {sorted(options)}, expected env, task, episode and starts")
        if starts not in _STARTS:
            raise ValueError(f"found the starts '{starts}', expected one of {', '.join(_STARTS)}")
        observation = self.server.reset(0, env, task, self._seed, episode, starts)
        self._goes_on = True
        self._info = {"env": self.server.envs[env], "task": self.server.tasks[task], "env_position": env,
                      "task_position": task, "seed": self._seed, "episode": episode}
        return observation, dict(self._info)

    def step(self, action):
        if not self._goes_on:
            raise RuntimeError("no episode goes on: reset() starts one")
        observations, rewards, success, terminated, truncated = self.server.step([0], [int(action)])
        self._goes_on = not (terminated[0] or truncated[0])
        info = dict(self._info, success=bool(success[0]))
        return observations[0], float(rewards[0]), bool(terminated[0]), bool(truncated[0]), info

    def expert(self):
        """What the shortest-path planner would do."""
        return int(self.server.expert([0])[0])

    def close(self):
        self.server.close()


def _seed(seed):
    if seed is None:
        return int(np.random.SeedSequence().generate_state(1, np.uint64)[0])
    if not 0 <= int(seed) < 2**64:
        raise ValueError(f"found the seed {seed}, expected one from 0 to 2^64 - 1")
    return int(seed)


def _drawn_pair(server, seed, episode):
    return server.pairs[int(np.random.default_rng([seed, episode]).integers(len(server.pairs)))]


def _position(which, names):
    if isinstance(which, str):
        if which not in names:
            raise ValueError(f"found '{which}', expected one of {', '.join(names)}")
        return names.index(which)
    if not 0 <= int(which) < len(names):
        raise ValueError(f"found the position {which}, expected 0 to {len(names) - 1}")
    return int(which)

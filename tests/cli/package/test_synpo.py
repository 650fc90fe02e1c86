"""What python/synpo.py reads and plays must be what the programs wrote and did. test_synpo.py FOLDER: with the files
that python.bats makes there."""
import io
import json
import os
import resource
import struct
import subprocess
import sys
import unittest

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "../../../python"))
import synpo  # noqa: E402

FOLDER = sys.argv.pop(1) if len(sys.argv) > 1 else "."
MAZES, KITCHENS = ("synpo", "mtl", "mlp", "modulenet", "sf", "blind", "mixed", "half"), ("kitchen-synpo", "kitchen-mlp")


def here(name):
    return os.path.join(FOLDER, name)


def written(name, text):
    with open(here(name), "wb") as file:
        file.write(text if isinstance(text, bytes) else text.encode())
    return here(name)


class Files(unittest.TestCase):
    def refused(self, words, function, *arguments):
        with self.assertRaises(ValueError) as caught:
            function(*arguments)
        self.assertIn(words, str(caught.exception))

    def test_a_matrix_has_the_columns_of_the_file(self):
        matrix = synpo.read_matrix(here("synpo.tsv"))
        self.assertEqual(list(matrix["env"]), ["map1", "map2"])
        self.assertEqual(list(matrix["task"]), ["R-B", "B-G"])
        self.assertEqual(list(matrix["episodes"]), [2, 2])
        self.assertEqual(matrix["temperature"][0], 0.5)
        self.assertEqual(matrix["successes"].dtype, np.int64)
        rates, tasks, envs = synpo.rates(matrix)
        self.assertEqual((tasks, envs), (["R-B", "B-G"], ["map1", "map2"]))
        self.assertTrue(np.isnan(rates[0, 1]) and np.isnan(rates[1, 0]))
        self.assertEqual(rates[1, 1], matrix["successes"][1] / 2)

    def test_rows_of_a_pair_are_added_up(self):
        head = "env\ttask\tfirst_episode\tepisodes\tsuccesses\treward\n"
        matrix = synpo.read_matrix(written("two.tsv", head + "a\tR-B\t1\t1\t1\t2.5\na\tR-B\t2\t3\t1\t\n"))
        self.assertEqual(synpo.rates(matrix)[0].tolist(), [[0.5]])
        self.assertTrue(np.isnan(matrix["reward"][1]) and matrix["reward"][0] == 2.5)
        matrix = synpo.read_matrix(written("two.tsv", head + "a\tR-B\t3\t1\t1\t\na\tR-B\t2\t3\t1\t\n"))
        self.refused("episode 3 of the pair 'a', 'R-B' twice", synpo.rates, matrix)

    def test_a_log_is_read_with_NA_and_repeated_updates(self):
        log = synpo.read_log(here("run.log"))
        self.assertEqual(log["update"].tolist(), [1, 2])
        self.assertTrue(np.isnan(log["seen_success"][0]) and log["loss"][0] > 0)
        twice = written("twice.log", "update\tloss\n1\t3\n2\tNA\n1\t4\n2\t5\n3")
        self.assertEqual({name: list(column) for name, column in synpo.read_log(twice).items()},
                         {"update": [1, 2], "loss": [4, 5]})

    def test_of_a_log_that_was_resumed_with_another_report_the_later_rows_count(self):
        rows = "".join(f"{update / 2}\t{update}\n" for update in (10, 20, 30, 15, 25))
        log = synpo.read_log(written("resumed.log", "loss\tupdate\n" + rows))
        self.assertEqual(log["update"].tolist(), [10, 15, 25])
        self.assertEqual(log["loss"].tolist(), [5, 7.5, 12.5])
        self.refused("no column 'update'", synpo.read_log, written("resumed.log", "step\tloss\n1\t2\n"))

    def test_trajectories_are_those_of_the_record(self):
        with open(here("synpo.jsonl"), encoding="utf-8") as file:
            lines = [json.loads(line) for line in file]
        episodes = list(synpo.read_trajectories(here("synpo.jsonl")))
        self.assertEqual(len(episodes), 4)
        for line, episode in zip(lines, episodes):
            self.assertEqual(episode["actions"].tolist(), line["actions"])
            self.assertEqual(episode["labels"].tolist(), line.get("labels", line["actions"]))
            self.assertEqual(episode["probabilities"].tolist(), line["probabilities"])
            self.assertEqual(episode["scores"].dtype, np.float32)
            weights = np.exp(episode["scores"].astype(float) / episode["temperature"])
            np.testing.assert_allclose(episode["probabilities"], weights / weights.sum(1, keepdims=True), rtol=1e-12)

    def test_a_stream_that_says_its_end_has_all_or_is_refused(self):
        with open(here("synpo.jsonl"), encoding="utf-8") as file:
            lines = file.readlines()
        end = '{"format":"synpo-end","version":1,"trajectories":2}\n'
        self.assertEqual(len(list(synpo.read_trajectories(io.StringIO("".join(lines[:2]) + end)))), 2)
        self.assertEqual(len(list(synpo.read_trajectories(io.StringIO("".join(lines[:2] + [end] + lines[2:4]) + end)))),
                         4)
        self.refused("found 1 trajectories, its end says 2", list,
                     synpo.read_trajectories(io.StringIO(lines[0] + end)))

    def test_a_checkpoint_has_metadata_and_tensors(self):
        checkpoint = synpo.read_checkpoint(here("synpo.ckpt"))
        described = json.loads(subprocess.check_output(["synpo-eval", "--describe", "-c", here("synpo.ckpt")]))
        self.assertEqual(checkpoint.tasks, described["tasks"])
        self.assertEqual(checkpoint.envs, [env["name"] for env in described["envs"]])
        self.assertEqual(checkpoint.metadata["options"], described["options"])
        self.assertEqual([list(pair) for pair in checkpoint.seen], described["seen"])
        self.assertEqual({name: list(tensor.shape) for name, tensor in checkpoint.tensors.items()},
                         described["tensors"])

    def test_a_whole_checkpoint_and_half_precision_are_read(self):
        metadata, tensors = synpo.read_safetensors(here("whole.ckpt"))
        self.assertEqual(tensors["train/position"].dtype, np.int64)
        self.assertEqual(tensors["train/position"][2], 2)
        header = {"a": {"dtype": "BF16", "shape": [2], "data_offsets": [0, 4]},
                  "b": {"dtype": "F16", "shape": [1, 2], "data_offsets": [4, 8]}}
        text = json.dumps(header).encode()
        path = written("half", struct.pack("<Q", len(text)) + text + struct.pack("<HH", 0x3FC0, 0xC000) +
                       np.array([0.5, -2], "<f2").tobytes())
        metadata, tensors = synpo.read_safetensors(path)
        self.assertEqual((tensors["a"].tolist(), tensors["a"].dtype), ([1.5, -2.0], np.float32))
        self.assertEqual(tensors["b"].tolist(), [[0.5, -2.0]])

    def test_what_is_broken_is_refused_by_name(self):
        self.refused("line 2: found 1 fields, expected 4", synpo.read_matrix,
                     written("x", "env\ttask\tepisodes\tsuccesses\na\n"))
        self.refused("no column 'task'", synpo.read_matrix, written("x", "env\tepisodes\tsuccesses\na\t1\t1\n"))
        self.refused("the last line has no end", synpo.read_matrix,
                     written("x", "env\ttask\tepisodes\tsuccesses\na\tb\t1\t1"))
        self.refused("column 'episodes'", synpo.read_matrix,
                     written("x", "env\ttask\tepisodes\tsuccesses\na\tb\tone\t1\n"))
        self.refused("no header", synpo.read_log, written("x", ""))
        for line, words in (("{", "line 2"), ("[]", "not a synpo trajectory"),
                            ('{"format":"synpo-trajectory","version":2}', "version 2"),
                            ('{"format":"synpo-trajectory","version":1}', "no field 'actions'"),
                            ('{"format":"synpo-trajectory","version":1,"actions":[1,2],"rewards":[1]}', "differ")):
            with open(here("synpo.jsonl"), encoding="utf-8") as file:
                first = file.readline()
            self.refused(words, list, synpo.read_trajectories(io.StringIO(first + line + "\n")))
        with open(here("synpo.ckpt"), "rb") as file:
            good = file.read()
        for size in (0, 5, 100, len(good) // 2, len(good) - 1):
            self.refused("x:", synpo.read_checkpoint, written("x", good[:size]))
        self.refused("bytes follow", synpo.read_checkpoint, written("x", good + b"x"))
        self.refused("header length", synpo.read_checkpoint, written("x", struct.pack("<Q", 2**40) + good[8:]))
        self.refused("not a synpo checkpoint", synpo.read_checkpoint, here("half"))
        for change in ({"data_offsets": [4, 8]}, {"dtype": "F8"}, {"shape": None}, {"data_offsets": 3}):
            text = json.dumps({"a": {"dtype": "F32", "shape": [1], "data_offsets": [0, 4], **change}}).encode()
            self.refused("x: ", synpo.read_safetensors, written("x", struct.pack("<Q", len(text)) + text + bytes(4)))


    def test_tables_are_read_no_more_freely_than_by_the_programs(self):
        head = "env\ttask\tseen\tepisodes\tsuccesses\treward\ttemperature\n"
        row = ["map1", "R-B", "1", "10", "5", "2.5", "0.5"]
        with open(here("good.tsv"), "w", encoding="utf-8") as file:
            file.write(head + "\t".join(row) + "\n")
        subprocess.check_output(["synpo-matrix", "merge", here("good.tsv")])
        synpo.read_matrix(here("good.tsv"))
        tables = {"\ufeff" + head: None, head.replace("\n", "\r\n"): None, head.replace("reward", "env"): None,
                  head.replace("reward", ""): None}
        tables = [table + "\t".join(row) + "\n" for table in tables]
        for column, fields in {0: ["", "\udcff"], 2: ["2", "-1", "1.0", "\u0661"],
                               3: ["0", "-1", "1_0", " 10", "+10", "1e1", "10" * 30, "0x10", "NaN", "4",
                                   "\u0661\u0660"],
                               4: ["-5", "11", ""], 5: ["nan", "inf", "1e999", "1_0", " 1", "+1", "0x1p3", "1,5"],
                               6: ["-1", "nan", "-inf"]}.items():
            tables += [head + "\t".join(row[:column] + [field] + row[column + 1:]) + "\n" for field in fields]
        for table in tables:
            path = written("bad.tsv", table.encode(errors="surrogateescape"))
            self.refused(path + ": line ", synpo.read_matrix, path)
            self.assertEqual(subprocess.run(["synpo-matrix", "merge", path], capture_output=True).returncode, 65, table)
        for field in ("nan", "inf", "1_0", "+1", "", "1e999"):
            self.refused("bad.log: line 3, column 'loss'", synpo.read_log,
                         written("bad.log", f"update\tloss\n1\t2\n2\t{field}\n"))

    def test_whatever_is_in_a_file_the_error_is_of_one_kind_and_names_it(self):
        with open(here("synpo.jsonl"), encoding="utf-8") as file:
            line = json.loads(file.readline())
        deep = "[" * 100000
        for change in ({"actions": [10**30] * len(line["actions"])}, {"actions": [1.5] * len(line["actions"])},
                       {"labels": [True] * len(line["actions"])}, {"rewards": [float("nan")] * len(line["actions"])},
                       {"actions": 7}, {"scores": [[1], [1, 2]]}, {"version": 1.5}, {"success": ...}):
            bad = {**line, **change}
            if bad["success"] is ...:
                del bad["success"]
            path = written("x.jsonl", json.dumps(line) + "\n" + json.dumps(bad) + "\n")
            self.refused("x.jsonl: line 2: ", list, synpo.read_trajectories(path))
        for text in (deep, '{"a":' * 100000, b'{"format":"\xff"}',
                     '{"format":"synpo-end","version":1,"trajectories":1e999}'):
            self.refused("x.jsonl: line 1: ", list, synpo.read_trajectories(written("x.jsonl", text)))
        tensor = {"dtype": "F32", "shape": [1], "data_offsets": [0, 4]}
        for header in (deep, '{"a":' * 100000, "[]", {"a": 1}, {"a": tensor, "b": tensor},
                       {"__metadata__": [], "a": tensor}, {"__metadata__": {"format": 1}, "a": tensor},
                       {"a": {**tensor, "shape": [-1]}},
                       {"a": {**tensor, "shape": [2**40, 2**40]}}, {"a": {**tensor, "shape": [2]}},
                       {"a": {**tensor, "shape": [True]}}, {"a": {**tensor, "data_offsets": [4, 0]}},
                       {"a": {**tensor, "data_offsets": [0, float("inf")]}}, {"a": {**tensor, "dtype": []}}):
            text = (header if isinstance(header, str) else json.dumps(header)).encode()
            path = written("x", struct.pack("<Q", len(text)) + text + bytes(4))
            self.refused("x: ", synpo.read_safetensors, path)
        metadata = synpo.read_safetensors(here("synpo.ckpt"))[0]
        for key, value in (("seen", "5"), ("seen", "[[1]]"), ("shape", "[]"), ("tasks", '"R-B"'), ("envs", "{}x"),
                           ("envs", deep), ("updates", "many"), ("options", "NaN")):
            text = json.dumps({"__metadata__": {**metadata, key: value}}).encode()
            self.refused("x: ", synpo.read_checkpoint, written("x", struct.pack("<Q", len(text)) + text))


def taken_by_python(kind, path):
    """Whether the reader of a kind of file takes this one; a refusal names the file."""
    read = {"matrix": synpo.read_matrix, "log": synpo.read_log, "checkpoint": synpo.read_checkpoint,
            "trajectories": lambda name: list(synpo.read_trajectories(name))}[kind]
    try:
        read(path)
    except ValueError as error:
        assert f"{path}: " in str(error), error
        return False
    return True


def taken_by_programs(kind, path):
    command = {"matrix": ["synpo-matrix", "merge"], "log": ["synpo-render", "curves", "--ansi", "-y", "loss"],
               "checkpoint": ["synpo-eval", "--describe", "-c"],
               "trajectories": ["synpo-gen-expert", "--relabel"]}[kind]
    code = subprocess.run([*command, path], capture_output=True).returncode
    assert code in (0, 65), (command, code)
    return code == 0


class Readers(unittest.TestCase):
    """What the programs take, Python takes, and no more."""

    def same(self, kind, taken, *texts):
        for text in texts:
            path = written("same", text)
            self.assertEqual(taken_by_programs(kind, path), taken, text[:2000])
            self.assertEqual(taken_by_python(kind, path), taken, text[:2000])

    def differ(self, kind, by_python, *texts):
        """Where the one and the other are right."""
        for text in texts:
            path = written("differ", text)
            self.assertEqual((taken_by_python(kind, path), taken_by_programs(kind, path)), (by_python, not by_python),
                             text[:2000])

    def test_the_files_of_the_tree(self):
        files = [os.path.join(folder, name) for top in ("data", "fuzz/cases")
                 for folder, _, names in os.walk(os.path.join(os.path.dirname(__file__), "../../..", "tests", top))
                 for name in names]
        self.assertGreater(len(files), 10)
        taken = []
        for path in files:
            for kind in ("matrix", "checkpoint", "trajectories"):  # there is no log
                by_python = taken_by_python(kind, path)
                self.assertEqual(by_python, taken_by_programs(kind, path), (kind, path))
                taken += [kind] * by_python
        self.assertEqual(set(taken), {"matrix", "checkpoint", "trajectories"})

    def test_matrices(self):
        good = {"run": "ab", "world": "gridworld", "window": 1, "method": "synpo", "seed": 1, "updates": 5,
                "eval_seed": 7, "first_episode": 0, "env": "map1", "task": "R-B", "seen": 1, "episodes": 10,
                "successes": 5, "wrong": 1, "timeouts": 4, "reward": 2.5, "length": 99, "part": "P",
                "temperature": 0.5, "new": 0, "x": ""}

        def table(*changes):
            rows = [good.keys()] + [{**good, **change}.values() for change in changes]
            return "".join("\t".join(map(str, row)) + "\n" for row in rows)

        self.same("matrix", True, *(table({column: field}) for column, field in (
            ("x", "\u200f"), ("part", ""), ("method", ""), ("reward", "-1e15"), ("reward", ".5"), ("reward", "5."),
            ("temperature", "-0"), ("env", "e" * 255), ("episodes", 10**12), ("seed", 2**63 - 1),
            ("length", "010"))))
        self.same("matrix", False, table(), *(table({column: field}) for column, field in (
            ("new", 1), ("part", "X"), ("env", "e" * 256), ("task", "\u00e9" * 128), ("method", "m" * 256),
            ("episodes", 10**12 + 1), ("window", 10**12 + 1), ("seed", 2**63), ("eval_seed", 2**64 - 1),
            ("updates", 2**63), ("reward", 1.1e15), ("wrong", 2), ("x", "\x01"), ("x", "\x7f"), ("x", "\x85"),
            ("run", "\x1b[0m"), ("x", "a\rb"))))
        self.same("matrix", True, table({}, {"temperature": 1}), table({}, {"first_episode": 10}),
                  table({"run": ""}, {"run": "", "seed": 2}))
        self.same("matrix", False, table({}, {}), table({}, {"successes": 4}), table({}, {"temperature": "0.50"}),
                  table({"temperature": 0}, {"temperature": "-0"}), table({"run": ""}, {"run": ""}),
                  table({"temperature": ""}, {"temperature": ""}))
        for columns, taken in ((999, True), (1001, False)):
            wide = {**good, **{f"x{i}": "" for i in range(columns - len(good))}}
            self.same("matrix", taken, "\t".join(wide) + "\n" + "\t".join(map(str, wide.values())) + "\n")
        # Reading takes it, adding up does not: rates(). And what is too small for a number is 0.
        self.differ("matrix", True, table({}, {"first_episode": 9}), table({"reward": "1e-400"}))

    def test_logs(self):
        head = "update\tloss\n"
        self.same("log", True, head + "10\t1\n20\tNA\n15\t3\n", "loss\tupdate\n5\t1\n5\t2\n")
        self.same("log", False, "step\tloss\n1\t2\n", head + "1\t2\x01\n",
                  *(f"{head}{update}\t2\n" for update in ("1.0", "-1", "NA", 2**63)))
        # A log that is read may still grow. A curve needs a row.
        self.differ("log", True, (head + "1\t2\n2\t").encode() + b"\xc3", head)
        # Every column is read, not only the one that is drawn.
        self.differ("log", False, *(f"update\tloss\t{column}\n1\t2\t{field}\n" for column, field in (
            ("unseen_success", "1.5"), ("right_move", "-1"), ("wrong", "2"), ("env", "x"))))

    def test_trajectories(self):
        with open(os.path.join(os.path.dirname(__file__), "../../data/cli/expert.jsonl"), encoding="utf-8") as file:
            text = file.readline().rstrip("\n")
        line = json.loads(text)
        n, rewards, start = len(line["actions"]), line["rewards"], line["start"]

        def changed(**changes):
            return text + "\n" + json.dumps({**line, **changes}) + "\n"

        def more(members):
            return text + "\n" + text[:-1] + f",{members}}}\n"

        self.same("trajectories", True, changed(), changed(seed=2**64 - 1), changed(window=1000),
                  changed(rewards=[rewards[0] + 5e-6] + rewards[1:]), changed(x="\U0001f600"),
                  changed(x=json.loads("[" * 7 + "1" + "]" * 7)), text + "\r\n", text,
                  text[:-1] + " " * (2**24 - len(text)) + "}\n")
        wrong = {"format": [None, "x"], "version": [True, 1.0, "1", 2, 0], "world": ["", 7, None, []],
                 "rules": [1.0, -1, True, 2**31], "env": ["", "e" * 256, "a\x85", "\ud800", 7], "task": [None, "\t"],
                 "env_hash": ["", 7, line["env_hash"][1:], "G" * 16], "window": [-1, 1001, 1.5, True],
                 "seed": [-1, 1.0, True, "1", 2**64], "episode": [-1, 2**63, None],
                 "start": [7, [], None, {**start, "agent": [1]}, {**start, "agent": [1, 1.0]},
                           {**start, "agent": [1, 2**21]}, {str(i): [1, 1] for i in range(65)}],
                 "actions": [[], [-7] * n, [256] * n, [True] * n, "0" * n, None],
                 "labels": [[300] * n, [-1] * n, [], [0], None],
                 "rewards": [[None] * n, list(map(str, rewards)), [True] * n, [0.015] * n, [10000.0] * n,
                             [10**400] * n, rewards[1:], {}],
                 "success": [3, 1, None, "true"], "terminated": [1], "truncated": [0]}
        self.same("trajectories", False, *(changed(**{field: value}) for field in wrong for value in wrong[field]),
                  changed(actions=[], rewards=[]), changed(actions=[0] * 301, rewards=[-0.01] * 301),
                  more('"seed":1'), text.replace('"start":{', '"start":{"agent":[1,1],'), more('"x":1e999'),
                  more('"x":[{"y":-1e999}]'), more('"\\ud800":1'), more('"x":' + "[" * 8 + "1" + "]" * 8), "\n",
                  text + "\0x\n",
                  text[:-1] + " " * (2**24 + 1 - len(text)) + "}\n")
        for end, taken in (({"trajectories": 1}, True), ({"trajectories": 2}, False), ({"trajectories": "1"}, False),
                           ({"trajectories": True}, False), ({"trajectories": 1.0}, False), ({}, False),
                           ({"trajectories": 1, "version": True}, False), ({"trajectories": 2**63}, False)):
            self.same("trajectories", taken, text + "\n" + json.dumps({"format": "synpo-end", "version": 1, **end}))
        # The episode is no episode of the world, which Python does not play; a number of no account is not looked at.
        self.differ("trajectories", True, *(changed(**change) for change in (
            {"world": "x"}, {"env": "x"}, {"task": "x"}, {"rules": 2}, {"start": {}}, {"truncated": True},
            {"labels": [255] * n}, {"rewards": [0.5] * n})), more('"x":1' + "0" * 400))
        # The programs' parser takes a byte order mark for the beginning of a line.
        self.differ("trajectories", False, "\ufeff" + text + "\n")

    def test_checkpoints(self):
        with open(os.path.join(os.path.dirname(__file__), "../../data/v1/checkpoint.safetensors"), "rb") as file:
            size, = struct.unpack("<Q", file.read(8))
            header, data = json.loads(file.read(size)), file.read()
        metadata = header["__metadata__"]
        name = min(header.keys() - {"__metadata__"}, key=lambda key: header[key]["data_offsets"])
        entry, end = header[name], len(data)

        def made(header, data=data):
            text = (header if isinstance(header, str) else json.dumps(header)).encode()
            return struct.pack("<Q", len(text)) + text + data

        def tensor(**changes):
            return made({**header, name: {**entry, **changes}})

        def empty(shape, begin=end):
            return made({**header, "empty": {"dtype": "F32", "shape": shape, "data_offsets": [begin, begin]}})

        def said(key, value):
            return made({**header, "__metadata__": {**metadata, key: value}})

        def twice(key, value):
            return made(json.dumps(header)[:-1] + f", {json.dumps(key)}: {json.dumps(value)}}}")

        dims, offsets = entry["shape"], entry["data_offsets"]
        self.same("checkpoint", True, made(header), made(json.dumps(header) + "  "), empty([0, 3]), empty([0, 3], 0),
                  tensor(extra=[[1]]), tensor(shape=[1] * (8 - len(dims)) + dims))
        self.same("checkpoint", False, twice(name, entry), twice("__metadata__", metadata),
                  made(json.dumps(header).replace('"dtype":', '"dtype": "I64", "dtype":', 1)),
                  *(tensor(data_offsets=wrong) for wrong in ([*offsets, 5], [0], [], "ab", [False, offsets[1]],
                                                             [0.0, offsets[1]], None)),
                  *(tensor(shape=wrong) for wrong in ([1] * (9 - len(dims)) + dims, [1] * 70, "3", None,
                                                      list(map(float, dims)))),
                  *(tensor(dtype=wrong) for wrong in ([], None, "f32", "F8")),
                  tensor(extra=[[[1]]]), empty([2**34, 2**34, 0]), made({**header, "zz": 1}), made([1]),
                  made({**header, "__metadata__": []}), made(header, data + b"x"), made(header, data[:-1]),
                  struct.pack("<Q", 50) + b"{} ")
        for key in ("version", "rules", "window", "updates", "states", "seed"):
            self.same("checkpoint", False, *(said(key, text) for text in (
                "", "-1", "+1", " 1", "1_0", "1.0", "\u0661", str(2**63))))
        self.same("checkpoint", False, *(said(key, str(2**53 + 1)) for key in ("updates", "states")),
                  *(said(key, text) for key in ("method", "world") for text in ("", "e" * 256, "\x85", "\t")))
        env = {"name": "a", "hash": "0123456789abcdef", "content": "x"}
        values = {"tasks": [[], ["a"]], "seen": [[], [["a", "b"]]], "shape": [{}, {"a": -1}],
                  "options": [{}, {"a": "x"}], "envs": [[], [env], [{**env, "more": "y"}]]}
        self.same("checkpoint", True, *(said(key, json.dumps(value)) for key in values for value in values[key]))
        wrong = {"tasks": ["R-B", {}, [1], [""], ["\x01"], ["e" * 256], None],
                 "seen": [{}, 5, [["a"]], [["a", 1]], [["a", "b", "c"]], ["ab"], [["a", ""]], None],
                 "shape": [[], {"a": 1.0}, {"a": True}, {"a": "1"}, {"a": 2**64}, None],
                 "options": [[], {"a": 1}, {"a": None}, None],
                 "envs": [{}, [{}], [1], [{**env, "hash": "0123456789ABCDEF"}], [{**env, "content": 1}],
                          [{**env, "name": ""}], [{**env, "more": 1}], None]}
        self.same("checkpoint", False, *(said(key, json.dumps(value)) for key in wrong for value in wrong[key]),
                  made(json.dumps(header) + "\0"), said("options", "{}\0"),
                  said("shape", '{"a":1,"a":1}'), said("options", '{"a":"x","a":"x"}'),
                  *(made({**header, "__metadata__": {other: metadata[other] for other in metadata if other != key}})
                    for key in metadata if key not in ("written_by", "extractor")))
        # No array of numpy; the mark as above.
        self.differ("checkpoint", False, empty([0, 2**34, 2**34]), made("\ufeff" + json.dumps(header)))


class Worlds(unittest.TestCase):
    def test_the_experts_episodes_are_played_again_from_the_same_starts(self):
        for world, name in (("gridworld", "e.jsonl"), ("kitchen", "k.jsonl")):
            env = synpo.Env(world)
            self.addCleanup(env.close)
            for episode in list(synpo.read_trajectories(here(name)))[:5]:
                observation, info = env.reset(seed=episode["seed"], options={
                    "env": episode["env"], "task": episode["task"], "episode": episode["episode"]})
                self.assertEqual(info["env"], episode["env"])
                for i, action in enumerate(episode["actions"]):
                    self.assertEqual(env.expert(), action)
                    observation, reward, terminated, truncated, info = env.step(action)
                    self.assertEqual(reward, episode["rewards"][i])
                    self.assertEqual(terminated, i + 1 == len(episode["actions"]))
                self.assertTrue(info["success"] and not truncated)
                with self.assertRaises(RuntimeError):
                    env.step(0)

    def test_a_seed_is_a_sequence_of_episodes(self):
        env, other = synpo.Env(pairs=here("pairs.tsv")), synpo.Env(pairs=here("pairs.tsv"))
        self.addCleanup(env.close)
        self.addCleanup(other.close)
        first = [env.reset(seed=7)] + [env.reset() for _ in range(9)]
        again = [other.reset(seed=7)] + [other.reset() for _ in range(9)]
        for (a, info), (b, other_info) in zip(first, again):
            self.assertEqual(info, other_info)
            np.testing.assert_array_equal(a, b)
        self.assertEqual([info["episode"] for _, info in first], list(range(10)))
        self.assertGreater(len({(info["env"], info["task"]) for _, info in first}), 1)
        self.assertNotEqual(first[0][1], env.reset(seed=8)[1])
        with open(here("pairs.tsv"), encoding="utf-8") as file:
            seen = {tuple(line.split("\t")[:2]) for line in file if line.endswith("\t1\n")}
        self.assertLessEqual({(info["env"], info["task"]) for _, info in first}, seen)

    def test_observations_are_colours(self):
        env = synpo.Env(window=1)
        self.addCleanup(env.close)
        observation, info = env.reset(seed=1, options={"env": "map3", "task": "R-B"})
        self.assertEqual((observation.shape, observation.dtype), ((16, 16, 12), np.uint8))
        self.assertEqual(observation[..., :9].max(), 0)  # nothing was seen before the first step
        colours = {tuple(colour) for colour in observation[..., 9:].reshape(-1, 3).tolist()}
        self.assertLessEqual({(0, 0, 0), (255, 255, 255), (0, 255, 0), (170, 0, 255)}, colours)
        moved = env.step(0)[0]
        np.testing.assert_array_equal(moved[..., 6:9], observation[..., 9:])

    def test_places_side_by_side_play_what_one_alone_plays(self):
        batch, env = synpo.BatchEnv(3, pairs=here("pairs.tsv")), synpo.Env(pairs=here("pairs.tsv"))
        self.addCleanup(batch.close)
        self.addCleanup(env.close)
        observations, info = batch.reset(seed=5)
        alone = [env.reset(seed=5)] + [env.reset(), env.reset()]
        np.testing.assert_array_equal(observations, [observation for observation, _ in alone])
        self.assertEqual(list(info["task"]), [info["task_position"] for _, info in alone])
        started, next_one = 3, env.reset()[0]
        for _ in range(60):
            observations, rewards, terminated, truncated, info = batch.step(batch.expert())
            self.assertEqual(sorted(info["final"]), np.flatnonzero(terminated).tolist())
            for place in sorted(info["final"]):
                self.assertTrue(info["success"][place])
                self.assertEqual(rewards[place], 10.99)
                np.testing.assert_array_equal(observations[place], next_one)
                started, next_one = started + 1, env.reset()[0]
        self.assertGreater(started, 5)

    def test_mistakes_are_named(self):
        env = synpo.Env()
        self.addCleanup(env.close)
        for options, words in (({"env": "map99"}, "map99"), ({"task": 20}, "20"), ({"start": 1}, "start"),
                               ({"starts": "x"}, "'x'")):
            with self.assertRaisesRegex(ValueError, words):
                env.reset(options=options)
        for seed in (-1, 2**64):
            with self.assertRaisesRegex(ValueError, f"found the seed {seed}"):
                env.reset(seed=seed)
        with self.assertRaisesRegex(ValueError, "found the episode -1"):
            env.reset(options={"episode": -1})
        with self.assertRaisesRegex(ValueError, "found the place -1"):
            env.server.reset(-1, 0, 0)
        env.reset(seed=1)
        with self.assertRaisesRegex(ValueError, "found actions"):
            env.server.step([0], [0.7])
        with self.assertRaises(ValueError):
            env.step(5)
        with self.assertRaisesRegex(RuntimeError, "synpo-gen-expert: .*no-such"):
            synpo.Env("gridworld:no-such")
        with self.assertRaisesRegex(RuntimeError, "no episode goes on in the place 1"):
            env.server.step([1], [0])
        with self.assertRaisesRegex(RuntimeError, "synpo-gen-expert has ended"):
            env.server.step([0], [0])

    def test_gymnasium_is_followed_where_it_is_there(self):
        env = synpo.Env()
        self.addCleanup(env.close)
        self.assertEqual(hasattr(env, "action_space"), synpo.gymnasium is not None)
        if synpo.gymnasium is None:
            self.skipTest("no gymnasium here")
        from gymnasium.utils.env_checker import check_env
        check_env(env, skip_render_check=True)


@unittest.skipIf(synpo.torch is None, "no torch here")
class Policies(unittest.TestCase):
    """Scores are compared with those that synpo-eval --scores recorded, in float64 here and in float32 there."""

    def compare(self, name, world, **options):
        env, policy = synpo.Env(world, **options), synpo.load_policy(here(name + ".ckpt")).double()
        self.addCleanup(env.close)
        for episode in synpo.read_trajectories(here(name + ".jsonl")):
            observation, info = env.reset(seed=episode["seed"], options={
                "env": episode["env"], "task": episode["task"], "episode": episode["episode"],
                "starts": "evaluation"})
            observations = []
            for action, reward in zip(episode["actions"], episode["rewards"]):
                observations.append(observation)
                observation, found, terminated, truncated, info = env.step(action)
                self.assertEqual(found, reward)
            self.assertEqual((terminated, truncated, info["success"]),
                             (episode["terminated"], episode["truncated"], episode["success"]))
            scores = policy.scores(np.stack(observations), episode["env"], episode["task"])
            np.testing.assert_allclose(scores, episode["scores"], rtol=1e-5,
                                       atol=1e-5 * np.abs(episode["scores"]).max(), err_msg=name)

    def test_scores_of_every_method_are_ours_in_the_mazes(self):
        for name in MAZES:
            self.compare(name, "gridworld", window=0 if name == "blind" else 1)

    def test_scores_are_ours_in_the_kitchens(self):
        for name in KITCHENS:
            self.compare(name, "kitchen")

    def test_the_greedy_policy_does_what_ours_does(self):
        policy, env = synpo.load_policy(here("synpo.ckpt")), synpo.Env()
        self.addCleanup(env.close)
        for episode in synpo.read_trajectories(here("greedy.jsonl")):
            observation, info = env.reset(seed=episode["seed"], options={
                "env": episode["env"], "task": episode["task"], "episode": episode["episode"],
                "starts": "evaluation"})
            for action in episode["actions"][:40]:
                self.assertEqual(policy.act(observation, info["env"], info["task"]), action)
                observation, *_, info = env.step(action)

    def test_a_policy_of_a_pair_is_an_onnx_network_that_opencv_runs_to_our_scores(self):
        try:
            import cv2
        except ImportError:
            self.skipTest("no cv2 here")
        env = synpo.Env()
        self.addCleanup(env.close)
        for name in MAZES:
            episode = next(synpo.read_trajectories(here(name + ".jsonl")))
            synpo.export_onnx(here(name + ".ckpt"), episode["env"], episode["task"], here("policy.onnx"))
            network = cv2.dnn.readNetFromONNX(here("policy.onnx"))
            if name == "blind":
                continue  # its observations are those of another window
            observation, _ = env.reset(seed=episode["seed"], options={
                "env": episode["env"], "task": episode["task"], "episode": episode["episode"],
                "starts": "evaluation"})
            for action, scores in list(zip(episode["actions"], episode["scores"]))[:10]:
                network.setInput(observation[None].astype(np.float32))
                np.testing.assert_allclose(network.forward()[0], scores, rtol=1e-5, atol=1e-5 * np.abs(scores).max())
                observation = env.step(action)[0]
        with self.assertRaisesRegex(ValueError, "kitchens"):
            synpo.export_onnx(here("kitchen-synpo.ckpt"), "FloorPlan1", "Mug-Sink", here("policy.onnx"))

    def test_parameters_can_be_learned(self):
        policy = synpo.load_policy(here("synpo.ckpt"))
        scores = policy(synpo.torch.zeros(2, 16, 16, 12), synpo.torch.tensor([0, 1]), synpo.torch.tensor([1, 0]))
        scores.sum().backward()
        self.assertGreater(float(policy.embedding["env"].grad.abs().sum()), 0)
        self.assertGreater(float(policy.encoder.stage1["block1"].conv1.weight.grad.abs().sum() +
                                 policy.theta.grad.abs().sum()), 0)

    def test_a_checkpoint_of_other_shapes_is_refused(self):
        checkpoint = synpo.read_checkpoint(here("synpo.ckpt"))
        checkpoint.tensors["theta"] = checkpoint.tensors["theta"][1:]
        with self.assertRaisesRegex(ValueError, "'theta'"):
            synpo.load_policy(checkpoint)
        del checkpoint.tensors["theta"]
        with self.assertRaisesRegex(ValueError, "no tensor 'theta'"):
            synpo.load_policy(checkpoint)
        with self.assertRaisesRegex(ValueError, "does not know 'map99'"):
            synpo.load_policy(here("synpo.ckpt")).scores(np.zeros((16, 16, 12)), "map99", "R-B")

    def test_a_shape_that_cannot_be_is_refused_before_memory_is_taken(self):
        for name in ("synpo", "mlp", "modulenet", "kitchen-synpo"):
            checkpoint = synpo.read_checkpoint(here(name + ".ckpt"))
            whole = checkpoint.shape
            before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
            own = "head_hidden" if name == "modulenet" else "hidden"
            last = "view_hidden" if "kitchen" in name else "channels4"
            for size in ("feature", own, last, "envs", "tasks", "actions"):
                for value in (0, -1, 2**23, 2**40, 2**70, 1.5, "8", None, [8]):
                    checkpoint.shape = {**whole, size: value}
                    with self.assertRaisesRegex(ValueError, f"{name}.ckpt: "):
                        synpo.load_policy(checkpoint)
            self.assertLess(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before, 200_000)  # kB


if __name__ == "__main__":
    unittest.main()

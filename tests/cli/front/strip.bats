load ../common

setup_file() {
    make_inputs
    synpo-train "${TINY[@]}" -n 2 -p pairs.tsv <e.jsonl >full.ckpt
}
setup() { set_up pairs.tsv two.tsv e.jsonl a.ckpt full.ckpt; }

@test "strip leaves out what training needs, and nothing else: the bytes of synpo-train --strip" {
    synpo-finetune strip <full.ckpt >stripped.ckpt
    cmp stripped.ckpt a.ckpt
    synpo-finetune strip full.ckpt -o operand.ckpt
    synpo-finetune strip -c full.ckpt >option.ckpt
    cmp operand.ckpt a.ckpt
    cmp option.ckpt a.ckpt
    fails 64 synpo-finetune strip -c full.ckpt a.ckpt
    says "exclude each other"
}

@test "strip --half: half the size, the same facts, and a policy that plays" {
    synpo-finetune strip --half full.ckpt >half.ckpt
    [ "$(wc -c <half.ckpt)" -lt $(($(wc -c <a.ckpt) * 52 / 100)) ]
    for fact in .seen .shape .options .envs .updates '.tensors | keys'; do
        [ "$(described half.ckpt "$fact")" = "$(described a.ckpt "$fact")" ]
    done
    [ "$(described half.ckpt .weights_hash)" != "$(described a.ckpt .weights_hash)" ]
    # numpy's own rounding of the whole one's weights.
    /usr/bin/python3 - <<'END'
import json, struct, numpy
def load(path):
    types = {"F16": "<f2", "F32": "<f4"}
    with open(path, "rb") as file:
        header = json.loads(file.read(struct.unpack("<Q", file.read(8))[0]))
        data = file.read()
    return {name: numpy.frombuffer(data[slice(*t["data_offsets"])], types[t["dtype"]]).reshape(t["shape"])
            for name, t in header.items() if name != "__metadata__"}
whole, half = load("a.ckpt"), load("half.ckpt")
assert whole.keys() == half.keys()
for name, values in whole.items():
    assert half[name].dtype == (numpy.float16 if values.ndim >= 2 else numpy.float32), name
    assert (half[name] == values.astype(half[name].dtype)).all(), name
END
    synpo-eval -q -p two.tsv -n 2 <half.ckpt >half.tsv
    [ "$(wc -l <half.tsv)" -eq 3 ]
    synpo-finetune ppo -q --lanes 2 --rollout 4 --steps 8 -p two.tsv --strip <half.ckpt >tuned.ckpt
    [ "$(wc -c <tuned.ckpt)" -gt $(($(wc -c <half.ckpt) * 19 / 10)) ]
    fails 65 synpo-train -q --resume half.ckpt -n 9 <e.jsonl
    says "no training state"
}

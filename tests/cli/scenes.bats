load common

# scene KITCHEN LAYOUTS [DIR]: a scene file as scripts/thor-dump.py makes it.
scene() {
    mkdir -p "${3:-scenes}"
    /usr/bin/python3 "$ROOT/tests/cli/fake_thor.py" "${3:-scenes}" "$1" "$2"
}

setup_file() {
    cd "$BATS_FILE_TMPDIR" || exit
    scene FloorPlan10 2
    scene FloorPlan2 1
    scene FloorPlan2 1 two
    EXTRACTOR_HASH=0000000000000001 scene FloorPlan2 1 others
    synpo-gen-expert -w kitchen:scenes -n 60 >e.jsonl
    synpo-train "${TINY[@]}" -w kitchen:scenes -n 2 <e.jsonl >a.ckpt
    printf 'env\ttask\nFloorPlan10\tMug-Sink\n' >one.tsv
}

setup() { set_up scenes two others e.jsonl a.ckpt one.tsv; }

@test "a dump of AI2-THOR's controller is a world: the expert succeeds in every pair, in natural order" {
    synpo-gen-expert -w kitchen:scenes --per-pair 2 >all.jsonl
    jq -r .env all.jsonl | uniq | paste -sd ' ' >got
    echo "FloorPlan2 FloorPlan10" | cmp - got
    jq -e -s 'length == 84 and all(.[]; .success)' all.jsonl
    # Two layouts: two places of the Mug, and what lies in the fridge is taken with its door open.
    [ "$(jq -c 'select(.env == "FloorPlan10") | .start.Mug' all.jsonl | sort -u | wc -l)" -eq 2 ]
    jq -e -s 'all(.[] | select(.task == "Container-Sink"); .actions | index(5) < index(6))' all.jsonl
}

@test "trajectories come back through --relabel; those of the built-in kitchens are refused" {
    synpo-gen-expert --relabel -w kitchen:scenes <e.jsonl | cmp - e.jsonl
    synpo-gen-expert -w kitchen -n 30 | grep -F '"FloorPlan2"' | head -n 1 >built.jsonl
    [ -s built.jsonl ]
    fails 65 synpo-gen-expert --relabel -w kitchen:scenes <built.jsonl
    says "env 'FloorPlan2' is not the one of that name here"
}

@test "a checkpoint names its extractor, holds no scenes, and is evaluated with -w" {
    [ "$(described a.ckpt .extractor)" = frames@0123456789abcdef ]
    [ "$(described a.ckpt '.envs | map(.name + .content) | join(" ")')" = "FloorPlan2 FloorPlan10" ]
    synpo-eval -q -p one.tsv -n 3 -w kitchen:scenes <a.ckpt >m.tsv
    [ "$(wc -l <m.tsv)" -eq 2 ]
    fails 64 synpo-eval -q -p one.tsv -n 3 -c a.ckpt
    says "name their folder with -w kitchen:DIR"
    fails 64 synpo-eval -q -p one.tsv -n 3 -c a.ckpt -w kitchen
    says "expected -w kitchen:DIR"
    fails 65 synpo-eval -q -p one.tsv -n 3 -c a.ckpt -w kitchen:two
    says "env 'FloorPlan10': no scene of that name"
    fails 65 synpo-eval -q -p one.tsv -n 3 -c a.ckpt -w kitchen:others
    says "env 'FloorPlan2': found a scene with hash"
    synpo-gen-expert -n 20 | synpo-train "${TINY[@]}" -n 1 --strip >maze.ckpt
    fails 64 synpo-eval -q -c maze.ckpt -w kitchen:scenes
    says "the checkpoint holds its environments"
}

@test "weights of another extractor's features are refused" {
    synpo-gen-expert -w kitchen:two -n 20 | synpo-train "${TINY[@]}" -n 1 -w kitchen:two --strip >b.ckpt
    fails 65 synpo-train "${TINY[@]}" -n 1 -w kitchen:others --init b.ckpt <e.jsonl
    says "trained on features of 'frames@0123456789abcdef', found those of 'frames@0000000000000001'"
}

@test "resume, ppo and adapt with -w" {
    synpo-train "${TINY[@]}" -w kitchen:scenes -n 4 <e.jsonl >whole.ckpt
    synpo-train -q -w kitchen:scenes -n 4 --resume a.ckpt <e.jsonl | cmp - whole.ckpt
    fails 64 synpo-train -q -n 4 --resume a.ckpt <e.jsonl
    says "-w kitchen:DIR"
    synpo-finetune ppo -q --steps 16 --lanes 4 --rollout 4 -w kitchen:scenes -c a.ckpt >p.ckpt
    synpo-gen-expert -w kitchen:two -n 20 >two.jsonl
    synpo-train "${TINY[@]}" -w kitchen:two -n 1 --strip <two.jsonl >two.ckpt
    synpo-gen-expert -w kitchen:scenes -p one.tsv -n 3 >new.jsonl
    synpo-finetune adapt -q -n 1 -c two.ckpt -w kitchen:scenes <new.jsonl >wide.ckpt
    [ "$(described wide.ckpt '.envs | map(.name) | join(" ")')" = "FloorPlan2 FloorPlan10" ]
    synpo-eval -q -p one.tsv -n 1 -w kitchen:scenes -c wide.ckpt >m.tsv
}

@test "1 and 2 threads: the same bytes" {
    for j in 1 2; do synpo-eval -q -j $j -p one.tsv -n 9 -w kitchen:scenes --record - -c a.ckpt >r$j; done
    cmp r1 r2
}

@test "a folder of two extractors, an empty one, a missing one, a file in a scene's place" {
    mkdir mixed empty
    cp scenes/FloorPlan10.scene.safetensors others/FloorPlan2.scene.safetensors mixed
    fails 65 synpo-gen-expert -n 1 -w kitchen:mixed
    says "cannot read mixed/FloorPlan10.scene.safetensors: FloorPlan10: found features of 'frames@0123456789abcdef', expected 'frames@0000000000000001' as of FloorPlan2"
    fails 66 synpo-gen-expert -n 1 -w kitchen:empty
    says "no *.scene.safetensors in the folder 'empty'"
    fails 66 synpo-gen-expert -n 1 -w kitchen:none
    says "cannot read the folder 'none'"
    head -c 100000 scenes/FloorPlan10.scene.safetensors >empty/x.scene.safetensors
    fails 65 synpo-gen-expert -n 1 -w kitchen:empty
    says "empty/x.scene.safetensors"
    says "it ends at byte 100000"
    cp a.ckpt empty/x.scene.safetensors
    fails 65 synpo-gen-expert -n 1 -w kitchen:empty
    says "not a synpo scene"
}

@test "the page's program reads a scene" {
    sed -n '/^import json, struct/,/^\.Ed/p' "$ROOT/man/synpo-scene.5" | sed '/^\./d; s/\\(dq/"/g; s/\\\\/\\/g' >read.py
    sed -i 's|"FloorPlan1.scene.safetensors"|"scenes/FloorPlan10.scene.safetensors"|' read.py
    /usr/bin/python3 read.py >got
    hash=$(jq -r 'select(.env == "FloorPlan10") | .env_hash' e.jsonl | head -n 1)
    grep -qx "$hash" got
}

@test "render features: scenes of built-in kitchens, whatever the threads" {
    synpo-render features -q --features "$ROOT/tests/data/means.onnx" --envs FloorPlan25 -j 1 -o made
    synpo-gen-expert -w kitchen:made -n 5 >e.jsonl2
    jq -e -s 'all(.[]; .success and .env == "FloorPlan25")' e.jsonl2
    synpo-train "${TINY[@]}" -w kitchen:made -n 1 <e.jsonl2 >k.ckpt
    described k.ckpt .extractor | grep -qE '^means@[0-9a-f]{16}$'
    fails 65 synpo-train "${TINY[@]}" -w kitchen -n 1 --init k.ckpt <e.jsonl2
}

@test "render features: what it refuses" {
    net=$ROOT/tests/data/means.onnx
    fails 64 synpo-render features -o made
    says "--features"
    fails 64 synpo-render features --features "$net"
    says "-o DIR"
    fails 64 synpo-render features --features "$net" -o made -w gridworld
    fails 64 synpo-render features --features "$net" -o made --envs FloorPlan7
    says "FloorPlan7"
    fails 66 synpo-render features --features none.onnx -o made
    fails 65 synpo-render features --features one.tsv -o made
    says "no network in ONNX"
    : >file
    fails 73 synpo-render features --features "$net" -o file/made
}

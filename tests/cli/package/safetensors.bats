# Checkpoints are safetensors files that every loader of the format takes.
load ../common

setup_file() { make_inputs; }
setup() { set_up pairs.tsv e.jsonl; }

strict() { /usr/bin/python3 "$ROOT/tests/cli/package/strict_safetensors.py" "$@"; }

@test "whole, stripped and tuned checkpoints hold types that the oldest loaders know, one after the other" {
    synpo-train "${TINY[@]}" -n 2 -p pairs.tsv --save whole.ckpt -o stripped.ckpt --strip <e.jsonl
    synpo-train "${TINY_PAPER[@]}" -n 2 -p pairs.tsv -m modulenet <e.jsonl >paper.ckpt
    synpo-finetune ppo -q --steps 300 --lanes 2 <whole.ckpt >tuned.ckpt
    synpo-finetune strip --half <whole.ckpt >half.ckpt
    strict whole.ckpt stripped.ckpt paper.ckpt tuned.ckpt half.ckpt >got
    [ "$(wc -l <got)" -eq 5 ]
    grep -qE '^half.ckpt F16:[0-9]+ F32:[0-9]+$' got
    grep -qE '^whole.ckpt F32:[0-9]+ I64:5 U8:2$' got
    grep -qE '^stripped.ckpt F32:[0-9]+$' got
    grep -qE '^paper.ckpt F32:[0-9]+ I64:3 U8:1$' got
    grep -qE '^tuned.ckpt F32:[0-9]+ I64:3 U8:1$' got
    # The reader does refuse.
    sed 's/"I64"/"U64"/' whole.ckpt >old.ckpt
    run ! strict old.ckpt
    [[ $output == *"type U64"* ]]
}

@test "the manual page's Python reads a checkpoint, whole or in half precision, and finds its hash" {
    synpo-train "${TINY[@]}" -n 2 -p pairs.tsv <e.jsonl >whole.ckpt
    synpo-finetune strip --half <whole.ckpt >half.ckpt
    awk '/^\.Bd/ { inside = 1; next } /^\.Ed/ { inside = 0; print "" } inside' "$ROOT/man/synpo-checkpoint.5" |
        sed -n '/^import json/,/^print/p' >read.py
    grep -q '^U = ' read.py
    for file in whole half; do
        { sed "s/synpo.ckpt/$file.ckpt/" read.py && echo 'print(U.shape, numpy.isfinite(U).all())'; } >$file.py
        /usr/bin/python3 $file.py >got
        { synpo-eval --describe $file.ckpt | jq -r .weights_hash && echo '(5, 128) True'; } >want
        cmp want got
    done
}

@test "a checkpoint with unsigned numbers, as older ones have them, is gone on from to the same bits" {
    synpo-train "${TINY[@]}" -n 4 -p pairs.tsv <e.jsonl >four.ckpt
    synpo-train "${TINY[@]}" -n 2 -p pairs.tsv <e.jsonl >two.ckpt
    cp two.ckpt old.ckpt
    for name in train/position train/memory/serials train/memory/added; do
        sed -i -E "s|(\"$name\":\{\"data_offsets\":[^]]*\],\"dtype\":)\"I64\"|\1\"U64\"|" old.ckpt
    done
    [ "$(grep -aoc '"U64"' old.ckpt)" -eq 1 ]
    [ "$(grep -ao '"U64"' old.ckpt | wc -l)" -eq 3 ]
    for from in two old; do synpo-train -q --resume $from.ckpt -n 4 <e.jsonl >$from-four.ckpt; done
    cmp two-four.ckpt old-four.ckpt
}

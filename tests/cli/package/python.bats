# python/synpo.py against the programs: files, worlds, scores.
load ../common

setup_file() {
    make_inputs
    synpo-gen-expert -w kitchen -n 6 >k.jsonl
    record() { synpo-eval -q -c "$1.ckpt" -p "${2-two.tsv}" -n "${3-2}" --record "$1.jsonl" --scores -o "$1.tsv"; }
    for method in synpo mtl mlp modulenet sf; do
        synpo-train "${TINY[@]}" -m "$method" -n 2 -p pairs.tsv --strip <e.jsonl >"$method.ckpt"
        record "$method"
    done
    synpo-train "${TINY_PAPER[@]}" --action-embedding 3 -n 2 -p pairs.tsv --strip <e.jsonl >mixed.ckpt
    record mixed
    synpo-gen-expert -p pairs.tsv -n 60 -s 1 --window 0 | synpo-train "${TINY[@]}" -n 2 -p pairs.tsv --strip >blind.ckpt
    record blind
    synpo-finetune strip --half <synpo.ckpt >half.ckpt
    record half
    printf 'env\ttask\nFloorPlan1\tMug-Sink\nFloorPlan2\tApple-Fridge\n' >kitchens.tsv
    for method in synpo mlp; do
        synpo-train "${TINY[@]}" -w kitchen -m $method -n 2 --strip <k.jsonl >"kitchen-$method.ckpt"
        record "kitchen-$method" kitchens.tsv 1
    done
    synpo-eval -q -c synpo.ckpt -p two.tsv -n 1 --temperature 0 --record greedy.jsonl -o greedy.tsv
    synpo-train "${TINY[@]}" -n 2 -p pairs.tsv --log run.log --report 1 <e.jsonl >whole.ckpt
}

python_test() {
    /usr/bin/python3 -B "$ROOT/tests/cli/package/test_synpo.py" "$BATS_FILE_TMPDIR" -v "$@" \
        2>"$BATS_TEST_TMPDIR/said" ||
        complain "$(cat "$BATS_TEST_TMPDIR/said")"
    ! grep -q 'no torch here' "$BATS_TEST_TMPDIR/said" || skip "no torch here"
}

@test "synpo.py: files are read as they are, and what is broken is refused" { python_test Files; }

@test "synpo.py: what the programs refuse is refused, and what they take is read" { python_test Readers; }

@test "synpo.py: the worlds are those of the programs, from the same starts" { python_test Worlds; }

@test "synpo.py: scores of a policy in torch are those of synpo-eval" { python_test Policies; }

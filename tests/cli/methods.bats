load common

# Each with what it is called on the command line.
METHODS=("synpo" "synpo --action-embedding 3" "mtl" "mlp" "modulenet" "sf --sf-loss td" "sf --sf-loss q"
    "sf --sf-loss ce")
SMALL=(--feature 16 --basis 12 --embedding 10 --hidden 24)

setup_file() { make_inputs; }
setup() { set_up pairs.tsv two.tsv e.jsonl a.ckpt; }

@test "every method: resumed equals unbroken, 1 and 2 threads" {
    for method in "${METHODS[@]}"; do
        # shellcheck disable=SC2086
        for tiny in TINY TINY_PAPER; do
            declare -n options=$tiny
            synpo-train "${options[@]}" "${SMALL[@]}" -m $method -n 3 -j 2 -s 5 <e.jsonl >unbroken
            synpo-train "${options[@]}" "${SMALL[@]}" -m $method -n 1 -j 1 -s 5 <e.jsonl >part
            synpo-train -q --resume part -n 3 -j 1 <e.jsonl >resumed
            cmp unbroken resumed || complain "$tiny $method"
        done
    done
}

@test "every method: evaluated under its name, 1 and 2 threads" {
    for method in "${METHODS[@]}"; do
        # shellcheck disable=SC2086
        synpo-train "${TINY[@]}" "${SMALL[@]}" -m $method -n 2 --strip <e.jsonl >m.ckpt
        [ "$(described m.ckpt .method)" = "${method%% *}" ]
        synpo-eval -q -p two.tsv -n 3 -j 1 <m.ckpt >one
        synpo-eval -q -p two.tsv -n 3 -j 2 <m.ckpt >two
        cmp one two
        awk -F '\t' -v method="${method%% *}" 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
            $at["method"] != method { exit 1 }' one
    done
}

@test "a method that learns values takes the best action unless told otherwise" {
    temperature() { awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "temperature") at = i }
        END { print $at }' "$1"; }
    for case in "sf --sf-loss td:0" "sf --sf-loss q:0" "sf:0.5" "mlp:0.5"; do
        # shellcheck disable=SC2086
        synpo-train "${TINY[@]}" "${SMALL[@]}" -m ${case%:*} -n 1 --strip <e.jsonl >m.ckpt
        synpo-eval -q -p two.tsv -n 1 <m.ckpt >got
        [ "$(temperature got)" = "${case#*:}" ] || complain "$case: temperature $(temperature got)"
    done
    synpo-eval -q -p two.tsv -n 1 --temperature 2 <m.ckpt >got
    [ "$(temperature got)" = 2 ]
}

@test "the log has NA for a loss that a method lacks" {
    synpo-train "${TINY[@]}" "${SMALL[@]}" -m modulenet -n 1 --log log.tsv --report 1 <e.jsonl >/dev/null
    awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i }
        NR == 2 { print $at["reward"], $at["env"], $at["task"], $at["loss"] == $at["policy"] }' log.tsv >got
    echo "NA NA NA 1" | cmp - got
}

@test "an ablation is a weight of 0" {
    for loss in env task reward; do
        synpo-train "${TINY[@]}" "${SMALL[@]}" -n 2 --no-$loss-loss <e.jsonl >flag
        synpo-train "${TINY[@]}" "${SMALL[@]}" -n 2 --$loss-loss 0 <e.jsonl >zero
        cmp flag zero
    done
    fails 64 synpo-train --resume flag -n 3 --no-env-loss
}

@test "an unknown method: 64 on the command line, 65 in a checkpoint" {
    fails 64 synpo-train "${TINY[@]}" -n 1 -m dqn <e.jsonl
    says "found 'dqn', expected synpo, mlp, mtl, modulenet or sf"
    fails 64 synpo-train "${TINY[@]}" -n 1 -m sf --sf-loss mse <e.jsonl
    says "expected td, q or ce"
    sed 's/"method":"synpo"/"method":"synqo"/' a.ckpt >other.ckpt
    fails 65 synpo-eval -q -p two.tsv -n 1 -c other.ckpt
    says "unknown method 'synqo', expected synpo, mlp, mtl, modulenet or sf"
}

@test "--init from another method, or from other sizes of it: 65" {
    synpo-train "${TINY[@]}" "${SMALL[@]}" -m mlp -n 1 <e.jsonl >mlp.ckpt
    for other in "sf" "mlp --head-hidden 32" "synpo"; do
        # shellcheck disable=SC2086
        fails 65 synpo-train "${TINY[@]}" "${SMALL[@]}" -m $other -n 1 --init mlp.ckpt <e.jsonl
        says "method or sizes differ"
    done
    synpo-train "${TINY[@]}" "${SMALL[@]}" -m mlp -n 1 --init mlp.ckpt <e.jsonl >again.ckpt
    # A checkpoint that calls itself another method lacks that one's tensors.
    sed 's/"method":"mlp"/"method":"mtl"/' mlp.ckpt >named.ckpt
    fails 65 synpo-eval -q -p two.tsv -n 1 -c named.ckpt
    says "no tensor 'alpha.hidden.weight'"
}

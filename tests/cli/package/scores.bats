# synpo-eval --scores: what the policy thought at every step of a record.
load ../common

setup_file() { make_inputs; }
setup() { set_up pairs.tsv two.tsv a.ckpt; }

@test "--scores adds a temperature, scores and probabilities for every action of every step, and changes nothing else" {
    synpo-eval -q -p two.tsv -n 3 -c a.ckpt --record plain.jsonl -o plain.tsv
    synpo-eval -q -p two.tsv -n 3 -c a.ckpt --record r.jsonl --scores -j 1 -o r.tsv
    synpo-eval -q -p two.tsv -n 3 -c a.ckpt --record - --scores -j 2 | cmp - r.jsonl
    cmp plain.tsv r.tsv
    jq -c 'del(.temperature, .scores, .probabilities)' r.jsonl >less.jsonl
    jq -c . plain.jsonl | cmp - less.jsonl
    jq -e -s 'all(.[]; .temperature == 0.5 and (.actions | length) == (.scores | length) and
        (.scores | length) == (.probabilities | length) and all(.scores[], .probabilities[]; length == 5))' \
        r.jsonl >answer
    # softmax(scores / temperature), but for the digits of a single-precision number.
    jq -e -s 'all(.[]; .temperature as $t | [.scores, .probabilities] | transpose[] |
        (.[0] | map(. / $t | exp)) as $e | ($e | add) as $sum | [($e | map(. / $sum)), .[1]] | transpose[] |
        (.[0] - .[1] | fabs) < 1e-6)' r.jsonl >answer
}

@test "--scores of the greedy policy: 1 for what was done" {
    synpo-eval -q -p two.tsv -n 2 -c a.ckpt --temperature 0 --record r.jsonl --scores -o r.tsv
    jq -e -s 'all(.[]; .temperature == 0 and ([.actions, .scores, .probabilities] | transpose |
        all(.[]; .[0] as $a | .[1][$a] == (.[1] | max) and .[2][$a] == 1 and (.[2] | add) == 1)))' r.jsonl
}

@test "records with scores are read wherever trajectories are" {
    synpo-eval -q -p pairs.tsv -n 2 -c a.ckpt --starts training --record r.jsonl --scores
    synpo-eval -q -p pairs.tsv -n 2 -c a.ckpt --starts training --record plain.jsonl
    awk 'NR == 1 || $3 == 1' pairs.tsv >seen.tsv
    for file in r plain; do
        synpo-train "${TINY[@]}" -n 2 --strip <$file.jsonl >$file.ckpt
        synpo-gen-expert --relabel <$file.jsonl >$file.relabelled
        synpo-render episode $file.jsonl >$file.png
    done
    cmp r.ckpt plain.ckpt
    cmp r.relabelled plain.relabelled
    cmp r.png plain.png
}

@test "--scores without --record is a mistake" {
    fails 64 synpo-eval -q -p two.tsv -c a.ckpt --scores
    says "--scores goes with --record"
}

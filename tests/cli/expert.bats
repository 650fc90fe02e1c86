load common

@test "-n trajectories, each of a pair with seen = 1" {
    printf 'env\ttask\tseen\nmap1\tR-B\t1\nmap1\tB-G\t0\nmap7\tO-P\t1\n' >pairs.tsv
    synpo-gen-expert -p pairs.tsv -n 50 >e.jsonl
    [ "$(wc -l <e.jsonl)" -eq 50 ]
    jq -r '.env + " " + .task' e.jsonl | sort -u >got
    printf 'map1 R-B\nmap7 O-P\n' | cmp - got
}

@test "a pairs file without the column seen: all of its rows; no file: all pairs" {
    printf 'task\tenv\nR-B\tmap1\nB-G\tmap1\n' >pairs.tsv
    synpo-gen-expert -p pairs.tsv --per-pair 1 >e.jsonl
    jq -r '.env + " " + .task' e.jsonl >got
    printf 'map1 R-B\nmap1 B-G\n' | cmp - got
    synpo-gen-expert --per-pair 1 >all.jsonl
    [ "$(jq -r '.env + " " + .task' all.jsonl | sort -u | wc -l)" -eq 400 ]
}

@test "--per-pair: N of each, in order, and more of them begin with the same" {
    synpo-matrix split --envs 2 --tasks 2 -n 4 >pairs.tsv
    synpo-gen-expert -p pairs.tsv --per-pair 3 >three
    [ "$(wc -l <three)" -eq 12 ]
    jq -r '[.env, .task] | @tsv' three | uniq -c | awk '{ print $1 }' | sort -u >got
    [ "$(cat got)" = 3 ]
    synpo-gen-expert -p pairs.tsv --per-pair 2 >two
    jq -c 'select(.episode < 2)' three >first_two
    jq -c . two | cmp - first_two
}

@test "-s: the same bytes for the same seed, others for another; -o and stdout alike" {
    synpo-gen-expert -n 20 -s 5 >a
    synpo-gen-expert -n 20 -s 5 -o b
    synpo-gen-expert -n 20 -s 6 >c
    cmp a b
    run ! cmp -s a c
    synpo-gen-expert -n 10 -s 5 >d
    head -n 10 a | cmp - d
}

@test "the expert's record, field by field" {
    synpo-gen-expert -n 1 -s 1 >got
    cmp "$DATA/expert.jsonl" got
    synpo-gen-expert -n 200 -s 2 >e.jsonl
    jq -e -s 'all(.success and .terminated and (.truncated | not) and (has("labels") | not)
        and (.actions | length) == (.rewards | length) and .rewards[-1] == 10.99
        and ((.rewards | add) - .return | fabs) < 1e-9)' e.jsonl
}

@test "when the reader goes away: SIGPIPE, no message" {
    status=$(
        synpo-gen-expert 2>err | head -n 1 >line
        echo "${PIPESTATUS[0]}"
    )
    [ "$status" -eq 141 ]
    [ ! -s err ]
    jq -e .success line
    # Even under a launcher that ignores the signal.
    status=$(
        trap '' PIPE
        synpo-gen-expert 2>err | head -n 1 >line
        echo "${PIPESTATUS[0]}"
    )
    [ "$status" -eq 141 ]
    [ ! -s err ]
}

@test "--noise: random moves are recorded beside the expert's labels; --relabel finds the same labels" {
    synpo-gen-expert -n 40 --noise 0.3 >noisy
    jq -e -s 'all(has("labels")) and all((.labels | length) == (.actions | length))' noisy
    jq -s 'map([.actions, .labels] | transpose | map(select(.[0] != .[1])) | length) | add' noisy >differ
    [ "$(cat differ)" -gt 200 ]
    jq -c 'del(.labels)' noisy >bare
    synpo-gen-expert --relabel <bare >restored
    cmp noisy restored
    synpo-gen-expert --relabel <noisy >again
    cmp noisy again
}

@test "--relabel leaves the expert's own as they are" {
    synpo-gen-expert -n 40 >e.jsonl
    synpo-gen-expert --relabel <e.jsonl >again
    cmp e.jsonl again
}

@test "lines are whole in themselves: any order, any part" {
    synpo-gen-expert -n 30 --noise 0.1 >e.jsonl
    shuf -n 10 --random-source=e.jsonl e.jsonl >some
    synpo-gen-expert --relabel <some >again
    cmp some again
}

@test "--window is noted in the records" {
    synpo-gen-expert -n 3 --window 0 >blind
    jq -e -s 'all(.window == 0)' blind
}

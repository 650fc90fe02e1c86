load common

setup_file() { make_inputs; }
setup() { set_up pairs.tsv two.tsv e.jsonl a.ckpt m.tsv; }

@test "1 and 2 threads: the same bytes, matrix and records" {
    synpo-eval -q -p two.tsv -n 9 -j 1 --record one.jsonl <a.ckpt >one
    synpo-eval -q -p two.tsv -n 9 -j 2 --record two.jsonl <a.ckpt >two
    cmp one two
    cmp one.jsonl two.jsonl
}

@test "-c FILE and stdin, -o FILE and stdout, alike" {
    synpo-eval -q -p two.tsv -n 1 -c a.ckpt -o got
    cmp m.tsv got
}

@test "all rows of -p in their order, whatever their seen; the matrix has the checkpoint's" {
    printf 'env\ttask\tseen\tpart\nmap9\tO-P\t0\trest\nmap1\tR-B\t0\tP\n' >p.tsv
    synpo-eval -q -p p.tsv -n 1 <a.ckpt >got
    synpo-matrix merge got >merged
    cmp got merged
    awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
        { print $at["env"], $at["task"], $at["seen"], $at["part"] }' got >rows
    seen=$(described a.ckpt 'if .seen | index([["map1", "R-B"]]) then 1 else 0 end')
    printf 'map9 O-P 0 rest\nmap1 R-B %d P\n' "$seen" | cmp - rows
}

@test "without -p: all pairs of the checkpoint's world" {
    mkdir maps
    awk 'BEGIN { for (r = 0; r < 16; ++r) { for (c = 0; c < 16; ++c) printf "%s", r % 15 && c % 15 ? " " : "#";
        print "" } }' >maps/map1.txt
    synpo-gen-expert -w gridworld:maps -n 20 >hall.jsonl
    synpo-train "${TINY[@]}" -n 1 -w gridworld:maps --strip <hall.jsonl >hall.ckpt
    synpo-eval -q -n 1 <hall.ckpt >got
    [ "$(wc -l <got)" -eq 21 ]
}

@test "pairs of an environment or a task that training never met are new, not unseen, and eval says so" {
    printf 'env\ttask\nmap1\tR-B\nmap1\tB-G\nmap2\tR-B\nmap2\tB-G\nmap3\tR-B\nmap1\tO-P\n' >p.tsv
    head -n 4 p.tsv >three.tsv
    synpo-gen-expert -p three.tsv -n 20 | synpo-train "${TINY[@]}" -p three.tsv -n 1 --strip >three.ckpt
    synpo-eval -p p.tsv -n 1 <three.ckpt >got 2>note
    awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
        { print $at["env"], $at["task"], $at["seen"], $at["new"] }' got >rows
    printf 'map1 R-B 1 0\nmap1 B-G 1 0\nmap2 R-B 1 0\nmap2 B-G 0 0\nmap3 R-B 0 1\nmap1 O-P 0 1\n' | cmp - rows
    grep -q 'note: 2 of 6 pairs are new, not unseen' note
    synpo-matrix summary got | grep -q '^unseen  *1 '
    synpo-matrix summary got | grep -q '^new  *2 '
    synpo-eval -q -p p.tsv -n 1 <three.ckpt 2>note | cmp - got
    [ ! -s note ]
    synpo-eval -q -p three.tsv -n 1 <three.ckpt >known
    ! head -n 1 known | grep -qw new || complain "a column without a new pair"
    synpo-eval -q -p p.tsv -n 1 --first-episode 1 <three.ckpt | synpo-matrix merge got - >merged
    [ "$(awk -F '\t' 'NR > 1 && $12 == 2' merged | wc -l)" -eq 6 ]
}

@test "the matrix has the hash of each environment, as trajectories have it" {
    synpo-eval -q -p two.tsv -n 1 --record r.jsonl <a.ckpt >got
    awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next } { print $at["env"], $at["env_hash"] }' got |
        sort -u >hashes
    jq -r '.env + " " + .env_hash' r.jsonl | sort -u | cmp - hashes
}

@test "shards by --first-episode merge to the whole" {
    synpo-eval -q -p two.tsv -n 7 <a.ckpt >whole
    synpo-eval -q -p two.tsv -n 3 <a.ckpt >first
    synpo-eval -q -p two.tsv -n 4 --first-episode 3 <a.ckpt >rest
    synpo-matrix merge first rest >merged
    cmp whole merged
    synpo-matrix merge rest first >merged
    cmp whole merged
    fails 65 synpo-matrix merge first first
    fails 65 synpo-matrix merge whole rest
    says "whole"
}

@test "shards by pairs merge to the whole" {
    synpo-eval -q -p two.tsv -n 2 <a.ckpt >whole
    for i in 2 3; do
        sed -n "1p;${i}p" two.tsv >one.tsv
        synpo-eval -q -p one.tsv -n 2 <a.ckpt >part$i
    done
    synpo-matrix merge part2 part3 >merged
    cmp whole merged
}

@test "start states depend on -s and the pair, not on the checkpoint" {
    synpo-train "${TINY[@]}" -n 2 -s 9 --strip <e.jsonl >b.ckpt
    for run in a b; do
        synpo-eval -q -p two.tsv -n 3 --record - <$run.ckpt >$run.jsonl
        jq -c '[.env, .task, .start]' $run.jsonl >$run.starts
    done
    cmp a.starts b.starts
    run ! cmp -s a.jsonl b.jsonl
    synpo-eval -q -p two.tsv -n 3 -s 2 --record - <a.ckpt >c.jsonl
    jq -c '[.env, .task, .start]' c.jsonl >c.starts
    run ! cmp -s a.starts c.starts
}

@test "--record - and the matrix tell the same" {
    synpo-eval -q -p two.tsv -n 4 --record - -o m4.tsv <a.ckpt >r.jsonl
    jq -r -s 'group_by([.env, .task])[] | [.[0].env, .[0].task, length, (map(select(.success)) | length),
        (map(select(.truncated)) | length), (map(.actions | length) | add)] | @tsv' r.jsonl | sort >got
    awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; OFS = FS; next }
        { print $at["env"], $at["task"], $at["episodes"], $at["successes"], $at["timeouts"], $at["length"] }' m4.tsv |
        sort | cmp - got
    fails 64 synpo-eval -q --record - -o - -c a.ckpt
}

@test "--record - goes into gen-expert --relabel and train --init" {
    set -o pipefail
    synpo-eval -q -p two.tsv -n 4 --record - <a.ckpt | synpo-gen-expert --relabel | tee labelled.jsonl |
        synpo-train "${TINY[@]}" --fill 8 -n 2 --init a.ckpt >b.ckpt
    [ "$(described b.ckpt .updates)" -eq 2 ]
    # The labels that eval writes are the expert's already.
    synpo-eval -q -p two.tsv -n 4 --record direct.jsonl <a.ckpt >m4.tsv
    cmp labelled.jsonl direct.jsonl
}

@test "--describe: JSON of what the checkpoint says, without the weights" {
    synpo-eval --describe <a.ckpt >description
    jq -e '.format == "synpo-checkpoint" and .version == 1 and .method == "synpo" and .world == "gridworld"
        and .updates == 2 and (.envs | length) == 20
        and (.envs[0].content | length) == 272 and (.tasks | length) == 20 and (.seen | length) == 5
        and .options["batch-states"] == "64" and .shape.feature == 128 and (.weights_hash | test("^[0-9a-f]{16}$"))' \
        description
    [ "$(jq -r .weights_hash description)" = "$(awk -F '\t' 'NR == 2 { print $1 }' m.tsv)" ]
}

@test "the blind agent's checkpoint is evaluated blind" {
    synpo-gen-expert -p two.tsv -n 20 --window 0 >blind.jsonl
    synpo-train "${TINY[@]}" -n 1 <blind.jsonl >blind.ckpt
    [ "$(described blind.ckpt .window)" -eq 0 ]
    synpo-eval -q -p two.tsv -n 1 <blind.ckpt >got
    [ "$(awk -F '\t' 'NR == 2 { print $3 }' got)" -eq 0 ]
    cat blind.jsonl e.jsonl >mixed.jsonl
    fails 65 synpo-train "${TINY[@]}" --fill 21 -n 1 <mixed.jsonl
    says "line 21: window 1, expected 0"
}

@test "--temperature: in the matrix, the greedy policy at 0, nonsense is 64" {
    for t in 0 0.5 1; do synpo-eval -q -p two.tsv -n 9 --temperature $t <a.ckpt >t$t; done
    synpo-eval -q -p two.tsv -n 9 <a.ckpt | cmp - t0.5
    ! cmp -s t0 t1 || complain "greedy and drawn are the same"
    awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next } { print $at["temperature"] }' t0.5 |
        sort -u >got
    echo 0.5 | cmp - got
    run -64 --separate-stderr synpo-eval --temperature -1 <a.ckpt
    run -64 --separate-stderr synpo-eval --temperature x <a.ckpt
}

@test "--starts training: episodes of their own starts and moves, to learn from and not to count" {
    synpo-eval -q -p two.tsv -n 9 --record tested.jsonl <a.ckpt >counted
    synpo-eval -q -p two.tsv -n 9 --starts evaluation --record - <a.ckpt | cmp - tested.jsonl
    for j in 1 2; do synpo-eval -q -j $j -p two.tsv -n 9 --starts training --record r$j.jsonl <a.ckpt >matrix$j; done
    cmp r1.jsonl r2.jsonl
    [ ! -s matrix1 ]
    [ "$(wc -l <r1.jsonl)" -eq 18 ]
    synpo-eval -q -p two.tsv -n 9 --starts training --record - <a.ckpt | cmp - r1.jsonl
    synpo-gen-expert -p two.tsv --per-pair 9 >expert.jsonl
    for other in tested expert; do
        paste -d '\n' <(jq -c .start r1.jsonl) <(jq -c .start $other.jsonl) | uniq -d >same
        [ ! -s same ]
    done
    fails 64 synpo-eval --starts training -p two.tsv -n 9 -c a.ckpt
    fails 64 synpo-eval --starts training --record r -o m -p two.tsv -n 9 -c a.ckpt
    fails 64 synpo-eval --starts test --record r -c a.ckpt
    says "expected evaluation or training"
}

@test "who learns from the starts that evaluations count is warned; DAgger's recipe is not" {
    printf 'env\ttask\nmap5\tR-B\nmap1\tP-O\n' >new.tsv
    for use in evaluation training; do
        synpo-eval -q -p two.tsv -s 3 -n 9 --starts $use --record $use.jsonl <a.ckpt >matrix
        synpo-eval -q -p new.tsv -s 3 -n 9 --starts $use --record new-$use.jsonl <a.ckpt >matrix
    done
    cat e.jsonl evaluation.jsonl >mixed.jsonl
    learn() { synpo-train "${TINY[@]}" -n 1 --init a.ckpt "$@" 2>err >b.ckpt; }
    learn --no-fresh-starts <evaluation.jsonl
    begins='line 1 begins where episode 0 of synpo-eval -s 3 begins: .*--starts training'
    grep -q "^synpo-train: warning: standard input: $begins" err
    [ "$(wc -l <err)" -eq 1 ]
    learn --no-fresh-starts --fill 78 <mixed.jsonl
    grep -q 'warning: standard input: line 61 begins' err
    learn --no-fresh-starts --fill 78 e.jsonl evaluation.jsonl
    grep -q 'warning: evaluation.jsonl: line 1 begins' err
    synpo-train "${TINY_PAPER[@]}" -n 1 <evaluation.jsonl 2>err >b.ckpt
    grep -q 'warning: standard input: line 1 begins' err
    synpo-finetune adapt -q -c a.ckpt -n 1 <new-evaluation.jsonl 2>err >b.ckpt
    grep -q '^synpo-finetune: warning: standard input: line 1 begins' err ||
        grep -q '^synpo-finetune adapt: warning: standard input: line 1 begins' err
    # With fresh starts the stream gives the pairs alone.
    learn <evaluation.jsonl
    [ ! -s err ]
    learn --no-fresh-starts <training.jsonl
    [ ! -s err ]
    learn --no-fresh-starts <e.jsonl
    [ ! -s err ]
    synpo-train "${TINY_PAPER[@]}" -n 1 <training.jsonl 2>err >b.ckpt
    [ ! -s err ]
    synpo-finetune adapt -q -c a.ckpt -n 1 <new-training.jsonl 2>err >b.ckpt
    [ ! -s err ]
}

@test "the starts of a training's own evaluations are none of synpo-eval's" {
    # The same policy, seed and pairs: with the same episodes both would find the same rewards.
    awk 'NR == 1 || $3 == 1' pairs.tsv | head -n 2 >one.tsv
    synpo-gen-expert -p one.tsv -n 20 >one.jsonl
    synpo-train "${TINY[@]}" -n 1 -p one.tsv -s 1 --evaluate-every 1 --evaluate-episodes 40 --log log <one.jsonl \
        >one.ckpt
    synpo-eval -q -p one.tsv -s 1 -n 40 <one.ckpt >matrix
    log=$(awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
        { printf "%.4f", 40 * $at["seen_reward"] }' log)
    tested=$(awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next } { printf "%.4f", $at["reward"] }' \
        matrix)
    [ "$log" != "$tested" ] || complain "both earn $log"
}

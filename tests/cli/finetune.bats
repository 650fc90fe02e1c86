load common

# Small enough for a moment.
PPO=(-q --lanes 4 --rollout 8 --minibatches 2 --epochs 2 --value-warm-up 1)

setup_file() { make_inputs; }
setup() {
    set_up pairs.tsv two.tsv e.jsonl a.ckpt
    printf 'env\ttask\nmap5\tR-B\nmap1\tP-O\n' >new.tsv
    synpo-gen-expert -p new.tsv --per-pair 1 >demos.jsonl
}

@test "adapt: new pairs count as seen, and the checkpoint goes through the pipeline" {
    synpo-finetune adapt -q -c a.ckpt -n 3 <demos.jsonl >b.ckpt
    [ "$(described b.ckpt '.seen | length')" -eq 7 ]
    [ "$(described b.ckpt '.options["task-loss"]')" = "$(described a.ckpt '.options["task-loss"]')" ]
    synpo-eval -q -p new.tsv -n 1 <b.ckpt >m
    [ "$(awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next } { n += $at["seen"] } END { print n }' m)" \
        -eq 2 ]
    for name in theta encoder.fc.weight alpha.hidden.weight encoder.stage1.block1.norm1.mean; do
        cmp <(tensor a.ckpt $name) <(tensor b.ckpt $name)
    done
    ! cmp -s <(tensor a.ckpt embedding.env) <(tensor b.ckpt embedding.env)
}

@test "adapt: threads don't show; another seed does" {
    for j in 1 2; do synpo-finetune adapt -q -c a.ckpt -n 3 -j $j <demos.jsonl >b$j.ckpt; done
    cmp b1.ckpt b2.ckpt
    synpo-finetune adapt -q -c a.ckpt -n 3 -s 2 <demos.jsonl >other.ckpt
    ! cmp -s b1.ckpt other.ckpt
}

@test "adapt: maps that the checkpoint has not, and maps that are others" {
    mkdir more same
    synpo-eval --describe <a.ckpt >/dev/null
    cp "$ROOT/lib/world/grid/maps/map1.txt" more/map21.txt
    cp "$ROOT/lib/world/grid/maps/map2.txt" same/map1.txt
    printf 'env\ttask\nmap21\tR-B\n' >far.tsv
    synpo-gen-expert -w gridworld:more -p far.tsv -n 2 >far.jsonl
    fails 65 synpo-finetune adapt -q -c a.ckpt -n 1 <far.jsonl
    says "map21"
    synpo-finetune adapt -q -c a.ckpt -w gridworld:more -n 1 <far.jsonl >wide.ckpt
    [ "$(described wide.ckpt .shape.envs)" -eq 21 ]
    synpo-eval -q -p far.tsv -n 1 <wide.ckpt >/dev/null
    fails 65 synpo-finetune adapt -q -c a.ckpt -w gridworld:same -n 1 <far.jsonl
    says "map1"
}

@test "adapt: what cannot be" {
    fails 64 synpo-finetune adapt <demos.jsonl
    says "-c"
    fails 64 synpo-finetune adapt -c a.ckpt --train everything <demos.jsonl
    for words in recognisers embeddings+ embeddings+theta embeddings+embeddings; do
        fails 64 synpo-finetune adapt -c a.ckpt --train $words <demos.jsonl
        says "found '$words', expected embeddings, and +recognisers, +basis or +coefficients after it"
    done
    # The older word for two of them.
    for words in heads basis+recognisers recognisers; do
        synpo-finetune adapt -q -n 3 -c a.ckpt --train embeddings+$words <demos.jsonl >$words.ckpt
    done
    cmp heads.ckpt basis+recognisers.ckpt
    ! cmp -s heads.ckpt recognisers.ckpt || complain "+recognisers learns the basis"
    says "embeddings"
    fails 65 synpo-finetune adapt -q -c a.ckpt </dev/null
    says "no trajectory"
    fails 65 synpo-finetune adapt -q -c demos.jsonl <demos.jsonl
    fails 66 synpo-finetune adapt -q -c none.ckpt <demos.jsonl
    synpo-gen-expert -p new.tsv -n 1 --window 0 >blind.jsonl
    fails 65 synpo-finetune adapt -q -c a.ckpt <blind.jsonl
    says "window"
    synpo-train "${TINY[@]}" -m modulenet -n 1 --strip <e.jsonl >m.ckpt
    fails 64 synpo-finetune adapt -q -c m.ckpt <demos.jsonl
    says "nothing to adapt"
    synpo-train "${TINY[@]}" -n 1 -p pairs.tsv -m sf --sf-loss td --strip <e.jsonl >sf.ckpt
    fails 64 synpo-finetune adapt -q -c sf.ckpt <demos.jsonl
    says "needs more than demonstrations hold"
    fails 64 synpo-finetune ppo -q --steps 0 <a.ckpt
}

@test "ppo: resumed equals unbroken, 1 and 2 threads; the log has a row a report" {
    synpo-finetune ppo "${PPO[@]}" --steps 128 -j 2 --log log.tsv --report 1 --evaluate-every 2 --evaluate-episodes 2 \
        <a.ckpt >unbroken
    [ "$(wc -l <log.tsv)" -eq 5 ]
    synpo-finetune ppo "${PPO[@]}" --steps 64 -j 1 <a.ckpt >part
    synpo-finetune ppo "${PPO[@]}" --steps 128 -j 1 --resume part >resumed
    cmp unbroken resumed
    synpo-eval -q -p two.tsv -n 1 <unbroken >/dev/null
}

# An episode has 1 for the first of its treasures, 11 for the second, -10 for a wrong one, and -0.01 or -0.02 a step.
@test "ppo: the log's reward is one that its successes, wrong treasures and steps can have" {
    synpo-finetune ppo "${PPO[@]}" --lanes 64 --rollout 64 --steps 4096 --epochs 1 --report 1 --log log.tsv \
        <a.ckpt >tuned
    [ "$(awk -F '\t' '
        NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
        $at["episodes"] > 0 {
            ++reports
            wrong = 10 * $at["wrong"]; steps = 0.01 * $at["length"]; reward = $at["reward"]
            if (reward < -wrong - 2 * steps - 0.001 || reward > 11 * $at["success"] + 1 - wrong - steps + 0.001) print
        }
        END { print reports + 0 }' log.tsv)" -ge 1 ]
}

@test "ppo: its log is drawn as curves" {
    synpo-render curves --help >/dev/null || skip "this build draws no pictures"
    synpo-finetune ppo "${PPO[@]}" --steps 64 --log log.tsv --report 1 --evaluate-every 1 --evaluate-episodes 2 \
        <a.ckpt >tuned
    synpo-render curves -o curve.png <log.tsv
}

@test "ppo: SIGTERM leaves a checkpoint to go on from" {
    synpo-finetune ppo "${PPO[@]}" --steps 1e6 --save s.ckpt --every 1 -o out.ckpt <a.ckpt &
    pid=$!
    for ((i = 0; i < 600; ++i)); do [ -s s.ckpt ] && break; sleep 0.05; done
    kill -TERM $pid
    status=0
    wait $pid || status=$?
    [ "$status" -eq 143 ]
    steps=$(described s.ckpt .states)
    synpo-finetune ppo "${PPO[@]}" --steps $((steps + 32)) --resume s.ckpt >/dev/null
}

@test "ppo: from scratch, and on other pairs" {
    synpo-finetune ppo "${PPO[@]}" --steps 64 --init random -p pairs.tsv --strip >r.ckpt
    synpo-eval -q -p two.tsv -n 1 <r.ckpt >/dev/null
    printf 'env\ttask\tseen\nmap9\tR-G\t1\n' >one.tsv
    synpo-finetune ppo "${PPO[@]}" --steps 32 -p one.tsv --strip <a.ckpt >o.ckpt
    [ "$(described o.ckpt '.seen | length')" -eq 1 ]
}

@test "ppo: what cannot be" {
    fails 64 synpo-finetune ppo -q --init zero </dev/null
    fails 64 synpo-finetune ppo -q --init random -c a.ckpt
    fails 64 synpo-finetune ppo -q -m mlp <a.ckpt
    fails 64 synpo-finetune ppo -q --lanes 3 --rollout 5 --minibatches 4 <a.ckpt
    says "minibatches"
    fails 65 synpo-finetune ppo -q --init random </dev/null
    says "-p"
    synpo-finetune ppo "${PPO[@]}" --steps 32 --save run.ckpt -o out.ckpt a.ckpt
    fails 65 synpo-finetune ppo "${PPO[@]}" --steps 64 --init random -m mlp --resume run.ckpt
    says "the run in the checkpoint has method synpo, not mlp"
    fails 65 synpo-finetune ppo "${PPO[@]}" --steps 64 --init random -w kitchen --resume run.ckpt
    says "the run in the checkpoint has world gridworld, not kitchen"
    fails 65 synpo-finetune ppo -q --resume a.ckpt
    says "stripped"
    synpo-finetune ppo "${PPO[@]}" --steps 32 <a.ckpt >part
    fails 65 synpo-finetune ppo "${PPO[@]}" --clip 0.3 --steps 64 --resume part
    says "--clip"
    fails 65 synpo-finetune ppo "${PPO[@]}" -s 9 --steps 64 --resume part
    says "seed"
}

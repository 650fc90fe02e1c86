# Options that stand together: what does not go together is refused, and their order says nothing.
load ../common

setup_file() {
    make_inputs
    synpo-train "${TINY[@]}" -n 2 -p pairs.tsv <e.jsonl >done.ckpt
    synpo-gen-expert -p pairs.tsv -n 3 --end >ended.jsonl
    synpo-finetune ppo "${PPO[@]}" --steps 64 -p pairs.tsv --save ppo.save -o /dev/null a.ckpt
}
setup() { set_up pairs.tsv e.jsonl a.ckpt m.tsv done.ckpt ended.jsonl ppo.save; }
PPO=(-q --lanes 4 --rollout 8 --minibatches 2 --epochs 1 --value-warm-up 0)

@test "a run that was done when it was resumed still hears of its stream's end, where it is asked to" {
    fails 65 synpo-train -q --resume done.ckpt --expect 61 -o out.ckpt e.jsonl
    says "the stream ended after 60 trajectories, expected 61"
    fails 65 synpo-train -q --resume done.ckpt --expect-end -o out.ckpt e.jsonl
    says "e.jsonl: it ended after 60 trajectories, expected a last line that says its end"
    synpo-gen-expert -p pairs.tsv -n 60 -s 2 --end >other.jsonl
    fails 65 synpo-train -q --resume done.ckpt --expect-end -o out.ckpt other.jsonl
    says "the first 21 lines are not those that the checkpoint was trained on"
    synpo-gen-expert -p pairs.tsv -n 60 -s 1 --end >whole.jsonl
    synpo-train -q --resume done.ckpt --expect 60 --expect-end whole.jsonl | cmp - done.ckpt
}

@test "--describe is alone with the checkpoint and the output" {
    for option in "-p pairs.tsv" "-n 3" "--record r.jsonl" --scores "-s 2" "--temperature 1"; do
        # shellcheck disable=SC2086
        fails 64 synpo-eval --describe $option a.ckpt
    done
    says "--describe does not go with --temperature"
    synpo-eval -q --describe -c a.ckpt -o described.json
}

@test "ppo --resume: the same pairs in another order are the same run, others are refused, and so are fewer steps" {
    (head -n 1 pairs.tsv; tail -n +2 pairs.tsv | tac) >turned.tsv
    run ! cmp -s pairs.tsv turned.tsv
    synpo-finetune ppo "${PPO[@]}" --steps 128 --resume ppo.save >plain.ckpt
    synpo-finetune ppo "${PPO[@]}" --steps 128 --resume ppo.save -p turned.tsv | cmp - plain.ckpt
    # One more, which the run never played: its episodes in progress would do.
    awk -F '\t' -v OFS='\t' '$3 == 0 && !n++ { $3 = 1 } 1' pairs.tsv >more.tsv
    fails 65 synpo-finetune ppo "${PPO[@]}" --steps 128 --resume ppo.save -p more.tsv -o out.ckpt
    says "more.tsv: found other pairs than those that the run in the checkpoint learns on"
    fails 64 synpo-finetune ppo "${PPO[@]}" --steps 32 --resume ppo.save -o out.ckpt
    says "found 32 steps in all, expected at least the 64 that the checkpoint has"
    # As many rollouts as were done.
    synpo-finetune ppo "${PPO[@]}" --steps 33 --resume ppo.save -o same.ckpt
}

@test "--temperature -0 is 0: one run in every table" {
    synpo-eval -q -n 1 -p pairs.tsv --temperature 0 a.ckpt >zero.tsv
    synpo-eval -q -n 1 -p pairs.tsv --temperature -0 a.ckpt | cmp - zero.tsv
    synpo-eval -q -n 1 -p pairs.tsv --temperature 0 --first-episode 1 a.ckpt |
        awk -F '\t' -v OFS='\t' 'NR == 1 { while ($++i != "temperature") ; } NR > 1 { $i = "-0" } 1' >minus.tsv
    [ "$(synpo-matrix merge zero.tsv minus.tsv | wc -l)" -eq "$(wc -l <zero.tsv)" ]
    synpo-matrix show zero.tsv minus.tsv >shown
}

@test "a count of names may be written as any other count" {
    synpo-matrix split --envs 20 --tasks 3 | cmp - <(synpo-matrix split --envs 2e1 --tasks 03)
    synpo-matrix split -w any --envs 20 --tasks 3 | cmp - <(synpo-matrix split -w any --envs 2e1 --tasks 3e0)
    fails 64 synpo-matrix split -w any --envs 2e6 --tasks 3
    says "--envs 2e6: expected 1 to 1000000, or names"
    fails 64 synpo-matrix split -w any --envs 99999999999999999999 --tasks 3
    says "expected 1 to 1000000, or names"
    fails 64 synpo-matrix split --envs -1
    says "--envs -1: expected 1 to 20, or names"
}

@test "standard input is read once, whatever options name it" {
    fails 64 synpo-eval -p - -c - <a.ckpt
    says "standard input can be read only once"
    fails 64 synpo-matrix merge - - <m.tsv
    says "standard input can be read only once"
    fails 64 synpo-train -q --resume - -n 9 -o out.ckpt <done.ckpt
    says "standard input can be read only once"
    fails 64 synpo-gen-expert --play -p - <pairs.tsv
    says "standard input can be read only once"
}

@test "summary --tsv has no colours to ask for" {
    fails 64 synpo-matrix summary --tsv --colour always m.tsv
    says "--colour is for text, not for --tsv"
}

load ../common

setup_file() { make_inputs; }
setup() { set_up pairs.tsv e.jsonl a.ckpt two.tsv; }

teardown() {
    [ -z "${pid-}" ] || kill -9 "$pid" 2>/dev/null || true
}

# interrupts COMMAND...: runs it until its log has a row, and sends it SIGINT; its words are in err. A script's shell
# has SIGINT ignored in the background, and ignored it would stay.
interrupts() {
    local status=0 i
    rm -f log.tsv
    env --default-signal=INT "$@" --log log.tsv --report 1 <&0 2>err 3>&- &
    pid=$!
    for ((i = 0; i < 600; ++i)); do
        [ ! -e log.tsv ] || [ "$(wc -l <log.tsv)" -lt 2 ] || break
        kill -0 "$pid" || complain "it ended: $(cat err)"
        sleep 0.05
    done
    kill -INT "$pid"
    wait "$pid" || status=$?
    pid=
    [ "$status" -eq 130 ] || complain "exit code $status: $(cat err)"
}

# The command that a stopped run names.
command_of() { sed -n "s/^$1: this goes on[^:]*: //p" err; }

TRAINING=(synpo-train --batch-states 64 --fill 20 --running 64 --memory 30)

@test "after Ctrl-C a training with --save names the command that goes on, and that command does" {
    interrupts "${TRAINING[@]}" -p pairs.tsv -s 3 -n 60 --lr 0.001 --no-cosine --save 'my run.ckpt' -o out.ckpt e.jsonl
    command=$(command_of synpo-train)
    [ "$command" = "synpo-train -n 60 --save 'my run.ckpt' -o out.ckpt --log log.tsv --report 1 --resume 'my run.ckpt'\
 e.jsonl" ]
    done_before=$(described 'my run.ckpt' .updates)
    [ "$done_before" -ge 1 ]
    bash -c "${command/-n 60/-q -n $((done_before + 2))}"
    [ "$(described out.ckpt .updates)" -eq $((done_before + 2)) ]
    # To the same bits as a run that was not stopped.
    "${TRAINING[@]}" -q -p pairs.tsv -s 3 -n 60 --lr 0.001 --no-cosine --save whole.ckpt -o whole.out e.jsonl &
    pid=$!
    wait "$pid"
    pid=
    bash -c "$command" 2>/dev/null
    cmp out.ckpt whole.out
}

@test "redirections of files are part of it; of a pipe it says that the same stream is needed" {
    interrupts "${TRAINING[@]}" -n 4000 --save run.ckpt <e.jsonl >out.ckpt
    [ "$(command_of synpo-train)" = "synpo-train -n 4000 --save run.ckpt --log log.tsv --report 1 --resume run.ckpt\
 < $(readlink -f e.jsonl) > out.ckpt" ]
    interrupts "${TRAINING[@]}" --time 2h --save run.ckpt -o out.ckpt < <(cat e.jsonl)
    grep -q '^synpo-train: this goes on, with the same stream on standard input: synpo-train ' err
    command_of synpo-train | grep -q -- '--time 2h\|-n' || [ "$(described run.ckpt .updates)" -ge 50 ]
}

@test "a limit in time that was told in updates is left to the checkpoint" {
    synpo-train "${TINY[@]}" -n 60 --save run.ckpt e.jsonl >/dev/null
    interrupts synpo-train --resume run.ckpt --time 1h --save run.ckpt -o out.ckpt e.jsonl
    command=$(command_of synpo-train)
    [[ $command == *" --resume run.ckpt e.jsonl" ]]
    [ "$(grep -o -- --resume <<<"$command" | wc -l)" -eq 1 ]
}

@test "a limit in time that was not told in updates yet is part of it" {
    "${TRAINING[@]}" -q -n 2 e.jsonl >a2.ckpt
    interrupts synpo-train --resume a2.ckpt --time 1h --save run.ckpt -o out.ckpt e.jsonl
    [ "$(described run.ckpt .updates)" -ge 50 ] || command_of synpo-train | grep -q -- '--time 1h .*--resume run.ckpt'
}

@test "nothing of it without --save or with -q" {
    interrupts "${TRAINING[@]}" -n 4000 -o out.ckpt e.jsonl
    [ -z "$(command_of synpo-train)" ]
    interrupts "${TRAINING[@]}" -q -n 4000 --save run.ckpt -o out.ckpt e.jsonl
    [ ! -s err ]
}

@test "PPO: all its options again, but not the checkpoint that it began with" {
    interrupts synpo-finetune ppo -p two.tsv --lanes 16 --steps 1e6 --no-env-loss --save run.ckpt -o out.ckpt a.ckpt ||
        interrupts synpo-finetune ppo -p two.tsv --lanes 16 --steps 1e6 --save run.ckpt -o out.ckpt a.ckpt
    command=$(command_of synpo-finetune)
    [[ $command == "synpo-finetune ppo -p two.tsv --lanes 16 --steps 1e6 "*" --resume run.ckpt" ]]
    [[ $command != *a.ckpt* ]]
    steps=$(described run.ckpt .states)
    bash -c "${command/--steps 1e6/-q --steps $((steps + 10))}"
    [ "$(described out.ckpt .states)" -gt "$steps" ]
}

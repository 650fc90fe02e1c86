load ../common

# kill -9 at moments drawn from a seed: what has a name is whole, and going on gives the bits of a run that was never
# killed. KILLS is how many of each command; make accidents takes more than the few of every day.

: "${KILLS:=3}" "${KILL_SEED:=1}"

setup_file() {
    make_inputs
    head -n 3 e.jsonl >few.jsonl
    synpo-train "${TINY[@]}" -n 40 -s 2 <e.jsonl >train.want
    synpo-finetune ppo "${PPO[@]}" <a.ckpt >ppo.want
    synpo-finetune adapt -q -n 300 -c a.ckpt <few.jsonl >adapt.want
    synpo-eval -q -p two.tsv -n 60 -c a.ckpt >eval.want
}

setup() { set_up pairs.tsv two.tsv e.jsonl few.jsonl a.ckpt {train,ppo,adapt,eval}.want; }

PPO=(-q --steps 640 --lanes 4 --rollout 8 --epochs 1 --minibatches 1)

# Milliseconds up to $2, by the seed, a command and a number.
moment() {
    local hash
    hash=$(printf '%s %s %s' "$KILL_SEED" "$1" "$3" | cksum | cut -d ' ' -f 1)
    printf '%d.%03d' $((hash % $2 / 1000)) $((hash % $2 % 1000))
}

# killed SECONDS COMMAND...: runs the command and kills it after so long; what the command says is lost with it.
killed() {
    local status=0
    "${@:2}" 2>err 3>&- &
    local pid=$!
    sleep "$1"
    kill -9 "$pid" 2>/dev/null || true
    wait "$pid" || status=$?
    [ "$status" -eq 137 ] || [ "$status" -eq 0 ] || complain "${*:2}: exit code $status: $(cat err)"
}

# How long a command takes, in milliseconds, at most.
lasts() {
    local begin
    begin=$(date +%s%N)
    "$@" >/dev/null
    echo $((($(date +%s%N) - begin) / 1000000 + 1))
}

nothing_but() {
    find . -maxdepth 1 -name '*.part*' | while read -r left; do
        case $left in
            "./$1".*.part | "./$1".*.part.lock | "./$2".*.part) ;;
            *) complain "left $left" ;;
        esac
    done
}

# In place of the shell, so that the kill is the program's.
exec_begin_train() { exec synpo-train "${TINY[@]}" -n 40 -s 2 --save saved --every 1 -o out <e.jsonl; }
exec_resume_train() { exec synpo-train -q --resume saved --save saved --every 1 -o out <e.jsonl; }
exec_begin_ppo() { exec synpo-finetune ppo "${PPO[@]}" --save saved --every 1 -o out <a.ckpt; }
exec_resume_ppo() { exec synpo-finetune ppo "${PPO[@]}" --resume saved --save saved --every 1 -o out; }
exec_adapt() { exec synpo-finetune adapt -q -n 300 -c a.ckpt -o out <few.jsonl; }
exec_eval() { exec synpo-eval -q -p two.tsv -n 60 -c a.ckpt -o out --record record; }
exec_in_shell() { ("$@"); }

# Which of the two goes on from what is there.
begin_or_resume() { if [ -e saved ]; then echo "exec_resume_$1"; else echo "exec_begin_$1"; fi; }

nothing_left() { [ -z "$(find . -name '*.part*')" ] || complain "left $(find . -name '*.part*')"; }

# kill_and_resume train|ppo: until it has been killed KILLS times.
kill_and_resume() {
    local long again=0
    long=$(lasts exec_in_shell "exec_begin_$1")
    cmp out "$1.want"
    rm out saved
    for ((i = 0; i < KILLS; ++i)); do
        killed "$(moment "$1" "$long" "$i")" "$(begin_or_resume "$1")"
        nothing_but saved out
        [ ! -e saved ] || described saved .updates >/dev/null
        # Some runs come to their end: the next one begins anew.
        if [ -e out ]; then
            cmp out "$1.want"
            rm out saved
            again=$((again + 1))
        fi
    done
    ("$(begin_or_resume "$1")")
    cmp out "$1.want"
    nothing_left
    echo "# $1: $KILLS kills, $again ends between" >&3
}

@test "train: the checkpoint is whole after every kill, and the end is that of a run never killed" {
    kill_and_resume train
}

@test "ppo: the checkpoint is whole after every kill, and the end is that of a run never killed" {
    kill_and_resume ppo
}

@test "adapt and eval: the output is there as a whole or not at all" {
    local command long
    for command in adapt eval; do
        rm -f out
        long=$(lasts exec_in_shell exec_$command)
        cmp out $command.want
        for ((i = 0; i < KILLS; ++i)); do
            rm -f out record
            killed "$(moment $command "$long" "$i")" exec_$command
            nothing_but out record
            [ ! -e out ] || cmp out $command.want
        done
        (exec_$command)
        cmp out $command.want
        nothing_left
    done
    echo "# adapt, eval: $KILLS kills each" >&3
}

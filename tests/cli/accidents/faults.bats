load ../common

# A preloaded library makes the system fail, in every place where it can.

setup_file() {
    cd "$BATS_FILE_TMPDIR" || exit
    "${CC:-cc}" -shared -fPIC -O1 -Wall -Wextra -o faults.so "$ROOT/tests/cli/accidents/faults.c" || exit
    make_inputs
    # An episode that is cut after three steps: few frames.
    head -n 1 e.jsonl |
        jq -c '(.actions, .rewards) |= .[:3] | .success = false | .terminated = false' >short.jsonl
}

setup() { set_up pairs.tsv two.tsv e.jsonl short.jsonl a.ckpt m.tsv faults.so; }

# with FAULT COMMAND...: the command with that fault; its messages go to ../err.
with() {
    # A sanitizer's library would have to come first.
    FAULT=$1 FAULT_LOG=$BATS_TEST_TMPDIR/count LD_PRELOAD=$PWD/faults.so ASAN_OPTIONS=verify_asan_link_order=0 \
        "${@:2}" 2>"$BATS_TEST_TMPDIR/err"
}

# count OF COMMAND...: how often the command writes (1) or syncs (2) a file.
count() {
    with none "${@:2}" >/dev/null
    cut -d ' ' -f "$1" "$BATS_TEST_TMPDIR/count"
}

TRAIN=(synpo-train "${TINY[@]}" -n 3 --every 1 --report 1)

# The commands, which write `out` and what else they say; train and ppo also write `saved` and `log`.
train() { "${TRAIN[@]}" --save saved --log log -o out <e.jsonl; }
resume() { synpo-train -q --resume start --every 1 --report 1 -n 4 --save saved --log log -o out <e.jsonl; }
ppo() {
    synpo-finetune ppo -q --steps 64 --lanes 4 --rollout 8 --epochs 1 --minibatches 1 --every 1 --report 1 \
        --save saved --log log -o out <a.ckpt
}
adapt() { head -n 3 e.jsonl | synpo-finetune adapt -q -n 3 -c a.ckpt -o out; }
evaluate() { synpo-eval -q -p two.tsv -n 2 -c a.ckpt --record record -o out; }
expert() { synpo-gen-expert -q -p pairs.tsv -n 400 -o out; }
split() { synpo-matrix split -o out; }
merge() { synpo-matrix merge -o out m.tsv; }
map() { synpo-render map -o out; }
frames() { synpo-render episode --frames out "$EPISODE"; }
EPISODE=${ACCIDENTS:+e.jsonl}
: "${EPISODE:=short.jsonl}"
COMMANDS=(train resume ppo adapt evaluate expert split merge map frames)

# In an empty folder but for the inputs.
fresh() {
    rm -rf out saved log record
    find . -name '*.part*' | grep . && complain "left $(find . -name '*.part*')"
    return 0
}

# Whatever bears a name is whole: as the undisturbed run left it in good/, or an earlier state of it.
check_left() {
    local name
    for name in out record; do
        [ ! -e $name ] || diff -r good/$name $name || complain "$name is not whole"
    done
    [ ! -e saved ] || synpo-eval --describe -c saved -o /dev/null
    [ ! -s log ] || [ "$(tail -c 1 log | od -An -tx1)" = ' 0a' ] || complain "the log's last row is cut off"
    [ ! -s log ] || head -n "$(wc -l <log)" good/log | cut -f 1-2 | cmp - <(cut -f 1-2 log)
}

# faulty FAULT COMMAND: 74 and one line that says what, and what it leaves is whole; 0 where the fault did not matter.
faulty() {
    local status=0
    fresh
    with "$1" "$2" || status=$?
    [ "$status" -eq 74 ] || complain "$2 with $1: exit code $status: $(cat "$BATS_TEST_TMPDIR/err")"
    [ "$(wc -l <"$BATS_TEST_TMPDIR/err")" -eq 1 ] || complain "$2 with $1: $(cat "$BATS_TEST_TMPDIR/err")"
    grep -qE "^synpo-[a-z-]+: cannot (write|close|rename|create)" "$BATS_TEST_TMPDIR/err" ||
        complain "$2 with $1: $(cat "$BATS_TEST_TMPDIR/err")"
    check_left
}

every_write() {
    local command writes n tried=0
    synpo-train "${TINY[@]}" -n 2 --save start -o /dev/null <e.jsonl
    for command in "$@"; do
        fresh
        writes=$(count 1 "$command")
        [ "$writes" -ge 1 ]
        rm -rf good
        mkdir good
        for name in out saved log record; do [ ! -e $name ] || mv $name good; done
        for ((n = 1; n <= writes; ++n)); do
            faulty "write:$n" "$command"
            tried=$((tried + 1))
        done
    done
    echo "# a full disk at each of $tried writes of $*: 74 each time" >&3
}

@test "a full disk at the n-th write, for every n, from every command: 74, and what has a name is whole" {
    every_write "${COMMANDS[@]}"
}

@test "a disk that is full for a moment: 74, and what has a name is whole" {
    local n
    for command in train evaluate; do
        fresh
        rm -rf good
        mkdir good
        count 1 $command >writes
        for name in out saved log record; do [ ! -e $name ] || mv $name good; done
        for ((n = 1; n <= $(cat writes); ++n)); do faulty "once:$n" $command; done
    done
}

@test "a disk that fails when it is flushed: 74, and what has a name is whole" {
    local n syncs
    for command in train evaluate split frames; do
        fresh
        rm -rf good
        mkdir good
        syncs=$(count 2 $command)
        [ "$syncs" -ge 2 ]
        for name in out saved log record; do [ ! -e $name ] || mv $name good; done
        for ((n = 1; n <= syncs; ++n)); do
            fresh
            status=0
            with "sync:$n" $command || status=$?
            [ "$status" -eq 74 ] || complain "$command with sync:$n: exit code $status: $(cat "$BATS_TEST_TMPDIR/err")"
            check_left
        done
    done
}

@test "short reads and writes, and interruptions: the same bytes" {
    synpo-train "${TINY[@]}" -n 2 --save start -o /dev/null <e.jsonl
    for command in "${COMMANDS[@]}"; do
        fresh
        $command
        rm -rf good
        mkdir good
        for name in out saved record; do [ ! -e $name ] || mv $name good; done
        rm -f log
        with short $command
        for name in good/*; do diff -r "$name" "${name#good/}"; done
    done
    # Through pipes on both sides.
    cat e.jsonl | with short synpo-gen-expert --relabel | cmp - e.jsonl
    cat a.ckpt | with short synpo-eval -q -p two.tsv -n 1 | cmp - m.tsv
}

@test "clocks that jump: the same bytes, and a limit in time ends" {
    train
    mv out want
    mv saved want.saved
    fresh
    with clock train
    cmp out want
    cmp saved want.saved
    [ "$(cut -f 1-3,6- log | wc -l)" -eq 4 ]
    with clock timeout 60 synpo-train "${TINY[@]}" --time 2h <e.jsonl >timed
    [ "$(described timed .updates)" -ge 1 ]
    with clock synpo-eval -p two.tsv -n 1 -c a.ckpt | cmp - m.tsv
}

load ../common

setup_file() {
    make_inputs
    synpo-train "${TINY[@]}" -n 12 -p pairs.tsv <e.jsonl >full.ckpt
}

setup() {
    set_up pairs.tsv two.tsv e.jsonl a.ckpt full.ckpt m.tsv
    mkfifo stream
}

teardown() {
    [ -z "${pid-}" ] || kill -9 "$pid" 2>/dev/null || true
}

# ends_asleep SIGNAL PLACE COMMAND...: the process $pid, which runs the command, is asleep in a place of the kernel that
# matches, not to be woken by anything else, before it gets the signal; it ends, and its exit code goes to $status.
ends_asleep() {
    local signal=$1 place=$2 i
    shift 2
    for ((i = 0; i < 2400; ++i)); do
        grep -qE "$place" "/proc/$pid/wchan" 2>/dev/null && break
        [ "$i" -gt 60 ] && grep -q '^State:.S' "/proc/$pid/status" && break
        sleep 0.05
    done
    kill -"$signal" "$pid"
    for ((i = 0; i < 200; ++i)); do
        kill -0 "$pid" 2>/dev/null || break
        sleep 0.05
    done
    kill -0 "$pid" 2>/dev/null && complain "$*: it goes on after SIG$signal"
    wait "$pid" || status=$?
    pid=
}

# stops SIGNAL CODE LINES COMMAND...: the command has the first LINES lines of e.jsonl and waits for more; the signal
# ends it with CODE.
stops() {
    local signal=$1 code=$2 lines=$3 status=0
    shift 3
    env --default-signal=HUP,INT "$@" <stream >stdout 2>err 3>&- &
    pid=$!
    exec 9>stream
    head -n "$lines" e.jsonl >&9
    ends_asleep "$signal" 'poll' "$@"
    exec 9>&-
    [ "$status" -eq "$code" ] || complain "$*: exit code $status, expected $code: $(cat err)"
    [ -z "$(find . -name '*.part')" ]
}

@test "signals are heard while a stream is read: before the first update, after the last, over lines read before" {
    for signal in "TERM 143" "INT 130" "HUP 129"; do
        # shellcheck disable=SC2086
        stops $signal 5 synpo-train "${TINY[@]}" -n 3
        [ ! -s stdout ]
    done
    for expected in "--expect 60" --expect-end; do
        # What was learned is written; 143 says that nobody has seen the stream's end.
        # shellcheck disable=SC2086
        stops TERM 143 40 synpo-train "${TINY[@]}" -n 3 $expected --save saved
        cmp saved stdout
        [ "$(described saved .updates)" -eq 3 ]
    done
    stops TERM 143 5 synpo-train -q --resume full.ckpt -n 20 -o out
    [ "$(described out .updates)" -eq "$(described full.ckpt .updates)" ]
    rm out
    stops TERM 143 5 synpo-finetune adapt -q -n 3 -c a.ckpt -o out
    [ ! -e out ]
    stops TERM 143 5 synpo-gen-expert --relabel
}

@test "signals are heard where a stream never ends and never waits" {
    for command in "synpo-finetune adapt -q -n 3 -c a.ckpt" "synpo-train ${TINY[*]} -n 3 --fill 1e7" \
        "synpo-train ${TINY[*]} -n 3 --expect 1000000000 --save saved"; do
        # shellcheck disable=SC2086
        env --default-signal=INT $command -o out < <(while cat e.jsonl 2>/dev/null; do :; done) 2>err 3>&- &
        pid=$!
        sleep 2
        kill -INT "$pid"
        status=0
        wait "$pid" || status=$?
        pid=
        [ "$status" -eq 130 ] || complain "$command: exit code $status: $(cat err)"
        # What was learned is written.
        [[ $command == *--save* ]] || [ ! -e out ]
        rm -f out
    done
    [ "$(described saved .updates)" -eq 3 ]
}

@test "signals are heard while a pipe is opened: to read it, to write it" {
    mkfifo pipe
    for command in "synpo-train ${TINY[*]} -n 3 -p pipe" "synpo-train ${TINY[*]} -n 3 -o pipe" \
        "synpo-train ${TINY[*]} -n 3 --log pipe" \
        "synpo-finetune adapt -q -c pipe" "synpo-gen-expert -n 3 -o pipe"; do
        # shellcheck disable=SC2086
        stops TERM 143 0 $command
    done
}

# A command that nobody reads, on pipe: when it waits there, the signal ends it.
stops_unread() {
    local signal=$1 code=$2 status=0
    shift 2
    env --default-signal=HUP,INT "$@" 2>err 3>&- &
    pid=$!
    exec 9<pipe
    ends_asleep "$signal" 'poll|pipe_w' "$@"
    exec 9<&-
    [ "$status" -eq "$code" ] || complain "$*: exit code $status, expected $code: $(cat err)"
    [ -z "$(find . -name '*.part')" ]
}

@test "signals are heard while nobody reads what is written: trajectories, labels, records, a log" {
    mkfifo pipe
    for signal in "TERM 143" "INT 130" "HUP 129"; do
        # shellcheck disable=SC2086
        stops_unread $signal synpo-gen-expert -o pipe
    done
    stops_unread TERM 143 bash -c 'exec synpo-gen-expert >pipe'
    synpo-gen-expert -n 2000 >many.jsonl
    stops_unread TERM 143 bash -c 'exec synpo-gen-expert --relabel <many.jsonl >pipe'
    stops_unread TERM 143 synpo-eval -q -j 1 -c a.ckpt -p two.tsv -n 1000 --record pipe -o matrix
    [ ! -e matrix ]
    stops_unread TERM 143 bash -c 'exec synpo-eval -q -j 1 -c a.ckpt -p two.tsv -n 1000 --record - >pipe'
    # A row of the log is lost; what was learned is not.
    stops_unread TERM 143 bash -c \
        "exec synpo-train ${TINY[*]} -j 1 --batch-states 1 --running 1 -n 100000 --report 1 --log pipe \
            --save saved -o out <e.jsonl"
    [ "$(described saved .updates)" -gt 100 ]
    cmp saved out
}

@test "a pipe is read and written whole, whoever opens it first" {
    mkfifo pipe
    (sleep 0.3; cat pairs.tsv >pipe) &
    synpo-gen-expert -n 20 -p pipe >got
    synpo-gen-expert -n 20 -p pairs.tsv | cmp got
    (sleep 0.3; cat pipe >got) &
    synpo-gen-expert -n 20 -p pairs.tsv -o pipe
    wait
    synpo-gen-expert -n 20 -p pairs.tsv | cmp got
}

@test "-n with the largest number is a number, not no number" {
    fails 64 synpo-train "${TINY[@]}" -n 9223372036854775807 <e.jsonl
    says "expected a whole number from 1 to 9223372036854775806"
    stops TERM 143 21 synpo-train "${TINY[@]}" -n 9223372036854775806 --save saved
    synpo-train -q --resume saved -n 3 <e.jsonl >/dev/null
}

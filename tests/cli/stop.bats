load common

setup_file() { make_inputs; }
setup() { set_up pairs.tsv e.jsonl; }

teardown() {
    [ -z "${pid-}" ] || kill -9 "$pid" 2>/dev/null || true
}

# begin LINES OPTION...: training in the background that has got the first LINES lines of e.jsonl and waits for more.
# Each update reads one, so that it is known where it stands. A script's shell has SIGINT ignored in the background,
# and ignored it would stay.
begin() {
    local lines=$1
    shift
    rm -f stream log.tsv
    mkfifo stream
    env --default-signal=HUP,INT synpo-train "$@" --log log.tsv --report 1 <stream >stopped 2>err 3>&- &
    pid=$!
    exec 9>stream
    head -n "$lines" e.jsonl >&9
}

# reaches UPDATE: waits until that update is in the log.
reaches() {
    local i
    for ((i = 0; i < 600; ++i)); do
        [ "$(tail -n 1 log.tsv 2>/dev/null | cut -f 1)" = "$1" ] && return
        kill -0 "$pid" || complain "it ended before update $1: $(cat err)"
        sleep 0.05
    done
    complain "update $1 did not come: $(cat log.tsv err)"
}

reaches_at_least() {
    local i
    for ((i = 0; i < 600; ++i)); do
        [ "$(tail -n 1 log.tsv 2>/dev/null | grep -o '^[0-9]*')" -ge "$1" ] 2>/dev/null && return
        kill -0 "$pid" || complain "it ended before update $1: $(cat err)"
        sleep 0.02
    done
    complain "update $1 did not come: $(cat log.tsv err)"
}

# ends CODE: the training ends, with that code.
ends() {
    local status=0
    exec 9>&-
    wait "$pid" || status=$?
    pid=
    [ "$status" -eq "$1" ] || complain "exit code $status, expected $1: $(cat err)"
}

@test "SIGTERM while it waits for the stream: the checkpoint is written, 143; resumed equals unbroken, both recipes" {
    for tiny in TINY TINY_PAPER; do
        declare -n options=$tiny
        fill=20
        [ "$tiny" = TINY ] || fill=1
        synpo-train "${options[@]}" -n 12 <e.jsonl >unbroken
        begin $((fill + 4)) "${options[@]}" -n 12 --save saved
        reaches 5
        kill -TERM "$pid"
        ends 143
        [ "$(described saved .updates)" -eq 5 ]
        cmp saved stopped
        synpo-train -q --resume saved <e.jsonl >resumed
        cmp unbroken resumed
        rm saved
    done
}

@test "SIGTERM in the middle of what an update reads: none of it counts, resumed equals unbroken" {
    synpo-train "${TINY[@]}" -n 8 --read 5 <e.jsonl >unbroken
    begin 33 "${TINY[@]}" -n 8 --read 5 --save saved
    reaches 3
    kill -TERM "$pid"
    ends 143
    [ "$(described saved .updates)" -eq 3 ]
    synpo-train -q --resume saved <e.jsonl >resumed
    cmp unbroken resumed
}

@test "SIGTERM while it computes: the update is finished, the checkpoint written, 143; resumed equals unbroken" {
    synpo-train "${TINY[@]}" -n 60 <e.jsonl >unbroken
    begin 60 "${TINY[@]}" -n 60 --save saved
    exec 9>&-
    reaches_at_least 3
    kill -TERM "$pid"
    ends 143
    [ "$(described saved .updates)" -eq "$(tail -n 1 log.tsv | cut -f 1)" ]
    [ "$(described saved .updates)" -lt 60 ]
    cmp saved stopped
    synpo-train -q --resume saved <e.jsonl >resumed
    cmp unbroken resumed
}

@test "SIGINT: 130, and the checkpoint is on stdout as well; SIGHUP: 129" {
    for signal in INT.130 HUP.129; do
        begin 24 "${TINY[@]:1}" -n 12
        reaches 5
        kill -"${signal%.*}" "$pid"
        ends "${signal#*.}"
        [ "$(described stopped .updates)" -eq 5 ]
        grep -q '^synpo-train: stopped: 5 updates' err
    done
}

@test "what was ignored at the start stays ignored: SIGINT in a script's background, SIGHUP under nohup" {
    synpo-train "${TINY[@]}" -n 12 <e.jsonl >unbroken
    rm -f stream
    mkfifo stream
    env --ignore-signal=HUP,INT synpo-train "${TINY[@]}" -n 12 --log log.tsv --report 1 <stream >stopped 3>&- &
    pid=$!
    exec 9>stream
    head -n 24 e.jsonl >&9
    reaches 5
    kill -INT "$pid"
    kill -HUP "$pid"
    sed -n '25,$p' e.jsonl >&9
    ends 0
    cmp unbroken stopped
}

@test "stopped twice, with other numbers of threads: still equal" {
    synpo-train "${TINY[@]}" -n 12 -j 2 <e.jsonl >unbroken
    begin 22 "${TINY[@]}" -n 12 -j 1 --save saved
    reaches 3
    kill -TERM "$pid"
    ends 143
    begin 25 -q --resume saved -j 2 --save saved
    reaches 6
    kill -TERM "$pid"
    ends 143
    [ "$(described saved .updates)" -eq 6 ]
    synpo-train -q --resume saved <e.jsonl >resumed
    cmp unbroken resumed
}

@test "kill -9: the last --save is whole, and the run goes on from it" {
    synpo-train "${TINY[@]}" -n 12 <e.jsonl >unbroken
    begin 27 "${TINY[@]}" -n 12 --save saved --every 3
    reaches 8
    kill -9 "$pid"
    ends 137
    [ "$(described saved .updates)" -eq 6 ]
    synpo-train -q --resume saved <e.jsonl >resumed
    cmp unbroken resumed
}

@test "kill -9 while it saves after every update: whole each time" {
    for pause in 0.2 0.27 0.34 0.41; do
        rm -f saved*
        synpo-train "${TINY[@]}" -n 1000000 --save saved --every 1 <e.jsonl >/dev/null 3>&- &
        pid=$!
        for ((i = 0; i < 600; ++i)); do
            [ -e saved ] && break
            sleep 0.05
        done
        sleep "$pause"
        kill -9 "$pid"
        wait "$pid" || true
        pid=
        updates=$(described saved .updates)
        [ "$updates" -ge 1 ]
        synpo-train -q --resume saved -n $((updates + 1)) <e.jsonl >resumed
        [ "$(described resumed .updates)" -eq $((updates + 1)) ]
    done
}

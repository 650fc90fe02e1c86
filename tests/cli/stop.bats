load common

setup_file() { make_inputs; }

setup() {
    mkdir "$BATS_TEST_TMPDIR/work"
    cd "$BATS_TEST_TMPDIR/work" || exit
    ln -s "$BATS_FILE_TMPDIR"/{pairs.tsv,e.jsonl} .
}

teardown() {
    [ -z "${pid-}" ] || kill -9 "$pid" 2>/dev/null || true
}

# begin LINES OPTION...: training in the background that has got the first LINES lines of e.jsonl and waits for more.
# Each update reads one, so that it is known where it stands.
begin() {
    local lines=$1
    shift
    rm -f stream log.tsv
    mkfifo stream
    synpo-train "$@" --log log.tsv --report 1 <stream >stopped 2>err 3>&- &
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

# ends CODE: the training ends, with that code.
ends() {
    local status=0
    exec 9>&-
    wait "$pid" || status=$?
    pid=
    [ "$status" -eq "$1" ] || complain "exit code $status, expected $1: $(cat err)"
}

@test "SIGTERM: the update is finished, the checkpoint written, 143; resumed equals unbroken, both recipes" {
    for tiny in TINY TINY_PAPER; do
        declare -n options=$tiny
        fill=20
        [ "$tiny" = TINY ] || fill=1
        synpo-train "${options[@]}" -n 12 <e.jsonl >unbroken
        begin $((fill + 4)) "${options[@]}" -n 12 --save saved
        reaches 5
        kill -TERM "$pid"
        sed -n "$((fill + 5)),\$p" e.jsonl >&9
        ends 143
        [ "$(described saved .updates)" -eq 6 ]
        cmp saved stopped
        synpo-train -q --resume saved <e.jsonl >resumed
        cmp unbroken resumed
        rm saved
    done
}

@test "SIGINT: 130, and the checkpoint is on stdout as well" {
    begin 24 "${TINY[@]:1}" -n 12
    reaches 5
    kill -INT "$pid"
    sed -n '25,$p' e.jsonl >&9
    ends 130
    [ "$(described stopped .updates)" -eq 6 ]
    grep -q '^synpo-train: stopped: 6 updates' err
}

@test "stopped twice, with other numbers of threads: still equal" {
    synpo-train "${TINY[@]}" -n 12 -j 2 <e.jsonl >unbroken
    begin 22 "${TINY[@]}" -n 12 -j 1 --save saved
    reaches 3
    kill -TERM "$pid"
    sed -n '23,$p' e.jsonl >&9
    ends 143
    begin 26 -q --resume saved -j 2 --save saved
    reaches 7
    kill -TERM "$pid"
    sed -n '27,$p' e.jsonl >&9
    ends 143
    [ "$(described saved .updates)" -eq 8 ]
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

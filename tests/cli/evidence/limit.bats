# scripts/reproduce --limit: cut short, killed and carried to another folder at any moment, and the results are those of
# one call that nothing disturbed.
load ../common

setup() {
    set_up
    mkdir tree
    cp -r "$ROOT/scripts" tree/
    ln -s "$(dirname "$(command -v synpo-train)")" tree/build
    # Small enough that the folder's files are cut up: a save has some 45 MB.
    asked=(small --toy --budget 5120 --seeds 1 -n 3)
}

reproduce() { TMPDIR=$PWD tree/scripts/reproduce "$@"; }

# kill_tree PID: it and all below it, at one moment.
kill_tree() {
    local child
    kill -STOP "$1" || return 0
    for child in $(pgrep -P "$1"); do kill_tree "$child"; done
    kill -KILL "$1"
}

# What must be the same, whatever happened: matrices, the page, and how far each log goes. (A stop shows in a log: its
# row's losses are those of the updates since.)
results() (
    cd "$1/small" || exit
    cat ./*.tsv README.md
    for log in *.log; do tail -n 1 "$log" | cut -f 1-3; done
)

@test "reproduce --limit: stopped, killed and carried, to the same results" {
    reproduce "${asked[@]}" --limit 20m -o whole 2>err || complain "$(tail err)"
    [ "$(reproduce "${asked[@]}" --list -o whole/small)" = '0 runs, 0 million states to learn from' ]
    results whole >expected

    [ "$(reproduce "${asked[@]}" --list -o part/small | tail -n 1)" = '2 runs, 0.0102 million states to learn from' ]
    # Out of time, told so, and gone on with; each time with a second more, for slow machines. The second and the fourth
    # call are killed by a signal that nothing can catch, with all of their children. What is left is carried elsewhere.
    for i in $(seq 60); do
        case $i in
        2 | 4)
            reproduce "${asked[@]}" --limit 20m -o part >out 2>err 3>&- &
            sleep $i
            kill_tree $!
            wait $! || true
            rm -rf reproduce-*
            ;;
        *) reproduce "${asked[@]}" --limit $((1 + i))s -o part >out 2>err || complain "$(tail err)" ;;
        esac
        [ -z "$(find part -size +16000000c)" ] || complain "files over 16 MB: $(ls -lR part)"
        ! grep -q '^outstanding: 0 runs' out || break
        mv part other
        cp -r other part
        rm -rf other
    done
    grep -q '^outstanding: 0 runs' out
    results part | cmp expected -
    [ -z "$(ls -d reproduce-* 2>/dev/null)" ] || complain "left over: $(ls -d reproduce-*)"
}

@test "reproduce --limit: pieces that are not whole are not gone on with" {
    reproduce "${asked[@]}" --limit 1s -o part 2>err || true
    mkdir -p part/small
    printf 'no such sum\n' >part/small/x.ckpt.cut
    printf 'half' >'part/small/x.ckpt.cut-no such sum-000'
    status=0
    reproduce "${asked[@]}" --limit 1s -o part 2>err || status=$?
    [ "$status" = 65 ]
    grep -q "part/small/x.ckpt.cut: its pieces are not whole" err
}

# until_there PATTERN: waits for such a file.
until_there() {
    local i
    for ((i = 0; i < 600; ++i)); do
        ! compgen -G "$1" >/dev/null || return 0
        sleep 0.1
    done
    complain "no $1: $(tail err)"
}
long=(small --toy --budget 6e6 --seeds 1 -n 3)

@test "reproduce --limit: other files of the folder stay, and a relative TMPDIR is as good" {
    mkdir -p part/gpu part/small tmp
    echo table >part/gpu/table.txt
    reproduce "${asked[@]}" --limit 1s -o part 2>err
    echo mine >part/small/notes
    TMPDIR=tmp tree/scripts/reproduce "${asked[@]}" --limit 2s -o part 2>err
    [ "$(cat part/gpu/table.txt part/small/notes)" = $'table\nmine' ]
    [ -e part/small/asked ]
    [ -z "$(ls tmp)" ] || complain "left over: $(ls tmp)"
}

@test "reproduce --limit: SIGHUP is as the end of the time" {
    # What was ignored at the start, as under nohup, stays so.
    TMPDIR=$PWD env --default-signal=HUP tree/scripts/reproduce "${long[@]}" --limit 5m -o part >out 2>err 3>&- &
    pid=$!
    until_there 'reproduce-*/small/synpo-1.log'
    kill -HUP "$pid"
    SECONDS=0
    wait "$pid"
    [ "$SECONDS" -lt 120 ]
    grep -q 'the time is over; small synpo-1 goes on' err
    [ -e part/small/synpo-1.save.cut ]
    [ -z "$(ls -d reproduce-* 2>/dev/null)" ] || complain "left over: $(ls -d reproduce-*)"
}

@test "reproduce --limit: a store that does not take all keeps what it had, and the rest is not lost" {
    reproduce "${long[@]}" --limit 3s -o part 2>err
    [ -e part/small/synpo-1.save.cut ]
    cp -r part before
    mkdir bin
    printf '#!/bin/bash\nexit 1\n' >bin/split
    chmod +x bin/split
    status=0
    PATH=$PWD/bin:$PATH reproduce "${long[@]}" --limit 3s -o part 2>err || status=$?
    [ "$status" = 74 ]
    diff -r before/small part/small
    work=$(sed -n 's/.*the rest is in \(.*\), and should.*/\1/p' err)
    [ -s "$work/small/synpo-1.save" ]
    reproduce "${long[@]}" --limit 3s -o part 2>err
}

load ../common

setup_file() {
    make_inputs
    synpo-train "${TINY[@]}" -n 8 -p pairs.tsv --report 2 --log log.tsv --save save <e.jsonl >/dev/null
    synpo-train -q --resume save -n 12 --report 2 <e.jsonl >whole.ckpt
}

setup() {
    set_up pairs.tsv two.tsv e.jsonl a.ckpt m.tsv save whole.ckpt
    cp "$BATS_FILE_TMPDIR/log.tsv" .
}

teardown() {
    [ -z "${pid-}" ] || kill -9 "$pid" 2>/dev/null || true
}

resume() { synpo-train -q --resume save -n 12 --report 2 "$@" <e.jsonl; }

# The updates of a log's rows, all of which have as many fields.
updates_of() {
    awk -F '\t' 'NR > 1 { print $1 } NF != 19 { print "bad" }' "$1" | paste -s -d ' '
}

@test "a resumed run continues the log; a last row that was cut off gives way" {
    [ "$(updates_of log.tsv)" = "2 4 6 8" ]
    size=$(stat -c %s log.tsv) header=$(head -n 1 log.tsv | wc -c)
    for cut in 1 5 80 $((size - header)) $((size - header + 1)) $((size - 5)) "$size"; do
        head -c -"$cut" log.tsv >cut.tsv
        resume --log cut.tsv -o got
        cmp got whole.ckpt
        case $(updates_of cut.tsv) in
        "2 4 6 8 10 12" | "2 4 6 10 12" | "10 12") ;;
        *) complain "$cut bytes cut off: $(cat cut.tsv)" ;;
        esac
        synpo-render curves -y policy cut.tsv -o x.png
    done
}

@test "a log that has got CRs is not continued: 65, and the message names them" {
    sed 's/$/\r/' log.tsv >cr.tsv
    cp cr.tsv before
    fails 65 synpo-train -q --resume save -n 12 --report 2 --log cr.tsv -o got <e.jsonl
    says "cr.tsv: line 1: ends in CR LF, expected LF alone"
    cmp cr.tsv before
}

@test "a table of another kind is not continued: 65, with the line, and it stays as it is" {
    synpo-finetune ppo -q -c a.ckpt --steps 32 --lanes 4 --rollout 8 --report 1 --log ppo.tsv -o /dev/null
    printf 'update' >short.tsv
    printf 'no end' >other
    head -c 3000 /dev/zero >zeros
    sed '3s/\t[^\t]*\t/\t/' log.tsv >fewer.tsv
    sed '4s/$/\t1\t2/' log.tsv >more.tsv
    for log in pairs.tsv m.tsv e.jsonl a.ckpt ppo.tsv other zeros fewer.tsv more.tsv; do
        cp -L $log copy
        fails 65 synpo-train -q --resume save -n 12 --log copy <two.tsv
        says "copy: line"
        cmp $log copy
    done
    fails 65 synpo-train -q --resume save -n 12 --log fewer.tsv <two.tsv
    says "fewer.tsv: line 3: found 18 fields, expected 19 as in the header"
    fails 65 synpo-train -q --resume save -n 12 --log pairs.tsv <two.tsv
    says "pairs.tsv: line 1: found 'env\\x09task\\x09seen', expected the columns"
}

@test "a start that fails leaves the log as it was, and makes none" {
    cp log.tsv before
    fails 65 synpo-train "${TINY[@]}" -n 3 --log log.tsv </dev/null
    fails 65 synpo-train "${TINY[@]}" -n 3 --log log.tsv <two.tsv
    fails 65 synpo-train "${TINY[@]}" -n 3 --log log.tsv -w kitchen <e.jsonl
    fails 64 synpo-train "${TINY[@]}" -n 3 --log log.tsv --save - <e.jsonl
    fails 65 synpo-train -q --resume save -n 12 --log log.tsv <two.tsv
    cmp log.tsv before
    fails 65 synpo-train "${TINY[@]}" -n 3 --log new.tsv </dev/null
    [ ! -e new.tsv ]
    fails 64 synpo-train "${TINY[@]}" -n 3 --log new.tsv --save - <e.jsonl
    [ ! -e new.tsv ]
}

@test "a log is emptied when its first row is due" {
    mkfifo stream
    cp log.tsv before
    synpo-train "${TINY[@]}" -n 3 --report 2 --log log.tsv --save s --every 1 <stream >stopped 3>&- &
    pid=$!
    exec 9>stream
    head -n 20 e.jsonl >&9
    for ((i = 0; i < 400; ++i)); do
        [ -e s ] && break
        sleep 0.05
    done
    [ -e s ]
    cmp log.tsv before
    sed -n '21,$p' e.jsonl >&9
    exec 9>&-
    wait "$pid"
    pid=
    [ "$(updates_of log.tsv)" = "2 3" ]
}

@test "a log that cannot be written does not cost the training: all checkpoints are there, then 74" {
    synpo-train "${TINY[@]}" -n 4 <e.jsonl >want
    status=0
    synpo-train "${TINY[@]}" -n 4 --log /dev/full --report 1 --save saved --every 2 <e.jsonl >got 2>err || status=$?
    [ "$status" -eq 74 ]
    grep -q "cannot write '/dev/full': No space left on device" err
    cmp want got
    cmp want saved
    # A limit to the size of files, as a full disk in the middle of a row.
    status=0
    (ulimit -f 1 && exec synpo-train "${TINY[@]}" -n 12 --log log.tsv --report 1 <e.jsonl 2>err) | cat >got || status=$?
    synpo-train "${TINY[@]}" -n 12 <e.jsonl | cmp got
    grep -q "cannot write 'log.tsv': File too large" err
    [[ "$(updates_of log.tsv)" =~ ^1\ 2\ 3\ 4 ]]
    run ! grep -q bad <<<"$(updates_of log.tsv)"
}

@test "two trainings with one log: the second is told, and the first goes on" {
    mkfifo stream
    synpo-train "${TINY[@]}" -n 3 --report 1 --log log.tsv <stream >first 3>&- &
    pid=$!
    exec 9>stream
    head -n 21 e.jsonl >&9
    for ((i = 0; i < 400; ++i)); do
        [ "$(tail -n 1 log.tsv | cut -f 1)" = 2 ] && break
        sleep 0.05
    done
    cp log.tsv before
    fails 73 synpo-train "${TINY[@]}" -n 3 --report 1 --log log.tsv <e.jsonl
    says "cannot create 'log.tsv': another process writes this log"
    fails 73 synpo-train -q --resume save -n 12 --log log.tsv <e.jsonl
    cmp log.tsv before
    sed -n '22,$p' e.jsonl >&9
    exec 9>&-
    wait "$pid"
    pid=
    [ "$(updates_of log.tsv)" = "1 2 3" ]
}

@test "a log may be a link, a pipe, a descriptor" {
    ln -s real.tsv link.tsv
    mkfifo pipe
    cat pipe >piped &
    for log in link.tsv pipe /dev/fd/3; do
        synpo-train "${TINY[@]}" -n 2 --report 1 --log $log <e.jsonl 3>third >/dev/null
    done
    wait $!
    [ -L link.tsv ]
    for got in real.tsv piped third; do
        [ "$(updates_of $got)" = "1 2" ]
    done
}

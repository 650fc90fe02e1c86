load ../common

setup_file() { make_inputs; }
setup() { set_up pairs.tsv two.tsv e.jsonl a.ckpt m.tsv; }

teardown() {
    [ -z "${pid-}" ] || kill -9 "$pid" 2>/dev/null || true
}

SMALL=("${TINY[@]}" -n 3 -p pairs.tsv)

# limited KB COMMAND...: with so much address space.
limited() { (ulimit -v "$1" && exec "${@:2}"); }

@test "two trainings with one --save: the second is told at its start, the first goes on; the dead hold nothing" {
    mkfifo stream
    synpo-train "${TINY[@]}" -n 4 --save saved --every 1 <stream >first 3>&- &
    pid=$!
    exec 9>stream
    head -n 21 e.jsonl >&9
    # Until it waits for the stream, and writes nothing.
    for ((i = 0, quiet = 0; i < 400 && quiet < 10; ++i)); do
        if [ -e saved ] && [ -z "$(find . -name 'saved.*.part')" ]; then ((++quiet)); else quiet=0; fi
        sleep 0.05
    done
    ln -s saved link
    for name in saved link "$PWD/saved"; do
        fails 73 synpo-train "${SMALL[@]}" --save "$name" <e.jsonl
        says "cannot create '$name': another process saves to it"
        fails 73 synpo-finetune ppo -q --steps 64 --lanes 4 --rollout 8 -c a.ckpt --save "$name"
        says "another process saves to it"
    done
    # Another file is another's, and what saves nothing is free.
    synpo-train "${SMALL[@]}" --save other -o out <e.jsonl
    synpo-eval --describe -c saved -o saved.json
    kill -9 "$pid"
    wait "$pid" || true
    pid=
    exec 9>&-
    [ -n "$(find . -name 'saved.*.part.lock')" ]
    synpo-train "${SMALL[@]}" --save saved -o out <e.jsonl
    [ -z "$(find . -name '*.part*')" ] || complain "left $(find . -name '*.part*')"
}

@test "too little memory: 70 and one line, whatever the limit, and no file; a limit that does is one" {
    local kb status least=0
    for kb in 20000 60000 100000 140000 180000 220000 260000 300000 400000 500000 800000 1600000; do
        status=0
        limited "$kb" synpo-train "${SMALL[@]}" -j 1 -o out <e.jsonl 2>err || status=$?
        if [ "$status" -eq 0 ]; then
            least=$kb
            rm out
            continue
        fi
        # The loader may not come as far as the program.
        [ "$status" -eq 127 ] || grep -qx 'synpo-train: out of memory' err || complain "$kb: $status: $(cat err)"
        [ "$status" -eq 127 ] || [ "$status" -eq 70 ] || complain "$kb: $status: $(cat err)"
        [ ! -e out ] && [ -z "$(find . -name '*.part*')" ]
    done
    [ "$least" -gt 0 ]
}

@test "more threads than the system has: 69, and which" {
    fails 69 limited_train 1000000
    grep -qE 'cannot start thread [0-9]+ of 1024: ' "$BATS_TEST_TMPDIR/err"
}

limited_train() {
    local status=0
    limited "$1" synpo-train "${SMALL[@]}" -j 1024 <e.jsonl 2>"$BATS_TEST_TMPDIR/said" || status=$?
    sed 's/synpo-train/limited_train/' "$BATS_TEST_TMPDIR/said" >&2
    return $status
}

@test "64 threads, whatever the processors: the same bytes as one" {
    synpo-train "${SMALL[@]}" -j 1 <e.jsonl >one
    synpo-train "${SMALL[@]}" -j 64 <e.jsonl | cmp - one
    synpo-eval -q -p two.tsv -n 8 -j 1 -c a.ckpt >one
    synpo-eval -q -p two.tsv -n 8 -j 64 -c a.ckpt | cmp - one
}

@test "evaluations of one checkpoint, again and again, with 1 to 64 threads: one answer" {
    local want times=${EVALUATIONS:-10}
    # Small, and sure to end soon.
    synpo-train "${SMALL[@]}" --feature 8 --basis 4 --hidden 8 --strip <e.jsonl >small.ckpt
    head -n 2 two.tsv >one.tsv
    want=$(synpo-eval -q -p one.tsv -n 1 -j 1 -c small.ckpt)
    [ "$(wc -l <<<"$want")" -eq 2 ]
    for ((i = 0; i < times; ++i)); do
        [ "$(synpo-eval -q -p one.tsv -n 1 -j $((1 << i % 7)) -c small.ckpt)" = "$want" ] || complain "evaluation $i"
    done
    echo "# $times evaluations: one answer" >&3
}

@test "a line without an end takes no more memory than a line may have" {
    local status=0
    { head -n 1 e.jsonl | tr -d '\n}'; head -c 200000000 /dev/zero | tr '\0' ' '; } |
        limited 200000 synpo-gen-expert --relabel 2>err || status=$?
    [ "$status" -eq 65 ]
    grep -q 'line 1: longer than 16777216 bytes' err
    for command in "synpo-matrix summary" "synpo-matrix merge" "synpo-gen-expert -n 1 -p /dev/stdin"; do
        status=0
        # shellcheck disable=SC2086
        head -c 200000000 /dev/zero | tr '\0' x | limited 200000 $command 2>err || status=$?
        [ "$status" -eq 65 ] || complain "$command: $status: $(cat err)"
    done
}

@test "a stream of any length takes as much memory as a short one" {
    local megabytes=20 expected
    [ -z "${ACCIDENTS-}" ] || megabytes=5000
    # A trainer that reads on to the number of lines that it expects.
    endless() { while :; do cat e.jsonl e.jsonl e.jsonl e.jsonl; done | head -c $((megabytes * 1000000)); }
    [ -n "${ACCIDENTS-}" ] || endless >stream
    expected=$((megabytes * 1000000 / $(wc -c <e.jsonl) * 60))
    { if [ -e stream ]; then cat stream; else endless; fi; } |
        limited 600000 synpo-train "${SMALL[@]}" -j 1 --expect "$expected" >got
    synpo-train "${SMALL[@]}" -j 1 <e.jsonl >want
    described got .updates | grep -qx 3
}

@test "stopped and continued, again and again: the same bytes" {
    synpo-train "${TINY[@]}" -n 12 <e.jsonl >want
    synpo-train "${TINY[@]}" -n 12 <e.jsonl >got 3>&- &
    pid=$!
    while kill -STOP "$pid" 2>/dev/null; do
        sleep 0.02
        kill -CONT "$pid" 2>/dev/null || true
        sleep 0.05
    done
    wait "$pid"
    pid=
    cmp got want
}

@test "a folder and a file that cannot be written: 73 before the work, and a log says so too" {
    mkdir closed
    cp m.tsv closed/kept
    chmod 755 . "$BATS_TEST_TMPDIR" "$BATS_FILE_TMPDIR"
    chmod a-w closed closed/kept
    # Root may write anywhere.
    as=()
    [ "$(id -u)" -ne 0 ] || as=(setpriv --reuid 65534 --regid 65534 --clear-groups)
    "${as[@]}" test -r closed/kept || skip "another user cannot look here"
    for output in closed/new closed/kept; do
        status=0
        "${as[@]}" "$(command -v synpo-train)" "${TINY[@]}" -o "$output" <two.tsv 2>err || status=$?
        [ "$status" -eq 73 ] || complain "$output: $status: $(cat err)"
        grep -q "cannot create '$output': Permission denied" err
        status=0
        "${as[@]}" "$(command -v synpo-train)" "${TINY[@]}" --log "$output" -o /dev/null <two.tsv 2>err || status=$?
        [ "$status" -eq 73 ] || complain "$output: $status: $(cat err)"
    done
    cmp closed/kept m.tsv
    chmod u+w closed  # so that it can be removed by who is not root
}

@test "a socket is no output: 73, with its name" {
    /usr/bin/python3 -c 'import socket; socket.socket(socket.AF_UNIX).bind("socket")'
    fails 73 synpo-matrix split -o socket
    says "cannot create 'socket'"
    [ -S socket ]
    fails 64 synpo-train "${SMALL[@]}" --save socket <e.jsonl
}

@test "the language of the user changes no byte of data or words" {
    mkdir locales
    localedef -i de_DE -f UTF-8 locales/de_DE.UTF-8 2>/dev/null || skip "there is no de_DE to make"
    everything() {
        synpo-train "${TINY[@]}" -n 3 --log log.tsv --report 1 --evaluate-every 3 --evaluate-episodes 4 -o out.ckpt \
            <e.jsonl
        cut -f 1-3,6- log.tsv
        synpo-eval -p two.tsv -n 2 -c out.ckpt
        synpo-matrix summary m.tsv
        synpo-matrix table -f latex m.tsv
        synpo-matrix split --ratio 0.25
        synpo-gen-expert -n 3 --noise 0.5
        synpo-render heatmap m.tsv
        synpo-render curves --mark 0.5=half a=log.tsv 2>&1
        synpo-train --noise 0,5 2>&1 || true
    }
    everything >want 2>&1
    env LOCPATH="$PWD/locales" LC_ALL=de_DE.UTF-8 printf '%.1f\n' 1,5 | grep -q 1,5
    LOCPATH=$PWD/locales LC_ALL=de_DE.UTF-8 everything >got 2>&1
    cmp want got
}

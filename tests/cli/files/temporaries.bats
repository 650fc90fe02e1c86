load ../common

setup_file() { make_inputs; }
setup() {
    set_up pairs.tsv two.tsv e.jsonl a.ckpt m.tsv
    mkfifo stream
}

teardown() {
    [ -z "${pid-}" ] || kill -9 "$pid" 2>/dev/null || true
}

# begin COMMAND...: in the background, with a stream that waits; signals are as in the foreground.
begin() {
    env --default-signal=HUP,INT,QUIT "$@" <stream >stdout 2>err 3>&- &
    pid=$!
    exec 9>stream
}

# Waits until a file of that pattern is there.
appears() {
    local i
    for ((i = 0; i < 400; ++i)); do
        [ -n "$(find . -name "$1")" ] && return
        kill -0 "$pid" 2>/dev/null || complain "it ended before $1 was there: $(cat err)"
        sleep 0.05
    done
    complain "no $1"
}

ends() {
    local status=0
    wait "$pid" || status=$?
    pid=
    exec 9>&-
    [ "$status" -eq "$1" ] || complain "exit code $status, expected $1: $(cat err)"
}

nothing_left() {
    [ -z "$(find . -name '*.part*')" ] || complain "left: $(find . -name '*.part*')"
}

@test "whatever signal ends a tool, no temporary file is left" {
    for signal in HUP.129 INT.130 QUIT.131 ABRT.134 USR1.138 SEGV.139 USR2.140 ALRM.142 TERM.143; do
        # It catches none of them.
        begin synpo-render episode -o out.png
        appears 'out.png.*.part'
        kill -"${signal%.*}" "$pid"
        ends "${signal#*.}"
        nothing_left
        [ ! -s err ]
    done
}

@test "signals that stop a tool leave no temporary file either" {
    for signal in HUP.129 INT.130 TERM.143; do
        begin synpo-gen-expert --relabel -o out
        appears 'out.*.part'
        kill -"${signal%.*}" "$pid"
        ends "${signal#*.}"
        nothing_left
        [ ! -e out ]
    done
}

@test "INT, then TERM: the second ends it at once, whatever it is in the middle of" {
    mkfifo taken
    # The checkpoint goes to a pipe that nobody reads.
    begin synpo-train "${TINY[@]}" -n 100000 --save saved --every 1 --log log.tsv -o taken
    exec 8<>taken
    head -n 21 e.jsonl >&9
    appears saved
    kill -INT "$pid"
    sleep 0.5
    kill -TERM "$pid" 2>/dev/null
    ends 143
    exec 8>&-
    nothing_left
    synpo-eval --describe -c saved -o /dev/null
}

@test "what kill -9 leaves is removed by the next run to the same file, and nothing else is" {
    begin synpo-gen-expert --relabel -o out
    appears 'out.*.part'
    left=$(find . -name 'out.*.part')
    # Of a process that goes on nothing is taken.
    synpo-matrix split -o out
    [ -f "$left" ]
    kill -9 "$pid"
    ends 137
    [ -f "$left" ]
    touch out.part out.abcd.part out.abcdefghijkl.partly out.ABCDEFGHIJKL.part xout.abcdefghijkl.part
    mkdir "${left%????????.part}22222222.part"
    cp "$left" "../${left##*/}"
    ln -s "../${left##*/}" "${left%????????.part}33333333.part"
    synpo-matrix split -o another
    [ -f "$left" ]
    synpo-matrix split -o out
    [ ! -e "$left" ]
    [ "$(find . -name '*part*' | wc -l)" -eq 7 ]
}

@test "what kill -9 leaves of frames and videos is removed by the next run" {
    for what in --frames --video; do
        name=out.avi
        # One frame is drawn every so often: there is time.
        env --default-signal=INT synpo-render episode --scale 8 e.jsonl $what $name 2>err 3>&- &
        pid=$!
        exec 9>/dev/null
        appears 'out.avi.*.part*'
        kill -9 "$pid"
        ends 137
        [ "$(find . -maxdepth 1 -name 'out.avi.*.part*' | wc -l)" -eq 1 ]
        synpo-render episode e.jsonl $what $name
        nothing_left
        [ -e $name ]
        rm -r $name
    done
}

@test "signals that end a drawing leave no frames and no video" {
    for what in --frames --video; do
        for signals in TERM "INT TERM" QUIT; do
            env --default-signal=INT,QUIT synpo-render episode --scale 8 e.jsonl $what out.avi 2>err 3>&- &
            pid=$!
            exec 9>/dev/null
            appears 'out.avi.*.part*'
            for signal in $signals; do kill -"$signal" "$pid" 2>/dev/null || true; done
            status=0
            wait "$pid" || status=$?
            pid=
            [ "$status" -ge 130 ]
            nothing_left
        done
    done
}

@test "the record's reader goes away: the matrix is finished, then 141 without a word" {
    synpo-eval -q -p two.tsv -n 40 -j 2 -c a.ckpt -o want
    mkfifo record
    head -n 1 record >first &
    reader=$!
    status=0
    synpo-eval -q -p two.tsv -n 40 -j 2 -c a.ckpt --record record -o got 2>err || status=$?
    wait $reader
    [ "$status" -eq 141 ]
    [ ! -s err ]
    cmp want got
    [ "$(wc -l <first)" -eq 1 ]
    nothing_left
}

@test "the record's disk is full: the matrix is finished, then 74" {
    synpo-eval -q -p two.tsv -n 9 -c a.ckpt -o want
    fails 74 synpo-eval -q -p two.tsv -n 9 -c a.ckpt --record /dev/full
    cmp want "$BATS_TEST_TMPDIR/out"
}

@test "the matrix's reader goes away: the record is finished" {
    synpo-eval -q -p two.tsv -n 3 -c a.ckpt --record want >/dev/null
    mkfifo pipe
    : <pipe &
    # shellcheck disable=SC2094
    exec 8>pipe
    wait $!
    status=0
    synpo-eval -q -p two.tsv -n 3 -c a.ckpt --record got >&8 || status=$?
    exec 8>&-
    [ "$status" -eq 141 ]
    cmp want got
}

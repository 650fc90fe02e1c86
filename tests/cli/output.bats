load common

setup_file() { make_inputs; }
setup() {
    set_up pairs.tsv two.tsv e.jsonl a.ckpt m.tsv
    printf 'update\tstates\tseen_success\tunseen_success\n1\t9\t0.5\tNA\n2\t18\t0.7\t0.4\n' >run.log
}

# Calls `$1 COMMAND...` for every command that writes, with standard input where it needs some; </dev/stdin begins it
# anew.
for_writers() {
    "$1" synpo-gen-expert -n 3
    "$1" synpo-gen-expert --relabel <e.jsonl
    "$1" synpo-train "${TINY[@]}" -n 1 <e.jsonl
    "$1" synpo-eval -q -p two.tsv -n 1 -c a.ckpt
    "$1" synpo-eval --describe -c a.ckpt
    "$1" synpo-matrix split
    "$1" synpo-matrix summary m.tsv
    "$1" synpo-matrix merge m.tsv
    for command in table "compare m.tsv" rows cols show filter wide; do
        # shellcheck disable=SC2086
        "$1" synpo-matrix $command m.tsv
    done
    "$1" synpo-render heatmap m.tsv
    "$1" synpo-render heatmap --ansi m.tsv
    "$1" synpo-render curves run.log
    "$1" synpo-render map
    "$1" synpo-render map --ansi
    "$1" synpo-render view
    "$1" synpo-render episode e.jsonl
    "$1" synpo-render episode --ansi e.jsonl
    "$1" synpo-render embedding a.ckpt
    "$1" synpo-render policy a.ckpt
}

@test "a full disk: 74 and a message, from every command" {
    on_full_disk() {
        OUT=/dev/full fails 74 "$@" </dev/stdin
        says "cannot write standard output: No space left on device"
        fails 74 "$@" -o /dev/full </dev/stdin
        says "'/dev/full': No space left on device"
    }
    for_writers on_full_disk </dev/null
    for tool in $TOOLS; do
        OUT=/dev/full fails 74 "$tool" --help
        OUT=/dev/full fails 74 "$tool" --version
    done
}

@test "a full disk under a record, a run log, a --save" {
    fails 74 synpo-eval -q -p two.tsv -n 1 -c a.ckpt --record /dev/full
    fails 74 synpo-eval -q -p two.tsv -n 9 -j 2 -c a.ckpt --record /dev/full
    OUT=/dev/full fails 74 synpo-eval -q -p two.tsv -n 1 -c a.ckpt --record -
    fails 74 synpo-train "${TINY[@]}" -n 2 --log /dev/full <e.jsonl
    fails 74 synpo-train "${TINY[@]}" -n 2 --save /dev/full --every 1 <e.jsonl
}

@test "a full disk has no line of the input" {
    for i in 1 2 3 4 5 6 7 8; do cat e.jsonl; done >long.jsonl
    OUT=/dev/full fails 74 synpo-gen-expert --relabel long.jsonl
    ! says line || complain "$(cat "$BATS_TEST_TMPDIR/err")"
}

@test "a --save that cannot be written does not cost the training: its checkpoint is there, then 74" {
    synpo-train "${TINY[@]}" -n 3 <e.jsonl >want
    status=0
    synpo-train "${TINY[@]:1}" -n 3 --save /dev/full --every 1 -o got <e.jsonl 2>err || status=$?
    [ "$status" -eq 74 ]
    cmp want got
    [ "$(grep -c "cannot write '/dev/full': No space left on device: the run goes on$" err)" -ge 2 ]
    tail -n 1 err | grep -qx "synpo-train: cannot write '/dev/full': No space left on device"
}

@test "a pipe that does not wait is written whole, at the pace of its reader" {
    for command in "synpo-finetune strip a.ckpt" "synpo-gen-expert -n 300" "synpo-render map"; do
        $command >want
        python3 - "$command" >got <<'END'
import os, shutil, subprocess, sys, time
out, into = os.pipe()
os.set_blocking(into, False)
child = subprocess.Popen(sys.argv[1].split(), stdout=into)
os.close(into)
time.sleep(0.3)
with os.fdopen(out, "rb") as read:
    shutil.copyfileobj(read, sys.stdout.buffer)
sys.exit(child.wait())
END
        cmp want got
    done
}

@test "-o into a missing folder: 73, from every command" {
    into_nowhere() {
        fails 73 "$@" -o missing/out
        says "cannot create 'missing/out': No such file or directory"
    }
    for_writers into_nowhere </dev/null
    fails 73 synpo-eval -q -p two.tsv -n 1 -c a.ckpt --record missing/r.jsonl
    fails 73 synpo-train "${TINY[@]}" -n 1 --log missing/log.tsv <e.jsonl
}

@test "what cannot be written is told before the training, not after" {
    # The stream is broken, too, which would be 65.
    for place in "-o missing/out" "--save missing/saved" "--log missing/log"; do
        # shellcheck disable=SC2086
        fails 73 synpo-train -q -n 3 $place <two.tsv
        says "cannot create 'missing/"
    done
}

@test "-o gives the same bytes as stdout, over an older file, with the usual rights, and nothing beside it" {
    to_file() {
        mkdir new
        echo old >new/out
        "$@" >stdout </dev/stdin
        "$@" -o new/out </dev/stdin
        cmp stdout new/out
        [ "$(ls -A new)" = out ]
        [ "$(stat -c %a new/out)" = "$(stat -c %a stdout)" ]
        rm -r new
    }
    for_writers to_file </dev/null
}

@test "a file that was there survives what fails" {
    echo precious >kept
    cp kept out
    fails 65 synpo-gen-expert --relabel -o out </dev/zero
    cmp kept out
    head -n 5 e.jsonl >bad.jsonl
    echo '{' >>bad.jsonl
    fails 65 synpo-gen-expert --relabel -o out <bad.jsonl
    fails 65 synpo-train "${TINY[@]}" -n 1 -o out <bad.jsonl
    fails 65 synpo-render heatmap -o out bad.jsonl
    cmp kept out
}

@test "--save and -o may be one file" {
    synpo-train "${TINY[@]}" -n 3 --save a --every 1 -o a <e.jsonl
    synpo-train "${TINY[@]}" -n 3 <e.jsonl >b
    cmp a b
}

@test "the reader went away: SIGPIPE and no message, from every command" {
    to_nobody() {
        mkfifo pipe
        : <pipe &
        # shellcheck disable=SC2094
        exec 8>pipe
        wait $!
        rm pipe
        status=0
        "$@" >&8 2>err || status=$?
        exec 8>&-
        [ "$status" -eq 141 ] || complain "$*: exit code $status, expected 141"
        [ ! -s err ]
    }
    for_writers to_nobody </dev/null
}

@test "binary output to a terminal is refused with 64, and before the work; -f forces it" {
    for command in "synpo-train -q -n 3 <two.tsv" "synpo-render map" "synpo-render heatmap m.tsv" \
        "synpo-render curves run.log" \
        "synpo-render view" "synpo-render episode e.jsonl" "synpo-render embedding a.ckpt" \
        "synpo-render policy a.ckpt"; do
        run -64 on_terminal "$command"
        says "standard output is a terminal and the output is binary: use -o FILE, or -f to force it"
    done
    run -0 on_terminal "synpo-render view -f"
    grep -q PNG "$BATS_TEST_TMPDIR/screen"
}

@test "where a stream is expected a terminal is refused with 64" {
    for command in "synpo-train -n 1 >x" "synpo-eval >x" "synpo-gen-expert --relabel" "synpo-matrix summary" \
        "synpo-matrix merge" \
        "synpo-render heatmap >x" "synpo-render curves >x" "synpo-render episode >x" "synpo-render embedding >x" \
        "synpo-render policy >x"; do
        status=0
        timeout 20 script -qec "$command" /dev/null </dev/null >"$BATS_TEST_TMPDIR/err" || status=$?
        [ "$status" -eq 64 ] || complain "$command: exit code $status: $(cat "$BATS_TEST_TMPDIR/err")"
        says "standard input is a terminal: expected a stream or a file"
    done
}

@test "text goes to a terminal; progress there is one line that is overwritten, without colours" {
    run -0 on_terminal "synpo-gen-expert -n 1"
    jq -e .success "$BATS_TEST_TMPDIR/err"
    run -0 on_terminal "synpo-matrix summary --colour never m.tsv"
    run ! grep -q "$(printf '\033')" "$BATS_TEST_TMPDIR/err"
}

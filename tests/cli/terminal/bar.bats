load ../common

setup_file() { make_inputs; }
setup() { set_up e.jsonl pairs.tsv a.ckpt two.tsv; }

# bar COLUMNS COMMAND: what the bar of a command showed on a terminal of so many columns, a line each, in ../bar.
bar() {
    run -0 on_terminal "stty cols $1; $2"
    tr '\r' '\n' <"$BATS_TEST_TMPDIR/screen" | sed 's/\x1b\[J//' | grep -E '%|/s' >"$BATS_TEST_TMPDIR/bar"
}

widest() { awk '{ if (length($0) > most) most = length($0) } END { print most + 0 }' "$BATS_TEST_TMPDIR/bar"; }

@test "no bar is as wide as its terminal, from 20 columns on" {
    for columns in 20 60 100; do
        for command in "synpo-gen-expert -n 20000 -o x" \
            "synpo-eval -o x -n 40 -p two.tsv -c a.ckpt" \
            "synpo-train --batch-states 64 --fill 20 --running 64 --memory 30 -n 12 --report 1 -o x <e.jsonl" \
            "synpo-finetune ppo --init random -p two.tsv --lanes 16 --steps 400 --report 1 -o x"; do
            bar "$columns" "$command"
            [ "$(wc -l <"$BATS_TEST_TMPDIR/bar")" -gt 0 ]
            [ "$(widest)" -lt "$columns" ] || complain "$columns: $command: $(cat "$BATS_TEST_TMPDIR/bar")"
            rm x
        done
    done
}

@test "a bar ends at 100 %; what goes into a file has one, what goes into a pipe leaves it to the reader" {
    bar 80 "synpo-gen-expert -n 20000 >x"
    [[ "$(tail -n 1 "$BATS_TEST_TMPDIR/bar")" == *" 100 % of 20.0 k trajectories"* ]]
    bar 80 "synpo-eval -n 40 -p two.tsv -c a.ckpt >x"
    [[ "$(tail -n 1 "$BATS_TEST_TMPDIR/bar")" == *" 100 % of 80 episodes"* ]]
    run -0 on_terminal "synpo-gen-expert -n 20000 | tail -n 1 >x"
    [ ! -s "$BATS_TEST_TMPDIR/screen" ]
}

@test "what matters most stays longest: the share, the time left, the tool's name" {
    bar 20 "synpo-gen-expert -n 20000 -o x"
    grep -qE '^[0-9]+ %(, [0-9:]+ left)?$' "$BATS_TEST_TMPDIR/bar"
    bar 45 "synpo-gen-expert -n 20000 -o x"
    grep -qE '^synpo-gen-expert: [0-9]+ %, [0-9:]+ left$' "$BATS_TEST_TMPDIR/bar"
    bar 100 "synpo-gen-expert -n 20000 -o x"
    grep -qE '^synpo-gen-expert: \[[= ]{20}\] [0-9]+ % of 20.0 k trajectories, ' "$BATS_TEST_TMPDIR/bar"
}

@test "where the terminal does not tell its width COLUMNS does, and where it does not either it is taken for 80" {
    bar 0 "env -u COLUMNS synpo-gen-expert -n 20000 -o x"
    [ "$(widest)" -lt 80 ]
    bar 0 "COLUMNS=30 synpo-gen-expert -n 20000 -o x"
    [ "$(widest)" -lt 30 ]
    bar 60 "COLUMNS=30 synpo-gen-expert -n 20000 -o x"
    [ "$(widest)" -gt 30 ]
    for bad in -5 many 0; do
        bar 0 "COLUMNS=$bad synpo-gen-expert -n 20000 -o x"
        [ "$(widest)" -gt 30 ]
    done
}

load ../common

setup_file() { make_inputs; }
setup() { set_up e.jsonl pairs.tsv a.ckpt two.tsv; }

# bar COLUMNS COUNT COMMAND: what the bar of a command showed on a terminal of so many columns, a line each, in ../bar.
# @ in COMMAND is COUNT, or, where that is done too fast for a bar to come before the end, twice as many, and so on.
bar() {
    local count first
    for ((count = $2; count <= 64 * $2; count *= 2)); do
        rm -f x
        run -0 on_terminal "stty cols $1; ${3//@/$count}"
        tr '\r' '\n' <"$BATS_TEST_TMPDIR/screen" | sed 's/\x1b\[J//' |
            { grep -E '%|/s' || true; } >"$BATS_TEST_TMPDIR/bar"
        first=$(head -n 1 "$BATS_TEST_TMPDIR/bar")
        if [[ $first == *%* && $first != *"100 %"* ]]; then return; fi
    done
    complain "$1: $3: no bar"
}

widest() { awk '{ if (length($0) > most) most = length($0) } END { print most + 0 }' "$BATS_TEST_TMPDIR/bar"; }

@test "no bar is as wide as its terminal, from 20 columns on" {
    for columns in 20 60 100; do
        for work in "20000 synpo-gen-expert -n @ -o x" \
            "40 synpo-eval -o x -n @ -p two.tsv -c a.ckpt" \
            "12 synpo-train --batch-states 64 --fill 20 --running 64 --memory 30 -n @ --report 1 -o x <e.jsonl" \
            "400 synpo-finetune ppo --init random -p two.tsv --lanes 16 --steps @ --report 1 -o x"; do
            bar "$columns" "${work%% *}" "${work#* }"
            [ "$(widest)" -lt "$columns" ] || complain "$columns: $work: $(cat "$BATS_TEST_TMPDIR/bar")"
        done
    done
}

@test "a bar ends at 100 %; what goes into a file has one, what goes into a pipe leaves it to the reader" {
    bar 80 20000 "synpo-gen-expert -n @ >x"
    [[ "$(tail -n 1 "$BATS_TEST_TMPDIR/bar")" =~ " 100 % of "[0-9.]+" "[kM]" trajectories" ]]
    bar 80 40 "synpo-eval -n @ -p two.tsv -c a.ckpt >x"
    [[ "$(tail -n 1 "$BATS_TEST_TMPDIR/bar")" =~ " 100 % of "[0-9.k\ ]+" episodes" ]]
    run -0 on_terminal "synpo-gen-expert -n 100000 | tail -n 1 >x"
    [ ! -s "$BATS_TEST_TMPDIR/screen" ]
}

@test "what matters most stays longest: the share, the time left, the tool's name" {
    bar 20 20000 "synpo-gen-expert -n @ -o x"
    grep -qE '^[0-9]+ %(, [0-9:]+ left)?$' "$BATS_TEST_TMPDIR/bar"
    bar 45 20000 "synpo-gen-expert -n @ -o x"
    grep -qE '^synpo-gen-expert: [0-9]+ %, [0-9:]+ left$' "$BATS_TEST_TMPDIR/bar"
    bar 100 20000 "synpo-gen-expert -n @ -o x"
    grep -qE '^synpo-gen-expert: \[[= ]{20}\] [0-9]+ % of [0-9.]+ [kM] trajectories, ' "$BATS_TEST_TMPDIR/bar"
}

@test "where the terminal does not tell its width COLUMNS does, and where it does not either it is taken for 80" {
    bar 0 20000 "env -u COLUMNS synpo-gen-expert -n @ -o x"
    [ "$(widest)" -lt 80 ]
    bar 0 20000 "COLUMNS=30 synpo-gen-expert -n @ -o x"
    [ "$(widest)" -lt 30 ]
    bar 60 20000 "COLUMNS=30 synpo-gen-expert -n @ -o x"
    [ "$(widest)" -gt 30 ]
    for bad in -5 many 0; do
        bar 0 20000 "COLUMNS=$bad synpo-gen-expert -n @ -o x"
        [ "$(widest)" -gt 30 ]
    done
}

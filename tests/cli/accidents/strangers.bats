load ../common

# What comes from strangers is shown and not obeyed, and never says where something is written.

setup_file() { make_inputs; }
setup() { set_up pairs.tsv two.tsv e.jsonl a.ckpt m.tsv; }

BIDI=$'\xe2\x80\xae' CSI=$'\xc2\x9b'

# No byte that a terminal would act on, but the colours of the programs (ESC [ ... m) and what moves the progress.
harmless() {
    sed -E 's/\x1b\[[0-9;]*[mK]//g' "$BATS_TEST_TMPDIR/err" |
        grep -P '[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]|\xc2[\x80-\x9f]|\xe2\x80[\x8e\x8f\xaa-\xae]|\xe2\x81[\xa6-\xa9]' &&
        complain "acts on a terminal: $(od -c "$BATS_TEST_TMPDIR/err" | head -n 20)"
    return 0
}

@test "marks of direction in names: raw in files, by their bytes on a terminal" {
    synpo-matrix split -w any --envs "a${BIDI}b,c" --tasks x,y -n 2 >named.tsv
    grep -q "a${BIDI}b" named.tsv
    sed "s/map1/a${BIDI}b/" m.tsv >named-matrix.tsv
    for command in "split -w any --envs a${BIDI}b,c --tasks x,y -n 2" "merge named-matrix.tsv" "show named-matrix.tsv" \
        "summary named-matrix.tsv" "rows named-matrix.tsv" "cols named-matrix.tsv" "wide named-matrix.tsv" \
        "filter named-matrix.tsv" "compare named-matrix.tsv named-matrix.tsv"; do
        on_terminal "synpo-matrix $command" || true
        harmless
    done
    on_terminal "synpo-matrix merge named-matrix.tsv"
    grep -qF 'a\xe2\x80\xaeb' "$BATS_TEST_TMPDIR/err"
    mkdir maps
    cp "$ROOT/lib/world/grid/maps/map1.txt" "maps/a${BIDI}b.txt"
    on_terminal "synpo-gen-expert -w gridworld:maps -n 1"
    harmless
    synpo-gen-expert -w gridworld:maps -n 1 | grep -q "a${BIDI}b"
}

@test "control characters in any file reach no terminal: messages and descriptions" {
    local bad name
    for bad in $'\033[2J' "$CSI" $'\a' "$BIDI" $'\x7f'; do
        sed "1s/map[0-9]*/$bad/" e.jsonl >bad.jsonl
        sed "2s/map1/$bad/" m.tsv >bad.tsv
        sed "1s/env/$bad/" two.tsv >bad-pairs.tsv
        mkdir -p maps
        rm -f maps/*
        { printf '%s\n' "$bad"; cat "$ROOT/lib/world/grid/maps/map1.txt"; } >maps/m.txt
        sed "s/\"fast\"/\"$bad\"/; s/synpo-checkpoint/synpo-${bad}nt/" a.ckpt >bad.ckpt
        for command in "gen-expert --relabel <bad.jsonl" "train <bad.jsonl" "eval -p bad-pairs.tsv -c a.ckpt" \
            "gen-expert -p bad-pairs.tsv -n 1" "matrix summary bad.tsv" "matrix show bad.tsv" "matrix merge bad.tsv" \
            "render heatmap -o x.png bad.tsv" "render episode -o x.png bad.jsonl" "gen-expert -w gridworld:maps -n 1" \
            "eval --describe -c bad.ckpt" "render curves -o x.png a=bad.tsv"; do
            on_terminal "synpo-$command" || true
            harmless
        done
    done
}

@test "names in files are no paths: nothing is written or read elsewhere" {
    local outside=../../../../../../../../tmp/synpo-outside
    rm -rf /tmp/synpo-outside*
    printf 'env\ttask\n%s\tR-B\n' "$outside" >pairs-out.tsv
    fails 65 synpo-gen-expert -p pairs-out.tsv -n 1
    sed "s|map1|$outside|" m.tsv >named.tsv
    synpo-matrix merge named.tsv -o merged.tsv
    synpo-matrix wide named.tsv >/dev/null
    synpo-render heatmap named.tsv -o h.png
    sed "1s|\"map[0-9]*\"|\"$outside\"|" e.jsonl >out.jsonl
    fails 65 synpo-render episode out.jsonl -o e.png
    fails 65 synpo-render episode --frames frames out.jsonl
    [ -z "$(find /tmp -maxdepth 1 -name 'synpo-outside*')" ]
}

@test "a link in the way of a temporary is not followed" {
    command -v strace >/dev/null || skip "needs strace"
    strace -f -e trace=openat,open,creat -o trace synpo-train "${TINY[@]}" -n 2 --save saved --every 1 --log log \
        -o out <e.jsonl || skip "strace cannot trace here"
    # Whatever is made is made anew, or is the log; no link is followed to it.
    grep O_CREAT trace | grep -v ENOENT >made
    [ "$(wc -l <made)" -ge 4 ]
    ! grep -v O_NOFOLLOW made || complain "followed: $(grep -v O_NOFOLLOW made)"
    ! grep -v O_EXCL made || complain "not anew: $(grep -v O_EXCL made)"
}

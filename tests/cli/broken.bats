load common

setup_file() {
    make_inputs
    synpo-train "${TINY[@]}" -n 2 -p pairs.tsv <e.jsonl >full.ckpt
}

setup() {
    set_up pairs.tsv two.tsv e.jsonl a.ckpt full.ckpt m.tsv
    printf '\211PNG\r\n\032\n\0\0\0\15IHDR\0\0\0\20\0\0\0\20\10\2\0\0\0' >picture.png
    : >empty
}

# Every way to read a checkpoint, trajectories, pairs, a matrix.
checkpoint_fails() {
    fails "$1" synpo-eval -q -n 1 -o out -c "$2"
    fails "$1" synpo-eval --describe -o out -c "$2"
    fails "$1" synpo-train "${TINY[@]}" -n 1 -o out --init "$2" <e.jsonl
    fails "$1" synpo-train -q -n 9 -o out --resume "$2" <e.jsonl
}
trajectories_fail() {
    fails "$1" synpo-train "${TINY[@]}" -n 1 -o out <"$2"
    fails "$1" synpo-gen-expert --relabel -o out <"$2"
}
pairs_fail() {
    fails "$1" synpo-gen-expert -n 1 -o out -p "$2"
    fails "$1" synpo-eval -q -n 1 -o out -c a.ckpt -p "$2"
    fails "$1" synpo-train "${TINY[@]}" -n 1 -o out -p "$2" <e.jsonl
}
matrix_fails() {
    fails "$1" synpo-matrix summary -o out "$2"
    fails "$1" synpo-matrix merge -o out "$2"
    fails "$1" synpo-render heatmap -o out "$2"
}

@test "a missing file or a folder in its place: 66, with its name" {
    mkdir folder
    for name in no-such-file folder no-such-folder/x; do
        for reader in checkpoint_fails pairs_fail matrix_fails; do
            $reader 66 $name
            says "'$name'"
        done
        fails 66 synpo-render map --font $name
    done
}

@test "empty input: 65" {
    for reader in checkpoint_fails pairs_fail matrix_fails; do
        $reader 65 empty
        says empty
    done
    fails 65 synpo-eval -q <empty
    says "cannot read standard input"
    fails 65 synpo-train "${TINY[@]}" -n 1 -o out <empty
    says "standard input has no trajectory"
    # Nothing to relabel is nothing wrong.
    synpo-gen-expert --relabel <empty >out
    cmp empty out
}

@test "a checkpoint cut off anywhere: 65, at which byte" {
    header=$((8 + $(od -An -tu8 -N8 a.ckpt)))
    size=$(stat -Lc %s a.ckpt)
    for length in 1 7 8 9 100 $((header - 1)) "$header" $((header + 1)) $((size / 2)) $((size - 1)); do
        head -c "$length" a.ckpt >cut
        fails 65 synpo-eval -q -n 1 -o out -c cut
        says "cannot read"
        says "cut"
        says "it ends at byte $length"
        fails 65 synpo-train "${TINY[@]}" -n 1 -o out --init cut <e.jsonl
        says "it ends at byte $length"
    done
    head -c -1 full.ckpt >cut
    checkpoint_fails 65 cut
    cat a.ckpt empty <(echo) >long
    checkpoint_fails 65 long
    says "bytes follow"
}

@test "another kind of file is named as what it is not: 65" {
    for file in picture.png e.jsonl m.tsv pairs.tsv; do
        checkpoint_fails 65 $file
        says "$file"
    done
    says "not a safetensors file"
    for file in picture.png a.ckpt m.tsv; do
        trajectories_fail 65 $file
        says "standard input: line 1: "
        says "expected a JSON object"
    done
    for file in picture.png a.ckpt e.jsonl; do
        pairs_fail 65 $file
        matrix_fails 65 $file
        says "$file: line 1"
    done
    # Pairs have no episodes; a picture of them is of the split.
    for command in summary merge; do
        fails 65 synpo-matrix $command -o out pairs.tsv
        says "episodes"
    done
    synpo-render heatmap -o split.png pairs.tsv
    fails 65 synpo-render map --font picture.png
}

@test "safetensors of another program: 65" {
    printf '\2\0\0\0\0\0\0\0{}' >other.ckpt
    checkpoint_fails 65 other.ckpt
    says "not a synpo checkpoint"
    printf '\2\0\0\0\0\0\0\0[]' >other.ckpt
    checkpoint_fails 65 other.ckpt
    printf '\377\377\377\377\377\377\377\177{}' >other.ckpt
    checkpoint_fails 65 other.ckpt
    says "header length"
}

@test "a newer version: 65, with what this build reads" {
    sed 's/"version":"1"/"version":"3"/' full.ckpt >newer
    run ! cmp -s full.ckpt newer
    checkpoint_fails 65 newer
    says "newer"
    says "version 3, this build reads 1 to "
    sed '2s/"version":1/"version":7/' e.jsonl >newer
    trajectories_fail 65 newer
    says "standard input: line 2: version 7, this build reads 1 to "
}

@test "a checkpoint whose contents disagree: 65" {
    sed 's/"window":"1"/"window":"x"/' full.ckpt >bad
    checkpoint_fails 65 bad
    says "window"
    sed 's/\\\\n#@@@@#/\\\\n#@@@##/' full.ckpt >bad
    run ! cmp -s full.ckpt bad
    fails 65 synpo-eval -q -n 1 -o out -c bad
    says "content and hash differ"
    fails 65 synpo-train -q -n 9 -o out --resume bad <e.jsonl
    sed 's/"theta"/"thetb"/' full.ckpt >bad
    fails 65 synpo-eval -q -n 1 -o out -c bad
    says "no tensor 'theta'"
    fails 65 synpo-train -q -n 9 -o out --resume bad <e.jsonl
    sed 's/train.memory.added/train_memory_added/' full.ckpt >bad
    fails 65 synpo-train -q -n 9 -o out --resume bad <e.jsonl
    says "train/memory/added"
}

@test "a broken line among trajectories: 65, with its number" {
    for damage in '3s/.$//' '3s/^/x/' '3s/"env":/"ent":/' '3s/"actions":\[/&9,/' '3s/"success":true/"success":1/' \
        '3s/.*/[]/' \
        '3s/.*/null/' '3s/"map[0-9]*"/"map99"/' '3s/"task":"..."/"task":"R-R"/' \
        '3s/"env_hash":".*","window"/"env_hash":"0","window"/' \
        '3s/"start":{/&"agent":[0,0],"x":/' '3s/"rules":1/"rules":9/' '3s/"world":"gridworld"/"world":"kitchen"/'; do
        sed "$damage" e.jsonl >bad.jsonl
        trajectories_fail 65 bad.jsonl
        says "standard input: line 3: "
    done
    # A file cut off in the middle of its last line.
    head -c -20 e.jsonl >cut.jsonl
    fails 65 synpo-train "${TINY[@]}" -n 1 --fill 60 -o out <cut.jsonl
    says "standard input: line 60: "
}

@test "other maps: the reward that does not come out again, with line and step" {
    sed '17s/"rewards":\[-0.01/"rewards":[0.99/' e.jsonl >bad.jsonl
    trajectories_fail 65 bad.jsonl
    says "line 17: replay gives reward -0.01 at step 1, file says 0.99: other maps?"
    sed '2s/"actions":\[\([0-9]\),.*\],"rewards":\[\(-0.01\).*\],"return"/"actions":[\1],"rewards":[\2],"return"/' \
        e.jsonl >bad.jsonl
    trajectories_fail 65 bad.jsonl
    says "line 2: replay and file differ"
}

@test "hostile lines: nested deep, very long, control characters; the message stays one line of text" {
    { printf '{"format":'; head -c 100000 /dev/zero | tr '\0' '['; echo; } >bad.jsonl
    trajectories_fail 65 bad.jsonl
    head -c 17000000 /dev/zero | tr '\0' x >bad.jsonl
    trajectories_fail 65 bad.jsonl
    says "line 1: longer than"
    printf '\033[31m{\n' >bad.jsonl
    trajectories_fail 65 bad.jsonl
    run ! grep -q "$(printf '\033')" "$BATS_TEST_TMPDIR/err"
    [ "$(wc -l <"$BATS_TEST_TMPDIR/err")" -eq 1 ]
}

@test "broken pairs: 65, with line and column" {
    while IFS='|' read -r text message; do
        printf '%b' "$text" >bad.tsv
        pairs_fail 65 bad.tsv
        says "$message"
    done <<'END'
env\ttask\tseen\n|bad.tsv: line 1
env\tseen\nmap1\t1\n|no column 'task'
env\ttask\tseen\nmap1\tR-B\n|bad.tsv: line 2: found 2 fields, expected 3
env\ttask\tseen\nmap1\tR-B\tyes\n|line 2, column 3 ('seen'): found 'yes'
env\ttask\nmap1\tR-B\nmap1\tR-B\n|line 3: pair 'map1', 'R-B' stands in line 2 already
env\ttask\nmap99\tR-B\n|bad.tsv: line 2: found the env 'map99', expected one of the world 'gridworld', such as 'map1'
env\ttask\nmap1\tR-X\n|bad.tsv: line 2: found the task 'R-X', expected one of the world 'gridworld', such as 'R-B'
env\ttask\nmap1\tR-B|cut off
env\ttask\r\nmap1\tR-B\r\n|CR
END
    printf 'env\ttask\tseen\nmap1\tR-B\t0\n' >none.tsv
    fails 65 synpo-gen-expert -n 1 -p none.tsv
    says "no pair with seen = 1 in 'none.tsv'"
    fails 65 synpo-train "${TINY[@]}" -n 1 -p none.tsv <e.jsonl
    says "no pair with seen = 1 in 'none.tsv'"
}

@test "broken matrices: 65, with line and column" {
    for damage in '2s/\t/ /' '2s/[^\t]*\t[^\t]*$/x\t0.5/' '2s/[^\t]*\t[^\t]*$/nan\t0.5/' '2s/[^\t]*$/1\t1/' \
        '1s/episodes/runs/' '1s/task/env/' '2s/R-B/R\xffB/'; do
        sed "$damage" m.tsv >bad.tsv
        run ! cmp -s m.tsv bad.tsv
        fails 65 synpo-matrix summary -o out bad.tsv
        says "bad.tsv: line"
        fails 65 synpo-matrix merge -o out bad.tsv
    done
    head -c -3 m.tsv >cut.tsv
    matrix_fails 65 cut.tsv
    says "cut.tsv: line 3"
    # More successes than episodes.
    awk -F '\t' 'BEGIN { OFS = FS } NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i } NR == 2 { $at["successes"] = 2 }
        { print }' m.tsv >bad.tsv
    matrix_fails 65 bad.tsv
    says "bad.tsv: line 2"
    fails 65 synpo-matrix merge m.tsv m.tsv
}

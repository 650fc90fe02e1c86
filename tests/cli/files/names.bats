load ../common

# maps NAME...: a folder of these maps.
maps() {
    local name
    mkdir -p maps
    for name in "$@"; do cp "$ROOT/lib/world/grid/maps/map1.txt" "maps/$name"; done
}

@test "every *.txt of a folder is a map, by the name of the file" {
    maps labyrinth.txt map2.txt map10.txt "two words.txt" kueche-öde.txt
    cp "$ROOT/lib/world/grid/maps/map1.txt" maps/.hidden.txt
    cp "$ROOT/lib/world/grid/maps/map1.txt" maps/map3.text
    synpo-gen-expert -w gridworld:maps --per-pair 1 | jq -r .env | uniq | paste -s -d , >got
    echo "kueche-öde,labyrinth,map2,map10,two words" | cmp got
    mkdir none
    fails 66 synpo-gen-expert -w gridworld:none -n 1
    says "no *.txt in the folder 'none'"
}

@test "a map whose file cannot be a name is refused before the work, with the byte" {
    while IFS='|' read -r name message; do
        maps map1.txt "$(printf '%b' "$name")"
        fails 65 synpo-gen-expert -w gridworld:maps -n 1
        says "$message"
        fails 65 synpo-train "${TINY[@]}" -w gridworld:maps -n 2 -o out </dev/null
        says "$message"
        fails 65 synpo-render map -w gridworld:maps -o out.png
        rm -r maps
    done <<'END'
map\xe9.txt|'map\xe9.txt' in the folder 'maps': found invalid UTF-8 at byte 4 of the name (\xe9), expected UTF-8 text
a\tb.txt|found a control character at byte 2 of the name (\x09)
\x1b[31m.txt|found a control character at byte 1 of the name (\x1b)
END
}

@test "names in files are 1 to 255 bytes of text: pairs, matrices, trajectories, checkpoints" {
    long=$(printf 'x%.0s' {1..256})
    make_inputs
    cd "$BATS_TEST_TMPDIR/work" || exit
    cp "$BATS_FILE_TMPDIR"/{e.jsonl,a.ckpt,m.tsv} .
    printf 'env\ttask\n%s\tR-B\n' "$long" >long.tsv
    fails 65 synpo-gen-expert -p long.tsv -n 1
    says "expected the name of an environment, of at most 255 bytes"
    printf 'env\ttask\nmap1\t%s\n' "$long" >long.tsv
    fails 65 synpo-gen-expert -p long.tsv -n 1
    sed "2s/\tmap1\t/\t$long\t/" m.tsv >long.tsv
    fails 65 synpo-matrix summary long.tsv
    says "expected the name of an environment, of at most 255 bytes"
    for name in "$long" '' 'a\\tb' 'a\\u001bb' 'a\\nb'; do
        sed "s/\"env\":\"[^\"]*\"/\"env\":\"$name\"/" e.jsonl >bad.jsonl
        fails 65 synpo-gen-expert --relabel <bad.jsonl
        says "line 1: field 'env': found"
    done
    maps "${long%xxxxx}.txt"
    synpo-gen-expert -w gridworld:maps -n 1 >e.jsonl
    synpo-gen-expert -w gridworld:maps --relabel <e.jsonl | cmp e.jsonl
}

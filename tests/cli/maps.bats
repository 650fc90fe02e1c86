load common

# map FILE: one room with a column of wall in it, 16 x 16.
map() {
    mkdir -p "$(dirname "$1")"
    awk 'BEGIN {
        for (r = 0; r < 16; ++r) {
            line = ""
            for (c = 0; c < 16; ++c) 
                line = line (r == 0 || r == 15 || c == 0 || c == 15 || (c == 7 && r > 3) ? "#" : " ")
            print line
        }
    }' >"$1"
}

@test "a folder of maps is a world; names in natural order, other files ignored" {
    for i in 10 2 1; do map maps/map$i.txt; done
    echo "not a map" >maps/notes.md
    synpo-gen-expert -w gridworld:maps --per-pair 1 >e.jsonl
    jq -r .env e.jsonl | uniq >got
    printf 'map1\nmap2\nmap10\n' | cmp - got
    synpo-gen-expert --relabel -w gridworld:maps <e.jsonl >again
    cmp e.jsonl again
}

@test "the wall of a map is where it stands: episodes go around it" {
    map maps/map1.txt
    synpo-gen-expert -w gridworld:maps -n 300 >e.jsonl
    jq -e -s 'all(.[].start[]; (.[1] != 7 or .[0] <= 3) and .[0] > 0 and .[0] < 15)' e.jsonl
}

@test "missing trailing blanks and '@' for floor: the same maze" {
    map maps/map1.txt
    map other/map1.txt
    tr ' ' '@' <maps/map1.txt >other/map1.txt
    synpo-gen-expert -w gridworld:maps -n 20 >a
    synpo-gen-expert -w gridworld:other -n 20 >b
    cmp a b
    printf '\n' >>other/map1.txt
    synpo-gen-expert -w gridworld:other -n 20 >c
    cmp a c
    # A line that ends early ends in floor and the outer wall.
    sed 's/ *#*$//; s/^$/#/' maps/map1.txt >other/map1.txt
    [ "$(awk '{ print length }' other/map1.txt | sort -n | tail -n 1)" -lt 16 ]
    sed -n '4p' maps/map1.txt | grep -q ' #$'
    synpo-gen-expert -w gridworld:other -n 20 >d
    cmp a d
    sed '5s/#$/@/' maps/map1.txt >other/map1.txt
    fails 65 synpo-gen-expert -w gridworld:other -n 1
    says "other/map1.txt: line 5, column 16: found floor, expected the outer wall"
}

@test "one map of any number through the whole pipeline" {
    map maps/map3.txt
    map maps/map12.txt
    synpo-matrix split -w gridworld:maps --tasks 2 -n 3 >pairs.tsv
    synpo-gen-expert -w gridworld:maps -p pairs.tsv -n 25 >e.jsonl
    synpo-train "${TINY[@]}" -w gridworld:maps -p pairs.tsv -n 2 --strip <e.jsonl >a.ckpt
    rm -r maps
    [ "$(described a.ckpt '.envs | map(.name) | join(" ")')" = "map3 map12" ]
    synpo-eval -q -n 1 -p pairs.tsv <a.ckpt >m.tsv
    [ "$(wc -l <m.tsv)" -eq 5 ]
    synpo-render heatmap m.tsv >m.png
}

@test "trajectories of other maps are refused" {
    map maps/map1.txt
    synpo-gen-expert -w gridworld:maps -n 1 >e.jsonl
    fails 65 synpo-gen-expert --relabel <e.jsonl
    says "line 1: env 'map1' is not the one of that name here"
    fails 65 synpo-train -q -n 1 <e.jsonl
    says "line 1: env 'map1' is not the one of that name here"
}

@test "15 lines, 17 lines, a line of 17: 65, with what was found" {
    for command in "synpo-gen-expert -n 1" "synpo-train -q -n 1" "synpo-matrix split" "synpo-render map"; do
        map maps/map1.txt
        sed -i 8d maps/map1.txt
        # shellcheck disable=SC2086
        fails 65 $command -w gridworld:maps
        says "maps/map1.txt: found 15 lines, expected a maze of 16 lines of 16 characters"
        map maps/map1.txt
        sed -i 8p maps/map1.txt
        # shellcheck disable=SC2086
        fails 65 $command -w gridworld:maps
        says "found 17 lines"
        map maps/map1.txt
        sed -i '8s/$/#/' maps/map1.txt
        # shellcheck disable=SC2086
        fails 65 $command -w gridworld:maps
        says "line 8: found 17 characters"
    done
}

@test "another character, rooms without a door, no floor, an empty file: 65" {
    map maps/map1.txt
    sed -i '9s/ /x/' maps/map1.txt
    fails 65 synpo-gen-expert -n 1 -w gridworld:maps
    says "maps/map1.txt: line 9, column 2: found 'x'"
    map maps/map1.txt
    sed -i '2,4s/^\(.......\)./\1#/' maps/map1.txt
    fails 65 synpo-gen-expert -n 1 -w gridworld:maps
    says "cannot be reached"
    map maps/map1.txt
    sed -i 's/ /#/g' maps/map1.txt
    fails 65 synpo-gen-expert -n 1 -w gridworld:maps
    says "found 0 floor cells"
    : >maps/map1.txt
    fails 65 synpo-gen-expert -n 1 -w gridworld:maps
    says "found nothing"
}

@test "an empty folder, a missing one, a file in its place: 66" {
    mkdir maps
    for world in gridworld:maps gridworld:no-such gridworld:; do
        fails 66 synpo-gen-expert -n 1 -w "$world"
        fails 66 synpo-train -q -n 1 -w "$world" </dev/null
        fails 66 synpo-matrix split -w "$world"
        fails 66 synpo-render map -w "$world"
    done
    says "folder"
    map maps/map1.txt
    fails 66 synpo-gen-expert -n 1 -w gridworld:maps/map1.txt
    mkdir maps/map2.txt
    fails 66 synpo-gen-expert -n 1 -w gridworld:maps
}

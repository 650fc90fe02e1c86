load common
load render/pictures

setup_file() {
    cd "$BATS_FILE_TMPDIR" || exit
    printf 'env\ttask\nFloorPlan25\tMug-Fridge\n' >pair.tsv
    synpo-gen-expert -w kitchen -p pair.tsv -n 3 -s 1 >k.jsonl
    synpo-gen-expert -n 1 >grid.jsonl
}

setup() { set_up k.jsonl grid.jsonl; }

@test "map: all kitchens, those named, in columns" {
    all_differ "map -w kitchen" "" "FloorPlan1" "FloorPlan25 FloorPlan1" "FloorPlan1 FloorPlan25" "--columns 1" \
        "--title Kitchens" "--scale 1"
}

@test "map --ansi: the plans as text" {
    synpo-render map -w kitchen --ansi FloorPlan25 FloorPlan30 >text
    head -n 1 text | grep -qE '^FloorPlan25 +FloorPlan30$'
    for letter in F M S; do grep -q "$letter$letter" text; done
    [ "$(wc -l <text)" -eq 14 ]
    synpo-render map -w kitchen --ansi --columns 1 FloorPlan25 FloorPlan30 >column
    [ "$(wc -l <column)" -eq 27 ]
}

@test "view: kitchens, tasks, seeds, steps, histories" {
    all_differ "view -w kitchen" "" "-e FloorPlan25" "-t Mug-Sink" "-s 1" "--episode 1" "--steps 2" "--history" \
        "--steps 2 --history" "--title View" "--scale 1"
    synpo-render view -w kitchen -e FloorPlan1 -t Container-Fridge -s 0 --steps 0 >b.png
    synpo-render view -w kitchen | cmp - b.png
}

@test "episode: the picture, its line, strip and title" {
    all_differ "episode -w kitchen" "k.jsonl" "--line 2 k.jsonl" "--strip 0 k.jsonl" "--strip 4 k.jsonl" \
        "--title Another k.jsonl" "--scale 1 k.jsonl"
    synpo-render episode -w kitchen k.jsonl >a.png
    synpo-render episode -w kitchen <k.jsonl | cmp - a.png
}

@test "episode --frames and --video: one for the start and one after every step, the same bytes twice" {
    synpo-render episode -w kitchen --scale 0.5 --frames frames --video a.avi k.jsonl >out
    [ ! -s out ]
    [ "$(find frames -name '*.png' | wc -l)" -eq $(($(head -n 1 k.jsonl | jq '.actions | length') + 1)) ]
    is_png frames/0000.png
    run ! cmp -s frames/0000.png frames/0001.png
    synpo-render episode -w kitchen --scale 0.5 --frames again --video b.avi k.jsonl
    diff -r frames again
    cmp a.avi b.avi
}

@test "what does not go with kitchens: 64, and says so" {
    fails 64 synpo-render view -w kitchen --window 2
    says "--window is for mazes, but the world is 'kitchen'"
    fails 64 synpo-render view -w kitchen -e map1
    says "no kitchen 'map1' in this world"
    fails 64 synpo-render view -w kitchen -t R-B
    says "no task 'R-B': expected an object and a receptacle, such as Mug-Sink"
    fails 64 synpo-render view -w kitchen --steps 300
    says "the expert's episode ends after"
    fails 64 synpo-render view -t Mug-Sink
    says "no task 'Mug-Sink': expected two of R B G O P"
    fails 64 synpo-render map -w kitchen map1
    says "no kitchen 'map1' in this world"
    fails 64 synpo-render map FloorPlan1
    says "no maze 'FloorPlan1' in this world"
    fails 64 synpo-render episode -w kitchen --ansi k.jsonl
    says "--ansi is for mazes, but the world is 'kitchen'"
    for command in map view episode; do
        fails 64 synpo-render $command -w kitchen:folder
        says "cannot draw the world 'kitchen:folder': of the kitchens, only those of 'kitchen' have plans"
        fails 64 synpo-render $command -w atari
        says "unknown world 'atari', expected gridworld, gridworld:DIR or kitchen"
    done
}

@test "an episode of the other world: 65, with the line" {
    fails 65 synpo-render episode -w kitchen -o out grid.jsonl
    says "line 1: world 'gridworld', expected 'kitchen'"
    fails 65 synpo-render episode -w gridworld -o out k.jsonl
    says "k.jsonl: line 1: world 'kitchen', expected 'gridworld'"
    synpo-render episode -o own.png k.jsonl  # in the world that it names
    jq -c '.rewards[0] = 1' k.jsonl >bad.jsonl
    fails 65 synpo-render episode -w kitchen -o out bad.jsonl
    says "bad.jsonl: line 1: replay gives reward -0.01 at step 1, file says 1"
}

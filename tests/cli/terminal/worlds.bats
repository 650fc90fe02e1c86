load ../common

setup_file() {
    cd "$BATS_FILE_TMPDIR" || exit
    mkdir mine other more
    cp "$ROOT"/lib/world/grid/maps/map{3,4}.txt mine
    cp "$ROOT/lib/world/grid/maps/map3.txt" other/map4.txt
    cp mine/* more
    cp "$ROOT/lib/world/grid/maps/map5.txt" more
    mv mine/map4.txt mine/own.txt
    cp mine/own.txt more/own.txt
    cp "$ROOT/lib/world/grid/maps/map6.txt" other/own.txt
    synpo-gen-expert -w gridworld:mine -n 30 >mine.jsonl
    synpo-train "${TINY[@]}" -w gridworld:mine -n 2 mine.jsonl >run.ckpt
    printf 'env\ttask\nown\tR-B\n' >one.tsv
}
setup() { set_up mine other more mine.jsonl run.ckpt one.tsv; }

@test "-w beside a checkpoint that holds its environments: accepted where they agree, 64 where they do not" {
    synpo-eval -q -n 1 -p one.tsv run.ckpt >m.tsv
    synpo-eval -q -n 1 -p one.tsv -w gridworld:mine run.ckpt | cmp - m.tsv
    fails 64 synpo-eval -q -p one.tsv -w gridworld:other run.ckpt
    says "the checkpoint holds its environments, and"
    fails 64 synpo-eval -q -p one.tsv -w gridworld:more run.ckpt
    says "of 'gridworld:more' is none of them"
    fails 64 synpo-eval -q -p one.tsv -w kitchen run.ckpt
    says "which are of 'gridworld', but found 'kitchen'"
    fails 66 synpo-eval -q -p one.tsv -w gridworld:nowhere run.ckpt
    synpo-train -q --resume run.ckpt -n 3 mine.jsonl >plain
    synpo-train -q --resume run.ckpt -n 3 -w gridworld:mine mine.jsonl | cmp - plain
    fails 64 synpo-train -q --resume run.ckpt -n 3 -w gridworld:other mine.jsonl
    synpo-finetune ppo -q --lanes 16 --steps 200 run.ckpt >tuned
    synpo-finetune ppo -q --lanes 16 --steps 200 -w gridworld:mine run.ckpt | cmp - tuned
}

@test "map, view, episode: the world of a checkpoint, or that which the file names" {
    for command in "map" "map own" "view -e own -t B-G" "episode mine.jsonl"; do
        synpo-render $command -w gridworld:mine -o there.png
        synpo-render $command -c run.ckpt -o here.png
        cmp there.png here.png || complain "$command"
    done
    fails 64 synpo-render view -e own
    fails 64 synpo-render view -c run.ckpt -w gridworld
    says "-w and -c exclude each other"
    fails 66 synpo-render map -c none.ckpt
    # The built-in world has no maze of that name.
    grep '"own"' mine.jsonl >own.jsonl
    fails 65 synpo-render episode own.jsonl
    says "(other maps? see -w)"
    synpo-gen-expert -n 1 >maze.jsonl
    synpo-gen-expert -n 1 -w kitchen >kitchen.jsonl
    for world in maze:gridworld kitchen:kitchen; do
        synpo-render episode "${world%:*}.jsonl" -o named.png
        synpo-render episode "${world%:*}.jsonl" -w "${world#*:}" | cmp - named.png
    done
    sed 's/"world":"gridworld"/"world":"atari"/' maze.jsonl >strange.jsonl
    fails 65 synpo-render episode strange.jsonl
    says "line 1: world 'atari', expected gridworld"
    synpo-gen-expert -w gridworld:mine --window 2 -n 30 |
        synpo-train "${TINY[@]}" -w gridworld:mine -n 1 --strip >wide.ckpt
    synpo-render view -c wide.ckpt -o wide.png
    synpo-render view -w gridworld:mine --window 2 | cmp - wide.png
}

load common

# Messages name the option of the command that would help, and no other.

# overflow TENSOR FILE: the checkpoint with every value of a tensor so large that products of it are infinite.
overflow() {
    local header begin end
    header=$(od -An -tu8 -N8 "$2" | tr -d ' ')
    read -r begin end < <(head -c $((8 + header)) "$2" | tail -c "$header" |
        jq -r --arg name "$1" '.[$name].data_offsets | @tsv')
    head -c $((8 + header + begin)) "$2"
    # 1.7e38, four bytes each.
    head -c $((end - begin)) /dev/zero | tr '\0' '\1' | sed 's/\x01\x01\x01\x01/\x00\x00\x00\x7f/g'
    tail -c +$((9 + header + end)) "$2"
}

setup_file() {
    make_inputs
    sed 's/"env":"map[0-9]*"/"env":"map21"/' e.jsonl >other.jsonl
    synpo-train "${TINY[@]}" -m mlp -n 1 -p pairs.tsv --strip <e.jsonl | synpo-eval -q -p two.tsv -n 1 >mlp.tsv
    synpo-matrix merge m.tsv mlp.tsv >both.tsv
    synpo-eval -q -p two.tsv -n 1 -s 7 <a.ckpt >seed7.tsv
    overflow theta a.ckpt >huge.ckpt
}
setup() { set_up e.jsonl a.ckpt m.tsv other.jsonl both.tsv seed7.tsv huge.ckpt; }

# The last line on stderr is just this.
says_all() { [ "$(tail -n 1 "$BATS_TEST_TMPDIR/err")" = "$1" ] ||
    complain "found '$(cat "$BATS_TEST_TMPDIR/err")', expected '$1'"; }

@test "an unknown maze: -w" {
    why="standard input: line 1: unknown env 'map21' (other maps? see -w)"
    fails 65 synpo-gen-expert --relabel <other.jsonl
    says_all "synpo-gen-expert: $why"
    fails 65 synpo-train "${TINY[@]}" -n 1 <other.jsonl
    says_all "synpo-train: $why"
    fails 65 synpo-finetune adapt -q -c a.ckpt -n 1 <other.jsonl
    says_all "synpo-finetune: $why"
    fails 65 synpo-render episode <other.jsonl
    says_all "synpo-render: $why"
    printf 'env\ttask\nFloorPlan1\tMug-Sink\n' >kitchen.tsv
    why="kitchen.tsv: line 2: found the env 'FloorPlan1', expected one of the world 'gridworld', such as 'map1'"
    fails 65 synpo-gen-expert -p kitchen.tsv -n 1
    says_all "synpo-gen-expert: $why (other maps? see -w)"
    fails 65 synpo-train "${TINY[@]}" -n 1 -p kitchen.tsv <e.jsonl
    says_all "synpo-train: $why (other maps? see -w)"
    # Its world is that of the checkpoint.
    fails 65 synpo-eval -q -p kitchen.tsv <a.ckpt
    says_all "synpo-eval: $why"
}

@test "a loss that is not finite: --lr" {
    why="the loss is not finite at update 1: try a smaller --lr"
    fails 70 synpo-train "${TINY[@]}" -n 1 --init huge.ckpt <e.jsonl
    says_all "synpo-train: $why"
    fails 70 synpo-finetune ppo -q --lanes 2 --rollout 8 --steps 16 --minibatches 1 -c huge.ckpt
    says_all "synpo-finetune: $why"
    fails 70 synpo-finetune adapt -q -n 1 -c huge.ckpt <e.jsonl
    says_all "synpo-finetune: $why"
}

@test "no training state: --init" {
    fails 65 synpo-train --resume a.ckpt <e.jsonl
    says_all "synpo-train: the checkpoint has no training state (was it stripped?): --init takes its weights"
}

@test "several methods: --method" {
    for command in "matrix show" "matrix wide" "render heatmap"; do
        # shellcheck disable=SC2086
        fails 65 synpo-$command both.tsv
        says "rows of several methods ('mlp', 'synpo'): choose one with --method"
    done
}

@test "a picture that is too large, axes without room or marks outside them: --scale, --size and --y-range" {
    fails 64 synpo-render map --scale 16 --columns 20
    says_all "synpo-render: the picture would have 35968 x 2144 pixels: use a smaller --scale"
    printf 'update\tstates\tseconds\tstates_per_s\tpolicy\tright_move\n1\t10\t1\t10\t0.5\t0.9\n' >run.log
    fails 64 synpo-render curves -y policy --size 60x60 run.log
    says_all "synpo-render: no room for the axes in a picture of 60x60 points: give a larger --size"
    fails 64 synpo-render curves -y right_move --y-range 200: run.log
    says_all "synpo-render: --y-range leaves nothing between 200 and 100"
    fails 64 synpo-render curves -y policy --mark 5=x --y-range 0:1 run.log
    says_all "synpo-render: the mark at 5 lies outside the axis from 0 to 1: give another --y-range"
}

@test "other start states: --any-start" {
    fails 65 synpo-matrix compare m.tsv seed7.tsv
    says "and the same seen; --any-start compares other start states, too"
    synpo-matrix compare --any-start m.tsv seed7.tsv
}

@test "a single pair that cannot be: --single" {
    fails 64 synpo-matrix split --single map1,R-B --single map1,O-R
    says_all "synpo-matrix: --single map1,O-R: its environment or its task has another single pair already"
    fails 64 synpo-matrix split --single map99,R-B
    says_all "synpo-matrix: --single map99,R-B: 'map99' is no environment of this split"
    fails 64 synpo-matrix split --single map1 --single map1,O-R
    says_all "synpo-matrix: --single map1,O-R: its environment or its task has another single pair already"
    fails 64 synpo-matrix split --single map99
    says_all "synpo-matrix: --single map99: 'map99' is no environment and no task of this split"
    fails 64 synpo-matrix split -w any --envs a,b --tasks b,c -n 2 --single b
    says_all "synpo-matrix: --single b: both an environment and a task"
}

@test "a policy whose loss demonstrations cannot feed" {
    synpo-train "${TINY[@]}" -m sf --sf-loss td -n 1 <e.jsonl >sf.ckpt
    fails 64 synpo-finetune adapt -q -c sf.ckpt -n 1 <e.jsonl
    says "needs more than demonstrations hold (sf: synpo-train --sf-loss ce makes policies that can be adapted)"
}

@test "a file of another kind is told what it is" {
    fails 65 synpo-matrix summary <a.ckpt
    says "expected UTF-8 text (this is a checkpoint)"
    fails 65 synpo-matrix summary <e.jsonl
    says "(this is JSON, as trajectories are)"
    fails 65 synpo-train -n 1 <a.ckpt
    says "expected a JSON object (this is a checkpoint)"
    fails 65 synpo-train -n 1 <m.tsv
    says "expected a JSON object (this is a table)"
    fails 65 synpo-eval <e.jsonl
    says "(this is JSON, as trajectories are)"
    synpo-render heatmap <m.tsv >m.png
    fails 65 synpo-eval <m.png
    says "(this is a picture)"
}

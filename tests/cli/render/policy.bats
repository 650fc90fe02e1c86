load ../common
load pictures

CHECKPOINT=a.ckpt

setup_file() { make_inputs; }
setup() { set_up e.jsonl a.ckpt; }

@test "a policy in every cell: stages, treasures, histories" {
    all_differ policy "" "--stage 1" "--stage 2" "--stage 2 --pictures 1" "-s 1" "--episode 1" "-e map2" "-t B-G" \
        "--title Policy" "--scale 1"
    drawn policy
    cp a.png default.png
    drawn policy -e map1 -t R-B -s 0 --episode 0 --stage 0 --pictures 0
    cmp a.png default.png
}

@test "a policy: unknown maze or task and wrong options 64, no checkpoint 65, missing 66" {
    refuses_broken_checkpoints synpo-render policy
    fails 64 synpo-render policy -e nowhere a.ckpt
    says "no maze 'nowhere' in the checkpoint's world"
    fails 64 synpo-render policy -t R-R a.ckpt
    says "no task 'R-R': expected two of R B G O P"
    for option in "--stage 3" "--pictures 5" "-s -1" "--episode x"; do
        # shellcheck disable=SC2086
        fails 64 synpo-render policy $option a.ckpt
    done
}

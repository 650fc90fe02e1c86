# scripts/reproduce with tools that only note how they were called: what is run, in which order, and what is not run
# again.
load common

# A copy of the scripts whose tools stand in for the real ones. A training fails once where a file `stop` names its run.
stand_ins() {
    mkdir build
    cp -r "$ROOT/scripts" scripts
    cat >build/synpo-train <<'END'
#!/bin/bash
echo "train $*" >>"$CALLS"
cat >read
all=$* out= save= log=
while [ $# -gt 0 ]; do
    case $1 in -o) out=$2 ;; --save) save=$2 ;; --log) log=$2 ;; esac
    shift
done
if [ -f stop ] && [ "$out" = "$(cat stop).part" ]; then
    rm stop
    echo half >"$save"
    exit 143
fi
echo "$all" >"$out"
echo rows >"$log"
END
    cat >build/synpo-eval <<'END'
#!/bin/bash
echo "eval $*" >>"$CALLS"
printf 'run\tmethod\tseen\nx\tsynpo\t1\n'
END
    cat >build/synpo-gen-expert <<'END'
#!/bin/bash
echo "expert $*" >>"$CALLS"
echo "{}"
END
    cat >build/synpo-matrix <<'END'
#!/bin/bash
echo "matrix $*" >>"$CALLS"
echo "what is printed"
END
    sed 's/matrix/render/' build/synpo-matrix >build/synpo-render
    chmod +x build/*
    export CALLS=$PWD/calls
}

trained() { grep -o -- '^train.*' calls | sed 's/.*-o \([^ ]*\)\.part.*/\1/'; }

@test "reproduce: every run once, the first seed first, for the budget's number of updates" {
    stand_ins
    scripts/reproduce figure3 --budget 1e6 --seeds 2 -n 7 -o results
    trained >got
    printf '%s\n' full-1 no-env-1 no-task-1 no-disentanglement-1 no-reward-1 full-2 no-env-2 no-task-2 \
        no-disentanglement-2 no-reward-2 | cmp - got
    [ "$(grep -c 'train.* -n 1953 ' calls)" = 10 ]
    grep -q 'train .*-p pairs2.tsv -s 2 .*--no-env-loss --no-task-loss ' calls
    [ "$(grep -c 'eval .* -n 7 ' calls)" = 10 ]
    # Splits 2 and 3 are reported; 1 is the one that the recipe was found on.
    grep -q '^matrix split .*-s 2' calls
    grep -q '^matrix split .*-s 3' calls
    [ "$(cut -f 2 results/no-env-2.tsv)" = $'method\nno-env' ]
    grep -q '1953 updates of 512 states' results/README.md
}

@test "reproduce: what was stopped goes on, and what is there is not made again" {
    stand_ins
    mkdir results
    echo no-task-1 >results/stop
    ! scripts/reproduce figure3 --budget 1e6 --seeds 1 -o results 2>err ||
        complain "a training that failed was passed over"
    [ ! -e results/README.md ]
    trained >got
    printf '%s\n' full-1 no-env-1 no-task-1 | cmp - got
    rm calls
    scripts/reproduce figure3 --budget 1e6 --seeds 1 -o results
    ! trained | grep -qx 'full-1\|no-env-1' || complain "trained again: $(trained)"
    grep -q 'train .*--resume no-task-1.save' calls
    [ ! -e results/no-task-1.save ]
    rm calls
    scripts/reproduce figure3 --budget 1e6 --seeds 1 -o results
    ! grep -q '^train\|^eval\|^expert' calls || complain "done again: $(cat calls)"
}

@test "reproduce: a page has the seeds asked for, whatever else lies in the folder" {
    stand_ins
    mkdir results
    touch results/full-2.log results/full-2.tsv
    scripts/reproduce figure3 --budget 1e6 --seeds 1 -o results
    ! grep -e '-2\.' calls || complain "a seed that was not asked for"
    grep -q '^render curves .* full=full-1.log no-env=no-env-1.log' calls
    grep -q '^matrix table .* full-1.tsv no-env-1.tsv' calls
    scripts/reproduce figure3 --budget 1e6 --seeds 2 -o results
    grep -q '^render curves .* full=full-1.log,full-2.log ' calls
}

@test "reproduce: what the grid has chosen for a method is taken" {
    stand_ins
    mkdir -p results/grid
    printf 'mlp\t--lr 0.5 --task-loss 0.25\t0.4\t-1\n' >results/grid/choice.tsv
    scripts/reproduce table4 --budget 1e6 --seeds 1 -o results/table4
    grep -q 'train .*-m mlp --lr 0.5 --task-loss 0.25 ' calls
    [ "$(grep -c 'train .*--lr' calls)" = 1 ]
    [ "$(grep -- '^- ' results/table4/README.md)" = '- mlp: `--lr 0.5 --task-loss 0.25`' ]
}

@test "reproduce grid: chosen is most success on pairs held back, or the best reward where none beats guessing" {
    stand_ins
    cat >build/synpo-eval <<'END'
#!/bin/bash
while [ "$1" != -c ]; do shift; done
successes=5 reward=-900
case $(cat "$2") in
*"-m synpo --lr 0.001 "*) successes=50 ;;
*"-m mlp "*"--embedding-sd 0.3 --weight-decay 0.001 "*) successes=7 ;;
*"-m modulenet "*"--dropout 0 --weight-decay 0.0001 "*) successes=3 reward=-100 ;;
*"-m sf "*"td --embedding-sd 0.1 "*) successes=0 reward=300 ;;
*) seen=100 ;;
esac
printf 'run\tmethod\tseen\tepisodes\tsuccesses\treward\n'
printf 'x\tm\t1\t100\t%s\t900\nx\tm\t0\t100\t%s\t%s\n' "${seen-0}" $successes $reward
END
    scripts/reproduce grid --budget 1e6 -o results
    cut -f 1-3 results/choice.tsv >got
    printf '%s\t%s\t%s\n' mlp '--lr 0.002 --embedding-sd 0.3 --weight-decay 0.001' 0.0700 \
        modulenet '--lr 0.002 --dropout 0 --weight-decay 0.0001' 0.0300 mtl '--lr 0.001 --embedding-sd 1' 0.0500 \
        sf '--lr 0.002 --sf-loss td --embedding-sd 0.1 --reward-loss 0.01 --weight-decay 0.001' 0.0000 synpo \
        '--lr 0.001' 0.5000 | cmp - got
    [ "$(trained | sort -u | wc -l)" = "$(wc -l <results/runs)" ]
}

@test "reproduce: a folder's results are of one budget and one number of episodes" {
    stand_ins
    scripts/reproduce figure3 --budget 1e6 --seeds 1 -n 7 -o results
    for words in "--budget 2e6 -n 7" "--budget 1e6 -n 8"; do
        # shellcheck disable=SC2086
        scripts/reproduce figure3 $words --seeds 2 -o results 2>err && complain "$words: taken"
        grep -q '^reproduce: found .* are of --budget 1e6 -n 7: ' err
    done
    rm calls
    scripts/reproduce figure3 --budget 1e6 --seeds 2 -n 7 -o results
    [ "$(trained | wc -l)" = 5 ]
}

@test "reproduce: nonsense is wrong usage, and says what is right" {
    stand_ins
    for words in "table9" "common" "table4 --seeds 0" "table4 -j x" "table4 -n" "table4 --colour blue" \
        "table4 --budget 12" "table4 --budget some" "table4 --budget foom" "table4 --budget 1.2.3h"; do
        status=0
        # shellcheck disable=SC2086
        scripts/reproduce $words 2>err || status=$?
        [ "$status" = 64 ] || complain "$words: exit code $status, expected 64: $(cat err)"
        grep -q '^reproduce: .' err
    done
    ! grep -qs '^train' calls || complain "trained: $(trained)"
    rm build/synpo-train
    status=0
    PATH=/usr/bin:/bin scripts/reproduce table4 2>err || status=$?
    [ "$status" = 69 ]
}

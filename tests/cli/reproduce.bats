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
    # Each twice: actions drawn, and always the best one.
    [ "$(grep -c '^eval .* -n 7 --temperature 0$' calls)" = 10 ]
    [ "$(grep -c '^eval .* -n 7$' calls)" = 10 ]
    [ "$(cut -f 2 results/no-env-2.greedy.tsv)" = $'method\nno-env' ]
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

@test "reproduce: a run by its number, in any order, and the page of those that are done" {
    stand_ins
    local asked=(figure3 --budget 1e6 --seeds 2 -n 7 -o results)
    scripts/reproduce "${asked[@]}" --run 7
    scripts/reproduce "${asked[@]}" --run 1
    trained >got
    printf '%s\n' no-env-2 full-1 | cmp - got
    [ ! -e results/README.md ]
    scripts/reproduce "${asked[@]}" --merge
    grep -qx 'So far: 2 of 10 runs.' results/README.md
    grep -q '^render curves .* full=full-1.log no-env=no-env-2.log$' calls
    grep -q '^matrix table .* full-1.tsv no-env-2.tsv$' calls
    [ "$(trained | wc -l)" = 2 ]
    scripts/reproduce "${asked[@]}"
    ! grep 'So far' results/README.md || complain "the page of all runs"
    [ "$(trained | sort | uniq -c | grep -c '^ *1 ')" = 10 ]
}

@test "reproduce: a page can be made of the first run alone, and there is none before that" {
    stand_ins
    for name in grid table4 table5 figure3 figure456 thor small; do
        scripts/reproduce $name --budget 1e6 -o $name --merge
        [ ! -e $name/README.md ] || complain "$name: a page of nothing"
        scripts/reproduce $name --budget 1e6 -o $name --run 1
        scripts/reproduce $name --budget 1e6 -o $name --merge
        grep -q '^So far: 1 of ' $name/README.md || complain "$name: $(cat $name/README.md)"
    done
    # What other reproductions would take for the choice of the whole grid.
    [ ! -e grid/choice.tsv ]
}

@test "reproduce --parallel: each run once, and after a failure those that are left" {
    [[ $(parallel --version 2>/dev/null) == 'GNU parallel'* ]] || skip "no GNU parallel here"
    stand_ins
    local asked=(figure3 --budget 1e6 --seeds 2 -o results --parallel 2)
    mkdir results
    echo no-task-1 >results/stop
    ! scripts/reproduce "${asked[@]}" 2>err || complain "a training that failed was passed over"
    [ ! -e results/README.md ]
    scripts/reproduce "${asked[@]}" -- --keep-order
    trained | sort | uniq -c >got
    [ "$(awk '$1 == 1' got | wc -l)" = 9 ]
    grep -qx ' *2 no-task-1' got
    grep -q 'train .*--resume no-task-1.save' calls
    [ "$(awk -F '\t' 'NR > 1 && $7 == 0' results/joblog | wc -l)" = 10 ]
    cp results/README.md page
    scripts/reproduce figure3 --budget 1e6 --seeds 2 -o results
    cmp page results/README.md
    rm results/no-env-2.tsv
    ! scripts/reproduce "${asked[@]}" 2>err || complain "a run without results was passed over"
    grep -q '^reproduce: joblog has no-env-2 as done' err
}

@test "reproduce --slurm: one task for each run that is not done, and options of sbatch pass through" {
    stand_ins
    cat >build/sbatch <<'END'
#!/bin/bash
printf '%s\n' "$@" >"$CALLS.sbatch"
echo '12;cluster'
END
    printf '#!/bin/bash\necho "$@" >>"$CALLS.squeue"\ncat in-queue 2>/dev/null\n' >build/squeue
    chmod +x build/*
    local asked=(figure3 --budget 1e6 --seeds 1 -o 'my results')
    scripts/reproduce "${asked[@]}" --run 2
    scripts/reproduce "${asked[@]}" --slurm -j 3 -- -p short --comment 'two words'
    printf '%s\n' --parsable -p short --comment 'two words' slurm.sh | cmp - calls.sbatch
    grep -qx '#SBATCH --array=1,3,4,5%3' 'my results/slurm.sh'
    [ "$(cat 'my results/slurm.job')" = 12 ]
    [ "$(trained | wc -l)" = 1 ]

    echo 12_1 >'my results/in-queue'
    status=0
    scripts/reproduce "${asked[@]}" --slurm 2>err || status=$?
    [ "$status" = 75 ]
    grep -qx -- '-h -j 12' calls.squeue

    # The script as a task of the array.
    SLURM_ARRAY_TASK_ID=4 bash 'my results/slurm.sh'
    trained | tail -n 1 | grep -qx no-disentanglement-1
    grep -qx 'So far: 2 of 5 runs.' 'my results/README.md'
    SLURM_CPUS_ON_NODE=3 scripts/reproduce "${asked[@]}" --run 1
    grep -q 'train .* -j 3 -o full-1.part' calls

    rm build/sbatch
    if ! command -v sbatch; then
        status=0
        scripts/reproduce "${asked[@]}" --slurm 2>err || status=$?
        [ "$status" = 69 ]
    fi
}

@test "reproduce: a device and a precision are those of every training and evaluation, and of the folder" {
    stand_ins
    local asked=(figure3 --budget 1e6 --seeds 1 -o results)
    scripts/reproduce "${asked[@]}" --device cuda --precision bf16
    [ "$(grep -c '^train .* --device cuda --precision bf16 ' calls)" = 5 ]
    [ "$(grep -c '^eval .* --device cuda --precision bf16 ' calls)" = 10 ]
    ! scripts/reproduce "${asked[@]}" 2>err || complain "a folder of another device was gone on with"
    grep -q '^reproduce: found .* are of --budget 1e6 -n 100 --device cuda --precision bf16: ' err
}

@test "reproduce: recipe, temperature and world are those of every training and evaluation, and of the folder" {
    stand_ins
    local asked=(figure3 --budget 1e7 --seeds 1 -o results)
    scripts/reproduce "${asked[@]}" --recipe paper --temperature 0.8 --world gridworld:mine
    [ "$(grep -c '^train .*-w gridworld:mine .* -n 4257 --recipe paper ' calls)" = 5 ]
    [ "$(grep -c '^eval .* --temperature 0$' calls)" = 5 ]
    [ "$(grep -c '^eval .* --temperature 0.8$' calls)" = 5 ]
    grep -q '^matrix split -w gridworld:mine ' calls
    grep -q '^expert .*-w gridworld:mine ' calls
    grep -q '^Recipe paper: 4257 updates of 2349 states' results/README.md
    ! scripts/reproduce "${asked[@]}" 2>err || complain "a folder of another recipe was gone on with"
}

@test "reproduce --splits: every split with every seed" {
    stand_ins
    scripts/reproduce table5 --budget 1e6 --splits 2 --seeds 2 -o results
    trained | grep synpo | sort >got
    printf '%s\n' synpo-2.1 synpo-2.2 synpo-3.1 synpo-3.2 | cmp - got
    grep -q '^train .*-p blind1.tsv -s 2 .*-o synpo-2.2.part' calls
    grep -q '^train .*-p blind2.tsv -s 1 .*-o synpo-3.1.part' calls
    [ "$(grep -c '^matrix split' calls)" = 2 ]
}

@test "reproduce --shard: an evaluation in pieces, of which none is made twice" {
    stand_ins
    scripts/reproduce small --budget 1e6 --seeds 1 -n 5 --shard 2 -o results
    grep '^eval .*synpo-1.ckpt' calls | sed 's/.*-n //' >got
    printf '%s\n' '2 --first-episode 0 --temperature 0' '2 --first-episode 2 --temperature 0' \
        '1 --first-episode 4 --temperature 0' '2 --first-episode 0' '2 --first-episode 2' '1 --first-episode 4' | cmp - got
    grep -q '^matrix merge synpo-1.from-0-2 synpo-1.from-2-2 synpo-1.from-4-1' calls
    ! ls results | grep from || complain "pieces are left"
}

@test "reproduce --shard: stopped with one length and gone on with another, no episode is left out or counted twice" {
    stand_ins
    mv build/synpo-eval build/real
    printf '#!/bin/bash\n[[ $* != *"--first-episode 2"* ]] || exit 143\nexec %q "$@"\n' "$PWD/build/real" \
        >build/synpo-eval
    chmod +x build/synpo-eval
    ! scripts/reproduce small --budget 1e6 --seeds 1 -n 5 --shard 2 -o results || complain "an evaluation that failed"
    [ -e results/synpo-1.greedy.from-0-2 ]
    mv build/real build/synpo-eval
    scripts/reproduce small --budget 1e6 --seeds 1 -n 5 --shard 3 -o results
    grep -q '^matrix merge synpo-1.greedy.from-0-3 synpo-1.greedy.from-3-2' calls
    ! ls results | grep from || complain "pieces are left"
}

@test "reproduce figure456: no two runs are the same, with splits and seeds" {
    stand_ins
    scripts/reproduce figure456 --budget 1e6 --splits 2 --seeds 2 -o results 2>/dev/null
    grep '^train ' calls | sed 's/ --save.*//' >trained
    [ "$(grep -c figure6 trained)" = 4 ]
    [ "$(wc -l <trained)" = $((4 + 2 * 9 * 4)) ]
    [ -z "$(sort trained | uniq -d)" ] || complain "$(sort trained | uniq -d)"
    grep -q '^matrix table .* synpo-figure6-1.tsv synpo-figure6-2.tsv mlp-figure6-1.tsv mlp-figure6-2.tsv' calls
}

@test "reproduce: a page says what was run" {
    stand_ins
    sed 's/expert/finetune/' build/synpo-gen-expert >build/synpo-finetune
    chmod +x build/synpo-finetune
    mkdir maps
    cp "$ROOT"/scripts/mazes/*.txt maps/
    page() {
        scripts/reproduce "$1" --budget 4e6 --seeds 1 -n 1 -o "results/$*" "${@:2}" 2>/dev/null
        cat "results/$*/README.md"
    }
    page table4 >got
    grep -q '^The paper.s are of three seeds. SF is learned by cross-entropy' got
    ! grep 'World:\|toy' got || complain "neither a world of its own nor a toy"
    page table4 --recipe paper >got
    ! grep 'cross-entropy' got || complain "recipe paper has td"
    page figure8 | grep -q 'Seeds: 1, with one split'
    page grid | grep -q 'Seeds: 1, with one split'
    page figure456 | grep -q 'own 20 pairs, the same for every seed'
    page table4 --world gridworld:maps --toy >got
    grep -qx 'World: gridworld:maps. Numbers of the paper are of its own.' got
    grep -q '^With --toy: .* Nothing has been learned' got
    ! grep '470 million' got || complain "states beside the paper's, for another world"
    grep -q 'stand in for AI2-THOR' <(page thor)
    ! grep 'stand in for AI2-THOR' <(page thor --world kitchen:maps) || complain "not the built-in kitchens"
    # A page of the second run alone has no picture of the first.
    scripts/reproduce thor --budget 4e6 --seeds 1 -n 1 -o one --run 2 2>/dev/null
    scripts/reproduce thor --budget 4e6 --seeds 1 -n 1 -o one --merge 2>/dev/null
    ! grep synpo.png one/README.md || complain "a picture that is not there"
}

@test "reproduce --world: programs are given the folder again, and the results can be carried with it" {
    stand_ins
    mkdir a
    cp -r "$ROOT/scripts/mazes" a/maps
    (cd a && ../scripts/reproduce figure3 --budget 1e6 --seeds 1 -o results --run 1 --world gridworld:maps)
    echo no-env-1 >a/results/stop
    (cd a && ! ../scripts/reproduce figure3 --budget 1e6 --seeds 1 -o results --run 2 --world gridworld:maps)
    mv a b
    (cd b && ../scripts/reproduce figure3 --budget 1e6 --seeds 1 -o results --world gridworld:maps)
    [ "$(grep -c '^train .*--resume no-env-1.save' calls)" = 1 ]
    grep -q "^train .*-w gridworld:$PWD/b/maps .*--resume no-env-1.save" calls
    ! grep '^eval' calls | grep -v -- '-w gridworld:.*/maps ' || complain "an evaluation without its mazes"
    echo >>b/maps/"$(ls b/maps | head -n 1)"
    (cd b && fails 64 ../scripts/reproduce figure3 --budget 1e6 --seeds 1 -o results --world gridworld:maps) ||
        complain "other mazes of the same name"
}

@test "reproduce: nonsense is wrong usage, and says what is right" {
    stand_ins
    for words in "table9" "common" "table4 --seeds 0" "table4 -j x" "table4 -n" "table4 --colour blue" \
        "table4 --run 0" "table4 --run" "table4 --slurm --merge" "table4 --parallel 2 --run 1" "table4 --parallel x" \
        "table4 -- -p short" "table4 --run 1 -- -p short" "common-runs" \
        "table4 --run 11 --budget 1e6" "table4 --budget 12" "table4 --recipe big" "table4 --temperature 0" "table4 --temperature warm" "table4 --splits 0" "all" \
        "table4 --limit 10" "table4 --limit 10m --run 1" "table4 --list --budget 10m" \
        "table4 --limit 10m --budget 40m -o other" "all --limit 10m --budget 10 -o other" \
        "table4 --budget some" "table4 --budget foom" "table4 --budget 1.2.3h"; do
        status=0
        # shellcheck disable=SC2086
        scripts/reproduce $words 2>err || status=$?
        [ "$status" = 64 ] || complain "$words: exit code $status, expected 64: $(cat err)"
        grep -q '^reproduce: .' err
    done
    [ -z "$(find other -type f)" ] || complain "$(find other -type f)"
    ! grep -qs '^train' calls || complain "trained: $(trained)"
    rm build/synpo-train
    status=0
    PATH=/usr/bin:/bin scripts/reproduce table4 2>err || status=$?
    [ "$status" = 69 ]
}

# Every reproduction from end to end, with the real programs and next to no training: its matrices are whole, and its
# page has its tables and its pictures.
load ../common

@test "reproduce all --toy: every name, its runs and its page" {
    mkdir tree
    cp -r "$ROOT/scripts" tree/
    ln -s "$(dirname "$(command -v synpo-train)")" tree/build
    tree/scripts/reproduce all --toy --budget 64 --seeds 1 -n 1 --limit 30m -o results 2>err || complain "$(tail err)"
    for name in table4 table5 figure456 figure3 figure8 thor grid; do
        page=results/$name/README.md
        [ -f $page ] || complain "$name has no page"
        ! grep -q 'So far' $page || complain "$name: $(grep 'So far' $page)"
        # Each picture of the page is one, and nothing on it is empty or not a number.
        grep -o '([a-z0-9-]*\.png)' $page | tr -d '()' | while read -r picture; do
            [ "$(head -c 4 "results/$name/$picture" | tail -c 3)" = PNG ] || complain "$name: no picture $picture"
        done
        # No cell is empty but those of the paper's that it has no numbers for.
        ! grep -v '^| mlp-figure6 ' $page | grep -i 'nan\||  |' || complain "$name: $(cat $page)"
        matrices=("results/$name/"*-1.greedy.tsv)
        [ $name != grid ] || matrices=(results/grid/*-[12].tsv)
        synpo-matrix summary -q "${matrices[@]}" >summary || complain "$name: matrices that are none"
    done
    grep -q '^| synpo | 1 | [0-9.]* (.* 83.3 +- 0.5 | 82.1 +- 1.5 |$' results/table4/README.md
    grep -q '^| synpo-figure6 | 1 | .* 94.5 | 32.8 |$' results/figure456/README.md
    [ "$(awk -F '\t' 'NR > 1 && $10 == 1' results/figure456/paper.tsv | wc -l)" = 20 ]
    [ "$(grep -c '^- ' results/grid/README.md)" = 5 ]
    scripts=$(tree/scripts/reproduce all --toy --budget 64 --seeds 1 -n 1 --list -o results)
    [ "$scripts" = '0 runs, 0 million states to learn from' ] || complain "$scripts"
}

@test "reproduce thor --toy: kitchens of scene files, that checkpoints do not hold" {
    mkdir tree scenes
    cp -r "$ROOT/scripts" tree/
    ln -s "$(dirname "$(command -v synpo-train)")" tree/build
    for kitchen in FloorPlan2 FloorPlan10; do /usr/bin/python3 "$ROOT/tests/cli/fake_thor.py" scenes $kitchen 1; done
    tree/scripts/reproduce thor --toy --budget 64 --seeds 1 -n 1 -o results --world kitchen:scenes 2>err ||
        complain "$(tail err)"
    grep -q '^| synpo | 1 | [0-9.]* (' results/README.md
}

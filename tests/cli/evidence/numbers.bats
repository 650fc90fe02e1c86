# The numbers of the texts are those of the matrices in lab/, and a wrong one is noticed.
load ../common

setup() {
    set_up
    mkdir copy
    cp -r "$ROOT/lab" "$ROOT/README.md" "$ROOT/RESULTS.md" copy/
}

# caught WORDS: scripts/numbers complains of just that.
caught() {
    local status=0
    "$ROOT/scripts/numbers" --root copy 2>err || status=$?
    [ "$status" = 1 ] || complain "exit code $status, expected 1: $(cat err)"
    grep -qF -- "$1" err || complain "expected '$1', found: $(cat err)"
}

@test "numbers: the texts say what the matrices say" {
    "$ROOT/scripts/numbers"
    "$ROOT/scripts/numbers" --root copy
    [ "$("$ROOT/scripts/numbers" --list | wc -l)" -gt 30 ]
}

@test "numbers: the texts are UTF-8 in every locale, and so is the list" {
    export LC_ALL=C PYTHONUTF8=0 # ASCII
    "$ROOT/scripts/numbers" --list >list
    grep -q † list
}

@test "numbers: a single run has no standard deviation, and counts have neither that nor a mean" {
    for claim in '{sd unseen forty2}' '{sd all k/n forty2,forty3}' '{mean all k/n forty2,forty3}'; do
        echo "RESULTS.md: $claim" >copy/lab/claims.txt
        caught "numbers: lab/claims.txt asks for $claim, which has no "
    done
}

@test "numbers: a wrong number in any of the texts" {
    for text in README.md RESULTS.md lab/book.md; do
        cp copy/$text kept
        # SynPo's unseen pairs of Table 4, which stand in all three.
        grep -q '92\.2\** +- 2\.3' copy/$text
        sed -i 's/92\.2\(\**\) +- 2\.3/92.3\1 +- 2.3/' copy/$text
        caught "$text does not say: "
        mv kept copy/$text
    done
    "$ROOT/scripts/numbers" --root copy
}

@test "numbers: another matrix, a row that nothing computes, and a mark that is missing" {
    # One episode more that succeeded, and the texts are wrong.
    gunzip copy/lab/forty2.tsv.gz
    awk -F '\t' 'NR == 2 { $13 -= 5 } 1' OFS='\t' copy/lab/forty2.tsv | gzip >copy/lab/forty2.tsv.gz
    caught "does not say: | the same, drawn | "
    # Of another checkpoint.
    cp "$ROOT/lab/forty3.tsv.gz" copy/lab/forty2.tsv.gz
    "$ROOT/scripts/numbers" --root copy 2>err && complain "a matrix of another checkpoint"
    grep -q 'forty2.tsv.gz is of another checkpoint' err
    cp "$ROOT/lab/forty2.tsv.gz" copy/lab/
    # Drawn actions in a greedy row.
    sed -i 's/\(greedy.*{seen \)ten2.greedy/\1ten2/' copy/lab/claims.txt
    want=$("$ROOT/scripts/numbers" --root copy --list 2>/dev/null | grep '3.4 million states, greedy' | head -n 1)
    sed -i "s%^| 3.4 million states, greedy .*%${want#*: }%" copy/RESULTS.md
    caught "stands as greedy and is drawn and greedy: | 3.4 million states, greedy"
    cp "$ROOT/lab/claims.txt" copy/lab/
    cp "$ROOT/RESULTS.md" copy/

    sed -i 's/^| 9.6 million states, greedy .*|$/&\n| made up | 99.9 \/ **99.9** | |/' copy/RESULTS.md
    caught "no claim computes this row, and it has no dagger: | made up | 99.9"
    cp "$ROOT/RESULTS.md" copy/
    sed -i '/^## SynPo and its rivals/,/^## The blind/s/†//' copy/lab/book.md
    caught "rests on logs alone, and has no dagger: | MTL | 82.1 / 72.7"
}

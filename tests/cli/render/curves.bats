load ../common
load pictures

setup_file() {
    make_inputs
    for seed in 1 2; do
        synpo-train "${TINY[@]}" -n 6 -s $seed -p pairs.tsv --log "run-$seed.log" --report 1 \
            --evaluate-every 2 --evaluate-episodes 3 <e.jsonl >/dev/null
    done
    synpo-train "${TINY[@]}" -n 2 -p pairs.tsv --log blind.log --report 1 <e.jsonl >/dev/null
}

setup() { set_up run-1.log run-2.log blind.log; }

# size_of FILE: its width and height in pixels.
size_of() { od -An -tu1 -j16 -N8 "$1" | awk '{ print $3 * 256 + $4, $7 * 256 + $8 }'; }

# table ROW...: a small log with these rows, tabs for blanks.
table() {
    printf 'update\tstates\tseconds\tstates_per_s\tpolicy\tseen_success\tunseen_success\n'
    printf '%s\n' "$@" | tr ' ' '\t'
}

@test "logs of synpo-train are drawn, against every axis, every kind of column" {
    drawn curves run-1.log
    [ "$(size_of a.png)" = "760 540" ]
    drawn curves -x states -y reward SynPo=run-1.log,run-2.log
    drawn curves -x minutes run-1.log run-2.log --mark 'unseen:82.1=paper' --title 'Two runs'
    [ "$(size_of a.png)" = "1240 540" ]
    drawn curves -x minutes --rate 100 --panels 1 --band range A=run-1.log A=run-2.log B=run-1.log --size 300x200 \
        --scale 1
    [ "$(size_of a.png)" = "300 200" ]
    for column in loss policy reward_loss env task right_move learning_rate states_per_s; do drawn curves -y $column \
        run-1.log blind.log; done
    drawn curves --pairs unseen --x-range :5 --y-range 0:50 run-1.log
}

@test "a log on standard input; every way to give runs a label" {
    synpo-render curves <run-1.log >want
    synpo-render curves - <run-1.log | cmp want -
    synpo-render curves run-1.log | cmp want -
    synpo-render curves SynPo=run-1.log,run-2.log B=run-1.log >want
    synpo-render curves SynPo=run-1.log SynPo=run-2.log B=run-1.log | cmp want -
    synpo-render curves SynPo= run-?.log B=run-1.log | cmp want -
    synpo-render curves SynPo=run-1.log,- B=run-1.log <run-2.log | cmp want -
    cp run-1.log B.log
    synpo-render curves SynPo=run-1.log,run-2.log B.log | cmp want -
    cp run-2.log lr=0.1,x.log
    cp run-2.log plain.log
    synpo-render curves lr=0.1,x.log | cmp - <(synpo-render curves plain.log)
    synpo-render curves X=lr=0.1,x.log | cmp - <(synpo-render curves X=plain.log)
    mkdir other
    cp run-2.log other/run-1.log
    # Two files of one name are two lines, not two runs.
    synpo-render curves run-1.log other/run-1.log |
        cmp - <(synpo-render curves run-1.log=run-1.log other/run-1.log=run-2.log)
}

@test "the time a log was written at does not show, except against minutes" {
    awk -F '\t' -v OFS='\t' 'NR > 1 { $4 *= 2; $5 /= 2 } 1' run-1.log >slow.log
    synpo-render curves -x states run-1.log | cmp - <(synpo-render curves -x states slow.log)
    synpo-render curves -x minutes --rate 50 run-1.log | cmp - <(synpo-render curves -x minutes --rate 50 slow.log)
    synpo-render curves -x minutes run-1.log >a
    synpo-render curves -x minutes slow.log >b
    run ! cmp -s a b
}

@test "updates done again count once, the later rows" {
    table '1 10 1 10 3 0.1 NA' '2 20 2 10 2 0.9 0.9' '2 20 1 10 2 0.4 0.3' '3 30 2 10 1 0.5 0.4' >killed.log
    table '1 10 1 10 3 0.1 NA' '2 20 2 10 2 0.4 0.3' '3 30 3 10 1 0.5 0.4' >unbroken.log
    for axis in updates states minutes; do
        synpo-render curves -x $axis killed.log | cmp - <(synpo-render curves -x $axis unbroken.log)
    done
}

@test "--log-axis and --smooth: other pictures, and a caption that says it" {
    for options in "" "--log-axis x" "--log-axis y" "--log-axis xy" "--smooth 3"; do
        # shellcheck disable=SC2086
        synpo-render curves -y policy $options run-1.log >a.png
        is_png a.png
        md5sum <a.png >>sums
    done
    [ "$(sort -u sums | wc -l)" -eq 5 ]
    synpo-render curves --smooth 3 -o a.svg run-1.log
    grep -qF '>each point the mean of the last 3 of its run<' a.svg
    synpo-render curves -y learning_rate -o a.svg run-1.log
    grep -qF '>learning rate<' a.svg
    table '1 10 1 10 3 0 0' '2 20 2 10 3 0 0' >zero.log
    fails 65 synpo-render curves --log-axis y zero.log
    says "a logarithmic axis of success (%) needs values above 0"
}

@test "broken logs: 65, with file, line and column" {
    refused() {
        local text=$1
        shift
        fails 65 synpo-render curves -o out "$@" bad.log
        says "bad.log: $text"
    }
    ln -s blind.log bad.log
    refused "no value of success in 2 rows: the run made no evaluation" -y success
    refused "line 1: no column 'nonsense'" -y nonsense
    rm bad.log
    printf 'env\ttask\na\tb\n' >bad.log
    refused "line 1: no column 'update', found 'env', 'task'"
    printf '\211PNG\032\n' >bad.log
    refused "line 1, column 1: found"
    : >bad.log
    refused "empty, expected a header line"
    table '1 10 1 10 3 nan NA' >bad.log
    refused "line 2, column 6 ('seen_success'): found 'nan', expected a rate from 0 to 1, or NA"
    table '1 10 1 10 inf 0 NA' >bad.log
    refused "line 2, column 5 ('policy'): found 'inf', expected a finite number, or NA" -y policy
    table '1 10 1 10 3 0.5 NA' '2 20 1 10 3 83.3 NA' >bad.log
    refused "line 3, column 6 ('seen_success'): found '83.3', expected a rate from 0 to 1, or NA"
    table '1 10 1 10 3 0.5 NA' $'2 20 1 10 3 \xff NA' >bad.log
    refused "line 3, column 6: found invalid UTF-8 at byte \xff"
    table '1 10 1 10 3 0.5 NA' '2 5 2 10 3 0.5 NA' >bad.log
    refused "line 3, column 2 ('states'): found '5', expected more than the 10 of the row before" -x states
    table '1 10 1 10 3 0.5' >bad.log
    refused "line 2"
    table '1 10 1 10 1e200 0.5 NA' '2 20 2 10 -1e200 0.5 NA' >bad.log
    fails 65 synpo-render curves -y policy bad.log
    says "cannot be drawn"
    table '1 10 1 10 1 0.5 NA' >early.log
    table '9 90 9 10 1 0.5 NA' >late.log
    fails 65 synpo-render curves X=early.log,late.log
    says "'X': the runs have no stretch in common"
    fails 66 synpo-render curves X=run-1.log,missing.log
    says "'missing.log'"
}

@test "wrong options: 64" {
    while read -r -a arguments; do
        fails 64 synpo-render curves "${arguments[@]}" run-1.log
    done <<'END'
-x days
--log-axis z
--smooth 0
--pairs none
--band sem
--panels 3
--rate 100
-x minutes --rate -1
-y policy --pairs seen
-y policy --panels 2
-y policy --mark seen:1=x
--pairs unseen --mark seen:1=x
--mark high
--mark train:5=x
--mark 120=x
--mark nan
--size 380
--size 380x270x
--size 60x60
--size 0x0
--x-range 5
--x-range 9:3
--y-range x:
--y-range 200:
=run-1.log
A=run-1.log,,run-2.log
A= B=run-1.log C=- -
END
    fails 64 synpo-render curves A=
    fails 64 synpo-render curves {1..8}=run-1.log
    says "8 methods, at most 7 can be told apart"
}

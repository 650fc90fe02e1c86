load common

setup_file() { make_inputs; }
setup() { set_up pairs.tsv two.tsv e.jsonl a.ckpt; }

@test "1 and 2 threads: the same checkpoint, both recipes" {
    synpo-train "${TINY[@]}" -n 4 -j 1 <e.jsonl >one
    synpo-train "${TINY[@]}" -n 4 -j 2 <e.jsonl >two
    synpo-train "${TINY[@]}" -n 4 -j 3 <e.jsonl >three
    cmp one two
    cmp one three
    synpo-train "${TINY_PAPER[@]}" -n 4 -j 1 <e.jsonl >one
    synpo-train "${TINY_PAPER[@]}" -n 4 -j 2 <e.jsonl >two
    cmp one two
}

@test "the seed decides; the log, --save and -o don't" {
    synpo-train "${TINY[@]}" -n 3 -s 7 <e.jsonl >a
    synpo-train "${TINY[@]}" -n 3 -s 7 -o b --save c --every 2 --log log.tsv --report 1 --evaluate-every 2 \
        --evaluate-episodes 2 <e.jsonl
    synpo-train "${TINY[@]}" -n 3 -s 8 <e.jsonl >d
    cmp a b
    cmp a c
    run ! cmp -s a d
}

@test "it learns: the loss falls" {
    synpo-train "${TINY[@]}" -n 40 --warm-up 5 --log log.tsv --report 10 <e.jsonl >/dev/null
    awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "policy") at = i } NR == 2 { first = $at }
        END { exit !($at < 0.8 * first) }' log.tsv
}

@test "resumed equals unbroken, both recipes, whatever the stop" {
    for tiny in TINY TINY_PAPER; do
        declare -n options=$tiny
        synpo-train "${options[@]}" -n 7 --save unbroken -p pairs.tsv <e.jsonl >/dev/null
        for stop in 1 4; do
            synpo-train "${options[@]}" -n $stop -p pairs.tsv <e.jsonl >part
            synpo-train -q --resume part -n 7 <e.jsonl >resumed
            cmp unbroken resumed
        done
    done
}

@test "resumed equals unbroken where trajectories break off before their episodes end" {
    jq -c '([(.actions | length) - 1, 6] | min) as $n | (.actions, .rewards) |= .[:$n] |
        .success = false | .terminated = false | .truncated = false' e.jsonl >cut.jsonl
    options=("${TINY[@]}" --no-fresh-starts --running 512 --memory 60 -p pairs.tsv)
    synpo-train "${options[@]}" -n 13 <cut.jsonl >unbroken
    synpo-train "${options[@]}" -n 12 <cut.jsonl >part
    synpo-train -q --resume part -n 13 <cut.jsonl | cmp - unbroken
}

@test "a resumed run continues its log" {
    synpo-train "${TINY[@]}" -n 6 --log unbroken.tsv --report 1 <e.jsonl >/dev/null
    synpo-train "${TINY[@]}" -n 3 --log log.tsv --report 1 <e.jsonl >part
    synpo-train -q --resume part -n 6 --log log.tsv --report 1 <e.jsonl >/dev/null
    # All but the times.
    cut -f 1-3,6- unbroken.tsv >want
    cut -f 1-3,6- log.tsv | cmp want -
}

@test "resuming what is done changes nothing and needs no stream" {
    synpo-train "${TINY[@]}" -n 2 <e.jsonl >a
    synpo-train -q --resume a <e.jsonl >b
    cmp a b
    synpo-train -q --resume a </dev/null >c
    cmp a c
    synpo-train -q --resume a -n 2 </dev/null >c
    cmp a c
}

@test "resuming with fewer updates than there are: 64, nothing is written" {
    synpo-train "${TINY[@]}" -n 3 <e.jsonl >three
    fails 64 synpo-train -q --resume three -n 2 -o two <e.jsonl
    says "found 2 updates in all, expected at least the 3 that the checkpoint has"
    [ ! -e two ]
}

@test "averaged weights: resumed equals unbroken, 1 and 2 threads" {
    synpo-train "${TINY[@]}" --cosine 0 --averaging 0.9 -n 5 -j 1 <e.jsonl >unbroken
    synpo-train "${TINY[@]}" --cosine 0 --averaging 0.9 -n 2 -j 2 <e.jsonl >part
    synpo-train -q --resume part -n 5 -j 2 <e.jsonl >resumed
    cmp unbroken resumed
}

@test "resuming on another stream, a shorter one or none: 65" {
    synpo-train "${TINY[@]}" -n 3 <e.jsonl >part
    tac e.jsonl >other.jsonl
    fails 65 synpo-train -q --resume part -n 5 <other.jsonl
    says "the first 22 lines are not those that the checkpoint was trained on"
    head -n 10 e.jsonl >short.jsonl
    fails 65 synpo-train -q --resume part -n 5 <short.jsonl
    says "another stream?"
    fails 65 synpo-train -q --resume part -n 5 </dev/null
}

@test "a stripped checkpoint: smaller, evaluates the same, cannot be resumed" {
    synpo-train "${TINY[@]}" -n 3 <e.jsonl >full
    synpo-train "${TINY[@]}" -n 3 --strip <e.jsonl >stripped
    [ "$(stat -c %s stripped)" -lt $(($(stat -c %s full) / 2)) ]
    [ "$(described stripped '.tensors | keys | map(select(startswith("train/"))) | length')" -eq 0 ]
    [ "$(described full '.tensors | keys | map(select(startswith("train/"))) | length')" -gt 0 ]
    synpo-eval -q -p two.tsv -n 2 <full >full.tsv
    synpo-eval -q -p two.tsv -n 2 <stripped >stripped.tsv
    cmp full.tsv stripped.tsv
    fails 65 synpo-train -q --resume stripped -n 5 <e.jsonl
    says "--init"
}

@test "--init: the weights of a checkpoint, all else fresh, another stream" {
    tac e.jsonl >other.jsonl
    # At a rate of 0 nothing moves but the statistics of batch normalisation.
    synpo-train "${TINY[@]}" -n 1 --lr 0 --init a.ckpt <other.jsonl >b.ckpt
    [ "$(described b.ckpt .updates)" -eq 1 ]
    synpo-train "${TINY[@]}" -n 1 --lr 0 <other.jsonl >fresh.ckpt
    described a.ckpt '.tensors | keys[]' >names
    [ "$(wc -l <names)" -gt 50 ]
    grep -v -e mean -e variance names >weights
    fresh=0
    while read -r name; do
        cmp <(tensor a.ckpt "$name") <(tensor b.ckpt "$name") || complain "$name differs"
        cmp -s <(tensor a.ckpt "$name") <(tensor fresh.ckpt "$name") || fresh=$((fresh + 1))
    done <weights
    [ "$fresh" -gt 20 ]
    fails 65 synpo-train "${TINY[@]}" -n 1 --basis 16 --init a.ckpt <e.jsonl
    says "method or sizes differ"
}

@test "--expect: a stream that ends too early is 65 and leaves no checkpoint" {
    fails 65 synpo-train "${TINY[@]}" -n 100 --expect 61 -o out.ckpt <e.jsonl
    says "the stream ended after 60 trajectories, expected 61"
    synpo-train "${TINY[@]}" --fill 60 -n 3 --expect 60 <e.jsonl >a
}

@test "a pair that is not seen: 65, with the line" {
    head -n 1 pairs.tsv >some.tsv
    grep '1$' pairs.tsv | head -n 2 >>some.tsv
    synpo-gen-expert -p some.tsv -n 5 >mixed.jsonl
    grep '0$' pairs.tsv | head -n 1 | sed 's/0$/1/' >>none.tsv
    cat <(head -n 1 pairs.tsv) none.tsv >unseen.tsv
    synpo-gen-expert -p unseen.tsv -n 1 >>mixed.jsonl
    fails 65 synpo-train "${TINY[@]}" -n 3 -p some.tsv <mixed.jsonl
    says "standard input: line 6: pair $(awk -F '\t' 'NR == 2 { print $1 ", " $2 }' unseen.tsv) is not in the seen set"
    synpo-train "${TINY[@]}" -n 3 <mixed.jsonl >a
}

@test "the seen pairs: those of -p, without it those that the stream brings" {
    synpo-train "${TINY[@]}" -n 1 -p pairs.tsv <e.jsonl >a
    described a '.seen[] | join("\t")' >seen
    sort seen >got
    awk -F '\t' '$3 == 1 { print $1 "\t" $2 }' pairs.tsv | sort | cmp - got
    synpo-train "${TINY[@]}" -n 1 --fill 3 <e.jsonl >b
    described b '.seen[] | join("\t")' >seen
    sort seen >got
    head -n 3 e.jsonl | jq -r '[.env, .task] | @tsv' | sort -u | cmp - got
    synpo-eval -q -n 1 -p pairs.tsv <b >m.tsv
    [ "$(awk -F '\t' '$11 == 1' m.tsv | wc -l)" -eq "$(wc -l <got)" ]
}

@test "--time is turned into a number of updates, and -n with that number repeats the run" {
    # As long as 20 updates take here, of which 5 fit at least, however slow and busy the machine is.
    small=("${TINY[@]:1}" --batch-states 1 --running 1 --warm-up 5)
    began=$EPOCHREALTIME
    synpo-train -q "${small[@]}" -n 20 <e.jsonl >counted
    took=$(awk -v began="$began" -v now="$EPOCHREALTIME" 'BEGIN { print now - began }')
    synpo-train "${small[@]}" --time "${took}s" <e.jsonl >timed 2>words
    n=$(sed -n 's/.*; -n \([0-9]*\) repeats this run.*/\1/p' words)
    [ "$n" -ge 5 ]
    [ "$(described timed .updates)" -eq "$n" ]
    synpo-train -q "${small[@]}" -n "$n" -j 1 <e.jsonl >counted
    cmp timed counted
}

@test "--time on a machine that is too slow for the first updates: no more than fit, and one at least" {
    slow=(--batch-states 1024 --fill 20 --running 1024 --memory 30)
    synpo-train "${slow[@]}" --time 0.02s <e.jsonl >timed 2>words
    n=$(sed -n 's/.*; -n \([0-9]*\) repeats this run.*/\1/p' words)
    [ "$n" -ge 1 ]
    [ "$n" -lt 50 ]
    [ "$(described timed .updates)" -eq "$n" ]
    synpo-train -q "${slow[@]}" -n "$n" -j 1 <e.jsonl >counted
    cmp timed counted
}

@test "a blank line, a missing last newline" {
    head -c -1 e.jsonl >cut.jsonl
    synpo-train "${TINY[@]}" -n 1 --fill 60 <cut.jsonl >a
    synpo-train "${TINY[@]}" -n 1 --fill 60 <e.jsonl >b
    cmp a b
    { head -n 2 e.jsonl; echo; } >blank.jsonl
    fails 65 synpo-train "${TINY[@]}" -n 1 <blank.jsonl
    says "line 3"
}

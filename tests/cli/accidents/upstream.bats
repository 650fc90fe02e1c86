load ../common

setup_file() { make_inputs; }
setup() { set_up pairs.tsv e.jsonl a.ckpt two.tsv; }

SMALL=("${TINY[@]}" -n 2 -p pairs.tsv)

@test "--end: a last line says how many came; without it the bytes are as ever; readers take either" {
    synpo-gen-expert -p pairs.tsv -n 60 -s 1 --end >ended.jsonl
    head -n 60 ended.jsonl | cmp - e.jsonl
    [ "$(tail -n 1 ended.jsonl)" = '{"format":"synpo-end","version":1,"trajectories":60}' ]
    synpo-train "${SMALL[@]}" <e.jsonl >plain.ckpt
    synpo-train "${SMALL[@]}" --expect-end <ended.jsonl >ended.ckpt
    cmp plain.ckpt ended.ckpt
    synpo-gen-expert -p two.tsv --per-pair 3 --end | tail -n 1 | jq -e '.trajectories == 6'
    synpo-gen-expert --relabel <ended.jsonl | cmp - e.jsonl
    synpo-gen-expert --relabel --end <ended.jsonl | cmp - ended.jsonl
    synpo-eval -q -c a.ckpt -p two.tsv -n 2 --record r.jsonl --end >m.tsv
    [ "$(tail -n 1 r.jsonl)" = '{"format":"synpo-end","version":1,"trajectories":4}' ]
}

@test "--expect-end: a first command that was killed between two lines is noticed: 65, no checkpoint" {
    synpo-gen-expert -p pairs.tsv -n 60 -s 1 --end >ended.jsonl
    for lines in 1 20 59 60; do
        head -n "$lines" ended.jsonl >cut.jsonl
        synpo-train "${SMALL[@]}" <cut.jsonl >goes-on.ckpt
        fails 65 synpo-train "${SMALL[@]}" --expect-end <cut.jsonl
        says "standard input: it ended after $lines trajectories, expected a last line that says its end"
        [ ! -s "$BATS_TEST_TMPDIR/out" ]
        fails 65 synpo-gen-expert --relabel --end <cut.jsonl
        fails 65 synpo-finetune adapt -q -n 1 -c a.ckpt --expect-end <cut.jsonl
    done
}

@test "kill -9 of the first command of a pipe: the trainer says so, 65, and there is no checkpoint" {
    sh -c 'echo $$ >pid; exec synpo-gen-expert -p pairs.tsv -n 100000000 -s 1 --end' | tee came |
        synpo-train "${SMALL[@]}" --expect-end -o got.ckpt 2>err &
    local pipe=$! status=0
    until [ -s came ]; do sleep 0.05; done
    kill -9 "$(cat pid)"
    wait "$pipe" || status=$?
    [ "$status" -eq 65 ]
    # The last line may be cut off.
    grep -qE "expected a last line that says its end|found no JSON" err
    [ ! -e got.ckpt ]
}

@test "lines that are missing are noticed by whoever reads to the end, wherever the end stands" {
    synpo-gen-expert -p pairs.tsv -n 60 -s 1 --end >ended.jsonl
    sed 7d ended.jsonl >missing.jsonl
    fails 65 synpo-train "${SMALL[@]}" --fill 60 --read 1 <missing.jsonl
    says "found 59 trajectories, expected 60 as its end says"
    fails 65 synpo-gen-expert --relabel <missing.jsonl
    says "found 59 trajectories, expected 60 as its end says"
    # Several streams after one another, and lines in another order, are whole.
    synpo-gen-expert -p pairs.tsv -n 5 -s 2 --end >more.jsonl
    cat ended.jsonl more.jsonl | synpo-gen-expert --relabel --end >both.jsonl
    [ "$(tail -n 1 both.jsonl | jq .trajectories)" -eq 65 ]
    tac ended.jsonl | synpo-gen-expert --relabel --end | tail -n 1 | jq -e '.trajectories == 60'
}

@test "a run that is done before the stream reads on to the end, and is resumed over ends" {
    synpo-gen-expert -p pairs.tsv -n 30 -s 1 --end >a.jsonl
    synpo-gen-expert -p pairs.tsv -n 30 -s 2 --end >b.jsonl
    cat a.jsonl b.jsonl >both.jsonl
    synpo-train "${SMALL[@]}" -n 30 --expect-end <both.jsonl >whole.ckpt
    synpo-train "${SMALL[@]}" -n 15 --save first.ckpt -o first.out <both.jsonl
    synpo-train -q --resume first.ckpt -n 30 --expect-end <both.jsonl >resumed.ckpt
    described whole.ckpt .updates | grep -qx 30
    grep -v synpo-end both.jsonl | synpo-train -q --resume first.ckpt -n 30 | cmp - resumed.ckpt
    head -n 60 both.jsonl >cut.jsonl
    fails 65 synpo-train -q --resume first.ckpt -n 16 --expect-end <cut.jsonl
    says "found 59 trajectories, expected 30"
}

@test "--end where there is none to say: 64" {
    fails 64 synpo-gen-expert -p pairs.tsv --end
    says "--end goes with -n or --per-pair"
    fails 64 synpo-eval -c a.ckpt --end
    says "--end goes with --record"
}

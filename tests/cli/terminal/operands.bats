load ../common

setup_file() {
    make_inputs
    head -n 15 e.jsonl >first.jsonl
    tail -n +16 e.jsonl >second.jsonl
}
setup() { set_up e.jsonl first.jsonl second.jsonl pairs.tsv two.tsv a.ckpt m.tsv; }

@test "synpo-eval and synpo-finetune ppo: the checkpoint as an operand, as -c, on standard input" {
    synpo-eval -q -p two.tsv -n 1 a.ckpt | cmp - m.tsv
    synpo-eval -q -p two.tsv -n 1 -c a.ckpt | cmp - m.tsv
    synpo-eval -q -p two.tsv -n 1 - <a.ckpt | cmp - m.tsv
    synpo-eval --describe a.ckpt | cmp - <(synpo-eval --describe <a.ckpt)
    tiny=(-q -p two.tsv --lanes 16 --steps 200)
    synpo-finetune ppo "${tiny[@]}" a.ckpt >operand
    synpo-finetune ppo "${tiny[@]}" <a.ckpt | cmp - operand
    fails 64 synpo-eval -c a.ckpt a.ckpt
    says "'a.ckpt' is given by --checkpoint, 'a.ckpt' as an operand: expected one of them"
    fails 64 synpo-eval a.ckpt m.tsv
    says "unexpected operand 'm.tsv'"
    fails 64 synpo-finetune ppo --init random a.ckpt
    says "a checkpoint and --init exclude each other"
}

@test "trajectories: a file, several one after the other, - among them, as one stream" {
    synpo-train "${TINY[@]}" -n 3 <e.jsonl >whole
    synpo-train "${TINY[@]}" -n 3 e.jsonl | cmp - whole
    synpo-train "${TINY[@]}" -n 3 first.jsonl second.jsonl | cmp - whole
    synpo-train "${TINY[@]}" -n 3 first.jsonl - <second.jsonl | cmp - whole
    synpo-train "${TINY[@]}" -n 3 <(cat first.jsonl) <(cat second.jsonl) | cmp - whole
    # What was read in two files is the stream that one file holds.
    synpo-train "${TINY[@]}" -n 2 first.jsonl second.jsonl >two
    synpo-train -q --resume two -n 3 e.jsonl >resumed
    synpo-train -q --resume two -n 3 first.jsonl second.jsonl | cmp - resumed
    fails 65 synpo-train --resume two -n 3 second.jsonl first.jsonl
    says "the stream of 2 files: the first"
    fails 65 synpo-train --resume two -n 3 first.jsonl
    says "first.jsonl: it ends at line"
}

@test "adapt and --relabel take files too" {
    synpo-gen-expert -p pairs.tsv -n 6 --noise 0.3 -s 2 >noisy
    head -n 2 noisy >one
    tail -n +3 noisy >other
    synpo-gen-expert --relabel <noisy >labelled
    synpo-gen-expert --relabel noisy | cmp - labelled
    synpo-gen-expert --relabel one other | cmp - labelled
    fails 64 synpo-gen-expert noisy
    says "unexpected operand 'noisy'"
    printf 'env\ttask\nmap5\tR-B\nmap6\tR-G\n' >new.tsv
    synpo-gen-expert -p new.tsv --per-pair 1 >demonstrations
    synpo-finetune adapt -q -n 2 -c a.ckpt <demonstrations >adapted
    synpo-finetune adapt -q -n 2 -c a.ckpt demonstrations | cmp - adapted
    synpo-finetune adapt -q -n 2 -c a.ckpt <(head -n 1 demonstrations) <(tail -n 1 demonstrations) | cmp - adapted
}

@test "an operand that is not there is 66 and is named, before the others are read; a folder too" {
    fails 66 synpo-eval none.ckpt
    says "'none.ckpt'"
    fails 66 synpo-train "${TINY[@]}" -n 1 e.jsonl none.jsonl
    says "cannot open 'none.jsonl': No such file or directory"
    fails 66 synpo-train "${TINY[@]}" -n 1 .
    says "it is a folder"
    fails 66 synpo-finetune ppo none.ckpt
    fails 66 synpo-finetune adapt -c a.ckpt none.jsonl
    fails 66 synpo-gen-expert --relabel e.jsonl none.jsonl
    for command in "synpo-render "{heatmap,curves,episode,embedding,policy} "synpo-matrix "{summary,show,merge,rows}; do
        # shellcheck disable=SC2086
        fails 66 $command none
        says "'none'"
    done
}

@test "a bad line is told with its file and its own number; standard input is read once; no output is an input" {
    { head -n 2 second.jsonl && echo '{}'; } >bad.jsonl
    fails 65 synpo-train "${TINY[@]}" -n 1 first.jsonl bad.jsonl
    says "bad.jsonl: line 3: "
    fails 64 synpo-train "${TINY[@]}" -n 1 - - <e.jsonl
    says "standard input can be read only once"
    cp e.jsonl mine.jsonl
    fails 64 synpo-train "${TINY[@]}" -n 1 first.jsonl mine.jsonl -o mine.jsonl
    cmp mine.jsonl e.jsonl
    fails 65 synpo-train "${TINY[@]}" -n 1 /dev/null /dev/null
    says "the stream of 2 files has no trajectory"
    fails 65 synpo-train "${TINY[@]}" -n 1 /dev/null
    says "/dev/null has no trajectory"
}

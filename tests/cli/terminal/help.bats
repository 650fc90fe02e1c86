load ../common

@test "--help fits into 80 columns in a pipe, and into the terminal's width" {
    commands >all
    tr ' ' '\n' <<<"$WITH_COMMANDS" >>all
    [ "$(wc -l <all)" -ge 26 ]
    while read -r -a command; do
        "${command[@]}" --help >text
        ! grep -nE '.{81}' text || complain "${command[*]}: wider than 80 columns"
        for columns in 60 100; do
            run -0 on_terminal "stty cols $columns; ${command[*]} --help"
            ! grep -nE ".{$((columns + 1))}" "$BATS_TEST_TMPDIR/err" || complain "${command[*]}: wider than $columns"
        done
        # However it is broken, the words are the same.
        cmp <(tr -s ' \n' '\n' <text) <(tr -s ' \n' '\n' <"$BATS_TEST_TMPDIR/err")
    done <all
}

@test "help, help COMMAND: as --help" {
    for tool in $WITH_COMMANDS; do
        "$tool" --help >whole
        "$tool" help | cmp - whole
        for command in $(awk '/^  [a-z]/ { print $1 }' whole); do
            "$tool" "$command" --help >one
            "$tool" help "$command" | cmp - one
        done
        fails 64 "$tool" help no-such-command
        says "unknown command 'no-such-command'"
        fails 64 "$tool" help a b
    done
}

@test "a command, an option or a name that is misspelled is guessed" {
    fails 64 synpo-matrix sumary
    says "unknown command 'sumary' (did you mean 'summary'?); try 'synpo-matrix --help'"
    fails 64 synpo-matrix help spilt
    says "(did you mean 'split'?)"
    fails 64 synpo-render heatmpa
    says "(did you mean 'heatmap'?)"
    fails 64 synpo-train --evalute-every 3
    says "unknown option '--evalute-every' (did you mean '--evaluate-every'?)"
    fails 64 synpo-gen-expert --no-of 3
    run ! grep -q "did you mean" "$BATS_TEST_TMPDIR/err"
    fails 64 synpo-render map mpa3
    says "no maze 'mpa3' in this world (did you mean 'map3'?)"
    fails 64 synpo-render view -t R_B
    says "(did you mean 'R-B'?)"
    fails 64 synpo-render view -w kitchen -t Mug-Snik
    says "(did you mean 'Mug-Sink'?)"
    fails 64 synpo-matrix split --envs mpa3,map4
    says "(did you mean 'map3'?)"
    printf 'env\ttask\nmap1\tR-B\nmpa2\tR-B\n' >pairs.tsv
    fails 65 synpo-gen-expert -p pairs.tsv -n 1
    says "(did you mean 'map2'?)"
    fails 64 synpo-gen-expert -n 1 -w gridwrold
    says "(did you mean 'gridworld'?)"
}

@test "options may be spelled as in America" {
    printf 'env\ttask\tseen\tepisodes\tsuccesses\nmap1\tR-B\t1\t2\t1\n' >m.tsv
    synpo-matrix show --colour always m.tsv >here
    synpo-matrix show --color always m.tsv | cmp - here
    fails 64 synpo-matrix show --color pink m.tsv
    says "option --colour: found 'pink'"
    synpo-matrix split --envs 2 --tasks 3 -n 5 >pairs.tsv
    synpo-gen-expert -p pairs.tsv -n 20 >e.jsonl
    synpo-train "${TINY[@]}" -n 1 --strip --no-normalize-input --normalize-embeddings <e.jsonl >american
    synpo-train "${TINY[@]}" -n 1 --strip --no-normalise-input --normalise-embeddings <e.jsonl | cmp - american
}

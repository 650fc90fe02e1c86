load common

setup_file() { make_inputs; }

# Lines "SHORT LONG ARGUMENT" of a --help text: - where there is no letter, or no argument. An option that is on or off
# stands there with its first name.
options_of() {
    help_of "$@" | sed -nE \
        's/^ {2}(-[A-Za-z0-9]|   ),? +?--([a-z0-9-]+)(, --no-[a-z0-9-]+)?( ([^ ]+))?( .*)?$/\1|--\2|\5/p' |
        awk -F '|' '{ gsub(/ /, "", $1); print ($1 == "" ? "-" : $1), $2, ($3 == "" ? "-" : $3) }'
}

@test "every option of every command that takes an argument refuses an empty one: 64, and what it found" {
    commands >all
    [ "$(wc -l <all)" -ge 23 ]
    count=0
    while read -r -a command; do
        options_of "${command[@]}" >options
        # Every line of --help that begins with an option has been read.
        [ "$(wc -l <options)" -eq "$(help_of "${command[@]}" | grep -cE '^  (-[A-Za-z0-9]|   ),? *--')" ]
        while read -r short long argument; do
            [ "$argument" != - ] || continue
            fails 64 "${command[@]}" "$long" ''
            says "option $long: found '', expected "
            fails 64 "${command[@]}" "$long="
            says "option $long: found '', expected "
            count=$((count + 1))
            [ "$short" != - ] || continue
            fails 64 "${command[@]}" "$short" ''
            says "option $long: found '', expected "
        done <options
    done <all
    [ "$count" -ge 180 ]
}

@test "an empty argument leaves the run that it should have resumed as it was" {
    cp "$BATS_FILE_TMPDIR"/{e.jsonl,pairs.tsv} .
    synpo-train "${TINY[@]}" -n 2 --save run.ckpt --log run.log <e.jsonl >/dev/null
    synpo-train "${TINY[@]}" -n 2 <e.jsonl >kept
    cp run.log kept.log
    fails 64 synpo-train --resume '' --save run.ckpt --log run.log -o out.ckpt -q -n 4 <e.jsonl
    says "option --resume: found '', expected FILE"
    cmp run.ckpt kept
    cmp run.log kept.log
    fails 64 synpo-gen-expert -p "$UNSET" -n 3
    says "option --pairs: found '', expected FILE"
}

@test "every option without an argument refuses a value: 64" {
    commands >all
    count=0
    while read -r -a command; do
        options_of "${command[@]}" >options
        help_of "${command[@]}" >help
        while read -r short long argument; do
            [ "$argument" = - ] || continue
            if grep -q -- "  $long, --no-${long#--}" help; then
                fails 64 "${command[@]}" "$long=2"
                says "option $long: found '2', expected 0 or 1"
                fails 64 "${command[@]}" "$long" 2
                says "option $long: found '2', expected 0 or 1"
                long=--no-${long#--}
            fi
            fails 64 "${command[@]}" "$long=1"
            says "option $long takes no value, found '1'"
            count=$((count + 1))
            [ "$short" != - ] || continue
            fails 64 "${command[@]}" "$short=1"
            says "option $short takes no value, found '1'"
        done <options
    done <all
    [ "$count" -ge 40 ]
}

@test "an ambiguous abbreviation lists what it may be; a clear one is read" {
    fails 64 synpo-train -q --se 3
    says "ambiguous option '--se': --seed or --seam"
    fails 64 synpo-finetune ppo --re=3
    says "ambiguous option '--re': --resume, --report or --reward-loss"
    fails 64 synpo-matrix summary --t x --tv
    synpo-gen-expert --cou 2 --se 7 >a
    synpo-gen-expert -n 2 -s 7 | cmp - a
    fails 64 synpo-gen-expert --se
    says "option --seed needs an argument"
}

@test "a number out of range, or none, is told the range" {
    for bad in 0 1e20 99999999999999999999 many; do
        fails 64 synpo-eval -n "$bad"
        says "option --count: found '$bad', expected a whole number from 1 to 100000000"
    done
    for bad in 2 -0.5 nan most; do
        fails 64 synpo-gen-expert --noise "$bad"
        says "option --noise: found '$bad', expected a number from 0 to 1"
    done
    fails 64 synpo-train --roll-in 1.5
    says "option --roll-in: found '1.5', expected a number from 0 to 1"
    fails 64 synpo-finetune ppo --lanes 5000
    says "option --lanes: found '5000', expected a whole number from 1 to 4096"
    fails 64 synpo-matrix split -n -3
    says "option --seen: found '-3', expected a whole number from 0 to 9223372036854775807"
    fails 64 synpo-matrix rows -n 0
    says "option --count: found '0', expected a whole number from 1 to 9223372036854775807"
}

@test "POSIXLY_CORRECT changes nothing" {
    synpo-matrix summary "$BATS_FILE_TMPDIR/m.tsv" --tsv >want
    POSIXLY_CORRECT=1 synpo-matrix summary "$BATS_FILE_TMPDIR/m.tsv" --tsv | cmp - want
    fails 66 synpo-matrix summary -- "$BATS_FILE_TMPDIR/m.tsv" --tsv
    says "'--tsv'"
}

@test "--x and --no-x, the older spelling 1 and 0, and a file that says either" {
    cp "$BATS_FILE_TMPDIR/e.jsonl" .
    for name in cosine fresh-starts normalise-input normalise-embeddings; do
        synpo-train "${TINY[@]}" -n 1 --strip "--$name" <e.jsonl >on
        synpo-train "${TINY[@]}" -n 1 --strip "--no-$name" <e.jsonl >off
        synpo-train "${TINY[@]}" -n 1 --strip "--$name" 1 <e.jsonl | cmp - on
        synpo-train "${TINY[@]}" -n 1 --strip "--$name=1" <e.jsonl | cmp - on
        synpo-train "${TINY[@]}" -n 1 --strip "--$name" 0 <e.jsonl | cmp - off
        synpo-train "${TINY[@]}" -n 1 --strip "--$name=0" <e.jsonl | cmp - off
        synpo-train "${TINY[@]}" -n 1 --strip "--$name" "--no-$name" <e.jsonl | cmp - off
        [ "$(described on ".options[\"$name\"]")" = 1 ]
        [ "$(described off ".options[\"$name\"]")" = 0 ]
    done
}

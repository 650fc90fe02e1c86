# Scripts called as people call them: with arguments that are wrong or missing, from another folder, through a link, in
# folders of any name.
load ../common

setup() {
    set_up
    tree="$PWD/it's \"a\" tree
of two lines"
    mkdir "$tree"
    cp -r "$ROOT/scripts" "$tree/"
    ln -s "$(dirname "$(command -v synpo-train)")" "$tree/build"
    small=(small --toy --budget 64 --seeds 1 -n 1)
}

# refused CODE WORDS COMMAND...: the exit code, the words, and nothing that was made.
refused() {
    local code=$1 words=$2 status=0 before
    shift 2
    before=$(here)
    "$@" >"$BATS_TEST_TMPDIR/out" 2>"$BATS_TEST_TMPDIR/err" || status=$?
    [ "$status" = "$code" ] || complain "$*: exit code $status, expected $code: $(cat "$BATS_TEST_TMPDIR/err")"
    says "$words"
    [ "$(here)" = "$before" ] || complain "$*: left files"
}

@test "reproduce: a value that is missing, empty or nonsense is wrong usage, and nothing is made" {
    for option in --budget --seeds --splits -j -n -o --temperature --recipe --world --shard --limit --device --run; do
        refused 64 "reproduce: $option needs a value" "$tree/scripts/reproduce" small $option ''
        refused 64 "reproduce: $option needs a value" "$tree/scripts/reproduce" small $option
    done
    for budget in 64abc 1,000 1e 10M 1h30m 0x100 -5; do
        refused 64 "found --budget $budget, expected" "$tree/scripts/reproduce" small --budget $budget
    done
    refused 64 "unexpected 'more'" "$tree/scripts/reproduce" small --list more
    for name in ../reproduce ./small ../demo small/ ''; do
        refused 64 "unknown name '$name', expected one of: figure3 " "$tree/scripts/reproduce" "$name"
    done
    "$tree/scripts/reproduce" small -h | cmp - <("$tree/scripts/reproduce" --help)
    touch file
    refused 73 "cannot create directory 'file'" "$tree/scripts/reproduce" "${small[@]}" -o file
    refused 73 "cannot create directory 'file'" "$tree/scripts/reproduce" "${small[@]}" --limit 9s -o file
}

@test "reproduce: the status of the run that failed is its own" {
    local status=0
    "$tree/scripts/reproduce" "${small[@]}" --precision none -o results 2>err || status=$?
    [ "$status" = 64 ] || complain "exit code $status: $(cat err)"
    [[ $(tail -n 1 err) == "synpo-train: option --precision: found 'none'"* ]] || complain "$(cat err)"
}

@test "reproduce: through a link, with CDPATH, from another folder, into folders of any name" {
    mkdir -p elsewhere/scripts elsewhere/NUMBER
    ln -s "$tree/scripts/reproduce" linked
    cp -r "$ROOT/scripts/mazes" mazes
    export CDPATH=$PWD/elsewhere
    for folder in "it's NUMBER {}" - -x; do
        ./linked "${small[@]}" --world gridworld:mazes -o "$folder" >said 2>err || complain "$folder: $(cat err)"
        [ -s "./$folder/README.md" ] || complain "$folder: $(here)"
        synpo-eval --describe "./$folder/synpo-1.ckpt" | jq -r '.envs[].name' | cmp - <(printf 'map%d\n' 1 2 3 4 5 6)
    done
    [ "$(here | grep -c '\.ckpt$')" = 6 ]
    TMPDIR=$PWD ./linked "${small[@]}" --world gridworld:mazes --limit 1h -o limited 2>err || complain "$(cat err)"
    grep -qx "The page: $PWD/limited/small/README.md" err || complain "$(cat err)"
    TMPDIR=$PWD/nowhere refused 73 "no folder for the work: TMPDIR" ./linked "${small[@]}" --limit 1h -o limited
    "$tree/scripts/check-order" "$ROOT"
}

@test "numbers, setup and demo: what they do not know is refused" {
    refused 64 "numbers: found '--lst', expected --list or --root DIR" "$ROOT/scripts/numbers" --lst
    refused 64 "numbers: found '--root'" "$ROOT/scripts/numbers" --root
    refused 66 "numbers: " "$ROOT/scripts/numbers" --root nowhere
    refused 64 "usage: scripts/setup" "$tree/scripts/setup" --help
    refused 64 "usage: scripts/demo" "$tree/scripts/demo" --help
}

load ../common

setup_file() { make_inputs; }
setup() {
    set_up m.tsv e.jsonl
    export TERM=xterm-256color COLORTERM='' NO_COLOR=''
}

# What may be coloured, one command a line.
COLOURED="synpo-matrix show m.tsv
synpo-matrix summary m.tsv
synpo-render heatmap --ansi m.tsv
synpo-render map --ansi map1
synpo-render episode --ansi e.jsonl"

has_colour() { grep -q "$(printf '\033\\[38;5;')" "$1"; }

@test "one rule for colour: a terminal has it, a pipe, NO_COLOR and TERM=dumb have none, --colour decides" {
    while read -r command; do
        $command >plain
        ! has_colour plain || complain "$command: colour in a pipe"
        $command --colour always >always
        has_colour always || complain "$command: no colour with --colour always"
        NO_COLOR=1 TERM=dumb $command --color=always | cmp - always
        run -0 on_terminal "stty cols 200; $command"
        cmp "$BATS_TEST_TMPDIR/err" always || complain "$command: other colours on a terminal"
        run -0 on_terminal "stty cols 200; $command --colour auto"
        cmp "$BATS_TEST_TMPDIR/err" always
        for setting in "NO_COLOR=1 $command" "TERM=dumb $command" "TERM= $command" "$command --color never"; do
            run -0 on_terminal "stty cols 200; $setting"
            cmp "$BATS_TEST_TMPDIR/err" plain || complain "$setting: not as in a pipe"
        done
        $command -o file
        cmp file plain
        # shellcheck disable=SC2086
        fails 64 $command --colour blue
        says "option --colour: found 'blue', expected auto, always or never"
    done <<<"$COLOURED"
}

@test "summary: the name of each subset has the colour of its pairs, as dark as their success; tables have none" {
    printf 'env\ttask\tseen\tepisodes\tsuccesses\na\tx\t1\t10\t10\nb\tx\t0\t10\t0\n' >hand.tsv
    synpo-matrix summary --colour always hand.tsv | sed 's/\x1b\[[0-9;]*m//g' >stripped
    synpo-matrix summary hand.tsv | cmp - stripped
    COLORTERM=truecolor synpo-matrix summary --colour always hand.tsv >true
    grep -q "$(printf '^\033\\[38;5;231;48;2;[0-9;]*mseen\033\\[0m  ')" true
    grep -q "$(printf '^\033\\[38;5;16;48;2;[0-9;]*munseen\033\\[0m')" true
    synpo-matrix summary --tsv hand.tsv >table
    run -0 on_terminal "stty cols 400; synpo-matrix summary --tsv hand.tsv"
    cmp "$BATS_TEST_TMPDIR/err" table
    run ! has_colour table
}

load ../common

setup_file() {
    cd "$BATS_FILE_TMPDIR" || exit
    make_inputs
    synpo-train "${TINY[@]}" -n 6 --report 1 --log plain.log e.jsonl >/dev/null
    synpo-train "${TINY[@]}" -n 6 --report 1 --evaluate-every 2 --evaluate-episodes 4 --log evaluated.log e.jsonl \
        >/dev/null
}
setup() {
    set_up plain.log evaluated.log pairs.tsv e.jsonl
    {
        echo update states seconds states_per_s episodes success reward policy seen_success unseen_success | tr ' ' '\t'
        for i in 1 2 3 4; do printf '%d\t%d\t%d\t100\t5\t0.%d\t%d.5\t0.01\tNA\tNA\n' "$i" "${i}00" "$i" "$i" "$i"; done
    } >ppo.log
}

teardown() {
    TMUX_TMPDIR=$BATS_TEST_TMPDIR tmux -L synpo kill-server 2>/dev/null || true
}

@test "curves --ansi: text of the terminal's size, braille where characters are UTF-8, marks elsewhere" {
    synpo-render curves --ansi evaluated.log >text
    [ "$(wc -l <text)" -eq 23 ]
    run ! grep -nE '.{81}' text
    run ! grep -q '[^ -~]' text
    grep -qE '^\* seen [0-9.]+ %   o unseen [0-9.]+ %$' text
    LC_ALL=C.UTF-8 synpo-render curves --ansi --colour always evaluated.log >braille
    grep -qa $'\xe2\xa0' braille
    # Without colours each of two curves has its mark on the braille.
    LC_ALL=C.UTF-8 synpo-render curves --ansi evaluated.log >marks
    grep -qaE $'\xe2[\xa0-\xa3]' marks
    tail -n 1 marks | grep -qE '^\* seen [0-9.]+ %   o unseen [0-9.]+ %$'
    for size in "40 12" "132 43"; do
        run -0 on_terminal "stty cols ${size% *} rows ${size#* }
            synpo-render curves --ansi --colour never evaluated.log"
        [ "$(wc -l <"$BATS_TEST_TMPDIR/err")" -eq $((${size#* } - 1)) ]
        run ! grep -nE ".{$((${size% *} + 1))}" "$BATS_TEST_TMPDIR/err"
    done
    synpo-render curves --ansi --colour always evaluated.log | sed 's/\x1b\[[0-9;]*m//g' | cmp - text
    fails 64 synpo-render curves --ansi --size 300x200 evaluated.log
    says "--size is for a picture, not for --ansi"
}

@test "values stand where they belong" {
    printf 'update\tloss\n1\t0\n2\t10\n3\t0\n' >hand.log
    synpo-render curves --ansi -y loss hand.log >text
    # 74 columns beside the labels: the first and the last point lie on the lowest line, at its ends, the middle one on
    # the highest, in the 37th and 38th column.
    [ "$(sed -n 2p text)" = "10.0 |$(printf '%36s' '')**" ]
    sed -n 20p text | grep -qE '^ 0\.0 \|\*.{72}\*$'
    tail -n 1 text | grep -qx '\* 0'
}

@test "a log's own columns: PPO's where nothing was evaluated, or with --pairs training; else the policy's loss" {
    synpo-render curves --ansi ppo.log >text
    head -n 1 text | grep -qx "nothing was evaluated: this is of the episodes that the training played"
    sed -n 2p text | grep -qx "success (%) in training"
    tail -n 1 text | grep -qx '\* 40 %'
    synpo-render curves --ansi -y success ppo.log | cmp - text
    synpo-render curves --ansi -y success --pairs training ppo.log >own
    diff <(tail -n 5 own) <(tail -n 5 text)
    synpo-render curves --ansi -y reward ppo.log | tail -n 1 | grep -qx '\* 4.5'
    synpo-render curves -y success -o own.png ppo.log 2>note
    grep -qx "synpo-render: note: nothing was evaluated: this is of the episodes that the training played" note
    synpo-render curves --ansi plain.log >text
    head -n 1 text | grep -qx "nothing was evaluated: this is the loss of the policy"
    synpo-render curves plain.log >picture.png 2>note
    [ -s picture.png ]
    fails 65 synpo-render curves -y success plain.log
    says "no value of success in 6 rows: the run made no evaluation"
    fails 65 synpo-render curves --pairs training plain.log
    says "this training played no episodes"
}

# follow COMMAND: runs it on a terminal of its own, 80 x 24.
follow() {
    export TMUX_TMPDIR=$BATS_TEST_TMPDIR
    unset TMUX
    tmux -f /dev/null -L synpo new-session -d -x 80 -y 24 "env LC_ALL=C PS1='> ' bash --norc"
    tmux -L synpo send-keys "cd '$PWD'; PATH='$PATH'; clear; $1; echo code \$?" Enter
}

# shows TEXT: waits until the terminal does.
shows() {
    for ((i = 0; i < 400; ++i)); do
        ! tmux -L synpo capture-pane -p | grep -qE -- "$1" || return 0
        sleep 0.05
    done
    complain "'$1' does not come: $(tmux -L synpo capture-pane -p)"
}

@test "--follow: waits for a log, draws it as it grows, past a row that is cut off and another log in its place" {
    command -v tmux >/dev/null || skip "no tmux"
    follow "synpo-render curves --follow -y loss run.log"
    shows "waiting: cannot open 'run.log'"
    printf 'update\tlo' >run.log
    shows "waiting: run.log: empty"
    printf 'ss\n1\t5\n' >>run.log
    shows '^\* 5$'
    printf '2\t7\n3\t9' >>run.log
    shows '^\* 7$'
    printf '1\n' >>run.log
    shows '^\* 91$'
    printf 'update\tloss\n1\t3\n' >other
    mv other run.log
    shows '^\* 3$'
    : >run.log
    shows "waiting: run.log: empty"
    printf 'update\tloss\n1\t4\n' >run.log
    shows '^\* 4$'
    tmux -L synpo resize-window -x 60 -y 16
    shows '^\* 4$'
    tmux -L synpo send-keys C-c
    shows '^code 130$'
    tmux -L synpo capture-pane -p >screen
    # What was drawn last stays above the shell's words.
    grep -qx '\* 4' screen
    run ! grep -nE '.{61}' screen
}

@test "--follow beside a training that runs" {
    command -v tmux >/dev/null || skip "no tmux"
    synpo-train --batch-states 64 --fill 20 --running 64 --memory 30 -q -n 12 --report 1 --log run.log -o x e.jsonl &
    follow "synpo-render curves --follow -y loss run.log"
    wait $!
    last=$(tail -n 1 run.log | cut -f 7)
    shows "^\* $(printf '%.3g' "$last")$"
    tmux -L synpo send-keys C-c
    shows '^code 130$'
}

@test "--follow where it cannot be: 64" {
    fails 64 synpo-render curves --follow plain.log
    says "--follow draws on a terminal"
    fails 64 synpo-render curves --follow
    says "--follow needs logs that are files"
}

@test "heatmap and show of a split: pairs in the colours of their kinds" {
    synpo-matrix show pairs.tsv >text
    # The marks are as many as the file's rows, of either kind.
    [ "$(head -n 4 text | grep -o '#' | wc -l)" -eq 5 ]
    [ "$(head -n 4 text | grep -o '\.' | wc -l)" -eq 4 ]
    grep -qx '# seen: 5 pairs' text
    grep -qx '\. unseen: 4 pairs' text
    synpo-render heatmap --ansi pairs.tsv | cmp - text
    synpo-matrix show --colour always pairs.tsv >coloured
    grep -qE 'seen: 5 pairs' coloured
    synpo-render heatmap pairs.tsv >split.png
    synpo-render heatmap <pairs.tsv | cmp - split.png
    synpo-matrix split --setting 2 | synpo-render heatmap --by part >parts.png
    [ -s parts.png ]
    fails 65 synpo-matrix show pairs.tsv pairs.tsv
    says "found pairs without episodes, expected a success matrix"
    fails 65 synpo-matrix summary pairs.tsv
    says "no column 'episodes'"
    printf 'env\ttask\nmap1\tR-B\n' >no_seen.tsv
    fails 65 synpo-matrix show no_seen.tsv
    says "no column 'episodes'"
}

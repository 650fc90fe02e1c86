load ../common

setup_file() {
    cd "$BATS_FILE_TMPDIR" || exit
    for tool in $TOOLS; do
        for shell in bash zsh fish; do "$ROOT/scripts/completions" $shell "$(command -v "$tool")" >"$tool.$shell"; done
    done
}
setup() {
    set_up
    # shellcheck disable=SC1090
    for tool in $TOOLS; do source "$BATS_FILE_TMPDIR/$tool.bash"; done
}

# completed WORD...: what bash offers for the last word of a command line, one a line, sorted. Where it leaves the word
# to file names, as bash does outside of readline, it is "files".
completed() {
    compopt() { echo files; }
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
    COMPREPLY=()
    "_${1//-/_}" "$1"
    [ ${#COMPREPLY[@]} -eq 0 ] || printf '%s\n' "${COMPREPLY[@]}" | sort
}

@test "bash, zsh and fish complete every option that --help has, and no other" {
    commands >all
    [ "$(wc -l <all)" -ge 23 ]
    while read -r -a command; do
        "${command[@]}" --help | help_options >in_help
        completed "${command[@]}" - >offered
        of_command=${command[1]+"seen_subcommand_from ${command[1]}."}
        diff in_help offered
        for shell in zsh fish; do
            of=$BATS_FILE_TMPDIR/${command[0]}.$shell
            case $shell in
                zsh) awk -v command="${command[1]-}" '
                    command != "" && $1 == command ")" { inside = 1 }
                    command == "" || inside
                    $1 == ";;" { inside = 0 }' "$of" | grep -oE -- "(^ +'--?|[{,]--?)[a-z0-9][a-z0-9-]*" |
                    grep -oE -- '--?[a-z0-9][a-z0-9-]*$' ;;
                fish) grep -E -- "^complete .*$of_command" "$of" | grep -vF -- ' -a help' |
                    grep -oE -- ' -(s [a-zA-Z]|l [a-z0-9-]+)' | sed 's/ -s /-/; s/ -l /--/' ;;
            esac | sort -u >offered
            diff in_help offered || complain "${command[*]}: $shell"
        done
    done <all
}

@test "bash: commands, words that an argument may be, files, folders, nothing where nobody can guess" {
    for tool in synpo-matrix synpo-render synpo-finetune; do
        { "$tool" --help | awk '/^  [a-z]/ { print $1 }' && echo help; } | sort | cmp - <(completed "$tool" '')
        { "$tool" --help | awk '/^  [a-z]/ { print $1 }' && echo help; } | sort | cmp - <(completed "$tool" help '')
    done
    [ "$(completed synpo-matrix su)" = summary ]
    [ "$(completed synpo-matrix table -f '' | tr '\n' ' ')" = "latex markdown text tsv " ]
    [ "$(completed synpo-matrix table --format = ma)" = markdown ]
    [ "$(completed synpo-matrix show --colour '' | tr '\n' ' ')" = "always auto never " ]
    [ "$(completed synpo-render heatmap --scheme p)" = purple-red ]
    [ "$(completed synpo-train -m m | tr '\n' ' ')" = "mlp modulenet mtl " ]
    [ "$(completed synpo-train --recipe '' | tr '\n' ' ')" = "fast paper " ]
    [ "$(completed synpo-eval --device '' | tr '\n' ' ')" = "cpu cuda torch-cpu " ]
    [ "$(completed synpo-render curves -y r | tr '\n' ' ')" = "reward reward_loss right_move right_pick " ]
    [ "$(completed synpo-gen-expert -w '' | tr '\n' ' ')" = "gridworld kitchen " ]
    [ "$(completed synpo-train --save '')" = files ]
    [ "$(completed synpo-eval '')" = files ]
    [ "$(completed synpo-matrix summary '')" = files ]
    [ -z "$(completed synpo-train -n '')" ]
    [ -z "$(completed synpo-train --lr '')" ]
    mkdir one two
    touch three
    [ "$(completed synpo-render episode --frames '' | tr '\n' ' ')" = "one two " ]
    [ "$(completed synpo-train --evaluate-e | tr '\n' ' ')" = "--evaluate-episodes --evaluate-every " ]
}

@test "the shells that are here read their files" {
    for tool in $TOOLS; do
        bash -n "$BATS_FILE_TMPDIR/$tool.bash"
        ! command -v zsh >/dev/null || zsh -n "$BATS_FILE_TMPDIR/$tool.zsh"
        ! command -v fish >/dev/null || fish --no-execute "$BATS_FILE_TMPDIR/$tool.fish"
    done
    run -64 "$ROOT/scripts/completions" tcsh synpo-train
    run -64 "$ROOT/scripts/completions" bash
}

@test "bash: in a shell of its own, as a user types it" {
    command -v tmux >/dev/null || skip "no tmux"
    export TMUX_TMPDIR=$BATS_TEST_TMPDIR
    unset TMUX
    tmux -f /dev/null -L synpo new-session -d -x 80 -y 24 "env PS1='> ' bash --norc"
    tmux -L synpo send-keys "source $BATS_FILE_TMPDIR/synpo-matrix.bash" Enter
    tmux -L synpo send-keys "synpo-matrix ta" Tab "--fo" Tab "ma" Tab
    for ((i = 0; i < 200; ++i)); do
        ! tmux -L synpo capture-pane -p | grep -q "^> synpo-matrix table --format markdown" || break
        sleep 0.05
    done
    tmux -L synpo capture-pane -p >screen
    tmux -L synpo kill-server
    grep -q "^> synpo-matrix table --format markdown" screen || complain "$(cat screen)"
}

@test "fish: commands, help's too, and words" {
    for tool in $WITH_COMMANDS; do
        "$tool" --help | awk '/^  [a-z]/ { print $1 }' | sort >want
        sed -nE "s/^complete -c $tool -n '__fish_seen_subcommand_from help' -f -a ([a-z]+) .*/\1/p" \
            "$BATS_FILE_TMPDIR/$tool.fish" | sort | cmp - want
    done
    command -v fish >/dev/null || skip "no fish"
    offered() { HOME=$PWD fish -c "source $BATS_FILE_TMPDIR/${1%% *}.fish; complete -C '$1'" | cut -f 1 | sort; }
    offered "synpo-render help " | cmp - want
    [ "$(offered "synpo-matrix su")" = summary ]
    [ "$(offered "synpo-train -m m" | tr '\n' ' ')" = "mlp modulenet mtl " ]
}

load common

# The commands that have a --help of their own.
COMMANDS=(synpo-gen-expert synpo-train synpo-finetune "synpo-finetune adapt" "synpo-finetune ppo"
    "synpo-finetune strip" synpo-eval
    synpo-matrix synpo-render "synpo-matrix split" "synpo-matrix summary"
    "synpo-matrix table" "synpo-matrix compare" "synpo-matrix rows" "synpo-matrix cols" "synpo-matrix show"
    "synpo-matrix filter"
    "synpo-matrix wide" "synpo-matrix merge" "synpo-render heatmap" "synpo-render curves" "synpo-render map"
    "synpo-render view"
    "synpo-render episode" "synpo-render embedding" "synpo-render policy" "synpo-render features")

# Options in a man page: of the list items ("It") or of the synopsis ("synopsis", or that of one command).
man_options() {
    awk -v what="$2" -v command="${3-}" '
        function options(   i, n, word, in_flag) {
            n = split(substr($0, 2), word, " ")
            for (i = 1; i <= n; ++i) {
                if (word[i] == "Fl") in_flag = 1
                else if (word[i] ~ /^[A-Z][a-z]$/) in_flag = 0
                else if (in_flag && word[i] ~ /[a-zA-Z0-9]/) print "-" word[i]
            }
        }
        /^\.Sh/ { synopsis = $2 == "SYNOPSIS" }
        /^\.Nm/ { now = "" }
        /^\.Cm/ { now = $2 }
        what == "It" && /^\.It/ { options() }
        what == "synopsis" && synopsis && /^\./ && (command == "" || now == command) { options() }' "$1" | sort -u
}

@test "--help: on stdout, 0, and it names the tool" {
    for command in "${COMMANDS[@]}"; do
        $command --help >out 2>err
        head -n 1 out | grep -q "^usage: $command"
        [ ! -s err ]
        $command -h >short
        cmp out short
    done
}

@test "--version: on stdout, 0, name and number" {
    for command in "${COMMANDS[@]}"; do
        $command --version >out 2>err
        grep -qxE "${command%% *} \(synpo\) [0-9]+\.[0-9]+\.[0-9]+( \(git [0-9a-f]{7,}(, modified)?\))?" out
        [ "$(wc -l <out)" -eq 1 ]
        [ ! -s err ]
    done
}

@test "an unknown option is 64 and is named" {
    for command in "${COMMANDS[@]}"; do
        # shellcheck disable=SC2086
        fails 64 $command --no-such-option
        says "--no-such-option"
        # shellcheck disable=SC2086
        fails 64 $command -X
        says "-X"
    done
}

@test "a missing or unknown command, an operand too many, an argument that is not a number: 64" {
    for tool in synpo-matrix synpo-render synpo-finetune; do
        fails 64 "$tool"
        fails 64 "$tool" no-such-command
        says "no-such-command"
    done
    fails 64 synpo-gen-expert operand
    says "operand"
    fails 64 synpo-gen-expert -n
    says "-n"
    for bad in x 1.5 -1 '' 99999999999999999999; do
        fails 64 synpo-gen-expert -n "$bad"
        says "--count"
    done
    fails 64 synpo-gen-expert -n 1 --noise 1.1
    fails 64 synpo-gen-expert -n 1 --per-pair 1
    fails 64 synpo-gen-expert --relabel -n 1
    fails 64 synpo-gen-expert -n 1 -w atari
    says "atari"
    fails 64 synpo-eval -n 0
    fails 64 synpo-train -n 0
    fails 64 synpo-train -n 1 --time 5s
    fails 64 synpo-train --time 5parsecs
    fails 64 synpo-train -n 1 --recipe slow
    fails 64 synpo-train -n 1 --lr -1
    says "--lr"
    fails 64 synpo-train -n 1 --recipe paper --roll-in 0.5
    fails 64 synpo-train --resume x --lr 0.1
    fails 64 synpo-matrix split -n 3 --ratio 0.5
    fails 64 synpo-matrix split -n 401
}

@test "every command of a tool has a section in its man page, and the other way round" {
    for tool in synpo-matrix synpo-render synpo-finetune; do
        "$tool" --help | awk '/^  [a-z]/ { print $1 }' | sort >in_help
        awk '/^\.Ss [a-z]/ { print $2 }' "$ROOT/man/$tool.1" | sort >in_man
        [ -s in_help ]
        diff in_help in_man
    done
}

@test "every option in --help is an item of the man page" {
    for command in "${COMMANDS[@]}"; do
        $command --help >help.txt
        help_options help.txt >in_help
        grep -qx -- --help in_help
        man_options "$ROOT/man/${command%% *}.1" It >in_man
        comm -23 in_help in_man >lacking
        [ ! -s lacking ] || complain "$command: not in the man page: $(tr '\n' ' ' <lacking)"
    done
}

@test "every option in the man page is in --help" {
    for tool in $TOOLS; do
        for command in "${COMMANDS[@]}"; do
            [ "${command%% *}" = "$tool" ] || continue
            $command --help
        done >help.txt
        help_options help.txt >in_help
        man_options "$ROOT/man/$tool.1" It >items
        man_options "$ROOT/man/$tool.1" synopsis >synopsis
        [ -s items ] && [ -s synopsis ]
        sort -u items synopsis >in_man
        comm -13 in_help in_man >lacking
        [ ! -s lacking ] || complain "$tool: not in --help: $(tr '\n' ' ' <lacking)"
    done
}

@test "the man page's synopsis of a command and its --help agree" {
    for command in "${COMMANDS[@]}"; do
        ! has_commands "$command" || continue
        $command --help >help.txt
        # -h and --version stand once, for the tool; of -n, --count the synopsis has either. Without a command it has
        # the options of the first group, before those of hyper-parameters.
        help_options help.txt >in_help
        if [[ $command == *' '* ]]; then
            man_options "$ROOT/man/${command% *}.1" synopsis "${command#* }" >in_man
        else
            man_options "$ROOT/man/$command.1" synopsis >in_man
            awk '/^ +-/ { begun = 1 } begun && /^$/ { exit } { print }' help.txt >group && mv group help.txt
        fi
        [ -s in_man ]
        comm -13 in_help in_man >lacking
        [ ! -s lacking ] || complain "$command: not in --help: $(tr '\n' ' ' <lacking)"
        sed -nE 's/^ +(-[a-z], )?(--[a-z-]+).*/\1\2/p' help.txt | tr -d ',' | while read -r short long; do
            [[ "$short $long" == *--help* || "$short $long" == *--version* ]] && continue
            grep -qx -e "$short" -e "${long:-$short}" in_man || complain "$command: $short $long is not in the synopsis"
        done
    done
}

@test "all man pages are well-formed" {
    for page in "$ROOT"/man/*.[157]; do
        LC_ALL=C.UTF-8 MANROFFSEQ='' MANWIDTH=80 man --warnings -E UTF-8 -l -Tutf8 -Z "$page" >/dev/null 2>warnings
        [ ! -s warnings ] || complain "$page: $(cat warnings)"
    done
}

@test "no line of a man page is longer than 80 columns, those of examples neither" {
    for page in "$ROOT"/man/*.[157]; do
        LC_ALL=C.UTF-8 MANROFFSEQ='' MANWIDTH=80 man -E UTF-8 -l "$page" >text
        [ "$(LC_ALL=C.UTF-8 wc -L <text)" -le 80 ] || complain "$page: $(LC_ALL=C.UTF-8 grep -E '^.{81}' text)"
        grep -q 'SEE ALSO' text
    done
}

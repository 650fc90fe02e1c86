load ../common

# Every option with a range, of every command, at its ends and beyond them. The input is missing, so that a command
# that takes its options ends there. Of an option make check tries one value that is no number, one beyond the range,
# and the ends together with those of the command's other options; make accidents tries all, each alone.

setup_file() { make_inputs; }
setup() { set_up; }

# Names of the options of a command that take an argument, but for those that are words.
with_argument() {
    # shellcheck disable=SC2086
    $1 --help | grep -oE -- '--[a-z][a-z0-9-]* [A-Z]+' |
        grep -vE ' (FILE|NAME|TEXT|LIST|WORLD|KIND|DEVICE|LABEL|LIMIT|ENV|TASK|LOW|WHICH|AXIS|AXES)$' |
        cut -d ' ' -f 1 | sort -u
}

# run_it COMMAND OPTION=VALUE...: the exit code is left in `status`, what was said in `said`.
run_it() {
    status=0
    # shellcheck disable=SC2086
    timeout 20 $1 -o out "${@:2}" <none >/dev/null 2>err || status=$?
    mapfile -t said <err
    [ ! -e out ] || rm out
}

# try CODES COMMAND OPTION=VALUE...: the exit code is one of CODES, and nothing is said but one line.
try() {
    local line lines=0
    run_it "${@:2}"
    [[ " $1 " == *" $status "* ]] || complain "${*:2}: exit code $status, expected one of $1: ${said[*]}"
    for line in "${said[@]}"; do [[ $line == *": note: "* || $line == *": warning: "* ]] || ((++lines)); done
    [ "$lines" -le 1 ] || complain "${*:2}: ${said[*]}"
}

# The range of which the command that was run last speaks, in `low` and `high`.
find_range() {
    low='' high=''
    [[ ! ${said[*]} =~ expected\ a\ (whole\ )?number\ from\ ([^\ ]+)\ to\ ([^\ ;]+) ]] ||
        low=${BASH_REMATCH[2]} high=${BASH_REMATCH[3]}
}

# Of trouble that comes after the options: no data, no file, options that do not go together.
LATER="64 65 66"
BAD=(x nan inf 1e400 9223372036854775808)

# taken COMMAND OPTION=VALUE...: none of them is out of its range.
taken() {
    try "0 $LATER" "$@"
    find_range
    [ -z "$low" ] || complain "$*: ${said[*]}"
}

beyond() {
    local -a values=()
    [[ ! $low =~ ^-?[0-9]{1,18}$ ]] || values+=($((low - 1)))
    [[ ! $high =~ ^[0-9]{1,18}$ ]] || values+=("$high""0")
    [ -n "${ACCIDENTS-}" ] || [ ${#values[@]} -eq 0 ] || values=("${values[tried % ${#values[@]}]}")
    for value in "${values[@]}"; do try 64 "$1" "$2=$value"; done
}

@test "every number of every option: its ends are taken, what is beyond them is told the range" {
    local command option value low high number=0 tried=0
    local -a said lows highs
    : >none
    for command in "synpo-gen-expert -p none" synpo-train synpo-eval "synpo-finetune adapt -c none" \
        "synpo-finetune ppo" "synpo-matrix split" "synpo-matrix rows" "synpo-matrix show" "synpo-matrix filter" \
        "synpo-render heatmap" "synpo-render curves" "synpo-render map" "synpo-render view" \
        "synpo-render episode" "synpo-render policy"; do
        lows=() highs=()
        for option in $(with_argument "${command% -? none}"); do
            run_it "$command" "$option=${BAD[number++ % ${#BAD[@]}]}"
            find_range
            [ -n "$low" ] || continue
            [ "$status" -eq 64 ]
            tried=$((tried + 1))
            [ -z "${ACCIDENTS-}" ] || for value in "${BAD[@]}" ''; do try 64 "$command" "$option=$value"; done
            lows+=("$option=$low") highs+=("$option=$high")
            beyond "$command" "$option"
        done
        [ ${#lows[@]} -gt 0 ] || continue
        try 64 "$command" "${lows[0]%%=*}="
        # A picture, a stream or a training of the largest size is not what is tried here.
        case $command in
            "synpo-render map" | "synpo-render view" | "synpo-matrix split") continue ;;
        esac
        [ -z "${ACCIDENTS-}" ] || for option in "${lows[@]}" "${highs[@]}"; do taken "$command" "$option"; done
        taken "$command" "${lows[@]}"
        taken "$command" "${highs[@]}"
    done
    local expected=115
    synpo-render map --help >/dev/null 2>&1 || expected=92  # of a build that draws no pictures
    [ "$tried" -ge "$expected" ] || complain "found $tried options"
    echo "# $tried options with a range" >&3
}

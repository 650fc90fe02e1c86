load ../common

# Every option with a range, of every command, at its ends and beyond them. The input is missing, so that a command
# that takes its options ends there.

setup_file() { make_inputs; }
setup() { set_up; }

# Names of the options of a command that take an argument.
with_argument() {
    # shellcheck disable=SC2086
    $1 --help | grep -oE -- '--[a-z][a-z0-9-]* [A-Z]+' | cut -d ' ' -f 1 | sort -u
}

# try CODES COMMAND OPTION VALUE: the exit code is one of CODES, and nothing is said but one line.
try() {
    local status=0
    # shellcheck disable=SC2086
    timeout 20 $2 -o out "$3=$4" <none >/dev/null 2>err || status=$?
    [[ " $1 " == *" $status "* ]] || complain "$2 $3=$4: exit code $status, expected one of $1: $(cat err)"
    [ "$(grep -vc ': note: \|: warning: ' err)" -le 1 ] || complain "$2 $3=$4: $(cat err)"
    rm -f out
}

# Of trouble that comes after the options: no data, no file, options that do not go together.
LATER="64 65 66"

@test "every number of every option: its ends are taken, what is beyond them is told the range" {
    local command option low high tried=0
    : >none
    for command in "synpo-gen-expert -p none" synpo-train synpo-eval "synpo-finetune adapt -c none" "synpo-finetune ppo" \
        "synpo-matrix split" "synpo-matrix rows" "synpo-matrix show" "synpo-matrix filter" "synpo-render heatmap" \
        "synpo-render curves" "synpo-render map" "synpo-render view" "synpo-render episode" "synpo-render policy"; do
        for option in $(with_argument "${command% -? none}"); do
            # shellcheck disable=SC2086
            $command "$option=x" <none >/dev/null 2>err || true
            read -r low high < <(sed -nE 's/.*expected a (whole )?number from (\S+) to (\S+)(;.*)?$/\2 \3/p' err) || true
            [ -n "$low" ] || continue
            tried=$((tried + 1))
            for value in nan inf 1e400 9223372036854775808 ''; do
                try 64 "$command" "$option" "$value"
            done
            [[ ! $low =~ ^-?[0-9]{1,18}$ ]] || try 64 "$command" "$option" $((low - 1))
            # A picture, a stream or a training of the largest size is not what is tried here.
            case $command$option in
                "synpo-render map"* | "synpo-render view"* | "synpo-matrix split"*) continue ;;
            esac
            try "0 $LATER" "$command" "$option" "$low"
            try "0 $LATER" "$command" "$option" "$high"
            [[ ! $high =~ ^[0-9]{1,18}$ ]] || try 64 "$command" "$option" "$high""0"
        done
    done
    [ "$tried" -ge 100 ] || complain "found $tried options"
    echo "# $tried options with a range" >&3
}

# Loaded by every test file: the build directory in PATH, a fresh working directory, and ways to say what should happen.
bats_require_minimum_version 1.5.0

ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
DATA=$ROOT/tests/data/cli
PATH="${SYNPO_BUILD:-$ROOT/build}:$PATH"
export LC_ALL=C
TOOLS="synpo-gen-expert synpo-train synpo-finetune synpo-eval synpo-matrix synpo-render"
WITH_COMMANDS="synpo-finetune synpo-matrix synpo-render"

# Small enough for a moment, and still the real network.
TINY=(-q --batch-states 64 --fill 20 --running 64 --memory 30)
TINY_PAPER=(-q --recipe paper --trajectories 4 --memory 30)

# set_up FILE...: a fresh working directory, with links to these files that setup_file made.
set_up() {
    mkdir "$BATS_TEST_TMPDIR/work"
    cd "$BATS_TEST_TMPDIR/work" || exit
    for file in "$@"; do ln -s "$BATS_FILE_TMPDIR/$file" .; done
}

setup() { set_up; }

# make_inputs: the files that one test file's tests share, made once: pairs.tsv, e.jsonl (60 trajectories of them),
# a.ckpt (stripped), m.tsv.
make_inputs() {
    cd "$BATS_FILE_TMPDIR" || exit
    synpo-matrix split --envs 3 --tasks 3 -n 5 -s 1 >pairs.tsv
    synpo-gen-expert -p pairs.tsv -n 60 -s 1 >e.jsonl
    synpo-train "${TINY[@]}" -n 2 -p pairs.tsv --strip <e.jsonl >a.ckpt
    printf 'env\ttask\nmap1\tR-B\nmap2\tB-G\n' >two.tsv
    synpo-eval -q -p two.tsv -n 1 <a.ckpt >m.tsv
}

# has_commands TOOL: whether it takes a command before its options.
has_commands() { [[ " $WITH_COMMANDS " == *" $1 "* ]]; }

# The commands of every tool that take options of their own, one a line.
commands() {
    local tool
    for tool in $TOOLS; do
        if has_commands "$tool"; then
            "$tool" --help | awk -v tool="$tool" '/^  [a-z]/ { print tool, $1 }'
        else
            echo "$tool"
        fi
    done
}

# help_options [FILE]: options in a --help text, one a line: -n and --count alike.
help_options() {
    awk '/^ +-/ {
        line = $0
        sub(/^ +/, "", line)
        sub(/   *.*/, "", line)
        n = split(line, word, /[ ,]+/)
        for (i = 1; i <= n; ++i) if (word[i] ~ /^-/) print word[i]
    }' "$@" | sort -u
}

complain() {
    printf '%s\n' "$*" >&2
    return 1
}

# help_of COMMAND...: its --help. To load synpo-render's libraries takes a tenth of a second: a test asks once.
help_of() {
    local kept="$BATS_TEST_TMPDIR/help of $*"
    [ -s "$kept" ] || "$@" --help >"$kept"
    cat "$kept"
}

# Options that a text names and the command COMMAND... does not have; those of a program named before them are its own.
options_lacking() {
    local text=$1 help option
    shift
    text=$(sed -E "s/(synpo-[a-z-]+( [a-z]+)?|tr) --?[a-z-]+//g" <<<"$text")
    text=$(grep -oE "(^|[ (])--?[a-z][a-z-]*" <<<"$text" | tr -d ' (' | sort -u) || return 0
    help=$(help_of "$@")
    for option in $text; do
        grep -qE -- "^ +(-[a-zA-Z], )?(--[a-z0-9-]+, )?$option([ ,]|$)" <<<"$help" || printf '%s ' "$option"
    done
}

# here: every name below this folder, in order. Called hundreds of times, so that it starts no program; neither do
# fails and says, but for the command itself.
here() {
    shopt -s globstar dotglob nullglob
    printf '%s\n' **
}

# names_options MESSAGE ARGUMENT...: whether it names what looks like an option, and is none of the arguments. Every
# command has --help (help.bats).
names_options() {
    local word words
    read -ra words <<<"${1//(/ }"
    shift
    for word in "${words[@]}"; do
        [[ $word =~ ^--?[a-z][a-z-]* && ${BASH_REMATCH[0]} != --help ]] || continue
        [[ " $* " == *" ${BASH_REMATCH[0]}"* ]] || return 0
    done
    return 1
}

# fails CODE TOOL ARGUMENT...: the exit code is CODE, the last words on stderr are "TOOL: ...", they name no option that
# the command does not have, unless it was given, and no new file is left.
# stdout goes to $OUT, or ../out; stderr to ../err, for `says`.
fails() {
    local code=$1 before after option status=0 lines
    shift
    local command=("$1")
    before=$(here)
    "$@" >"${OUT:-$BATS_TEST_TMPDIR/out}" 2>"$BATS_TEST_TMPDIR/err" || status=$?
    [ "$status" -eq "$code" ] || complain "$*: exit code $status, expected $code: $(cat "$BATS_TEST_TMPDIR/err")"
    mapfile -t lines <"$BATS_TEST_TMPDIR/err"
    local message=${lines[*]: -1}
    [[ $message == "$1: "?* ]] || complain "$*: found '$(cat "$BATS_TEST_TMPDIR/err")', expected '$1: ...'"
    if names_options "$message" "$@"; then
        if has_commands "$1" && [[ ${2-} == [a-z]* ]]; then command=("$1" "$2"); fi
        for option in $(options_lacking "$message" "${command[@]}" 2>/dev/null); do
            [[ " $* " == *" $option"* ]] || complain "$*: '$message' names $option"
        done
    fi
    after=$(here)
    [ "$before" = "$after" ] || complain "$*: left files: $(diff <(echo "$before") <(echo "$after"))"
}

# says TEXT: the message of the command that failed last holds TEXT.
says() {
    local text
    text=$(<"$BATS_TEST_TMPDIR/err")
    [[ $text == *"$1"* ]] || complain "found '$text', expected '$1'"
}

# described FILE FILTER: what jq finds in a checkpoint's description.
described() {
    synpo-eval --describe -c "$1" -o "$BATS_TEST_TMPDIR/description" && jq -r "$2" "$BATS_TEST_TMPDIR/description"
}

# tensor FILE NAME: the bytes of a tensor of a safetensors file.
tensor() {
    local size begin end
    size=$(od -An -tu8 -N8 "$1" | tr -d ' ')
    read -r begin end < <(head -c $((8 + size)) "$1" | tail -c "$size" |
        jq -r --arg name "$2" '.[$name].data_offsets | @tsv')
    tail -c +$((9 + size + begin)) "$1" | head -c $((end - begin))
}

# A command on a terminal; its output, without the terminal's carriage returns, in ../err. Returns its exit code.
on_terminal() {
    local status=0
    script -qec "$1" /dev/null </dev/null >"$BATS_TEST_TMPDIR/screen" || status=$?
    tr -d '\r' <"$BATS_TEST_TMPDIR/screen" >"$BATS_TEST_TMPDIR/err"
    return "$status"
}

load ../common

# A newcomer's first hour: the commands are those of README.md and GUIDE.md, read from their own blocks, in order, in a
# copy of what they name. Budgets are made small by the substitutions below, each of which must find what it replaces.
setup() {
    set_up
    cp -r "$ROOT/examples" "$ROOT/scripts" "$ROOT/Makefile" .
    mkdir build home
    for tool in $TOOLS; do ln -s "$(command -v "$tool")" build/; done
    export DEMO_TIME=1s DEMO_EPISODES=1 HOME=$PWD/home
}

# The indented blocks of a page, from heading FROM up to, but not with, heading TO.
commands_of() {
    awk -v from="## $2" -v to="## $3" '
        /^```/ { fenced = !fenced }
        $0 == to { inside = 0 }
        $0 == from { inside = 1 }
        inside && !fenced && /^    / { print substr($0, 5) }' "$1"
}

# small EXPRESSION...: the script on stdin, changed by these of sed; each has something to change.
small() {
    local script changed expression
    script=$(cat)
    for expression; do
        changed=$(sed -E "$expression" <<<"$script")
        [ "$changed" != "$script" ] || complain "nothing to change for $expression" || return
        script=$changed
    done
    printf '%s\n' "$script"
}

# What is made, but for the demo, would take the compiler: whether make knows how is all that is asked.
run_all() {
    {
        echo 'make() { command make -n -C "$ROOT" "$@" >/dev/null; }'
        cat "$1"
    } >commands
    export ROOT
    bash -eux commands >printed 2>said || complain "$(tail -n 5 said)"
}

# Names that the script writes, one a line, as often as they are written.
written() { grep -oE '(> |-o |--log |--save |--record |--video )[a-z0-9.-]+\.[a-z0-9]+' "$1" | sed 's/.* //'; }

TINY_TRAINING='-n 2 --batch-states 64 --fill 20 --running 64 --memory 30'

@test "README: every command, in order; each writes a file of its own" {
    commands_of "$ROOT/README.md" Install Results >all
    [ "$(wc -l <all)" -ge 30 ]
    small 's|^scripts/setup demo .*|scripts/demo|' 's|^scripts/setup check .*|make deps check|' \
        's|^synpo-eval -n 2 <|synpo-eval -n 1 <|' 's|-n 300 -c|-n 3 -c|' 's|-n 20 < adapted|-n 1 < adapted|' \
        's|split -s 2|split --envs 3 --tasks 3 -n 5|' 's|split -w kitchen|& --envs 3 --tasks 3 -n 5|' \
        's|-n 20000|-n 60|' "s|--time 30m|$TINY_TRAINING|" 's|-n 20 < kitchen|-n 1 < kitchen|' \
        's|--evaluate-every 1000|--evaluate-every 2 --evaluate-episodes 2|' <all >script
    run_all script
    written all >names
    [ "$(wc -l <names)" -ge 20 ]
    [ -z "$(sort names | uniq -d)" ] || complain "written twice: $(sort names | uniq -d)"
    # A run's own saves come before its end, which is the checkpoint.
    for name in $(grep -v '^run.ckpt$' names); do [ -s "$name" ] || complain "$name is missing or empty"; done
    for picture in mazes heatmap curves episode; do [ -s build/demo/$picture.png ]; done
    grep -q 'build/demo/curves.png ' printed

    # The output that the page shows is of this form.
    sed -n '/^```text$/,/^```$/p' "$ROOT/README.md" | sed '1d;$d' >shown
    [ "$(wc -l <shown)" -eq 5 ]
    synpo-matrix summary play.tsv | head -n 5 >got
    diff <(sed -E 's/[0-9.]+/N/g; s/ +/ /g' shown) <(sed -E 's/[0-9.]+/N/g; s/ +/ /g' got)
    [ "$(head -n 1 shown)" = "$(head -n 1 got)" ]
}

@test "README: the policy to play with succeeds on nine in ten unseen pairs" {
    synpo-eval -q -n 1 <examples/play/synpo.ckpt >play.tsv
    awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
        !$at["seen"] { ++all; good += $at["successes"] }
        END { exit !(all == 256 && good >= 0.9 * all) }' play.tsv
    [ "$(described examples/play/synpo.ckpt '.envs | length')" -eq 20 ]
    [ "$(wc -c <examples/play/synpo.ckpt)" -lt 8000000 ]
}

@test "GUIDE: every command that learns, asks or draws, in order" {
    commands_of "$ROOT/GUIDE.md" 'A problem that is through in a minute' \
        "The paper's tables and figures, here and on clusters" >all
    [ "$(wc -l <all)" -ge 55 ]
    mkdir new
    cp examples/play/maze/map21.txt new/
    small 's|split -s 1|split --envs 3 --tasks 3 -n 5|' 's|split -w kitchen|& --envs 3 --tasks 3 -n 5|' \
        's|-n 500|-n 60|' 's|-n 50 --batch-states 64|'"$TINY_TRAINING|" "s/--time (2h|30m)/$TINY_TRAINING/" \
        's|--evaluate-every 1000|--evaluate-every 2 --evaluate-episodes 2 --every 1|' \
        's|-n 200000|-n 1 --trajectories 4 --memory 30|' \
        "s|-s 1 -n 20000 < full|-s 1 $TINY_TRAINING < full|" 's|-n 20000|-n 60|' 's|-n 100 |-n 1 |' \
        's|synpo-eval -p full-pairs.tsv >|synpo-eval -n 1 -p full-pairs.tsv >|' 's|-n 20 |-n 1 |' \
        's|adapt -w gridworld:new|& -n 3|' 's|--steps 6e5 --lanes 64|--steps 64 --lanes 4 --rollout 8|' \
        "s|--no-fresh-starts -n 2000|--no-fresh-starts $TINY_TRAINING|" <all >script
    run_all script
    written all | grep -v '\$' >names
    for name in $(sort -u names | grep -vx 'full-run.ckpt\|paper-run.ckpt'); do
        [ -s "$name" ] || complain "$name is missing or empty"
    done
}

@test "README and GUIDE: their relative links lead somewhere" {
    for page in README GUIDE RESULTS CHANGELOG CONTRIBUTING ARCHITECTURE examples/play/README; do
        grep -oE '\]\([^)]+\)' "$ROOT/$page.md" | sed -E 's/^\]\(//; s/\)$//' >links || true
        while read -r link; do
            [[ $link != http* ]] || continue
            path=${link%%#*}
            target=$ROOT/$(dirname $page.md)/${path:-$(basename $page.md)}
            [ -e "$target" ] || complain "$page.md: no file for $link"
            [[ $link == *'#'* ]] || continue
            # As forges name headings.
            grep '^#' "$target" | sed -E 's/^#+ //' | tr 'A-Z ' 'a-z-' | tr -cd 'a-z0-9_\n-' |
                grep -qxF -- "${link#*#}" || complain "$page.md: no heading for $link"
        done <links
    done
}

@test "the version is one: Makefile, README, CITATION, CHANGELOG and --version" {
    version=$(sed -n 's/^VERSION *:= *//p' "$ROOT/Makefile")
    [[ $version =~ ^[0-9]+\.[0-9]+\.[0-9]+$ ]]
    grep -q "^Version $version " "$ROOT/README.md"
    grep -qx "version: $version" "$ROOT/CITATION.cff"
    [[ $(grep -m 1 '^## ' "$ROOT/CHANGELOG.md") == "## $version "* ]]
    [[ $(synpo-train --version) == "synpo-train (synpo) $version"?(' '*) ]]
}

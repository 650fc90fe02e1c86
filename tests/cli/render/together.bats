load ../common

setup_file() {
    make_inputs
    synpo-gen-expert -p pairs.tsv -n 3 --end >ended.jsonl
}
setup() { set_up pairs.tsv e.jsonl m.tsv ended.jsonl; }

@test "heatmap: --task-order and --env-order hold, wherever --order stands" {
    synpo-matrix split -w any --envs 4 --tasks 4 | awk -F '\t' -v OFS='\t' '
        NR == 1 { print $0, "episodes", "successes"; next } { print $0, 10, (NR * 7) % 11 }' >by-hand.tsv
    for side in task env; do
        synpo-render heatmap --order natural --$side-order mean by-hand.tsv >after.png
        synpo-render heatmap --$side-order mean --order natural by-hand.tsv | cmp - after.png
        synpo-render heatmap --order natural by-hand.tsv >without.png
        run ! cmp -s after.png without.png
    done
}

@test "episode --ansi: the title is there, and options of the picture are refused" {
    synpo-render episode --ansi --title 'An episode' e.jsonl >titled
    [ "$(head -n 1 titled)" = 'An episode' ]
    tail -n +2 titled | cmp - <(synpo-render episode --ansi e.jsonl | tail -n +2)
    for option in "--scale 3" "--font nowhere" "--strip 3"; do
        # shellcheck disable=SC2086
        fails 64 synpo-render episode --ansi $option e.jsonl
        says "${option%% *} is for a picture, not for --ansi"
    done
}

@test "episode: films have no strip" {
    for film in "--frames frames" "--video x.gif" "--video x.avi" "-o x.gif" "--format gif"; do
        # shellcheck disable=SC2086
        fails 64 synpo-render episode $film --strip 3 e.jsonl
        says "--strip is for a picture of the whole episode"
    done
}

@test "the end of a video's name is read in either case, as that of a picture is" {
    for kind in gif avi; do
        synpo-render episode --scale 0.5 --video "x.$kind" e.jsonl
        synpo-render episode --scale 0.5 --video "x.${kind^^}" e.jsonl
        cmp "x.$kind" "x.${kind^^}"
    done
}

@test "episode --line: the line of the file, whatever stands in those before it" {
    cat ended.jsonl e.jsonl >both.jsonl
    synpo-render episode --ansi --line 5 both.jsonl | cmp - <(synpo-render episode --ansi e.jsonl)
    fails 65 synpo-render episode --ansi --line 4 both.jsonl
    says "both.jsonl: line 4: found the end of a stream, expected a trajectory"
    fails 65 synpo-render episode --ansi --line 4 ended.jsonl
    says "ended.jsonl: line 4: found the end of a stream, expected a trajectory"
    fails 65 synpo-render episode --ansi --line 5 ended.jsonl
    says "ended.jsonl: it ends after 4 lines, before line 5"
}

@test "curves: a run that stands twice under its label is refused, whatever its name" {
    printf 'update\tseen_success\tunseen_success\n1\t0.5\t0.25\n2\t0.75\t0.5\n' >a.log
    sed 's/0\.75/1/' a.log >b.log
    ln -s a.log link.log
    ln a.log hard.log
    for logs in "a.log a.log" "S=a.log,b.log,a.log" "S=a.log S=a.log" "S= a.log b.log link.log" "S=a.log,hard.log"; do
        # shellcheck disable=SC2086
        fails 64 synpo-render curves -o x.png $logs
        says "stands twice under its label"
    done
    says "the log 'hard.log' stands twice under its label, as 'a.log' too: a run counts once"
    synpo-render curves -o x.png S=a.log,b.log T=a.log
}

@test "a rate is the same in the terminal as in the picture, halves too, and 100 is all" {
    awk 'BEGIN { OFS = "\t"; print "env", "task", "seen", "episodes", "successes"
        for (k = 0; k <= 8; ++k) print "env" k, "t", 1, 8, k
        print "env9", "t", 1, 1000, 999; print "env10", "t", 1, 1000, 1 }' >by-hand.tsv
    synpo-matrix show by-hand.tsv | awk '$1 == "t" { for (i = 2; i <= NF; ++i) print $i }' >shown
    printf '%s\n' 0 13 25 38 50 63 75 88 100 99 1 | cmp - shown
    synpo-render heatmap --cell 30 --format svg by-hand.tsv | grep -o 'anchor="middle">[01]\.[0-9][0-9]<' |
        tr -dc '01.23456789\n' | awk '{ print 100 * $1 }' | cmp - shown
    printf 'update\tseen_success\tunseen_success\n1\t0.5\t0.5\n2\t0.9999\t1\n' >run.log
    synpo-render curves --ansi --colour never run.log | tail -n 1 >legend
    grep -q 'unseen 100 %' legend
    grep -q ' seen 99.9 %' legend
}

load common

# The matrix that synpo-matrix(1) makes with awk: 3 x 3, the diagonal unseen and worse.
by_hand() {
    awk 'BEGIN {
      OFS = "\t"
      print "env", "task", "seen", "episodes", "successes"
      for (e = 1; e <= 3; e++)
        for (t = 1; t <= 3; t++)
          print "env" e, "task" t, e != t, 100, e == t ? 60 : 90 + e
    }'
}

# with COLUMN=VALUE...: the matrix on stdin with these columns added.
with() {
    awk -v given="$*" 'BEGIN { FS = OFS = "\t"; n = split(given, part, " ") }
        { for (i = 1; i <= n; ++i) { split(part[i], kv, "="); $(NF + 1) = NR == 1 ? kv[1] : kv[2] } print }'
}

QUESTIONS=(summary table rows cols show filter wide merge "compare hand.tsv")

@test "the matrix of the man page, made with awk: every command takes it" {
    by_hand >hand.tsv
    sed -n '/^awk .BEGIN/,/> hand.tsv$/p' "$ROOT/man/synpo-matrix.1" | sed 's/\\et/\\t/; s/ > hand.tsv//' >example
    bash example | cmp - hand.tsv
    for command in "${QUESTIONS[@]}"; do
        # shellcheck disable=SC2086
        synpo-matrix $command hand.tsv >out
        [ -s out ]
    done
    synpo-matrix wide hand.tsv >wide.tsv
    printf 'task\tenv1\tenv2\tenv3\ntask1\t0.6\t0.92\t0.93\ntask2\t0.91\t0.6\t0.93\ntask3\t0.91\t0.92\t0.6\n' |
        cmp - wide.tsv
    synpo-matrix show hand.tsv >shown
    cat >expected <<'END'
100 episodes a pair
  env   1   2   3
task1  60* 92  93
task2  91  60* 93
task3  91  92  60*

seen: 92.0 % of 600 episodes, 6 pairs
unseen (*): 60.0 % of 300 episodes, 3 pairs
END
    cmp expected shown
}

@test "table: text, TSV, Markdown, LaTeX say the same of three seeds" {
    for seed in 1 2 3; do by_hand | awk -v s=$seed 'BEGIN { FS = OFS = "\t" } NR > 1 { $5 -= s } { print }' |
        with seed=$seed; done >all
    awk 'NR == 1 || !/^env\t/' all >runs.tsv
    # Means 91, 90, 89 of seen pairs and 59, 58, 57 of unseen ones: sd 1.
    synpo-matrix table runs.tsv >text
    grep -q '^unnamed  *3  *90.0 +- 1.0 .* 58.0 +- 1.0 ' text
    grep -q 'divisor: runs - 1' text
    synpo-matrix table -f markdown -b runs.tsv >markdown
    grep -qxF '| unnamed |    3 | 90.0 ± 1.0 | 58.0 ± 1.0 |' markdown
    synpo-matrix table --format latex -b runs.tsv >latex
    grep -qxF 'unnamed & 3 & 90.0 $\pm$ 1.0 & 58.0 $\pm$ 1.0 \\' latex
    synpo-matrix table -f tsv --subset seen,unseen runs.tsv >tsv
    # Student's with two degrees of freedom, 0.9 +- 4.3027 * 0.01 / sqrt(3); Wilson's of 522 in 900 is the wider one.
    awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i }
        function near(x, y) { return x - y < 1e-5 && y - x < 1e-5 }
        NR == 2 { ok += $at["subset"] == "seen" && near($at["mean"], 0.9) && $at["interval"] == "student" &&
            near($at["low"], 0.875159) && near($at["high"], 0.924841) }
        NR == 3 { ok += $at["subset"] == "unseen" && near($at["mean"], 0.58) && near($at["sd"], 0.01) &&
        $at["interval"] == "wilson" &&
            near($at["low"], 0.547482) && near($at["high"], 0.611838) }
        END { exit !(ok == 2 && NR == 3) }' tsv
    synpo-matrix table -f tsv --pair-by-pair -s 7 --samples 500 runs.tsv >drawn
    synpo-matrix table -f tsv --pair-by-pair -s 7 --samples 500 runs.tsv | cmp - drawn
    synpo-matrix table -s 1 runs.tsv | cmp - text
    fails 64 synpo-matrix table -f html runs.tsv
    fails 64 synpo-matrix table --subset sen runs.tsv
    fails 64 synpo-matrix table --measure luck runs.tsv
}

@test "no 100.0 +- 0.0, no 1.00: runs without a failure are alike, and have an interval" {
    for seed in 1 2 3; do by_hand | awk 'BEGIN { FS = OFS = "\t" } NR > 1 { $5 = 100 } { print }' |
        with seed=$seed; done |
        awk 'NR == 1 || !/^env\t/' >runs.tsv
    synpo-matrix table runs.tsv >text
    grep -q '100.0 (3 alike)  *99.8 to 100.0 w  *100.0' text
    synpo-matrix summary runs.tsv >>text
    run ! grep -q -e '+- 0.0' text
}

@test "a rate lies in its interval as both are printed, and neither is rounded to 100.0" {
    printf 'env\ttask\tseen\tepisodes\tsuccesses\ne\tt\t1\t40000\t39990\n' >m.tsv
    for command in summary table rows; do
        synpo-matrix $command m.tsv >text
        grep -q ' 99.98 .* 99.95 to 99.99\| 99.98  *99.95 to 99.99' text
    done
}

@test "temperatures are runs of their own: not pooled, not counted twice, named" {
    by_hand | with run=r temperature=0 first_episode=0 >t0.tsv
    by_hand | with run=r temperature=0.5 first_episode=100 >t1.tsv
    by_hand | with run=r temperature=0.5 first_episode=0 >again.tsv
    for other in t1 again; do
        synpo-matrix summary t0.tsv $other.tsv >out
        grep -q '^synpo.*\|^unnamed method, temperature 0: 1 run' out
        grep -q '^unnamed method, temperature 0.5: 1 run' out
        [ "$(grep -c '^all  *9  *732 of 900 ' out)" -eq 2 ]
    done
    synpo-matrix compare t0.tsv again.tsv >out
    grep -q 'Actions were drawn at temperature 0 in A, 0.5 in B' out
    synpo-matrix merge t0.tsv again.tsv >both.tsv
    [ "$(wc -l <both.tsv)" -eq 19 ]
    synpo-matrix filter --temperature 0.5 both.tsv | synpo-matrix summary | grep -q 'temperature 0.5: 1 run'
    fails 65 synpo-matrix show both.tsv
    says "rows of several temperatures ('0', '0.5')"
    fails 65 synpo-matrix compare both.tsv t0.tsv
    says "both.tsv: rows of several temperatures"
    fails 64 synpo-matrix filter --temperature hot both.tsv
    fails 65 synpo-matrix filter --temperature 2 both.tsv
}

@test "new pairs are a class of their own; other environments of the same name are noticed" {
    by_hand | awk 'BEGIN { FS = OFS = "\t" } { $6 = NR == 1 ? "new" : $1 == "env3" && $3 == 0 ? 1 : 0 }
        { print }' >m.tsv
    synpo-matrix summary m.tsv >out
    grep -q '^unseen  *2  *120 of 200 ' out
    grep -q '^new  *1  *60 of 100 ' out
    synpo-matrix filter --new m.tsv | cut -f 9,10 >out
    printf 'env\ttask\nenv3\ttask3\n' | cmp - out
    synpo-matrix show m.tsv >out
    grep -q '^new (n): 60.0 % of 100 episodes, 1 pair$' out
    synpo-matrix table --subset unseen,new m.tsv | grep -q '^method  *runs  *unseen %  *95 % interval  *IQM  *new %'
    fails 64 synpo-matrix filter --new --seen m.tsv
    by_hand | with run=a env_hash=0000000000000001 >a.tsv
    by_hand | with run=b env_hash=0000000000000002 >b.tsv
    synpo-matrix summary a.tsv b.tsv 2>note >out
    grep -q "the environment 'env1' is not the same in all runs" note
    fails 65 synpo-matrix cols a.tsv b.tsv
    fails 65 synpo-matrix show a.tsv b.tsv
    fails 65 synpo-matrix compare a.tsv b.tsv
    says "other environments go by the same names"
}

@test "compare: on common start states, with what was left out; two standard inputs are 64" {
    by_hand >a.tsv
    awk 'BEGIN { FS = OFS = "\t" } NR > 1 && $1 == "env1" { $5 = 50 } NR == 3 { $4 = 99 } { print }' a.tsv >b.tsv
    synpo-matrix compare -n 1 a.tsv b.tsv >text
    # env1 fell from 60 and 91 (task3) to 50; of task2 other episodes were run.
    grep -q '^all  *8 .* 0  *6  *2$' text
    grep -q '^env1  task3  seen  91 of 100  50 of 100  -41.0  ' text
    grep -q 'Left out: 1 pair without common start states' text
    synpo-matrix compare --tsv --any-start a.tsv - <b.tsv >tsv
    [ "$(cut -f 1 tsv | sort | uniq -c | tr -s ' \n' ' ')" = " 1 level 9 pair 3 subset " ]
    fails 64 synpo-matrix compare - -
    fails 64 synpo-matrix compare a.tsv
    with method=x <a.tsv >x.tsv
    with method=y <a.tsv >y.tsv
    synpo-matrix merge x.tsv y.tsv >xy.tsv
    fails 65 synpo-matrix compare xy.tsv a.tsv
    says "xy.tsv: rows of several methods"
}

@test "filter narrows and its output is a matrix again; unknown names and nothing left are 65" {
    by_hand >hand.tsv
    synpo-matrix filter --unseen hand.tsv | synpo-matrix summary >out
    grep -q '^unseen  *3  *180 of 300 ' out
    synpo-matrix filter --env env1,env3 -t task3 hand.tsv | cut -f 9,10 >out
    printf 'env\ttask\nenv1\ttask3\nenv3\ttask3\n' | cmp - out
    printf 'env\ttask\tseen\nenv2\ttask1\t0\nenv9\ttask1\t1\n' >pairs.tsv
    synpo-matrix filter -p pairs.tsv --pair env3,task3 hand.tsv | cut -f 9,10 >out
    printf 'env\ttask\nenv2\ttask1\nenv3\ttask3\n' | cmp - out
    [ "$(synpo-matrix filter --not -p pairs.tsv hand.tsv | wc -l)" -eq 9 ]
    fails 65 synpo-matrix filter -e env4 hand.tsv
    says "no environment 'env4'"
    fails 65 synpo-matrix filter --seen --pair env1,task1 hand.tsv
    says "no row is left"
    sed -i 2d pairs.tsv
    fails 65 synpo-matrix filter -p pairs.tsv hand.tsv
    says "pairs.tsv: none of its pairs"
    fails 64 synpo-matrix filter --seen --unseen hand.tsv
    fails 64 synpo-matrix filter --pair env1 hand.tsv
}

@test "rows and cols: the worst first, and -n of them" {
    by_hand >hand.tsv
    synpo-matrix rows --tsv hand.tsv | cut -f 4,16 | tr '\n\t' ' :' >out
    [ "$(cat out)" = "task:worst_env task3:env3 task2:env2 task1:env1 " ]
    synpo-matrix cols -n 1 --tsv hand.tsv | cut -f 4,8,16 >out
    printf 'env\tsuccesses\tworst_task\nenv1\t242\ttask1\n' | cmp - out
    fails 64 synpo-matrix rows -n 0 hand.tsv
}

@test "show: coloured on a terminal that has colour; NO_COLOR, dumb terminals and pipes get none" {
    by_hand >hand.tsv
    escape=$(printf '\033')
    synpo-matrix show hand.tsv >plain
    run -0 on_terminal "stty cols 80; TERM=xterm-256color COLORTERM= NO_COLOR= synpo-matrix show hand.tsv"
    grep -q "${escape}\[38;5;[0-9]*;48;5;[0-9]*m  60${escape}\[0m" "$BATS_TEST_TMPDIR/err"
    run -0 on_terminal "stty cols 80; TERM=xterm COLORTERM=truecolor NO_COLOR= synpo-matrix show hand.tsv"
    grep -q "48;2;[0-9]*;[0-9]*;[0-9]*m" "$BATS_TEST_TMPDIR/err"
    for setting in "TERM=xterm NO_COLOR=1" "TERM=dumb NO_COLOR=" "TERM= NO_COLOR="; do
        run -0 on_terminal "$setting synpo-matrix show hand.tsv"
        cmp plain "$BATS_TEST_TMPDIR/err"
    done
    run -0 on_terminal "TERM=xterm NO_COLOR= synpo-matrix show --colour never hand.tsv"
    cmp plain "$BATS_TEST_TMPDIR/err"
    run ! grep -q "$escape" plain
    TERM=dumb synpo-matrix show --colour always hand.tsv >coloured
    grep -q "$escape" coloured
    fails 64 synpo-matrix show --colour pink hand.tsv
}

@test "bad matrices: 65 with line and column, from every command" {
    by_hand >hand.tsv
    awk 'BEGIN { for (i = 1; i <= 1000000; ++i) printf "c%d%s", i, i < 1000000 ? "\t" : "\n" }' >wide_one
    while IFS='|' read -r text message; do
        case $text in wide_one) cp wide_one bad.tsv ;; *) printf '%b' "$text" >bad.tsv ;; esac
        for command in "${QUESTIONS[@]}"; do
            # shellcheck disable=SC2086
            fails 65 synpo-matrix $command bad.tsv
            says "bad.tsv: $message"
        done
    done <<'END'
env\ttask\tepisodes\na\tb\t1\n|line 1: no column 'successes'
env\ttask\tepisodes\tsuccesses\na\tb\t9\t10\n|line 2, column 4 ('successes'): found '10', expected at most 9
env\ttask\tepisodes\tsuccesses\na\tb\t9\t1\na\tb\t9\t1\n|line 3: pair 'a', 'b' from episode 0 on stands in line 2 already
env\ttask\tepisodes\tsuccesses\na\tb\t9\tnan\n|line 2, column 4 ('successes'): found 'nan'
env\ttask\tepisodes\tsuccesses\treward\na\tb\t9\t1\tNaN\n|line 2, column 5 ('reward'): found 'NaN'
env\ttask\tepisodes\tsuccesses\na\tb\t9\t-1\n|line 2, column 4 ('successes'): found '-1'
env\ttask\tepisodes\tsuccesses\n|line 1: found a header and no row
env\ttask\tepisodes\tsuccesses\na\tb\xff\t9\t1\n|line 2, column 2: found invalid UTF-8 at byte \xff
wide_one|line 1: found 1000000 columns, expected at most 1000
END
}

@test "names that turn the direction are shown by their bytes in text, and stay as they are in tables" {
    turn=$'\xe2\x80\xae'
    printf 'env\ttask\tmethod\tepisodes\tsuccesses\na%s\tb%s\tc%s\t9\t1\n' "$turn" "$turn" "$turn" >turned.tsv
    for command in summary table rows cols show; do
        synpo-matrix "$command" turned.tsv >text
        grep -qF '\xe2\x80\xae' text || complain "$command: $(cat text)"
        ! grep -qF "$turn" text || complain "$command: $(cat -v text)"
    done
    synpo-matrix compare turned.tsv turned.tsv >text
    ! grep -qF "$turn" text || complain "compare: $(cat -v text)"
    synpo-matrix rows --tsv turned.tsv | grep -qF "b$turn"
    synpo-matrix wide turned.tsv | grep -qF "a$turn"
}

@test "split -w any: as many environments and tasks as are asked for, nested" {
    synpo-matrix split -w any --envs 30 --tasks push,lift --ratio 0.2 >small.tsv
    synpo-matrix split -w any --envs 30 --tasks push,lift --ratio 0.3 >large.tsv
    [ "$(awk '$3 == 1' small.tsv | wc -l)" -eq 12 ]
    [ "$(awk '$3 == 1' large.tsv | wc -l)" -eq 18 ]
    comm -23 <(awk '$3 == 1' small.tsv | sort) <(awk '$3 == 1' large.tsv | sort) >outside
    [ ! -s outside ]
    sed -n 2p small.tsv | cut -f 1,2 | grep -qx 'env1	push'
    fails 64 synpo-matrix split -w any --envs 3
    says "--tasks is needed"
    fails 64 synpo-matrix split -w any --envs 3 --tasks a,a
    fails 64 synpo-matrix split -w any --envs a,,b --tasks 2
    says "an environment has no name"
    fails 64 synpo-matrix split -w any --envs 2000 --tasks 2000
}

load ../common
load pictures

# matrix SIDE [SCALE]: SIDE x SIDE pairs, a third of them seen.
matrix() {
    awk -v n="$1" -v scale="${2:-7}" 'BEGIN {
        OFS = "\t"
        print "env", "task", "seen", "episodes", "successes"
        for (e = 1; e <= n; e++) for (t = 1; t <= n; t++)
            print "env" e, "task" t, (e + t) % 3 == 0, 20, (e * scale + t * 5) % 21
    }'
}

differ() { if cmp -s "$1" "$2"; then complain "$1 and $2 are the same"; fi; }

# ansi ARGUMENT...: the matrix as characters. tasks ARGUMENT...: its tasks from top to bottom.
ansi() { NO_COLOR=1 synpo-render heatmap --ansi "$@"; }
tasks() { ansi "$@" | awk '/^t/ { print $1 }' | tr '\n' ' '; }

@test "every order, with margins, from 1 x 1 to 50 x 50" {
    for side in 1 5 50; do
        matrix $side >m.tsv
        for order in paper given natural mean cluster; do drawn heatmap --order $order --margins m.tsv; done
    done
    drawn heatmap --task-order cluster --env-order mean --no-values --scheme purple-red --title 'Título' m.tsv
}

@test "200 x 200, clustered" {
    matrix 200 >m.tsv
    drawn heatmap --order cluster m.tsv
}

@test "the orders of tasks and environments, as characters" {
    {
        printf 'env\ttask\tseen\tepisodes\tsuccesses\n'
        # Rates: t10 1.0 0.2, t9 0.2 0.8, t1 0.9 0.1.
        printf '%s\t%s\t1\t10\t%s\n' e2 t10 10 e1 t10 2 e2 t9 2 e1 t9 8 e2 t1 9 e1 t1 1
    } >m.tsv
    [ "$(tasks m.tsv)" = "t10 t9 t1 " ]
    [ "$(tasks --order given m.tsv)" = "t10 t9 t1 " ]
    [ "$(tasks --order natural m.tsv)" = "t1 t9 t10 " ]
    [ "$(tasks --order mean m.tsv)" = "t10 t9 t1 " ]
    [ "$(tasks --order cluster m.tsv)" = "t10 t1 t9 " ]
    [ "$(tasks --order cluster --task-order natural m.tsv)" = "t1 t9 t10 " ]
    ansi m.tsv | grep -qE '^ *e +1 +2$'
    ansi --env-order given m.tsv | grep -qE '^ *e +2 +1$'
    ansi --order mean m.tsv | grep -qE '^ *e +2 +1$'
    ansi --order mean --env-order natural m.tsv | grep -qE '^ *e +1 +2$'
    awk 'NR == 1 { print; next } { print | "sort -k2,2" }' m.tsv >sorted.tsv
    [ "$(tasks --order given sorted.tsv)" = "t1 t10 t9 " ]
}

@test "matrices side by side: by file, label, method, seed" {
    matrix 4 >one.tsv
    matrix 4 9 >two.tsv
    drawn heatmap one.tsv two.tsv
    cp a.png want
    synpo-render heatmap one=one.tsv two=two.tsv | cmp want -
    synpo-render heatmap one.tsv two=- <two.tsv | cmp want -
    synpo-render heatmap two.tsv one.tsv >other
    differ want other
    [ "$(ansi one.tsv two.tsv | grep -c '^task3 ')" -eq 2 ]
    [ "$(ansi one.tsv two.tsv | sed -n 1p)" = one ]
    # Two shards of one label are one panel.
    awk 'BEGIN { FS = OFS = "\t" } { print $0, NR == 1 ? "first_episode" : 20 }' one.tsv >shard.tsv
    ansi A=one.tsv,shard.tsv | grep -q '^40 episodes a pair$'
    fails 65 synpo-render heatmap A=one.tsv,one.tsv
    says "one.tsv"
    for seed in 1 2; do
        for method in synpo mlp; do
            awk -v s=$seed -v m=$method 'BEGIN { FS = OFS = "\t" } NR == 1 { print $0, "seed", "method"; next }
                { print $0, s, m }' one.tsv
        done
    done | awk 'NR == 1 || !/^env\t/' >all.tsv
    fails 65 synpo-render heatmap all.tsv
    says "rows of several methods ('mlp', 'synpo')"
    drawn heatmap --panels method all.tsv
    drawn heatmap --panels seed --method mlp all.tsv
    # Those left out are no panels.
    [ "$(ansi --panels method --method mlp all.tsv | grep -cE '^(synpo|mlp)$')" -eq 1 ]
    fails 65 synpo-render heatmap --panels seed --method mtl all.tsv
    says "no row of the method 'mtl'"
    [ "$(ansi --panels method all.tsv | grep -cE '^(synpo|mlp)$')" -eq 2 ]
    [ "$(ansi --panels seed --method mlp all.tsv | grep -c '^seed [12]$')" -eq 2 ]
    ansi --panels method A=all.tsv B=all.tsv | grep -qx 'B, mlp'
}

@test "--ansi: colours as the terminal has them, characters with NO_COLOR and in a pipe; --colour decides" {
    matrix 3 >m.tsv
    export TERM=xterm COLORTERM=truecolor
    synpo-render heatmap --ansi --colour always m.tsv >true
    grep -q "$(printf '\033\\[38;5;16;48;2;')" true
    COLORTERM='' synpo-render heatmap --ansi --colour always m.tsv >cube
    grep -q "$(printf '\033\\[38;5;16;48;5;')" cube
    TERM=dumb synpo-render heatmap --ansi m.tsv >dumb
    NO_COLOR=1 synpo-render heatmap --ansi m.tsv | cmp dumb -
    synpo-render heatmap --ansi m.tsv | cmp dumb -
    run -0 on_terminal "NO_COLOR=1 synpo-render heatmap --ansi m.tsv"
    cmp dumb "$BATS_TEST_TMPDIR/err"
    run -0 on_terminal "TERM=dumb synpo-render heatmap --ansi m.tsv"
    cmp dumb "$BATS_TEST_TMPDIR/err"
    run -0 on_terminal "synpo-render heatmap --ansi --color never m.tsv"
    cmp dumb "$BATS_TEST_TMPDIR/err"
    synpo-matrix show --colour never m.tsv | cmp dumb -
    synpo-matrix show --colour always m.tsv | cmp true -
    run -0 on_terminal "synpo-render heatmap --ansi m.tsv"
    cmp true "$BATS_TEST_TMPDIR/err"
    run -0 on_terminal "synpo-render map --ansi map1"
    synpo-render map --ansi --colour always map1 | cmp - "$BATS_TEST_TMPDIR/err"
    NO_COLOR=1 synpo-render map --ansi >maps
    [ "$(grep -c '^#' maps)" -eq 160 ]
    run ! grep -q "$(printf '\033')" maps
    synpo-render heatmap --ansi -o out m.tsv
    cmp dumb out
    synpo-render heatmap --ansi --colour always -o out m.tsv
    cmp true out
    fails 64 synpo-render heatmap --colour always m.tsv
    says "--colour is for --ansi"
    fails 64 synpo-render heatmap --ansi --margins m.tsv
    says "--margins is for a picture, not for --ansi"
    fails 64 synpo-render map --ansi --scale 1
}

@test "what is not UTF-8: 64 on the command line, 65 in a file" {
    matrix 2 >m.tsv
    for arguments in --title=$'\xff' $'\xe9=m.tsv' --title=$'a\nb'; do
        fails 64 synpo-render heatmap "$arguments" m.tsv
        says "UTF-8"
    done
    fails 64 synpo-render map --title $'\xff'
    # A byte of text takes some 6 kB to draw.
    long=$(head -c 1001 /dev/zero | tr '\0' x)
    fails 64 synpo-render heatmap --title "$long" m.tsv
    says "expected at most 1000 bytes"
    fails 64 synpo-render heatmap "$long=m.tsv"
    says "expected at most 1000"
    synpo-render heatmap --title "${long:1}" -o picture m.tsv
    for command in view episode embedding policy; do fails 64 synpo-render $command --title $'\xc3'; done
    cp m.tsv $'\xff.tsv'
    synpo-render heatmap $'\xff.tsv' >alone.png
    fails 64 synpo-render heatmap m.tsv $'\xff.tsv'
    says "the label '\xff' is not UTF-8 text"
    printf 'update\tstates\tloss\n1\t9\t0.5\n' >run.log
    fails 64 synpo-render curves -y loss $'\xff=run.log'
    fails 64 synpo-render curves -y loss --mark $'0=\xff' run.log
    sed '3s/task2/ta\xffk/' m.tsv >bad.tsv
    fails 65 synpo-render heatmap bad.tsv
    says "bad.tsv: line 3, column 2: found invalid UTF-8 at byte \xff"
}

@test "hostile matrices: 65, with line and column" {
    refused() {
        fails 65 synpo-render heatmap -o out good.tsv bad.tsv
        says "bad.tsv: $1"
        fails 65 synpo-render heatmap --ansi bad.tsv
    }
    matrix 2 >good.tsv
    cut -f 1,2,3,5 good.tsv >bad.tsv
    refused "line 1: no column 'episodes'"
    while IFS='|' read -r damage message; do
        sed "$damage" good.tsv >bad.tsv
        refused "$message"
    done <<'END'
2s/[^\t]*$/21/|line 2, column 5 ('successes'): found '21', expected at most 20, the row's episodes
3s/[^\t]*$/nan/|line 3, column 5 ('successes'): found 'nan', expected
3s/[^\t]*$/-1/|line 3, column 5 ('successes'): found '-1', expected
4s/\t20\t/\t-20\t/|line 4, column 4 ('episodes'): found '-20', expected
4s/\t20\t/\t0\t/|line 4, column 4 ('episodes'): found '0', expected
5s/\t20\t/\t1e300\t/|line 5, column 4 ('episodes'): found '1e300', expected
2s/^env1//|line 2, column 1 ('env'): found '', expected the name of an environment
1!d|line 1: found a header and no row
d|empty, expected a header line
5s/\t[^\t]*$//|line 5: found 4 fields, expected 5
END
    { head -n 1 good.tsv | tr -d '\n'; seq -f '%.0f' 1000000 | tr '\n' '\t' | sed 's/^/\t/; s/\t$/\n/'; } >bad.tsv
    refused "line 1: found 1000005 columns, expected at most 1000"
    awk 'BEGIN { OFS = "\t"; print "env", "task", "episodes", "successes";
        for (i = 0; i < 120000; ++i) print "e" i, "t", 1, 1 }' >bad.tsv
    fails 65 synpo-render heatmap bad.tsv
    says "120000 environments: expected at most 100000"
    awk 'BEGIN { OFS = "\t"; print "env", "task", "episodes", "successes";
        for (i = 0; i < 2001; ++i) print "e" i, "t", 1, 1 }' >bad.tsv
    fails 65 synpo-render heatmap --order cluster bad.tsv
    says "2001 names cannot be clustered, at most 2000"
    awk 'BEGIN { OFS = "\t"; print "env", "task", "episodes", "successes", "seed";
        for (i = 0; i < 101; ++i) print "e", "t", 1, 1, i }' >bad.tsv
    fails 65 synpo-render heatmap --panels seed bad.tsv
    says "more than 100 panels cannot be drawn"
    fails 66 synpo-render heatmap good.tsv missing.tsv
}

@test "wrong options: 64" {
    matrix 2 >m.tsv
    while read -r -a arguments; do
        fails 64 synpo-render heatmap "${arguments[@]}" m.tsv
    done <<'END'
--order best
--task-order
--env-order x
--panels run
--by method
--scheme grey
--cell 201
=m.tsv
A=m.tsv,
A= B=
- -
--ansi --cell 5
--ansi --scale 1
END
}

@test "the matrix of the man page, made with awk" {
    sed -n '/^awk .BEGIN/,/hand.png$/p' "$ROOT/man/synpo-render.1" | sed 's/\\et/\\t/' >example
    [ "$(wc -l <example)" -eq 7 ]
    bash example
    [ -s hand.png ]
}

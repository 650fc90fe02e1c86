load common
load render/pictures

@test "split | gen-expert | train | eval | summary | heatmap, as in the README" {
    synpo-matrix split --envs 3 --tasks 3 -n 5 -s 1 >pairs.tsv
    set -o pipefail
    synpo-gen-expert -p pairs.tsv -n 30 -s 1 |
        synpo-train -q -p pairs.tsv -m synpo -s 1 -n 3 --batch-states 64 --fill 30 \
        --expect 30 --log log.tsv --report 1 >synpo.ckpt
    synpo-eval -q -p pairs.tsv -n 2 <synpo.ckpt >synpo.tsv
    synpo-matrix summary synpo.tsv >summary.txt
    synpo-render heatmap <synpo.tsv >synpo.png

    [ "$(described synpo.ckpt .updates)" -eq 3 ]
    [ "$(wc -l <log.tsv)" -eq 4 ]
    awk -F '\t' 'NR > 1 { pairs += 1; seen += $11; episodes += $12 }
        END { exit !(pairs == 9 && seen == 5 && episodes == 18) }' synpo.tsv
    grep -q unseen summary.txt
    is_png synpo.png
}

@test "the matrix has the columns of synpo-matrix(5), and merge and summary read what eval wrote" {
    make_inputs
    head -n 1 m.tsv >got
    printf '%s\t' run world window method seed updates eval_seed first_episode env task seen episodes successes wrong \
        timeouts reward length |
        sed 's/$/temperature\tenv_hash\n/' | cmp - got
    synpo-matrix merge m.tsv >merged
    cmp m.tsv merged
    synpo-matrix summary -q --tsv m.tsv >summary.tsv
    awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i }
        NR > 1 && $at["subset"] == "all" { ok = $at["pairs"] == 2 && $at["episodes"] == 2 }
        END { exit !ok }' summary.tsv
}

@test "the run log is a table: a row per report, numbers or NA, its updates in order" {
    make_inputs
    synpo-train "${TINY[@]}" -n 6 --log log.tsv --report 2 --evaluate-every 4 --evaluate-episodes 2 <e.jsonl >/dev/null
    awk -F '\t' '
        NR == 1 { columns = NF; for (i = 1; i <= NF; ++i) at[$i] = i; next }
        NF != columns { print "line " NR ": " NF " fields"; exit bad = 1 }
        { for (i = 1; i <= NF; ++i) if ($i != "NA" && $i !~ /^-?[0-9.]+(e[-+][0-9]+)?$/) { print "found " $i;
        exit bad = 1 } }
        { updates = updates $at["update"] " "; evaluated = evaluated ($at["seen_success"] == "NA" ? 0 : 1) }
        END { if (!bad && updates evaluated != "2 4 6 011") { print updates evaluated; bad = 1 } exit bad }' log.tsv
    jq -R -s -e 'split("\n")[0] | split("\t") | index("policy") and index("right_walk_on") and index("states_per_s")' \
        log.tsv
}

@test "pictures: heatmap, map, view are whole PNGs, and the same bytes twice" {
    make_inputs
    for command in "heatmap m.tsv" map "map map3 map19" "view -e map3 --steps 5" "view --window 0 --history"; do
        # shellcheck disable=SC2086
        drawn $command
    done
}

@test "without -q there are words on stderr, with it none, and none on stdout" {
    make_inputs
    synpo-train "${TINY[@]}" -n 1 <e.jsonl >a 2>quiet
    [ ! -s quiet ]
    synpo-train "${TINY[@]:1}" -n 1 <e.jsonl >b 2>words
    cmp a b
    grep -q '^synpo-train: 1 update, .* peak memory [0-9]* MB$' words
    synpo-eval -q -p two.tsv -n 1 <a >m 2>quiet
    [ ! -s quiet ]
}

@test "the default training stays under 1 GB" {
    synpo-gen-expert -n 2100 >e.jsonl
    synpo-train -n 1 <e.jsonl 2>words >/dev/null
    memory=$(sed -n 's/.*peak memory \([0-9]*\) MB.*/\1/p' words)
    [ "$memory" -gt 50 ]
    [ "$memory" -lt 1000 ]
}

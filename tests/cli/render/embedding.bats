load ../common
load pictures

CHECKPOINT=a.ckpt

setup_file() { make_inputs; }
setup() { set_up e.jsonl a.ckpt; }

@test "embeddings: components and distances, of what was trained or of all" {
    all_differ embedding "" "--all" "--kind distance" "--kind distance --all" "--kind distance --metric euclidean" \
        "--title Embeddings" "--scale 1"
}

@test "embeddings: wrong options 64, no checkpoint 65, missing 66" {
    refuses_broken_checkpoints synpo-render embedding
    fails 64 synpo-render embedding --kind tsne a.ckpt
    says "expected pca or distance"
    fails 64 synpo-render embedding --metric euclidean a.ckpt
    says "--metric is for --kind distance"
    fails 64 synpo-render embedding --kind distance --metric taxi a.ckpt
    says "expected cosine or euclidean"
}

@test "embeddings of one environment: 65, nothing to compare" {
    printf 'env\ttask\nmap1\tR-B\nmap1\tB-G\n' >one.tsv
    synpo-gen-expert -p one.tsv -n 30 >one.jsonl
    synpo-train "${TINY[@]}" -n 1 -p one.tsv --strip <one.jsonl >one.ckpt
    fails 65 synpo-render embedding -o out one.ckpt
    says "fewer than two environments"
    synpo-render embedding --all one.ckpt >a.png
}

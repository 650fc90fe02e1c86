# Shared by the tests of pictures.

is_png() {
    head -c 8 "$1" >magic
    printf '\211PNG\r\n\032\n' | cmp magic -
    tail -c 8 "$1" >end
    printf 'IEND\256B`\202' | cmp end -
}

# drawn COMMAND ARGUMENT...: a whole PNG in a.png, the same bytes on standard output and in the file of -o.
# Where CHECKPOINT is set it is drawn, and the second time it comes from standard input.
drawn() {
    synpo-render "$@" ${CHECKPOINT:+"$CHECKPOINT"} >a.png
    synpo-render "$@" -o b.png <"${CHECKPOINT:-/dev/null}"
    cmp a.png b.png
    is_png a.png
}

# all_differ "COMMAND ARGUMENT..." OPTIONS...: each of the OPTIONS draws a picture, of which no two are alike.
all_differ() {
    local command=$1
    shift
    for options in "$@"; do
        # shellcheck disable=SC2086
        drawn $command $options
        md5sum <a.png >>sums
    done
    [ "$(sort -u sums | wc -l)" -eq $# ]
}

# refuses_broken_checkpoints COMMAND...: other files, parts of a checkpoint, none, and two.
refuses_broken_checkpoints() {
    fails 65 "$@" -o out e.jsonl
    says "not a safetensors file"
    head -c 100000 a.ckpt >part.ckpt
    fails 65 "$@" -o out part.ckpt
    : >empty.ckpt
    fails 65 "$@" -o out empty.ckpt
    head -c 5000 /dev/urandom >noise.ckpt
    fails 65 "$@" -o out noise.ckpt
    fails 66 "$@" missing.ckpt
    says "'missing.ckpt'"
    fails 64 "$@" a.ckpt a.ckpt
}

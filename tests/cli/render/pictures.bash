# What the tests of pictures share.

is_png() {
    head -c 8 "$1" >magic
    printf '\211PNG\r\n\032\n' | cmp magic -
    tail -c 8 "$1" >end
    printf 'IEND\256B`\202' | cmp end -
}

# drawn COMMAND ARGUMENT...: a whole PNG of a.ckpt, the same bytes from the operand and from standard input, in a.png.
drawn() {
    synpo-render "$@" a.ckpt >a.png
    synpo-render "$@" -o b.png <a.ckpt
    cmp a.png b.png
    is_png a.png
}

# all_differ COMMAND OPTIONS...: pictures of the checkpoint, each with options of its own, of which no two are alike.
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

# What is no checkpoint, or not a whole one.
refuses_what_is_no_checkpoint() {
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

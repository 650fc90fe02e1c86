load ../common

setup_file() { make_inputs; }
setup() { set_up pairs.tsv two.tsv e.jsonl a.ckpt m.tsv; }

teardown() {
    [ -z "${pid-}" ] || kill -9 "$pid" 2>/dev/null || true
}

# refused_before CODE OUTPUT: a training is told CODE for -o OUTPUT although its stream is broken too, which would be
# 65.
refused_before() {
    fails "$1" synpo-train -q -n 3 -o "$2" <two.tsv
}

@test "standard error is closed: no progress in the checkpoint" {
    loud=(-p pairs.tsv -n 3 --batch-states 16 --running 16 --fill 5 -j 1 --report 1 --evaluate-every 3
        --evaluate-episodes 2)
    synpo-train "${loud[@]}" -o open <e.jsonl
    synpo-train "${loud[@]}" -o closed <e.jsonl 2>&-
    cmp open closed
    synpo-train "${loud[@]}" -o closed <e.jsonl 2>&- >&-
    cmp open closed
}

@test "standard input is closed: 66; standard output is closed: 73, before the work" {
    for command in "synpo-gen-expert --relabel" "synpo-eval -q" "synpo-matrix summary" "synpo-render episode"; do
        # shellcheck disable=SC2086
        fails 66 $command <&-
        says "cannot read standard input: it is not open for reading"
    done
    status=0
    synpo-train -q -n 3 <two.tsv >&- 2>err || status=$?
    [ "$status" -eq 73 ]
    grep -q 'cannot write standard output: it is not open for writing' err
    for tool in $TOOLS; do
        status=0
        "$tool" --help >&- 2>err || status=$?
        [ "$status" -eq 73 ]
    done
}

@test "-o follows links, to a file that is there, to one that is not, over several, from another folder" {
    mkdir real other
    echo old >real/there
    ln -s ../real/there other/link
    ln -s ../real/new other/dangling
    ln -s "$PWD/other/link" chain
    synpo-matrix split >want
    for link in other/link other/dangling chain; do
        synpo-matrix split -o "$link"
        [ -L "$link" ]
        cmp "$link" want
        echo old >real/there
    done
    cmp real/new want
    [ "$(ls -A real other)" = "$(printf 'other:\ndangling\nlink\n\nreal:\nnew\nthere')" ]
    synpo-train "${TINY[@]}" -n 2 --save other/link --every 1 --log chain.log <e.jsonl >a
    [ -L other/link ]
    cmp real/there a
    ln -s loop1 loop2
    ln -s loop2 loop1
    refused_before 73 loop1
    says "Too many levels of symbolic links"
}

@test "-o keeps the rights of the file that is there" {
    for mode in 600 640 755 444; do
        echo old >out
        chmod $mode out
        synpo-matrix split -o out
        [ "$(stat -c %a out)" = $mode ]
        [ "$(head -c 3 out)" = env ]
        rm -f out
    done
    umask 077
    synpo-matrix split -o out
    [ "$(stat -c %a out)" = 600 ]
}

@test "-o keeps the owner of the file that is there, where root writes it" {
    [ "$(id -u)" -eq 0 ] || skip "needs root"
    echo old >out
    chown 12345:23456 out
    synpo-matrix split -o out
    [ "$(stat -c %u:%g out)" = 12345:23456 ]
}

@test "devices, pipes and open descriptors are written as they are" {
    synpo-matrix split >want
    synpo-matrix split -o /dev/stdout >got
    cmp want got
    synpo-matrix split -o /dev/stdout | cmp want
    synpo-matrix split -o /dev/fd/3 3>got
    cmp want got
    { echo before; synpo-matrix split -o /dev/fd/3 3>&1; echo after; } >got
    { echo before; cat want; echo after; } | cmp - got
    synpo-matrix split -o /dev/null
    [ -c /dev/null ]
    mkfifo pipe
    cat pipe >got &
    synpo-matrix split -o pipe
    wait $!
    cmp want got
    [ -p pipe ]
    [ -z "$(find . -name '*.part*')" ]
    refused_before 73 /dev/fd/77
    status=0
    synpo-train -q -n 3 -o /dev/fd/3 3<two.tsv <two.tsv 2>err || status=$?
    [ "$status" -eq 73 ]
    grep -q "it is not open for writing" err
}

@test "what no other file can take the place of is refused before the work: folders, no name" {
    mkdir folder
    for name in folder folder/ . .. new/ folder/new/x "$(printf 'x%.0s' {1..300})"; do
        refused_before 73 "$name"
        says "cannot create '"
    done
    refused_before 64 ""
    # A name as long as may be has room for a temporary.
    long=$(printf 'x%.0s' {1..255})
    synpo-matrix split -o "$long"
    [ "$(ls -A)" = "$(ls -A | grep -v part)" ]
}

@test "a file that is mounted is refused before the work" {
    echo old >out
    echo under >mounted
    unshare --mount true 2>/dev/null || skip "needs the right to mount"
    # shellcheck disable=SC2016
    status=0
    unshare --mount sh -c 'mount --bind mounted out && exec synpo-train -q -n 3 -o out' <two.tsv 2>err || status=$?
    [ "$status" -eq 73 ] || { [ "$status" -eq 32 ] && skip "cannot mount"; }
    grep -q "cannot create 'out': something is mounted there" err
    grep -qx old out
    [ -z "$(find . -name '*.part*')" ]
}

@test "another user's file in a folder for all is refused before the work" {
    [ "$(id -u)" -eq 0 ] || skip "needs root"
    # A path that another user may enter.
    open=$(mktemp -d)
    chmod 1777 "$open"
    cp two.tsv "$open"
    echo old >"$open/out"
    chmod 666 "$open/out"
    cp "$(command -v synpo-train)" "$open/synpo-train"
    chmod 755 "$open/synpo-train"
    status=0
    (cd "$open" && setpriv --reuid 12345 --regid 12345 --clear-groups ./synpo-train -q -n 3 -o out <two.tsv) 2>err ||
        status=$?
    grep -qx old "$open/out"
    rm -r "$open"
    [ "$status" -eq 73 ] || complain "exit code $status: $(cat err)"
    grep -q "the file there is another user's, and in its folder only the owner may replace it" err
}

@test "a file that must not be changed is refused before the work" {
    echo old >out
    chattr +i out 2>/dev/null || skip "needs root, and a file system that can"
    status=0
    synpo-train -q -n 3 -o out <two.tsv 2>err || status=$?
    chattr -i out
    [ "$status" -eq 73 ]
    grep -q "marked as one that must not be replaced" err
}

@test "a finished file that cannot have its name is kept, and named; no later run removes it" {
    mkfifo stream
    synpo-gen-expert --relabel -o out <stream 2>err 3>&- &
    pid=$!
    exec 9>stream
    cat e.jsonl >&9
    for ((i = 0; i < 200; ++i)); do
        [ -n "$(find . -name 'out.*.part')" ] && break
        sleep 0.05
    done
    mkdir -p out/x
    exec 9>&-
    status=0
    wait "$pid" || status=$?
    pid=
    [ "$status" -eq 74 ]
    kept=$(sed -n "s/.*cannot rename to 'out': .*; it is kept as '\(.*\)'/\1/p" err)
    cmp "$kept" <(synpo-gen-expert --relabel <e.jsonl)
    rm -r out
    synpo-matrix split -o out
    [ -f "$kept" ]
}

@test "an output that is an input, or another output: 64, and nothing is lost" {
    synpo-train "${TINY[@]}" -n 2 -p pairs.tsv --save saved --log log.tsv <e.jsonl >/dev/null
    for file in pairs.tsv e.jsonl a.ckpt m.tsv; do
        cp --remove-destination "$(readlink -f $file)" $file
    done
    ln -s pairs.tsv link
    mkdir folder
    ln -s ../pairs.tsv folder/link
    cp -r . ../before
    refuse() {
        fails 64 "$@" </dev/stdin
        says "$message"
        diff -r ../before .
    }
    message="cannot write 'pairs.tsv': it is read as well"
    refuse synpo-train "${TINY[@]}" -n 2 -p pairs.tsv -o pairs.tsv <e.jsonl
    refuse synpo-train "${TINY[@]}" -n 2 -p pairs.tsv --log pairs.tsv <e.jsonl
    refuse synpo-train "${TINY[@]}" -n 2 -p link --save pairs.tsv <e.jsonl
    refuse synpo-train "${TINY[@]}" -n 2 -p "$PWD/folder/../pairs.tsv" --save pairs.tsv <e.jsonl
    refuse synpo-eval -q -n 1 -p pairs.tsv -c a.ckpt --record pairs.tsv
    message="cannot write 'link': it is read as well, as 'pairs.tsv'"
    refuse synpo-train "${TINY[@]}" -n 2 -p pairs.tsv --log link <e.jsonl
    message="cannot write 'folder/link': it is read as well, as 'pairs.tsv'"
    refuse synpo-eval -q -n 1 -p pairs.tsv -c a.ckpt -o folder/link
    message="cannot read 'pairs.tsv': an output goes there"
    refuse synpo-gen-expert -n 3 -p pairs.tsv -o pairs.tsv
    message="cannot read a standard stream: an output goes there, to 'e.jsonl'"
    refuse synpo-train "${TINY[@]}" -n 2 -o e.jsonl <e.jsonl
    refuse synpo-gen-expert --relabel -o e.jsonl <e.jsonl
    message="it is read as well"
    refuse synpo-train "${TINY[@]}" -n 2 --init a.ckpt -o a.ckpt <e.jsonl
    refuse synpo-train "${TINY[@]}" -n 2 --init a.ckpt --save a.ckpt <e.jsonl
    refuse synpo-train -q --resume saved -n 3 --strip -o saved <e.jsonl
    refuse synpo-train -q --resume saved -n 3 --log saved <e.jsonl
    refuse synpo-eval -q -n 1 -p two.tsv -c a.ckpt -o a.ckpt
    refuse synpo-eval -q -n 1 -p two.tsv -o a.ckpt <a.ckpt
    refuse synpo-finetune adapt -q -n 1 -c a.ckpt -o a.ckpt <e.jsonl
    refuse synpo-finetune ppo -q --steps 10 -c a.ckpt --save a.ckpt
    refuse synpo-matrix merge m.tsv -o m.tsv
    refuse synpo-matrix filter m.tsv -o m.tsv
    message="cannot write 'same': another output goes there, to './same'"
    refuse synpo-eval -q -n 1 -p two.tsv -c a.ckpt --record ./same -o same
    message="another output goes there, to 'same'"
    refuse synpo-eval -q -n 1 -p two.tsv -c a.ckpt --record same -o same
    refuse synpo-train "${TINY[@]}" -n 2 --save same -o same --strip <e.jsonl
    refuse synpo-train "${TINY[@]}" -n 2 --log same -o same <e.jsonl
    refuse synpo-train "${TINY[@]}" -n 2 --log same --save same <e.jsonl
}

@test "what is appended to standard output is not one of the inputs, nor a log" {
    synpo-train "${TINY[@]}" -n 2 --log log.tsv <e.jsonl >/dev/null
    cp "$(readlink -f m.tsv)" copy.tsv
    status=0
    synpo-matrix merge copy.tsv >>copy.tsv 2>err || status=$?
    [ "$status" -eq 64 ]
    cmp copy.tsv m.tsv
    cp log.tsv before
    status=0
    synpo-train "${TINY[@]}" -n 2 --log log.tsv <e.jsonl >>log.tsv 2>err || status=$?
    [ "$status" -eq 64 ]
    cmp log.tsv before
}

@test "files that one command may use twice: what holds as much, devices" {
    synpo-train "${TINY[@]}" -n 4 <e.jsonl >whole
    synpo-train "${TINY[@]}" -n 2 --save run -o run <e.jsonl
    synpo-train -q --resume run -n 4 --save run -o run <e.jsonl
    cmp run whole
    synpo-train "${TINY[@]}" -n 2 -o run <e.jsonl
    synpo-train -q --resume ./run -n 4 --every 1 --save run -o other --strip <e.jsonl
    cmp run whole
    synpo-eval -q -n 1 -p two.tsv -c a.ckpt --record /dev/null -o /dev/null
    synpo-matrix merge m.tsv m.tsv -o out && complain "a matrix was counted twice"
    synpo-render heatmap "A=m.tsv" "B=m.tsv" -o out.png
}

@test "what needs a file is given none: 64" {
    mkfifo pipe
    for option in "--save -" "--log -" "--save pipe" "--save /dev/stdout"; do
        # shellcheck disable=SC2086
        fails 64 synpo-train "${TINY[@]}" -n 2 $option <e.jsonl
        says "expected a file"
    done
    fails 64 synpo-render episode e.jsonl --frames -
    fails 64 synpo-render episode e.jsonl --video -
    [ -p pipe ]
}

@test "a folder of frames follows a link, and appears whole" {
    mkdir empty
    ln -s empty link
    ln -s new dangling
    for name in link dangling; do
        synpo-render episode e.jsonl --frames $name
        [ -L $name ]
        [ -s $name/0000.png ]
    done
    [ "$(ls -A | grep -c part)" -eq 0 ]
}

@test "file, name and folder are flushed to the disk, in this order; a temporary is not followed nor shared" {
    command -v strace >/dev/null || skip "needs strace"
    strace -f -y -e trace=open,openat,fsync,rename,renameat,renameat2 -o trace synpo-matrix split -o out 2>/dev/null ||
        skip "strace cannot trace here"
    grep -Eq 'openat\(.*"\./out\.[a-z2-7]{12}\.part", O_RDWR\|O_CREAT\|O_EXCL\|O_NOFOLLOW\|O_CLOEXEC, 0666\)' trace
    grep -E 'fsync|rename' trace | sed 's/.*\(fsync\|rename\)[a-z0-9]*(\(.*\)) *= 0/\1 \2/' >order
    [ "$(cut -d ' ' -f 1 order | tr '\n' ' ')" = "fsync rename fsync " ]
    sed -n 1p order | grep -q '/out\.[a-z2-7]*\.part>$'
    sed -n 2p order | grep -q '", "out"$'
    sed -n 3p order | grep -q "<$PWD>\$"
}

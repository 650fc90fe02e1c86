load common

# A small tree of modules, cut from the real one.
tree() {
    mkdir -p lib tools tests/unit/draw tests/unit/world
    for file in lib/base/error.h lib/base/files/io.h lib/world/world.h lib/world/grid/maze.h lib/world/kitchen/rules.h \
        lib/format/tsv.h lib/nn/gemm.h \
        lib/nn/layers/dense.h lib/policy/policy.h lib/policy/head/groups.h lib/play/model.h lib/learn/steps.h \
        lib/stats/interval.h lib/stats/matrix/runs.h \
        lib/draw/colour.h lib/draw/canvas/canvas.h lib/draw/plot/axes.h lib/draw/face/path.h \
        lib/draw/episode/time_bar.h lib/draw/grid/maze_picture.h lib/draw/terminal/terminal.h lib/draw/worlds/faces.h \
        tools/synpo-eval.cc; do
        mkdir -p "$(dirname $file)"
        cp "$ROOT/$file" $file
    done
}

# refused FILE INCLUDE: an include planted at the end of FILE is found, with its line, and nothing else is.
refused() {
    echo "#include $2" >>"$1"
    "$ROOT/scripts/check-order" . >found && complain "$1 may include $2"
    [ "$(cut -d : -f 1,2 found)" = "$1:$(wc -l <"$1")" ] || complain "found '$(cat found)'"
    sed -i '$d' "$1"
}

@test "check-order: the tree is in order, and so is a small one cut from it" {
    "$ROOT/scripts/check-order"
    tree
    "$ROOT/scripts/check-order" .
}

@test "check-order: every step down is refused where it is planted" {
    tree
    while read -r file include; do
        refused "$file" "$include"
    done <<'END'
lib/base/error.h "world/world.h"
lib/base/error.h "base/files/io.h"
lib/base/files/io.h "format/tsv.h"
lib/base/files/io.h "base/cli/options.h"
lib/world/world.h "format/tsv.h"
lib/world/world.h "world/grid/maze.h"
lib/world/grid/maze.h "nn/layers/dense.h"
lib/world/grid/maze.h "world/kitchen/rules.h"
lib/world/kitchen/rules.h "world/grid/maze.h"
lib/format/tsv.h "world/world.h"
lib/format/tsv.h <nn/layers/dense.h>
lib/nn/gemm.h "nn/layers/dense.h"
lib/nn/layers/dense.h "world/world.h"
lib/nn/layers/dense.h   "format/tsv.h"
lib/nn/layers/dense.h "policy/policy.h"
lib/policy/policy.h "policy/head/groups.h"
lib/policy/policy.h "play/model.h"
lib/policy/policy.h "stats/interval.h"
lib/play/model.h "learn/steps.h"
lib/learn/steps.h "draw/canvas/canvas.h"
lib/stats/interval.h "world/world.h"
lib/stats/interval.h "stats/matrix/runs.h"
lib/stats/matrix/runs.h "draw/colour.h"
lib/draw/colour.h "draw/canvas/canvas.h"
lib/draw/canvas/canvas.h "nn/gemm.h"
lib/draw/canvas/canvas.h "policy/policy.h"
lib/draw/canvas/canvas.h "play/model.h"
lib/draw/canvas/canvas.h "draw/plot/axes.h"
lib/draw/plot/axes.h "draw/grid/maze_picture.h"
lib/draw/plot/axes.h <opencv2/core.hpp>
lib/draw/face/path.h "draw/plot/axes.h"
lib/draw/face/path.h "draw/episode/time_bar.h"
lib/draw/face/path.h "draw/grid/maze_picture.h"
lib/draw/face/path.h "draw/worlds/faces.h"
lib/draw/episode/time_bar.h "draw/plot/axes.h"
lib/draw/episode/time_bar.h "draw/grid/maze_picture.h"
lib/draw/grid/maze_picture.h "draw/kitchen/kitchen_picture.h"
lib/draw/grid/maze_picture.h "draw/plot/axes.h"
lib/draw/grid/maze_picture.h "draw/episode/time_bar.h"
lib/draw/grid/maze_picture.h "draw/worlds/faces.h"
lib/draw/worlds/faces.h "draw/episode/time_bar.h"
lib/draw/terminal/terminal.h "draw/canvas/canvas.h"
lib/draw/terminal/terminal.h "draw/grid/maze_picture.h"
lib/world/grid/maze.h "../format/tsv.h"
lib/world/grid/maze.h "task.h"
lib/world/grid/maze.h <opencv2/core.hpp>
tools/synpo-eval.cc <opencv2/core.hpp>
END
}

@test "check-order: violations with their lines; OpenCV and cairo in their wings alone; unknown wings" {
    tree
    sed -i '3i #include "format/tsv.h"' lib/world/world.h
    sed -i '2i # include <opencv2/core.hpp>' lib/nn/gemm.h
    mkdir lib/attic lib/draw/attic lib/kernel lib/kernel/attic
    mkdir -p lib/draw/video
    echo '#include <opencv2/core.hpp>' >lib/draw/video/video.cc
    cp lib/draw/video/video.cc tests/unit/world/world_test.cc
    cp lib/draw/video/video.cc lib/draw/canvas/canvas.cc
    echo '#include <cairo.h>' >lib/draw/canvas/font.cc
    cp lib/draw/canvas/font.cc tests/unit/draw/canvas_test.cc
    cp lib/draw/canvas/font.cc lib/draw/plot/axes.cc
    for wing in attic draw/attic kernel/attic; do echo '#pragma once' >lib/$wing/old.h; done
    run -1 "$ROOT/scripts/check-order" .
    printf '%s\n' "${lines[@]}" | cut -d : -f 1,2 | sort >got
    printf '%s\n' lib/attic/old.h:1 lib/draw/attic/old.h:1 lib/draw/canvas/canvas.cc:1 lib/draw/plot/axes.cc:1 \
        lib/kernel/attic/old.h:1 lib/nn/gemm.h:2 \
        lib/world/world.h:3 \
        tests/unit/world/world_test.cc:1 | cmp - got
    mkdir empty
    run -66 "$ROOT/scripts/check-order" empty
    mkdir empty/lib
    run -66 "$ROOT/scripts/check-order" empty
}

@test "check-order: a folder has at most 20 files" {
    tree
    for i in {1..19}; do : >lib/format/$i.txt; done
    "$ROOT/scripts/check-order" .
    : >lib/format/20.txt
    run -1 "$ROOT/scripts/check-order" .
    [ "$output" = "lib/format: 21 files, expected at most 20" ]
}

# kernel TARGET TEXT: an object of that name, with this in the namespace that it should stay in.
kernel() { echo "namespace synpo::$1 { $2 } ${3-}" | g++ -std=c++17 -x c++ -c -o "build/lib/kernel/target_$1.o" -; }

# check UNIT CASES [NAME=STATUS]...: scripts/check over a unit test program and a test file made of these texts (TEST
# stands for bats' own word, which this file cannot hold); its last line in $last.
check() {
    mkdir -p build/lib/kernel cli
    [ -e build/lib/kernel/target_plain.o ] || kernel plain 'int mine() { return 1; }'
    {   # of the parts the first has all tests
        printf '#!/bin/sh\n[ "$GTEST_SHARD_INDEX" = 0 ] || {\n%s\n}\n' "$(gtest)"
        printf '%s\n' "$1"
    } >build/unit-tests
    chmod +x build/unit-tests
    printf '%s\n' "$2" | sed 's/^TEST/@test/' >cli/x.bats
    status=0
    # bats inside bats: what the outer one exports would mislead the inner one.
    env -i PATH=/usr/local/bin:/usr/bin:/bin TMPDIR="$BATS_TEST_TMPDIR" CHECK_CLI="$PWD/cli" \
        "$ROOT/scripts/check" "$PWD/build" "${@:3}" >out 2>&1 3>&- 4>&- || status=$?
    last=$(tail -n 1 out)
}

gtest() { # RESULT...: a program that writes such results as gtest does
    printf 'for a; do case $a in --gtest_output=json:*) out=${a#*json:};; esac; done\n'
    printf "cat >\"\$out\" <<'END'\n"
    local result failures list= bad=0
    for result; do
        failures=
        [ "$result" != FAILED ] || { failures=', "failures": [{"failure": "x"}]' bad=1; }
        list+=${list:+,}"{\"status\": \"RUN\", \"result\": \"${result/FAILED/COMPLETED}\"$failures}"
    done
    printf '{"testsuites": [{"testsuite": [%s]}]}\nEND\nexit %d\n' "$list" "$bad"
}

@test "check: counts over all runners, in its last line" {
    check "$(gtest COMPLETED COMPLETED)" 'TEST "a" { true; }'
    [ "$status $last" = "0 5 passed, 0 failed" ] || complain "$(cat out)"
    check "$(gtest COMPLETED SKIPPED)" 'TEST "a" { skip; }
TEST "b" { true; }'
    [ "$status $last" = "0 4 passed, 0 failed, 2 skipped" ] || complain "$(cat out)"
}

@test "check: a failure anywhere is counted, printed, and the other runners still run" {
    check "$(gtest COMPLETED FAILED)" 'TEST "a" { true; }'
    [ "$status $last" = "1 4 passed, 1 failed" ] || complain "$(cat out)"
    check "$(gtest FAILED)" 'TEST "a" { echo the reason; false; }'
    [ "$status $last" = "1 2 passed, 2 failed" ] || complain "$(cat out)"
    grep -q "the reason" out
    check "$(gtest COMPLETED)" 'TEST "a" { true; }' lint=0 fuzz=7
    [ "$status $last" = "1 5 passed, 1 failed" ] || complain "$(cat out)"
    grep -q "check: fuzz ended with status 7" out
}

@test "check: a runner that dies, or runs nothing, is a failure" {
    check 'kill -SEGV $$' 'TEST "a" { true; }'
    [ "$status $last" = "1 3 passed, 1 failed" ] || complain "$(cat out)"
    check "$(gtest)" 'TEST "a" { true; }'
    [ "$status $last" = "1 3 passed, 1 failed" ] || complain "$(cat out)"
    check "$(gtest COMPLETED)
exit 3" '# no test'
    [ "$status $last" = "1 3 passed, 1 failed" ] || complain "$(cat out)"
    check "$(gtest COMPLETED | sed 's/exit 0/exit 3/')" 'TEST "a" { true; }'
    [ "$status $last" = "1 4 passed, 1 failed" ] || complain "$(cat out)"
    check "$(gtest COMPLETED)" 'TEST "a" { true'
    [ "$status" -eq 1 ] || complain "$(cat out)"
    run -64 "$ROOT/scripts/check" no-such-build
}

@test "deps: nothing to do where all is installed; without root or sudo it names what is missing" {
    "$ROOT/scripts/deps" bash bats >out 2>&1
    [ ! -s out ]
    run -64 "$ROOT/scripts/deps"
    mkdir bin
    printf '#!/bin/sh\necho 1000\n' >bin/id
    printf '#!/bin/sh\necho "apt-get $*" >&2\nexit 1\n' >bin/apt-get
    chmod +x bin/*
    for tool in dpkg-query env sh dirname; do ln -s "$(command -v $tool)" bin/$tool; done
    status=0
    PATH=$PWD/bin "$ROOT/scripts/deps" bash no-such-package >out 2>&1 || status=$?
    [ "$status" -eq 77 ]
    grep -q "missing: no-such-package" out
    printf '#!/bin/sh\necho "sudo $*"\n' >bin/sudo
    chmod +x bin/sudo
    PATH=$PWD/bin "$ROOT/scripts/deps" bash no-such-package >out 2>&1
    grep -qx 'sudo env DEBIAN_FRONTEND=noninteractive apt-get -q update' out
    grep -qx 'sudo env DEBIAN_FRONTEND=noninteractive apt-get -q -y --no-install-recommends install no-such-package' out
}

@test "check: a kernel that exports what others could use is a failure" {
    mkdir -p build/lib/kernel
    kernel avx2 'int mine() { return 1; }' 'int shared() { return 2; }'
    check "$(gtest COMPLETED)" 'TEST "a" { true; }'
    [ "$status $last" = "1 3 passed, 1 failed" ] || complain "$(cat out)"
    grep -q 'shared()' out
    run ! grep -q 'mine()' out
    rm build/lib/kernel/target_avx2.o
    : >build/lib/kernel/target_plain.o # which holds nothing that could be looked at
    check "$(gtest COMPLETED)" 'TEST "a" { true; }'
    [ "$status $last" = "1 3 passed, 1 failed" ] || complain "$(cat out)"
}

# standing_in FOLDER NAME...: programs of these names there that do what stdin says.
standing_in() {
    local name script
    script=$(cat)
    mkdir -p "$1"
    for name in "${@:2}"; do
        printf '#!/bin/sh\n%s\n' "$script" >"$1/$name"
        chmod +x "$1/$name"
    done
}

@test "completions: a program that does not run gives none" {
    standing_in bin synpo-train <<<'exit 3'
    run -3 "$ROOT/scripts/completions" bash bin/synpo-train
    [ -z "$output" ] || complain "found '$output'"
    # Nor does one whose command does not.
    standing_in bin synpo-train <<<'[ "$1" = --list-options ] || exit 3; printf "command\tsplit\tsplits\n"'
    run -3 "$ROOT/scripts/completions" bash bin/synpo-train
}

@test "gpu-kit: the folder is the caller's, and is replaced only where it is a kit" {
    cp -r "$ROOT/scripts" .
    mkdir -p mine/kit empty
    echo mine >mine/kit/notes
    cd mine
    run -73 ../scripts/gpu-kit kit
    [ "$output" = "gpu-kit: $PWD/kit is no kit, and not empty" ]
    [ "$(cat kit/notes)" = mine ]
    for folder in ../empty ../empty new; do
        ../scripts/gpu-kit "$folder"
        [ -d "$folder/gtest/src" ]
    done
    ../scripts/gpu-kit
    [ -d ../build-kit/eigen3/Eigen ]
}

@test "deb: the time is that of this tree, not that of a repository which it lies in" {
    command -v git >/dev/null || skip "no git here"
    export HOME=$PWD GIT_CONFIG_NOSYSTEM=1
    git init -q .
    git -c user.name=x -c user.email=x@y.z commit -q --allow-empty -m one
    mkdir -p tree/build
    for name in CHANGELOG.md GUIDE.md LICENSE Makefile README.md RESULTS.md examples lib man python scripts tests \
        tools packaging; do mkdir "tree/$name"; done
    cp -r "$ROOT/scripts" "$ROOT/packaging" tree/
    touch -d @1234567890 tree/Makefile
    standing_in bin dh </dev/null
    standing_in bin dpkg-buildpackage <<<'echo "$SOURCE_DATE_EPOCH" >../x.deb'
    PATH=$PWD/bin:$PATH tree/scripts/deb "$PWD/tree/build" 1.2.3
    [ "$(cat tree/build/deb/x.deb)" = 1234567890 ] || complain "found the time $(cat tree/build/deb/x.deb)"
}

@test "check-deb: runs what the packages installed, not what comes first in PATH" {
    [ ! -e /usr/bin/synpo-matrix ] || skip "the packages are installed here"
    for package in synpo synpo-render libsynpo-dev python3-synpo; do
        mkdir -p build/deb
        : >"build/deb/${package}_1_all.deb"
    done
    standing_in bin dpkg-query <<<'exit 1'
    standing_in bin id <<<'echo 0'
    standing_in bin lintian apt-get dpkg </dev/null
    standing_in bin synpo-matrix <<<'touch wrong; exit 1'
    sed -i "s|touch wrong|touch $PWD/wrong|" bin/synpo-matrix
    PATH=$PWD/bin:$PATH run -127 "$ROOT/scripts/check-deb" "$PWD/build"
    [ ! -e wrong ]
}

@test "check-gpu: what fails is a failure, whatever an earlier run has left" {
    cp -r "$ROOT/scripts" .
    standing_in bin make nvidia-smi python3 </dev/null
    standing_in build-gpu synpo-matrix synpo-gen-expert </dev/null
    standing_in build-gpu engine-tests <<<'echo "x loss 1e-7 logits 1e-6 worst gradient 1e-5"'
    # One that writes every checkpoint that it is told to.
    standing_in build-gpu synpo-train <<<'for a; do case $a in *.ckpt) echo 1 >"$a" ;; esac; done'
    check_gpu() { PATH=$PWD/bin:$PATH TORCH=x OUTPUT=out scripts/check-gpu parity >table; }
    check_gpu
    [ "$(grep -c '^bits .* the same$' table)" -eq 2 ]
    standing_in build-gpu synpo-train <<<'exit 1'
    run -1 check_gpu
    run ! grep '^bits' table
    standing_in build-gpu synpo-train <<<'for a; do case $a in *.ckpt) echo 1 >"$a" ;; esac; done'
    check_gpu
    # Tests that are all skipped.
    standing_in build-gpu engine-tests <<<'echo "[  PASSED  ] 0 tests."'
    run -1 check_gpu
}

@test "demo: its mazes are there where the build folder is a link to another disk" {
    cp -r "$ROOT/scripts" .
    mkdir -p far/away/disk
    ln -s far/away/disk build
    standing_in build $TOOLS <<<'echo x'
    scripts/demo >out
    [ -s far/away/disk/demo/mazes/map1.txt ]
    standing_in other $TOOLS <<<'echo x'
    rm -r far/away/disk/demo
    scripts/demo other >out
    [ -e other/demo/pairs.tsv ] && [ ! -e build/demo ]
    run -64 scripts/demo 30s
}

@test "the first step of CI stays in its tree, whatever CDPATH says" {
    mkdir -p tree elsewhere/.ci
    cp -r "$ROOT/.ci" tree/
    standing_in bin make <<<'pwd; exit 3'
    cd tree
    CDPATH=$OLDPWD/elsewhere PATH=$OLDPWD/bin:$PATH run -3 .ci/run
    [ "$output" = "$PWD" ] || complain "found '$output'"
}

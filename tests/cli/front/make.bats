load ../common

setup() {
    set_up
    cp -r "$ROOT/Makefile" "$ROOT/scripts" "$ROOT/man" "$ROOT/.gitattributes" .
    mkdir -p tests/unit lib tools build
    cp -r "$ROOT/tests/fuzz" "$ROOT"/tests/*.mk tests/
    export HOME=$PWD GIT_CONFIG_NOSYSTEM=1
    # What was said to the make that runs the tests.
    unset MAKEFLAGS MAKEOVERRIDES MAKELEVEL MFLAGS
}

# The folder as a repository of one commit.
commit_all() {
    git init -q .
    git add -A
    git -c user.name=x -c user.email=x@y.z commit -qm "$1"
}

@test "make help names every target, and no other" {
    make help >text
    awk '/^  make / { words = substr($0, 8, 11); gsub(/,/, " ", words); print words }' text |
        tr -s ' ' '\n' | grep . | sort >named
    awk '/^\.PHONY:/ { on = 1 } on { print } !/\\$/ { on = 0 }' Makefile | tr -d '\\' | sed 's/^\.PHONY://' |
        tr -s ' ' '\n' | grep -vx 'FORCE\|all\|help\|' | sort >targets
    [ "$(wc -l <targets)" -ge 15 ]
    comm -13 named targets >lacking
    [ ! -s lacking ] || complain "make help does not name $(tr '\n' ' ' <lacking)"
    while read -r target; do
        make -n "$target" >/dev/null 2>err || ! grep -q "No rule to make target '$target'" err ||
            complain "no target $target"
    done <named
    [ "$(awk 'length > 100' text | wc -l)" -eq 0 ]
}

@test "make uninstall takes away what make install put there, and nothing else" {
    # The programs' completions are made of the programs, which must not be built here.
    for tool in $TOOLS; do
        cp "$(command -v "$tool")" "build/$tool"
        built+=(-o "build/$tool")
    done
    echo plugin >build/libsynpo_torch.so
    make -o all "${built[@]}" install DESTDIR="$PWD/root" PREFIX=/opt/x >out
    grep -qx "The programs are in $PWD/root/opt/x/bin, their pages in $PWD/root/opt/x/share/man" out
    [ -s root/opt/x/share/bash-completion/completions/synpo-train ]
    [ -x root/opt/x/bin/synpo-train ]
    [ -s root/opt/x/share/man/man7/synpo.7 ]
    [ -s root/opt/x/lib/synpo/libsynpo_torch.so ]
    echo mine >root/opt/x/bin/mine
    make uninstall DESTDIR="$PWD/root" PREFIX=/opt/x >out
    [ "$(find root -type f)" = root/opt/x/bin/mine ]
    make uninstall DESTDIR="$PWD/root" PREFIX=/opt/x >out
    make uninstall DESTDIR="$PWD/nowhere" >out
}

@test "the commit: of this tree and no other, with what was changed; none without git" {
    [ -z "$(scripts/commit)" ]
    command -v git >/dev/null || skip "no git here"
    commit_all one
    [ "$(scripts/commit)" = "$(git rev-parse --short=7 HEAD)" ]
    echo >>Makefile
    [ "$(scripts/commit)" = "$(git rev-parse --short=7 HEAD), modified" ]
    mkdir inner
    cp -r scripts inner/
    [ -z "$(inner/scripts/commit)" ]
    # As root sees the tree of a user.
    ! GIT_TEST_ASSUME_DIFFERENT_OWNER=1 git status 2>err || skip "this git asks for no owner"
    [ "$(GIT_TEST_ASSUME_DIFFERENT_OWNER=1 scripts/commit)" = "$(git rev-parse --short=7 HEAD), modified" ]
}

@test "make dist: the same bytes twice, and a tree that knows its commit" {
    command -v git >/dev/null || skip "no git here"
    commit_all one
    make dist >name 2>err
    [ ! -s err ]
    cp "$(cat name)" first.tar.gz
    make dist >name
    cmp "$(cat name)" first.tar.gz
    tar xzf first.tar.gz
    version=$(sed -n 's/^VERSION *:= *//p' Makefile)
    [ "$("synpo-$version/scripts/commit")" = "$(git rev-parse HEAD | cut -c 1-7)" ]
    [ ! -e "synpo-$version/.git" ]
    echo >>Makefile
    make dist >name 2>err
    cmp "$(cat name)" first.tar.gz
    grep -q '^dist: changes' err
}

@test "the version is written again where the commit is another one, and only then" {
    make -n build/version.o COMMIT=abc1234 | grep -q version.cc
    make build/version.cc COMMIT=abc1234
    grep -qF '"abc1234"' build/version.cc
    make -q build/version.cc COMMIT=abc1234
    ! make -q build/version.cc COMMIT=abc1235 || complain "another commit makes no difference"
    make build/version.cc COMMIT=
    grep -qF 'kCommit[] = ""' build/version.cc
}

@test "make deps says nothing on stdout" {
    make -s deps >out 2>err || true
    [ ! -s out ]
    make -n -C "$ROOT" B="$PWD/none" deps bench 2>err | grep -E '^printf .*(CXX|LINK|AR)' >words
    ! grep -v '>&2$' words || complain "words of compilers go to stdout"
}

# A tree of a source for each program and a few more; a compiler that makes what it is told to and notes it in made.
small_tree() {
    mkdir -p tools/without_drawing lib/base lib/kernel lib/draw/canvas lib/world/grid/maps bin
    for tool in $TOOLS; do : >"tools/$tool.cc"; done
    : >tools/without_drawing/synpo-render.cc
    touch lib/base/{a,b,c}.cc lib/kernel/{select,target}.cc lib/draw/canvas/canvas.cc
    for map in 1 2 3; do seq $((map * 1000)) $((map * 1000 + 200)) >lib/world/grid/maps/map$map.txt; done
    cat >bin/cxx <<'END'
#!/bin/bash
while [ $# -gt 0 ]; do
    [ "$1" != -o ] || { echo "$2" >>made; printf '#!/bin/sh\n' >"$2"; chmod +x "$2"; }
    shift
done
END
    cp bin/cxx bin/cxx2
    chmod +x bin/*
}

# made ARGUMENT...: what make ARGUMENT... compiles and links, in $made.
made() {
    : >made
    make CXX=bin/cxx TARGETS='plain avx2' "$@" >out 2>&1 || complain "make $*: $(cat out)"
    made=$(sort made | tr '\n' ' ')
}

# stale ARGUMENT...: make ARGUMENT... has something to do.
stale() { ! make -q CXX=bin/cxx TARGETS='plain avx2' "$@" || complain "make $*: nothing to do"; }

@test "make builds again what was built with other flags, and nothing else" {
    small_tree
    made
    [[ $made == *build/lib/base/a.o\ * && $made == *build/synpo-train\ * ]]
    all=$made
    run ! stale
    made
    [ -z "$made" ] || complain "made again: $made"
    made -j1
    [ -z "$made" ]

    stale CXXFLAGS=-O0
    made CXXFLAGS=-O0
    [ "$made" = "$all" ] || complain "with other flags: $made"
    run ! stale CXXFLAGS=-O0
    stale CXX=bin/cxx2 CXXFLAGS=-O0
    stale CXXFLAGS=
    # Flags that depend on what is compiled, as those of make asan.
    made CXXFLAGS='$(if $(filter $(B)/lib/%,$@),-O0,'"'-DX=1'"')'
    [ "$made" = "$all" ]
    stale CXXFLAGS='$(if $(filter $(B)/lib/%,$@),-O1,'"'-DX=1'"')'
    made

    sed -i 's/-mavx2 -mfma/-mavx2/' Makefile
    made
    [[ $made == *build/lib/kernel/target_avx2.o\ * ]] || complain "with other flags of a kernel: $made"
    made LDFLAGS=-s
    [ "$made" = "$(printf 'build/%s\n' $TOOLS | sort | tr '\n' ' ')" ] || complain "with other LDFLAGS: $made"
}

@test "make links again where pictures come or go, or a source goes" {
    small_tree
    made
    for draw in no yes; do
        stale DRAW=$draw
        made DRAW=$draw
        [[ $made == *build/synpo-render\ * && $made != *build/lib/base/* ]] || complain "DRAW=$draw: $made"
    done
    ar t build/libsynpo.a | grep -x canvas.o
    rm lib/base/b.cc
    made
    run ! grep -x b.o <(ar t build/libsynpo.a)
}

@test "make install builds nothing again, and writes nothing anew where it installs the same" {
    small_tree
    made
    made install DESTDIR="$PWD/root"
    [ -z "$made" ] || complain "made again: $made"
    find build -type f -printf '%p %T@\n' | sort >before
    made install DESTDIR="$PWD/root"
    find build -type f -printf '%p %T@\n' | sort | diff before -
    grep -qx 'prefix=/usr/local' root/usr/local/lib/pkgconfig/synpo.pc
    made install DESTDIR="$PWD/root" PREFIX=/opt/x
    [ -z "$made" ]
    grep -qx 'prefix=/opt/x' root/opt/x/lib/pkgconfig/synpo.pc
}

@test "make: lists are in order, whatever order the disk has" {
    small_tree
    printf '#!/bin/sh\n%s "$@" | sort -r\n' "$(command -v find)" >bin/find
    chmod +x bin/find
    PATH=$PWD/bin:$PATH made
    ar t build/libsynpo.a | grep -x '[abc]\.o' >got
    printf '%s\n' a.o b.o c.o | cmp - got
}

@test "make: a file that could not be written is not there" {
    small_tree
    (
        trap '' XFSZ
        ulimit -f 1
        ! make build/builtin_maps.cc 2>err
    )
    [ ! -e build/builtin_maps.cc ]
    make build/builtin_maps.cc
    [ "$(tail -n 1 build/builtin_maps.cc)" = '}' ]
}

# noting FILE: a script that takes a moment, and notes in log when it begins and when it has ended.
noting() {
    printf '#!/bin/sh\necho "$0 $1 begins" >>log\nsleep 0.2\necho "$0 $1 has ended" >>log\n' >"$1"
    chmod +x "$1"
}

@test "make: goals that do more than build come one after the other" {
    small_tree
    rm tests/fuzz/*.cc
    for script in scripts/deps scripts/deb scripts/check tests/fuzz/run; do noting "$script"; done
    while read -r goals; do
        rm -rf build log
        # shellcheck disable=SC2086
        make CXX=bin/cxx FUZZ_CXX=bin/cxx GTEST= $goals >out 2>&1 || complain "make $goals: $(cat out)"
        [ "$(wc -l <log)" -eq 4 ]
        awk '{ sub(/ has ended$/, ""); sub(/ begins$/, "") } NR % 2 { of = $0; next } $0 != of { exit 1 }' log ||
            complain "make $goals: $(cat log)"
        run ! grep -i warning out
    done <<'END'
deps deps-torch
deps deps-deb
deps-deb deb
deps-fuzz fuzz
deps check
END
    [ "$(head -n 1 log)" = 'scripts/deps g++ begins' ]
}

@test "make: packages come before the first compilation, and clean before all of it" {
    small_tree
    printf '#!/bin/sh\nsleep 0.2\ncp bin/cxx bin/new\n' >scripts/deps
    make CXX=bin/new deps all
    [ -x build/synpo-train ]
    make CXX=bin/cxx clean all
    [ -x build/synpo-train ]
    make CXX=bin/cxx all build/synpo-eval clean
    [ ! -e build ]
    # A goal that fails ends it.
    printf '#!/bin/sh\nexit 3\n' >scripts/deps
    ! make CXX=bin/cxx deps all || complain "no failure"
    [ ! -e build ]
}

@test "make: B is where demo, bench and gallery find the programs; CHECKPOINT may have a space" {
    small_tree
    mkdir tests/bench
    : >tests/bench/synpo-bench.cc
    for script in demo bench gallery; do
        printf '#!/bin/sh\nprintf "<%%s>" "$0" "$@"\necho\n' >scripts/$script
    done
    make -s CXX=bin/cxx B=other demo bench gallery CHECKPOINT='my run.ckpt' | grep '^<' >got
    printf '%s\n' '<scripts/demo><other>' '<scripts/bench><other>' '<scripts/gallery><other><my run.ckpt>' | cmp - got
    [ ! -e build/synpo-train ]
}

load ../common

setup() {
    set_up
    cp -r "$ROOT/Makefile" "$ROOT/scripts" "$ROOT/man" "$ROOT/.gitattributes" .
    mkdir -p tests/unit lib tools build
    cp -r "$ROOT/tests/fuzz" "$ROOT"/tests/*.mk tests/
    export HOME=$PWD GIT_CONFIG_NOSYSTEM=1
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

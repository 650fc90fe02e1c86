# What make install puts somewhere is enough to build against, and make uninstall takes all of it away.
load ../common

setup_file() { make_inputs; }
setup() { set_up a.ckpt; }

# From the build under test, as it is.
make_there() {
    local build tool built=()
    build=$(dirname "$(command -v synpo-train)")
    for tool in $TOOLS; do built+=(-o "$build/$tool"); done
    make -C "$ROOT" B="$build" -o all "${built[@]}" PREFIX=/opt/synpo DESTDIR="$PWD/to" "$@"
}

@test "a program of ten lines is built with pkg-config against what was installed, and counts as synpo-eval does" {
    command -v pkg-config >/dev/null || skip "no pkg-config here"
    make_there install
    export PKG_CONFIG_PATH=$PWD/to/opt/synpo/lib/pkgconfig PKG_CONFIG_SYSROOT_DIR=$PWD/to
    [ "$(pkg-config --modversion synpo)" = "$(synpo-eval --version | grep -oE '[0-9]+\.[0-9]+\.[0-9]+' | head -n 1)" ]
    read -ra flags <<<"$(pkg-config --cflags --libs synpo)"
    g++ -std=c++20 "$ROOT/examples/success.cc" "${flags[@]}" -o success
    ./success a.ckpt >got
    synpo-eval -q -n 1 -c a.ckpt >m.tsv
    awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
        { n += $at["successes"] } END { print n " of " NR - 1 }' m.tsv | cmp - got
    run -66 ./success no-such.ckpt
    [[ $output == "success: cannot open 'no-such.ckpt': "* ]]
}

@test "with pkg-config --static a program draws" {
    command -v pkg-config >/dev/null || skip "no pkg-config here"
    make_there install
    export PKG_CONFIG_PATH=$PWD/to/opt/synpo/lib/pkgconfig PKG_CONFIG_SYSROOT_DIR=$PWD/to
    printf '#include <draw/canvas/canvas.h>\nconst synpo::Font font;\n' >draw.cc
    echo 'int main() { return synpo::Canvas(3, 2, font).width() != 3; }' >>draw.cc
    read -ra flags <<<"$(pkg-config --cflags --libs --static synpo)"
    g++ -std=c++20 draw.cc "${flags[@]}" -o draw
    ./draw
}

@test "every header is there and can be included alone" {
    make_there install
    (cd to/opt/synpo/include/synpo && find . -name '*.h' | sort) >got
    (cd "$ROOT/lib" && find . -name '*.h' -not -path './torch/*' | sort) | cmp - got
    for header in play/evaluate.h learn/training.h format/matrix.h stats/report/summary.h world/world.h; do
        echo "#include <$header>" >one.cc
        g++ -std=c++20 -fsyntax-only -Ito/opt/synpo/include/synpo one.cc
    done
}

@test "installed programs, pages and synpo.py work where they are" {
    make_there install
    for tool in $TOOLS; do "to/opt/synpo/bin/$tool" --version; done >versions
    [ "$(wc -l <versions)" -eq 6 ]
    for page in "$ROOT"/man/*; do
        cmp "$page" "to/opt/synpo/share/man/man${page##*.}/$(basename "$page")"
    done
    PYTHONPATH=to/opt/synpo/share/synpo/python PATH=$PWD/to/opt/synpo/bin:$PATH /usr/bin/python3 -B -c '
import synpo
env = synpo.Env()
print(env.reset(seed=1)[1]["env"])
env.close()' >got
    grep -qx 'map[0-9]*' got
}

@test "make uninstall leaves nothing of it, and what is not its own" {
    mkdir -p to/opt/synpo/lib/synpo to/opt/synpo/include/other
    touch to/opt/synpo/bin-note to/opt/synpo/include/other/x.h to/opt/synpo/lib/synpo/mine
    find to | sort >before
    make_there install
    make_there uninstall
    find to -not -type d | sort >left
    printf '%s\n' to/opt/synpo/bin-note to/opt/synpo/include/other/x.h to/opt/synpo/lib/synpo/mine | cmp - left
    [ ! -e to/opt/synpo/include/synpo ] && [ ! -e to/opt/synpo/share/synpo ]
}

@test "the Debian package is built of what make deps installs" {
    sed -n '/^PACKAGES/,/[^\\]$/p' "$ROOT/Makefile" | tr -s ' \\' '\n' | grep -- '-dev$' | grep -v gtest >needed
    [ "$(wc -l <needed)" -ge 4 ]
    sed -n '/^Build-Depends/,/^[A-Z]/p' "$ROOT/packaging/debian/control" | tr -s ', ' '\n' >named
    while read -r package; do grep -qx -- "$package" named || complain "Build-Depends lacks $package"; done <needed
}

@test "every installed file has a Debian package, and every page is in one" {
    make_there PREFIX=/usr LIBDIR=lib/x PYTHONDIR=lib/python3/dist-packages install
    cat "$ROOT"/packaging/debian/*.install >patterns
    (cd to && find . -type f -not -path './usr/lib/synpo/*' | cut -c 3-) >files
    while read -r file; do
        matched=
        while read -r pattern; do
            # shellcheck disable=SC2053
            [[ $file != $pattern && $file != $pattern/* ]] || matched=yes
        done <patterns
        [ -n "$matched" ] || complain "$file is in no package"
    done <files
}

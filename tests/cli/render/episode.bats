load ../common
load pictures

setup_file() { make_inputs; }
setup() { set_up e.jsonl a.ckpt two.tsv; }

@test "trajectories of the expert and of a policy are drawn, the same bytes twice" {
    synpo-eval -q -p two.tsv -n 2 --record r.jsonl <a.ckpt >/dev/null
    for file in e.jsonl r.jsonl; do
        synpo-render episode $file >a.png
        synpo-render episode -o b.png <$file
        cmp a.png b.png
        is_png a.png
    done
}

@test "--line picks the line, and looks at no line before it" {
    synpo-render episode --line 3 e.jsonl >a.png
    sed -n 3p e.jsonl | synpo-render episode >b.png
    cmp a.png b.png
    synpo-render episode e.jsonl >first.png
    run ! cmp -s a.png first.png
    { echo broken; sed -n 3p e.jsonl; } | synpo-render episode --line 2 | cmp - a.png
}

@test "--strip, --title and --scale change the picture" {
    synpo-render episode e.jsonl >a.png
    for option in "--strip 0" "--strip 3" "--title Another" "--scale 1"; do
        # shellcheck disable=SC2086
        synpo-render episode $option e.jsonl >b.png
        is_png b.png
        run ! cmp -s a.png b.png
    done
}

@test "--frames: a picture for the start and one after every step" {
    synpo-render episode --scale 0.5 --frames frames e.jsonl >out
    [ ! -s out ]
    [ "$(find frames -name '*.png' | wc -l)" -eq $(($(head -n 1 e.jsonl | jq '.actions | length') + 1)) ]
    is_png frames/0000.png
    run ! cmp -s frames/0000.png frames/0001.png
    synpo-render episode --scale 0.5 --frames again/ e.jsonl
    diff -r frames again
    mkdir empty
    synpo-render episode --scale 0.5 --frames empty e.jsonl
    diff -r frames empty
}

@test "--frames into a folder that is not empty, into a file, into nowhere: 73, and nothing changes" {
    mkdir full
    echo mine >full/file
    for folder in full full/file missing/frames; do
        fails 73 synpo-render episode --frames $folder e.jsonl
        says "cannot create the folder '$folder'"
    done
    echo mine | cmp - full/file
}

@test "--frames, --video: stopped half way, nothing is left" {
    for signal in INT TERM; do
        for films in "--frames frames" "--video a.avi" "--video a.gif"; do
            # shellcheck disable=SC2086
            env --default-signal=INT synpo-render episode --scale 3 $films e.jsonl &
            until ls | grep -q part; do kill -0 $! || complain "$films: done before it could be stopped"; done
            kill -$signal $!
            status=0
            wait $! || status=$?
            [ "$status" = $((128 + $(kill -l $signal))) ]
            ! ls | grep 'part\|frames\|avi\|gif' || complain "files are left"
        done
    done
}

@test "--video: GIF, which shows every moment, the same bytes twice" {
    moments=$(($(head -n 1 e.jsonl | jq '.actions | length') + 1))
    synpo-render episode --scale 0.5 --video a.gif e.jsonl
    synpo-render episode --scale 0.5 --video b.gif --rate 8 e.jsonl
    cmp a.gif b.gif
    head -c 6 a.gif >magic
    printf GIF89a | cmp - magic
    # Each picture comes after a block of its own, that begins so.
    [ "$(LC_ALL=C grep -aoP '\x21\xf9\x04' a.gif | wc -l)" -eq "$moments" ]
    synpo-render episode --scale 0.5 --video b.gif --rate 20 e.jsonl
    run ! cmp -s a.gif b.gif
    fails 73 synpo-render episode --video missing/a.gif e.jsonl
    says "cannot create 'missing/a.gif': No such file or directory"
    ln -s /dev/full full.gif
    fails 74 synpo-render episode --scale 0.5 --video full.gif e.jsonl
}

@test "--video: the same bytes twice; other formats 64, nowhere 73" {
    synpo-render episode --scale 0.5 --video a.avi e.jsonl
    synpo-render episode --scale 0.5 --video b.avi --frames frames e.jsonl
    cmp a.avi b.avi
    head -c 4 a.avi >magic
    printf RIFF | cmp - magic
    synpo-render episode --scale 0.5 --video b.avi --rate 30 e.jsonl
    run ! cmp -s a.avi b.avi
    fails 64 synpo-render episode --video a.webm e.jsonl
    says "cannot tell the format of the video 'a.webm': expected a name that ends in .gif, .avi, .mp4 or .mkv"
    fails 73 synpo-render episode --video missing/a.avi e.jsonl
    says "cannot create 'missing/a.avi': No such file or directory"
}

@test "--video: an .mp4 is H.264 with colours that every browser knows, or there is none and that is said" {
    status=0
    synpo-render episode --scale 0.5 --video a.mp4 e.jsonl 2>err || status=$?
    if [ "$status" -ne 0 ]; then
        [ "$status" -eq 64 ]
        grep -qF "has no encoder for .mp4, but .gif and .avi can be written" err
        skip "no encoder for H.264 here"
    fi
    [ ! -s err ]
    python3 - <<'END'
video = open('a.mp4', 'rb').read()
assert video[4:8] == b'ftyp' and b'avc1' in video
profile = video[video.index(b'avcC') + 5]
assert profile in (66, 77, 100), profile  # of 4:2:0
END
}

@test "--ansi: text in a file, colours on a terminal, and none with NO_COLOR" {
    synpo-render episode --ansi e.jsonl >text
    [ "$(wc -l <text)" -eq 18 ]
    [ "$(sed -n 2p text)" = "$(printf '#%.0s' {1..64})" ]
    tail -n 1 text | grep -qE \
        '^success after [0-9]+ steps \(the fewest\), reward 1[01]\.[0-9]+; . at step [0-9]+, . at step [0-9]+$'
    run ! grep -q $'\033' text
    run -0 on_terminal "env TERM=xterm-256color NO_COLOR= COLORTERM= synpo-render episode --ansi e.jsonl"
    grep -q $'\033\[38;5;[0-9]*;48;5;[0-9]*m' "$BATS_TEST_TMPDIR/err"
    run -0 on_terminal "env TERM=xterm-256color NO_COLOR=1 synpo-render episode --ansi e.jsonl"
    cmp text "$BATS_TEST_TMPDIR/err"
}

@test "no JSON, no such line, another world, another reward: 65, with the line" {
    refused() {
        fails 65 synpo-render episode -o out "${@:2}"
        says "$1"
    }
    echo 'not json' >bad.jsonl
    refused "bad.jsonl: line 1:" bad.jsonl
    head -n 2 e.jsonl >bad.jsonl
    refused "bad.jsonl: it ends after 2 lines, before line 3" --line 3 bad.jsonl
    refused "it ends after 2 lines, before line 9223372036854775807" --line 9223372036854775807 bad.jsonl
    head -n 1 e.jsonl | head -c 200 >bad.jsonl
    refused "bad.jsonl: line 1:" bad.jsonl
    : >bad.jsonl
    refused "it ends after 0 lines, before line 1" bad.jsonl
    head -c 1000 /dev/urandom >bad.jsonl
    refused "bad.jsonl: line 1:" bad.jsonl
    { head -n 1 e.jsonl; sed -n 2p e.jsonl | jq -c '.rewards[0] = -0.02'; } >bad.jsonl
    refused "bad.jsonl: line 2: replay gives reward -0.01 at step 1, file says -0.02" --line 2 bad.jsonl
    head -n 1 e.jsonl | jq -c '.env = "nowhere"' >bad.jsonl
    refused "line 1: unknown env 'nowhere'" bad.jsonl
    fails 66 synpo-render episode missing.jsonl
    says "'missing.jsonl'"
}

@test "wrong options: 64" {
    while read -r -a arguments; do
        fails 64 synpo-render episode "${arguments[@]}" e.jsonl
    done <<'END'
--line 0
--line x
--strip -1
--strip 301
--rate 5
--video a.avi --rate 0
--ansi --frames frames
--ansi --video a.avi
--ansi --video a.gif
--frames frames -o a.png
--scale 99
-w atari
e.jsonl
END
}

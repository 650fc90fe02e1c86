load ../common
load pictures

setup_file() {
    make_inputs
    synpo-train "${TINY[@]}" -n 4 -p pairs.tsv --log run.log --report 1 --evaluate-every 2 --evaluate-episodes 3 \
        <e.jsonl >/dev/null
    synpo-eval -q -p two.tsv -n 2 <a.ckpt >m.tsv
    synpo-gen-expert -q -w kitchen -n 1 >k.jsonl
}

setup() { set_up run.log m.tsv e.jsonl a.ckpt k.jsonl; }

# pdf_words FILE: its text, in one line.
pdf_words() { pdftotext -layout "$1" - | tr -s ' \n\f' ' '; }

# svg_words FILE: the texts of its text elements, in one line. Fails where it is no XML.
svg_words() {
    python3 - "$1" <<'END'
import sys
import xml.etree.ElementTree as tree
print(*(element.text for element in tree.parse(sys.argv[1]).iter('{http://www.w3.org/2000/svg}text')))
END
}

@test "every kind of picture as PNG, PDF and SVG, with its words" {
    while IFS='|' read -r words command; do
        # shellcheck disable=SC2086
        for format in png pdf svg; do
            synpo-render $command -o a.$format
            synpo-render $command --format $format >b.$format
            cmp a.$format b.$format || complain "$command: two pictures in $format"
        done
        is_png a.png
        pdffonts a.pdf >fonts
        [ "$(wc -l <fonts)" -ge 3 ]
        # Each font is embedded, a part of it, and its letters are known: emb sub uni.
        tail -n +3 fonts | grep -v ' yes yes yes ' && complain "$command: $(cat fonts)"
        [[ "$(pdf_words a.pdf)" == *"$words"* ]] || complain "$command: no '$words' in $(pdf_words a.pdf)"
        [[ "$(svg_words a.svg)" == *"$words"* ]] || complain "$command: no '$words' in $(svg_words a.svg)"
    done <<'END'
environment|heatmap m.tsv
success (%)|curves run.log
map3|map map3 map4
Microwave|map -w kitchen FloorPlan1
next action|view --history
Fridge|view -w kitchen
success after|episode e.jsonl
end, and its heading|episode -w kitchen k.jsonl
component 1|embedding a.ckpt
cosine distance|embedding --kind distance a.ckpt
not optimal|policy a.ckpt
END
}

@test "the page of a PDF has the size that the PNG says it has" {
    for scale in 1 2.5; do
        synpo-render map map3 --scale $scale -o a.png
        synpo-render map map3 --scale $scale -o a.pdf
        python3 - "$(pdfinfo a.pdf)" <<'END'
import re, struct, sys
points = [float(x) for x in re.search(r'Page size: +([\d.]+) x ([\d.]+) pts', sys.argv[1]).groups()]
png = open('a.png', 'rb').read()
pixels = struct.unpack('>2I', png[16:24])
name, *per_metre, unit = struct.unpack('>4s2IB', png[37:50])
assert (name, unit) == (b'pHYs', 1)
for p, n, density in zip(points, pixels, per_metre):
    assert abs(p - n / density / 0.0254 * 72) < 0.05, (points, pixels, per_metre)
END
    done
}

@test "a name that ends in no format of ours is refused: 64, and names them" {
    for name in a.jpg a.tar.gz none.ckpt dir.d/a.eps; do
        fails 64 synpo-render map -o "$name"
        says "cannot tell the format of the picture '$name': expected a name that ends in .png, .pdf or .svg"
        [ ! -e "$name" ]
    done
    fails 64 synpo-render map -o a.gif
    fails 64 synpo-render episode e.jsonl -o a.avi
    says "expected a name that ends in .png, .pdf, .svg or .gif"
    fails 64 synpo-render map -o a.svg --format pdf
    says "--format pdf does not go with the name 'a.svg'"
    fails 64 synpo-render map --format jpg
    says "expected png, pdf or svg"
    fails 64 synpo-render map --ansi --format png
    says "--format is for a picture, not for --ansi"
    fails 64 synpo-render episode e.jsonl --frames f --format pdf
    [ ! -e f ]
}

@test "the end of a name in capitals, a name without one, and --format over any" {
    synpo-render map map3 -o a.PDF
    synpo-render map map3 --format pdf -o noname
    cmp a.PDF noname
    synpo-render map map3 --format pdf -o out.tmp
    cmp a.PDF out.tmp
    synpo-render map map3 -o plain
    is_png plain
}

@test "a GIF of an episode: -o, --format and --video write the same" {
    synpo-render episode --scale 0.5 --rate 20 e.jsonl -o a.gif
    synpo-render episode --scale 0.5 --rate 20 e.jsonl --format gif | cmp - a.gif
    synpo-render episode --scale 0.5 --rate 20 e.jsonl --video b.gif
    cmp a.gif b.gif
}

@test "labels as the paper writes them, panels in columns, margins with names" {
    printf '%s\n' 'env task seen episodes successes' 'map1 O-R 1 10 9' 'map12 O-R 0 10 5' 'map2 O-R 1 10 5' |
        tr ' ' '\t' >three.tsv
    synpo-render heatmap --labels paper --margins -o a.svg three.tsv
    for text in '(O, R)' env_0 env_1 env_2 'mean all' 'mean seen'; do
        grep -qF ">$text<" a.svg || complain "no $text"
    done
    run ! grep -qF '>map1<' a.svg
    synpo-render heatmap --columns 1 -o a.svg A=m.tsv B=m.tsv
    synpo-render heatmap -o b.svg A=m.tsv B=m.tsv
    run ! cmp -s a.svg b.svg
    fails 64 synpo-render heatmap --ansi --columns 1 m.tsv
    fails 64 synpo-render heatmap --labels theirs m.tsv
}

@test "a full disk: 74 in every format, and nothing is left" {
    for format in png pdf svg; do
        ln -s /dev/full full.$format
        fails 74 synpo-render map -o full.$format
        says "No space left"
    done
    fails 74 synpo-render episode e.jsonl --format gif -o /dev/full
}

@test "characters that the font lacks are said, and drawn" {
    synpo-render map map3 --title 'A title: 漢字 x 漢' -o a.svg 2>err
    grep -qF "note: the font DejaVu Sans lacks '字', '漢', drawn as boxes" err
    [[ "$(svg_words a.svg)" == *'漢字'* ]]
    synpo-render map map3 --title 'Ein Titel: äöü' 2>err >a.png
    [ ! -s err ]
    synpo-render map map3 --title 'שלום 7' 2>err >a.png
    [ ! -s err ]
    for title in 'title שלום' 'שלום title'; do
        synpo-render map map3 --title "$title" 2>err >a.png
        grep -qxF "synpo-render: note: a text that mixes directions of writing is set in that of its first letter" err
        synpo-render map map3 --title "$title" --format svg 2>err >a.svg
        [ ! -s err ]
    done
}

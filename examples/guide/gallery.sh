#!/usr/bin/env bash
# Makes the pictures of examples/guide/gallery.md: every stock graph on exemplars that terrazzo generates itself.
# Needs a build (examples/quickstart.sh). Takes less than a minute of CPU time.
# Usage: examples/guide/gallery.sh [GRAPH ...]
set -euo pipefail
cd "$(dirname "$0")/../.."
made=out/guide/gallery
pictures=examples/guide/pictures/gallery
mkdir -p "$made" "$pictures"
chosen=" ${*:-all} "

run() { build/terrazzo run "$@" --progress none; }

# exemplar NAME KIND [OPTION ...]: a generated material in a folder, and how it looks, in preview.png.
exemplar() {
  run graphs/generate-exemplar.json --set type="$2" --set size=192 --set 'lit.lights=[]' --set lit.size=304 \
    --set out="$made/$1" "${@:3}"
}

# make NAME [OPTION ...]: runs a stock graph.
make() { run "graphs/$1.json" --set out="$made/$1" "${@:2}"; }

# show NAME LEFT CAPTIONS [OPTION ...]: its picture.
show() {
  run examples/guide/gallery.json --set from="$made" --set left="$2" --set captions="$3" --set result="$1" \
    --set out="$pictures/$1.jpg" "${@:4}"
}

gallery_of() { [[ $chosen == " all " || $chosen == *" $1 "* ]]; }

exemplar bricks bricks
exemplar charcoal bricks --set surface.palette=charcoal --set seed=2
exemplar gravel gravel
exemplar ochre gravel --set surface.palette=ochre --set seed=2
exemplar cobbles cobbles
exemplar herringbone herringbone
exemplar tiles tiles
exemplar cut cobbles --set surface.tileable=false --set lit.repeats=2
exemplar planks planks
exemplar grit gravel --set surface.scale=20
exemplar fine gravel --set size=384
run examples/guide/masks.json --set size=192 --set out="$made/masks"
run examples/guide/gallery-exemplars.json --set out="$made"

g=$made
if gallery_of material; then
  make material --set material=$g/bricks
  show material '["bricks/preview.png"]' '["exemplar"]'
fi
if gallery_of texture; then
  make texture --set image=$g/gravel/base_color.png
  show texture '["gravel/base_color.png"]' '["exemplar"]' --set picture=texture/base_color.png
fi
if gallery_of noise; then
  make noise --set material=$g/grit
  show noise '["grit/preview.png"]' '["exemplar"]'
fi
if gallery_of make_tileable; then
  make make_tileable --set material=$g/cut
  show make_tileable '["cut/preview.png"]' '["exemplar, repeated"]' --set repeats=2 --set caption="result, repeated" \
    --set side=300
fi
if gallery_of inpaint; then
  make inpaint --set seed=3 --set material=$g/damaged --set mask=$g/holes.png
  show inpaint '["damaged/preview.png", "holes.png"]' '["exemplar", "holes"]'
fi
if gallery_of transfer; then
  make transfer --set material=$g/grit --set strength=8 --set target=$g/target.png
  show transfer '["grit/preview.png", "target.png"]' '["exemplar", "target"]'
fi
if gallery_of progression; then
  make progression --set material=$g/mossy --set target=$g/target.png
  show progression '["mossy/preview.png", "target.png"]' '["exemplar", "target"]'
fi
if gallery_of labels; then
  make labels --set material=$g/mossy --set labels=$g/parts.png --set target=$g/masks/layout.png --set leeway=20
  show labels '["mossy/preview.png", "parts.png", "masks/layout.png"]' \
    '["exemplar", "its parts", "layout"]' --set side=88
fi
if gallery_of mix; then
  make mix --set first=$g/bricks --set second=$g/ochre --set mix=$g/masks/mix.png --set leeway=20
  show mix '["bricks/preview.png", "ochre/preview.png", "masks/mix.png"]' '["first", "second", "mix"]' --set side=88
fi
if gallery_of several; then
  make several --set first=$g/bricks --set second=$g/charcoal
  show several '["bricks/preview.png", "charcoal/preview.png"]' '["first", "second"]'
fi
if gallery_of variants; then
  make variants --set material=$g/planks --set 'rotations=[90]'
  show variants '["planks/preview.png"]' '["exemplar"]'
fi
if gallery_of masked; then
  make masked --set material=$g/marked --set mask=$g/allowed.png
  show masked '["marked/preview.png", "allowed.png"]' '["exemplar", "mask"]'
fi
if gallery_of extend; then
  make material --set material=$g/tiles --set size=192 --set out=$g/kept
  make extend --set material=$g/tiles --set kept=192 --set size=384 --set 'at=[96, 96]'
  show extend '["tiles/preview.png", "kept/base_color.png"]' '["exemplar", "kept in the middle"]'
fi
if gallery_of magnify; then
  make magnify --set material=$g/fine --set analysed=0.5 --set scale=1.25
  show magnify '["fine/preview.png"]' '["exemplar"]'
fi
if gallery_of from_analysis; then
  run graphs/analyse.json --set material=$g/herringbone --set out=$g/herringbone.analysis
  make from_analysis --set analysis=$g/herringbone.analysis --set material=$g/herringbone --set size=384
  show from_analysis '["herringbone/preview.png"]' '["exemplar"]'
fi
if gallery_of layered; then
  make layered --set base=$g/cobbles --set top=$g/ochre --set amount=0.4
  show layered '["cobbles/preview.png", "ochre/preview.png"]' '["base", "top"]'
fi
if gallery_of engine; then
  make engine --set material=$g/cobbles
  show engine '["cobbles/preview.png", "engine/T_cobbles_ORM.png"]' '["exemplar", "packed maps"]' \
    --set picture=engine/lit.png --set caption="lit from four sides"
fi
if gallery_of generate-exemplar; then
  make generate-exemplar --set type=weave --set size=304 --set surface.palette=denim
  maps='["generate-exemplar/base_color.png", "generate-exemplar/normal.png", "generate-exemplar/height.png"]'
  show generate-exemplar "$maps" \
    '["base colour", "normal", "height"]' --set side=88 --set picture=generate-exemplar/preview.png \
    --set caption="lit from four sides" --set file.jpeg_quality=70
fi
ls "$pictures"

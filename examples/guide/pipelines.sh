#!/usr/bin/env bash
# Makes the table of examples/guide/materials.md, in three steps, all of them without arguments:
#   folders   five folders, named and packed as the sites and engines do it, with originals beside them
#   exports   each of them with each preset
#   pictures  each export opened by its reader, and compared with the original; the readers are got from the npm registry,
#             and Chromium, Blender and Godot 3 (with xvfb) have to be there
# Needs a build (examples/quickstart.sh). OUT, PICTURE and TERRAZZO in the environment: another folder, picture and program.
# Usage: examples/guide/pipelines.sh [STEP ...]
set -euo pipefail
cd "$(dirname "$0")/../.."
program=$(realpath "${TERRAZZO:-build/terrazzo}")
root=$PWD made=${OUT:-out/guide/pipelines}
picture=$(realpath -m "${PICTURE:-examples/guide/pictures/pipelines.jpg}")
chosen=" ${*:-folders exports pictures} "
sources=(ambientcg polyhaven quixel unity unreal)
presets=(unreal unity_hdrp unity_urp godot gltf glb usd materialx materialx_openpbr blender)
mkdir -p "$made" "$(dirname "$picture")"
made=$(realpath "$made")

run() { "$program" run "$@" --progress none; }

# original NAME KIND [OPTION ...]: a generated material, in a folder of its own.
original() {
  run graphs/generate-exemplar.json --set type="$2" --set size=128 --set 'lit.lights=[]' --set lit.size=16 --set out="$made/originals/$1" "${@:3}"
  rm "$made/originals/$1/preview.png"
}

# pack FILE MAP [OPTION ...]: an original's map as a file of the folder, without what terrazzo has noted in it.
pack() { oiiotool --no-autopremult "$of/$2.png" "${@:3}" --eraseattrib ".*" --quality 95 -o "$into/$1"; }

if [[ $chosen == *" folders "* ]]; then
  rm -rf "$made/originals" "$made/downloads"
  turned=(--mulc 1,-1,1 --addc 0,1,0)
  inverted=(--mulc -1 --addc 1)
  begin() {
    of=$made/originals/$1 into=$made/downloads/$2
    mkdir -p "$into"
  }

  # ambientCG: normals twice, green up and green down, and a thumbnail.
  original ambientcg bricks
  begin ambientcg Bricks104_2K
  pack Bricks104_2K_Color.jpg base_color
  pack Bricks104_2K_NormalGL.png normal
  pack Bricks104_2K_NormalDX.png normal "${turned[@]}"
  pack Bricks104_2K_Roughness.jpg roughness
  pack Bricks104_2K_AmbientOcclusion.jpg ambient_occlusion
  pack Bricks104_2K_Displacement.png height
  pack Bricks104.png base_color --resize 64x64

  # Poly Haven: occlusion, roughness and metallic packed; normals as half floats.
  original polyhaven cobbles
  begin polyhaven cobblestone_floor_04_2k/textures
  pack cobblestone_floor_04_diff_2k.jpg base_color
  pack cobblestone_floor_04_nor_gl_2k.exr normal -d half
  oiiotool "$of/ambient_occlusion.png" "$of/roughness.png" --pattern constant:color=0 128x128 1 \
    --chappend:n=3 --chnames R,G,B --eraseattrib ".*" --quality 95 -o "$into/cobblestone_floor_04_arm_2k.jpg"
  pack cobblestone_floor_04_disp_2k.png height

  # Quixel Megascans: gloss, normals green down, heights as floats.
  original quixel gravel
  begin quixel ground_gravel_vlkhcbxia_2k
  pack vlkhcbxia_2K_Albedo.jpg base_color
  pack vlkhcbxia_2K_Normal.jpg normal "${turned[@]}"
  pack vlkhcbxia_2K_Gloss.jpg roughness "${inverted[@]}"
  pack vlkhcbxia_2K_AO.jpg ambient_occlusion
  pack vlkhcbxia_2K_Displacement.exr height -d half

  # Unity's HDRP: metallic, occlusion, detail and smoothness. Its tiles are of metal where they stand out.
  original unity tiles --set surface.palette=cobalt
  begin unity MetalTiles
  oiiotool "$of/height.png" --subc 0.4 --mulc 2 --clamp:min=0:max=1 -d uint8 --eraseattrib ".*" -o "$of/metallic.png"
  pack MetalTiles_BaseColor.png base_color
  pack MetalTiles_Normal.png normal
  oiiotool --no-autopremult "$of/metallic.png" "$of/ambient_occlusion.png" --pattern constant:color=0.5 128x128 1 \
    "$of/roughness.png" "${inverted[@]}" --chappend:n=4 --chnames R,G,B,A -d uint8 --eraseattrib ".*" \
    --attrib oiio:UnassociatedAlpha 1 -o "$into/MetalTiles_MaskMap.png"
  pack MetalTiles_Height.png height

  # Substance for Unreal: ORM, normals green down.
  original unreal planks
  begin unreal T_OldPlanks
  oiiotool "$of/height.png" --subc 0.6 --mulc 2.5 --clamp:min=0:max=1 -d uint8 --eraseattrib ".*" -o "$of/metallic.png"
  pack T_OldPlanks_BaseColor.png base_color
  pack T_OldPlanks_Normal.png normal "${turned[@]}"
  oiiotool "$of/ambient_occlusion.png" "$of/roughness.png" "$of/metallic.png" --chappend:n=3 --chnames R,G,B -d uint8 \
    --eraseattrib ".*" -o "$into/T_OldPlanks_ORM.png"
  pack T_OldPlanks_Height.png height
fi

# folder SOURCE: of its files.
folder() {
  case $1 in
    ambientcg) echo Bricks104_2K ;;
    polyhaven) echo cobblestone_floor_04_2k/textures ;;
    quixel) echo ground_gravel_vlkhcbxia_2k ;;
    unity) echo MetalTiles ;;
    unreal) echo T_OldPlanks ;;
  esac
}

if [[ $chosen == *" exports "* ]]; then
  {
    echo "material,preset,relief,out"
    for source in "${sources[@]}"; do
      for preset in "${presets[@]}"; do
        relief=0
        [ "$preset" != blender ] || relief=0.02
        echo "$made/downloads/$(folder "$source"),$preset,$relief,$made/$source/$preset"
      done
    done
  } >"$made/exports.csv"
  run examples/guide/pipelines.json --table "$made/exports.csv"
fi

[[ $chosen == *" pictures "* ]] || exit 0
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
for needed in "${browser:-chromium}" npm blender godot3 xvfb-run; do
  command -v "$needed" >/dev/null || {
    echo "skipped: there is no $needed (apt-get install chromium npm blender python3-numpy godot3 xvfb xauth libgl1-mesa-dri)"
    exit 77
  }
done
for source in "${sources[@]}"; do
  run examples/guide/pipelines-original.json --set original="$made/originals/$source" --set out="$made/lit/$source"
done
cd "$made"
rm -rf seen told
mkdir seen
"$root/tests/readers/install.sh"

cat >seen.mjs <<JS
import { Browser } from '$root/tests/readers/browser.mjs';
JS
cat >>seen.mjs <<'JS'
import fs from 'fs';
// What the pages are to do: all but Blender's and Godot's part.
const jobs = [];
const add = (source, preset, lit, more) => jobs.push({
  name: `${source} ${preset}`, size: [128, 128], azimuth: 135, elevation: 40, ambient: 0.25, expected: `lit/${source}-${lit}.png`,
  picture: `seen/${source}-${preset}.png`, ...more});
for (const source of process.argv.slice(3)) {
  for (const engine of ['unreal', 'unity_hdrp', 'unity_urp'])
    add(source, engine, 'lit', {page: 'three', reader: 'engine', engine, file: `${source}/${engine}/${engine === 'unreal' ? 'T_' : ''}wall{}`});
  for (const kind of ['gltf', 'glb']) add(source, kind, 'lit', {page: 'three', reader: 'gltf', file: `${source}/${kind}/wall.${kind}`});
  add(source, 'usd', 'lit', {page: 'three', reader: 'usd', file: `${source}/usd/wall.usda`});
  for (const preset of ['materialx', 'materialx_openpbr'])
    add(source, preset, 'bare', {page: 'materialx', reader: 'materialx', file: `${source}/${preset}/wall.mtlx`});
}
// Prints by how much each differs; of those that something is wrong with, what.
const browser = await Browser.start(process.argv[2]);
jobs.sort((a, b) => a.page.localeCompare(b.page));
for (const job of jobs) {
  const {mean, picture, errors} = await browser.work(job);
  if (picture) fs.writeFileSync(job.picture, Buffer.from(picture.split(',')[1], 'base64'));
  console.log(job.name, errors.length ? errors.join('; ') : mean);
}
browser.close();
JS
node seen.mjs "$browser" "${sources[@]}" >told

for source in "${sources[@]}"; do
  blender --background --factory-startup --python-exit-code 1 --python "$source/blender/wall.py" --python "$root/tests/readers/blender.py" \
    -- script 1 1 "seen/$source-blender.png" "lit/$source-bare.png" 9 >log 2>&1 || { cat log; exit 1; }
  sed -nE "s/^script: the picture differs by ([0-9.]+) .*/$source blender \1/p" log >>told
  echo "$made/$source/godot/wall 1 128 $made/seen/$source-godot.png"
done >godot
HOME=$made LC_ALL=en_US.UTF-8 timeout 120 xvfb-run -a godot3 --video-driver GLES3 --audio-driver Dummy \
  --script "$root/tests/readers/godot.gd" "$made/godot" >log 2>&1 || { cat log; exit 1; }
for source in "${sources[@]}"; do
  mean=$(oiiotool "lit/$source-lit.png" --ch R,G,B "seen/$source-godot.png" --ch R,G,B --diff 2>&1 |
    sed -nE 's/.*Mean error = ([0-9.e-]+).*/\1/p' || true)
  awk "BEGIN { printf \"$source godot %.2f\\n\", ${mean:-1} * 255 }" >>told
done

pictures=() captions=()
titles=(Unreal "Unity HDRP" "Unity URP" Godot glTF glb USD "MtlX standard" "MtlX OpenPBR" Blender)
names=("ambient CG" "Poly Haven" Quixel "Unity HDRP" Unreal)
for i in "${!sources[@]}"; do
  pictures+=("lit/${sources[$i]}-lit.png") captions+=("${names[$i]}")
  for preset in "${presets[@]}"; do pictures+=("seen/${sources[$i]}-$preset.png"); done
  for title in "${titles[@]}"; do captions+=("$title"); done
  titles=("${titles[@]/*/}")
done
list() { printf '"%s",' "$@" | sed 's/^/[/; s/,$/]/'; }
run "$root/examples/guide/pipelines-sheet.json" --set from="$made" --set pictures="$(list "${pictures[@]}")" \
  --set captions="$(list "${captions[@]}")" --set columns=$((1 + ${#presets[@]})) --set out="$picture"

# How far the pictures that each reader made are from the originals, at most, in the mean of 255 steps.
awk -v presets="${presets[*]}" -v sources="${sources[*]}" '
  NF == 3 { at[$1, $2] = $3; next }
  { print "WRONG: " $0; failed = 1 }
  END {
    count = split(sources, s, " ")
    for (p = 1; p <= split(presets, names, " "); p++) {
      most = 0
      for (i = 1; i <= count; i++) {
        d = ((s[i], names[p]) in at) ? at[s[i], names[p]] : 255
        if (d > most) most = d
        if (d > 6) { print "WRONG: " s[i] " as " names[p] " differs by " d; failed = 1 }
      }
      print names[p] ": differs by at most " most
    }
    exit failed
  }' told

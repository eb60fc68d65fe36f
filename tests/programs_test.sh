#!/usr/bin/env bash
# What programs need: the installed tree is enough to compile a program and a plug-in (examples/embedding, examples/plugin),
# with CMake and with pkg-config; the same job gives the same bytes by command line and C++; plug-ins are loaded, are in
# keys, and what goes wrong in them is said.
# Usage: tests/programs_test.sh SOURCE_FOLDER BUILD_FOLDER
set -euo pipefail
source=$(realpath "${1:?usage: programs_test.sh SOURCE_FOLDER BUILD_FOLDER}")
build=$(realpath "${2:?usage: programs_test.sh SOURCE_FOLDER BUILD_FOLDER}")
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-programs.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
export TERRAZZO_CACHE=$scratch/cache
unset TERRAZZO_PLUGINS
cd "$scratch"
failed=0

complain() {
  echo "$1" >&2
  failed=1
}

# refuses WORDS COMMAND...: the command fails with exit code 1 or 2 and says the words.
refuses() {
  local words=$1 status=0
  shift
  "$@" >said 2>&1 || status=$?
  [[ $status == [12] ]] || complain "$* ended with $status, not 1 or 2"
  grep -qF -- "$words" said || complain "$*: expected \"$words\", found: $(cat said)"
}

# The commands of the guide, in a tree where they find what they name.
mkdir guide && cp -r "$source/examples" "$source/graphs" guide && ln -s "$build" guide/build
awk '/^```/ { open = ($0 == "```bash"); next } open' "$source/examples/guide/programs.md" >commands
(cd guide && bash -euo pipefail ../commands) >said 2>&1 || { complain "a command of programs.md failed: $(tail -5 said)"; exit 1; }
grep -q 'the inverted height at (20, 4) is 0.25' said || complain "the value from memory was lost: $(cat said)"
ln -s guide/out/terrazzo tree
ln -s guide/out/plugin plugin
terrazzo=$scratch/tree/bin/terrazzo
for header in $(cd tree/include && find . -name '*.h'); do echo "#include \"$header\"" >"one-$(basename "$header").cpp"; done
g++ -std=c++20 -Wall -Wextra -Werror -fsyntax-only -Itree/include one-*.cpp || complain "a header does not compile alone"
PKG_CONFIG_PATH=$scratch/tree/lib/pkgconfig pkg-config --exists 'terrazzo >= 0.1' || complain "pkg-config does not find it"
g++ $(PKG_CONFIG_PATH=$scratch/tree/lib/pkgconfig pkg-config --cflags terrazzo) -fsyntax-only "$source/examples/embedding/main.cpp"

# The same bytes by command line and C++.
sed 's/"default": *"bricks"/"default": "tiles"/; s/"default": *\[512, 512\]/"default": [64, 64]/' "$source/graphs/generate-exemplar.json" >job.json
"$terrazzo" run job.json --no-cache --set out="$scratch/by-command" --progress none
guide/out/embedding/embedding job.json "$scratch/by-program" "$scratch/cache" >said
diff -r by-command by-program || complain "the command line and the program made different files"

# The Debian package says what it needs, and runs from where it is unpacked.
cpack --config "$build/CPackConfig.cmake" -B package >said 2>&1 || complain "cpack failed: $(tail -3 said)"
package=$(find package -maxdepth 1 -name '*.deb')
dpkg-deb -f "$package" Depends >depends
for library in libopenimageio libopencolorio libtbb; do grep -q $library depends || complain "it does not depend on $library"; done
dpkg-deb -x "$package" root
root/usr/bin/terrazzo synth by-command -o unpacked --size 64x64 --quality draft --format exr --no-cache --progress none 2>said ||
  complain "the unpacked program does not run: $(cat said)"
for file in man/man1/terrazzo-cache-gc.1.gz bash-completion/completions/terrazzo zsh/vendor-completions/_terrazzo; do
  test -s root/usr/share/$file || complain "the package lacks $file"
done

# Plug-ins.
plugin=$scratch/plugin/emboss.so
graph=$source/examples/plugin/emboss.json
run=("$terrazzo" run "$graph" --set material="$scratch/by-command" --progress none)
refuses 'unknown node type "emboss"' "${run[@]}"
"${run[@]}" --plugin "$plugin" --set out="$scratch/embossed" 2>said
test -s embossed/embossed.png || complain "the plug-in made nothing"
TERRAZZO_PLUGINS=$plugin "${run[@]}" --set out="$scratch/embossed" --dry-run >said 2>&1
grep -q 'up to date' said || complain "a second run does it again: $(cat said)"
for list in nodes schema; do
  "$terrazzo" $list --plugin "$plugin" >said
  grep -q emboss said || complain "the plug-in's type is not in \`terrazzo $list\`"
done
# Another build has other keys.
sed 's/0.5f + x/0.25f + x/' "$source/examples/plugin/emboss.cpp" >other.cpp
compile() { g++ -std=c++20 -shared -fPIC -Itree/include "$@" -Ltree/lib -lterrazzo; }
compile other.cpp -o other.so
"${run[@]}" --plugin other.so --set out="$scratch/embossed" --dry-run >said 2>&1
grep -q 'plug-in' said || complain "another build of the plug-in takes the first one's results: $(cat said)"

refuses 'there is no such file (did you mean "emboss.so"?)' "$terrazzo" nodes --plugin plugin/embos.so
refuses 'it has no TERRAZZO_PLUGIN' "$terrazzo" nodes --plugin tree/lib/libterrazzo.so
refuses 'another plug-in of the name "emboss" is loaded already' "$terrazzo" nodes --plugin "$plugin" --plugin other.so
odd() { compile "-DODD=$1" "$source/tests/programs/odd_plugin.cpp" -o "odd$1.so"; }
for i in 0 1 2 3; do odd $i; done
refuses 'plug-in "odd" failed: no types today' "$terrazzo" nodes --plugin odd1.so
refuses 'the node type "blur" of odd already exists, from terrazzo' "$terrazzo" nodes --plugin odd2.so
refuses 'it was compiled for another terrazzo' "$terrazzo" nodes --plugin odd3.so
echo '{"terrazzo": 1, "nodes": {"a": {"type": "odd"}}}' >odd.json
refuses 'node "a" (odd), parameter "how": it is odd' "$terrazzo" run odd.json --plugin odd0.so
refuses 'plug-in "odd" failed: out of luck' "$terrazzo" run odd.json --plugin odd0.so --set a.how=exception
refuses 'something other than a std::exception' "$terrazzo" run odd.json --plugin odd0.so --set a.how=number
refuses 'did not set its output' "$terrazzo" run odd.json --plugin odd0.so --set a.how=nothing
refuses 'odd gave a null pointer for its output image' "$terrazzo" run odd.json --plugin odd0.so --set a.how=null
refuses 'an image cannot be computed from one that is null' "$terrazzo" run odd.json --plugin odd0.so --set a.how='null source'
for moment in check files_read preflight infer; do
  refuses 'node "a"' "$terrazzo" run odd.json --plugin odd0.so --set a.how=$moment
  grep -qF 'something other than a std::exception' said || complain "$moment: found: $(cat said)"
done
refuses 'something other than a std::exception' "$terrazzo" run odd.json --plugin odd0.so --set a.how=memory_ahead --memory 1G
"$terrazzo" check odd.json --plugin odd0.so --set a.how=doubts >said 2>&1 || complain "check ended badly: $(cat said)"
grep -qF 'something other than a std::exception' said || complain "doubts: found: $(cat said)"
# Pixels are made when another node reads them; it is the one that makes them that fails.
echo '{"terrazzo": 1, "nodes": {"a": {"type": "odd"}, "soft": {"type": "blur", "image": "@a", "radius": 2},
  "file": {"type": "export", "material": "@soft", "path": "late.exr"}}}' >late.json
refuses 'node "a" (odd): out of luck' "$terrazzo" run late.json --plugin odd0.so --set a.how='late exception'
refuses 'node "a" (odd): what makes its pixels threw something other than a std::exception' \
  "$terrazzo" run late.json --plugin odd0.so --set a.how='late number'
# A node that ends the program does not end it as if all was done.
for how in exit _exit; do
  refuses 'code of the node "a" called exit() before the command was done' \
    "$terrazzo" run late.json --plugin odd0.so --set a.how=$how
done
[ ! -e late.exr ] || complain "a file was written after a failure"

# Nodes that lie are caught by name in a checked run; those of terrazzo do not.
echo 0.25 >secret.txt
echo '{"terrazzo": 1, "nodes": {"liar": {"type": "odd"}, "file": {"type": "export", "material": "@liar", "path": "liar.exr"}}}' >liar.json
checked=("$terrazzo" run liar.json --checked --plugin odd0.so --progress none)
"${checked[@]}" --set liar.how=honest 2>said || complain "an honest node is not believed: $(cat said)"
[ ! -s said ] || complain "a checked run says more than it should: $(cat said)"
refuses "node \"liar\" (odd): checked: odd reads $scratch/secret.txt, which its \`files_read\` does not name" "${checked[@]}" --set liar.how=file
refuses 'node "liar" (odd): checked: odd gives another "image"' "${checked[@]}" --set liar.how=random
refuses 'node "liar" (odd): checked: odd gives another "image"' "${checked[@]}" --set liar.how=clock
refuses 'checked: odd reads the variable ODD_VALUE of the environment' "${checked[@]}" --set liar.how=variable
"$terrazzo" synth "$scratch/by-command" -o synthesized --size 96x96 --quality draft --checked --progress none 2>said ||
  complain "a node of terrazzo is caught: $(cat said)"
"$terrazzo" run "$source/graphs/engine.json" --checked --set material="$scratch/by-command" --set engine=glb --set scale=1 \
  --set out="$scratch/glb" --progress none 2>said || complain "a node of terrazzo is caught: $(cat said)"
exit $failed

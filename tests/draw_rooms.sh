#!/usr/bin/env bash
# Draws the includes between rooms with Graphviz: tests/draw_rooms.sh rooms.svg (or .png, .pdf, .dot). Rooms stand in
# the order of tests/rooms.txt, the lowest at the bottom; an arrow that runs against it is red. What is clear from
# others is left out (a room that includes B, which includes C, is not drawn as including C).
set -euo pipefail
out=${1:?usage: tests/draw_rooms.sh FILE.svg|.png|.pdf|.dot}
cd "$(dirname "$0")/.."

draw() {
  grep -rHoE '^#include "[^"]+"' --include='*.cpp' --include='*.h' core nodes graphs runner | awk -F: '
    function room(path) { sub(/\/[^\/]*$/, "", path); return path }
    BEGIN {
      while ((getline line < "tests/rooms.txt") > 0) { split(line, part, "\t"); order[++rooms] = part[1]; place[part[1]] = rooms; what[part[1]] = part[2] }
      print "digraph rooms {\n  rankdir=BT; ranksep=0.35; node [shape=box, style=\"rounded,filled\", fillcolor=white, fontname=Helvetica]; edge [color=gray40]"
    }
    { from = room($1); split($2, part, "\""); to = room(part[2]); if (from != to && place[from] && place[to]) arrow[from, to]++ }
    END {
      colour["core"] = "#e8f0ff"; colour["nodes"] = "#eaf7e6"; colour["graphs"] = "#fff5d6"; colour["runner"] = "#fde8e4"
      for (i = 1; i <= rooms; i++) {
        split(order[i], part, "/")
        printf "  \"%s\" [label=<<b>%s</b><br/><font point-size=\"10\">%s</font>>, fillcolor=\"%s\"]\n", order[i], order[i], what[order[i]], colour[part[1]]
      }
      for (k in arrow) { split(k, end, SUBSEP); reach[place[end[1]], place[end[2]]] = 1 }
      for (m = 1; m <= rooms; m++) for (i = 1; i <= rooms; i++) if ((i, m) in reach) for (j = 1; j <= rooms; j++) if ((m, j) in reach) { through[i, j] = 1; reach[i, j] = 1 }
      for (k in arrow) {
        split(k, end, SUBSEP); i = place[end[1]]; j = place[end[2]]
        if (j > i) printf "  \"%s\" -> \"%s\" [color=red, penwidth=2]\n", end[1], end[2]
        else if (!((i, j) in through)) printf "  \"%s\" -> \"%s\"\n", end[1], end[2]
      }
      print "}"
    }'
}

case "$out" in
  *.dot) draw >"$out" ;;
  *) draw | dot -T"${out##*.}" -o "$out" ;;
esac

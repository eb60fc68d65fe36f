#include "graphs/tools/draw.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "graphs/tools/layout.h"
#include "tests/graphs/document/fake_types.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

const std::string nodes = R"("a": {"type": "photo", "file": "a.png"}, "late-one": {"type": "photo", "file": "b.png"},
  "b": {"type": "adjust", "image": "@a"}, "c": {"type": "adjust", "image": "@b", "mask": "@a"},
  "set": {"type": "gather", "images": ["@a", "@c", "@late-one"]}, "out": {"type": "write", "material": "@set", "path": "o"})";

size_t count(const std::string& text, const std::string& part) {
  size_t n = 0;
  for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) n++;
  return n;
}

bool overlap(Point a, BoxSize a_size, Point b, BoxSize b_size) {
  return a.x < b.x + b_size.width && b.x < a.x + a_size.width && a.y < b.y + b_size.height && b.y < a.y + a_size.height;
}

}  // namespace

TEST_CASE("Graphviz gets every node and every wire") {
  const std::string dot = draw_dot(load_fake(document(nodes)).graph);
  CHECK(dot.starts_with("digraph terrazzo {"));
  CHECK(dot.find("\"late-one\" [label=\"late-one\\nphoto\"") != dot.npos);
  CHECK(dot.find("\"a\" -> \"c\" [label=\"mask\"") != dot.npos);
  CHECK(count(dot, " -> ") == 7);
}

TEST_CASE("the picture shows every node, its type, wired ports and wires") {
  const std::string svg = draw_svg(load_fake(document(nodes)).graph);
  CHECK(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\""));
  CHECK(svg.ends_with("</svg>\n"));
  for (const std::string name : {"late-one", "gather", "mask", "out"}) {
    CAPTURE(name);
    CHECK(svg.find(fmt::format(">{}</text>", name)) != svg.npos);
  }
  CHECK(count(svg, "fill=\"none\"") == 7);
  CHECK(svg.find("<title>image: late-one.image to set.images</title>") != svg.npos);
  CHECK(svg.find(">extra</text>") == svg.npos);
  CHECK(draw_svg(load_fake(document(nodes)).graph) == svg);
}

TEST_CASE("texts are escaped in pictures") {
  const std::string text =
      R"({"terrazzo": 1, "summary": "a < b & \"c\"", "nodes": {"a": {"type": "photo", "file": "x"}}})";
  CHECK(draw_svg(load_fake(text).graph).find("<title>a &lt; b &amp; &quot;c&quot;</title>") != std::string::npos);
}

TEST_CASE("what a run says of a node stands in its box") {
  const Graph graph = load_fake(document(nodes)).graph;
  std::vector<NodeMark> marks(graph.nodes.size(), NodeMark{"cached", "cached", ""});
  marks[0] = {"run", "run, 1.25 s", "data:image/png;base64,xyz"};
  const std::string svg = draw_svg(graph, marks);
  CHECK(svg.find(">run, 1.25 s</text>") != svg.npos);
  CHECK(svg.find("href=\"data:image/png;base64,xyz\"") != svg.npos);
  CHECK(count(svg, ">cached</text>") == graph.nodes.size() - 1);
  CHECK(count(svg, fmt::format("fill=\"{}\"", state_colour("run"))) == 2);
}

TEST_CASE("nodes of a subgraph are named by their place in it, in a frame") {
  Graph graph = load_fake(document(nodes)).graph;
  for (GraphNode& n : graph.nodes) {
    if (n.name != "out") n.name = "walls/" + n.name;
    for (auto& [port, wires] : n.inputs)
      for (Wire& w : wires) w.node = "walls/" + w.node;
  }
  const std::string svg = draw_svg(graph);
  CHECK(svg.find(">late-one</text>") != svg.npos);
  CHECK(count(svg, ">walls/</text>") == graph.nodes.size() - 1);
  CHECK(count(svg, "class=\"frame\"") == 1);
  CHECK(svg.find(">walls</text>") != svg.npos);
}

TEST_CASE("an empty graph has an empty picture") {
  CHECK(draw_svg(Graph()).find("</svg>") != std::string::npos);
  CHECK(draw_dot(Graph()).find("->") == std::string::npos);
}

TEST_CASE("boxes do not overlap, and wires lead to the right") {
  std::vector<BoxSize> boxes;
  std::vector<LayoutWire> wires;
  for (size_t i = 0; i < 40; i++) {
    boxes.push_back({60 + 10.0 * double(i % 4), 50 + 20.0 * double(i % 3)});
    for (const size_t back : {size_t{1}, size_t{3}, size_t{11}})
      if (i >= back && (i * back) % 5 != 0) wires.push_back({i - back, 20, i, 30});
  }
  const Layout layout = lay_out(boxes, wires);
  for (size_t i = 0; i < boxes.size(); i++) {
    CHECK(layout.corners[i].x >= 0);
    CHECK(layout.corners[i].y >= 0);
    CHECK(layout.corners[i].x + boxes[i].width <= layout.width);
    CHECK(layout.corners[i].y + boxes[i].height <= layout.height);
    for (size_t k = 0; k < i; k++) CHECK_FALSE(overlap(layout.corners[i], boxes[i], layout.corners[k], boxes[k]));
  }
  for (size_t w = 0; w < wires.size(); w++) {
    const std::vector<Point>& way = layout.ways[w];
    CHECK(way.size() % 2 == 0);
    for (size_t p = 1; p < way.size(); p++) CHECK(way[p].x >= way[p - 1].x);
    CHECK(way.back().y == layout.corners[wires[w].to].y + 30);
    // Where a wire crosses a column, it passes between the boxes.
    for (size_t p = 1; p + 1 < way.size(); p += 2)
      for (size_t i = 0; i < boxes.size(); i++)
        CHECK_FALSE(overlap(layout.corners[i], boxes[i], way[p], {way[p + 1].x - way[p].x, 0.01}));
  }
}

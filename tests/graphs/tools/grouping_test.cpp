#include "graphs/tools/grouping.h"

#include <set>
#include <string>

#include <doctest/doctest.h>

#include "core/base/hash.h"
#include "graphs/document/load.h"
#include "graphs/text/migrate.h"
#include "graphs/text/stock_graphs.h"

using namespace terrazzo;

namespace {

const std::string text = R"graph({
  "terrazzo": 1,

  "parameters": {
    "size": {"type": "size", "default": "=@exemplar.size * 2"},
    "scale": {"type": "number", "default": 0.5},
    "out": {"type": "path", "default": "out", "help": "where to"}
  },
  "presets": {
    "fine": {"set": {"layout.quality": "best"}}
  },
  "nodes": {
    // what is made larger
    "exemplar": {"type": "pattern", "kind": "gravel", "size": 64},
    "weighted": {"type": "weight", "material": "@exemplar"},
    "space": {"type": "pca", "features": "@weighted"},

    // from here on
    "index": {"type": "index", "appearance": "@space"},
    "layout": {"type": "synthesize", "index": "@index", "size": "=max(size * scale, @exemplar.size)"},  // the core
    "result": {"type": "resolve_uv", "uv": "@layout", "material": "@exemplar"},
    "files": {"type": "export", "material": "@result", "path": "$out/at-${scale}x/{map}.png"}
  }
}
)graph";

std::string signature_of(const GraphNode& node) {
  Hasher h;
  add_to(h, node.params);
  std::string out = node.type->name + h.digest().hex();
  for (const auto& [port, wires] : node.inputs) out += " " + port + std::to_string(wires.size());
  return out;
}

/// Whether two documents are the same graph but for the names of nodes.
bool are_alike(const std::string& a, const std::string& b) {
  const auto load = [](const std::string& t) {
    return load_graph_text(t, "/p/t.json", {}, {.allow_unset = true}).graph;
  };
  const Graph one = load(a), other = load(b);
  if (one.nodes.size() != other.nodes.size()) return false;
  std::multiset<std::string> left, right;
  for (const GraphNode& n : one.nodes) left.insert(signature_of(n));
  for (const GraphNode& n : other.nodes) right.insert(signature_of(n));
  return left == right;
}

}  // namespace

TEST_CASE("nodes into a subgraph and back give the same document") {
  REQUIRE(upgraded(text, "t.json") == text);
  const std::string inner = grouped(text, "/p/t.json", "analysis", {"weighted", "space", "index"});
  CHECK(are_alike(text, inner));
  const std::string both = grouped(inner, "/p/t.json", "make", {"analysis", "layout", "result"});
  CHECK(are_alike(text, both));
  CHECK(both.find("\"make/layout.quality\": \"best\"") != std::string::npos);
  CHECK(
      both.find(
          "\"make\": {\"type\": \"make\", \"exemplar\": \"@exemplar\", \"size\": \"$size\", \"scale\": \"$scale\"}") !=
      std::string::npos);
  const std::string all = grouped(both, "/p/t.json", "save", {"files"});
  CHECK(all.find("\"out\": {\"type\": \"path\", \"default\": \"out\", \"help\": \"where to\"}") !=
        all.rfind("\"out\": {"));
  std::string back = all;
  for (const char* node : {"save", "make", "analysis"}) back = ungrouped(back, "/p/t.json", node);
  CHECK(back == text);
}

TEST_CASE("every stock graph can be grouped and ungrouped") {
  for (const StockGraph& stock : stock_graphs()) {
    CAPTURE(stock.name);
    const std::string plain = upgraded(stock.text, "t.json");
    const Graph graph = load_graph_text(plain, "/p/t.json", {}, {.allow_unset = true}).graph;
    std::vector<std::string> names;
    for (const GraphNode& n : graph.nodes)
      if (n.name.find('/') == std::string::npos && n.type->category != "source") names.push_back(n.name);
    if (names.empty()) continue;
    const std::string moved = grouped(plain, "/p/t.json", "moved", names);
    CHECK(are_alike(plain, moved));
    CHECK(are_alike(plain, ungrouped(moved, "/p/t.json", "moved")));
  }
}

TEST_CASE("literal values take the place of parameters") {
  const std::string use =
      R"({"terrazzo": 1, "graphs": {"g": {"parameters": {"kind": {"type": "text", "default": "gravel"},
    "side": {"type": "int", "default": 64}, "both": {"type": "size", "default": "=[side, side * 2]"}, "out": {"type": "path", "default": "o"}},
    "nodes": {"p": {"type": "pattern", "kind": "$kind", "size": "$both"},
    "f": {"type": "export", "material": "@p", "path": "$out/$kind-$side-{map}.png"}}}},
    "nodes": {"u": {"type": "g", "side": 32, "out": "=out + '/x'"}}, "parameters": {"out": {"type": "path", "default": "q"}}})";
  const std::string flat = ungrouped(use, "/p/t.json", "u");
  CHECK(flat.find("\"kind\": \"gravel\"") != flat.npos);
  CHECK(flat.find("\"size\": \"=[32, 32 * 2]\"") != flat.npos);
  CHECK(flat.find("\"path\": \"=(out + '/x') + '/' + 'gravel' + '-' + 32 + '-{map}.png'\"") != flat.npos);
  CHECK(flat.find("graphs") == flat.npos);
  CHECK(are_alike(use, flat));
}

TEST_CASE("what cannot be grouped or ungrouped") {
  CHECK_THROWS_WITH(grouped(text, "t.json", "x", {"exemplr"}),
                    "the graph has no node \"exemplr\" (did you mean \"exemplar\"?)");
  CHECK_THROWS_WITH(grouped(text, "t.json", "pca", {"space"}),
                    "there is a graph or node type \"pca\" already; choose another name");
  CHECK_THROWS_WITH(grouped(text, "t.json", "files", {"space"}),
                    "there is a node \"files\" already; choose another name");
  CHECK_THROWS_WITH(grouped(text, "t.json", "a b", {"space"}), "\"a b\": expected a name of letters, digits, _ and -");
  CHECK_THROWS_WITH(ungrouped(text, "t.json", "space"), "the node \"space\" is of type \"pca\", which is not a graph");
  CHECK_THROWS_WITH(ungrouped(text, "t.json", "spce"), "the graph has no node \"spce\" (did you mean \"space\"?)");
}

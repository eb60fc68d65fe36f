#include "graphs/values/variations.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tests/graphs/document/fake_types.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

std::string labels(const std::vector<Variation>& all) {
  std::vector<std::string> out;
  for (const Variation& v : all) out.push_back(v.label());
  return fmt::format("{}", fmt::join(out, " | "));
}

template <typename F>
std::string trouble(const F& f) {
  try {
    f();
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("sweeps give every combination, the last one changing fastest") {
  CHECK(labels(swept({"seed=1..3"})) == "seed=1 | seed=2 | seed=3");
  CHECK(labels(swept({"seed=3..1"})) == "seed=3 | seed=2 | seed=1");
  CHECK(labels(swept({"seed=1..9:4,20"})) == "seed=1 | seed=5 | seed=9 | seed=20");
  CHECK(labels(swept({"x=0..0.3:0.1"})) == "x=0 | x=0.1 | x=0.2 | x=0.3");
  CHECK(labels(swept({"seed=1,2", "size=512x256,64"})) ==
        "seed=1, size=512x256 | seed=1, size=64 | seed=2, size=512x256 | seed=2, size=64");
  CHECK(labels(swept({R"(w={"a": 1, "b": 2},{"a": 3})"})) == R"(w={"a": 1, "b": 2} | w={"a": 3})");
  CHECK(labels(swept({"out=../x"})) == "out=../x");
  CHECK(swept({"layout.seed=4"}).front().label() == "layout.seed=4");
  CHECK(swept({}).empty());
}

TEST_CASE("sweeps that mean nothing are refused") {
  const auto problem = [](const std::vector<std::string>& sweeps) { return trouble([&] { swept(sweeps); }); };
  CHECK(problem({"seed"}) == "\"seed\": expected name=values, such as seed=1..8 or size=512,1024");
  CHECK(problem({"seed="}).find("expected name=values") != std::string::npos);
  CHECK(problem({"seed=1...3"}) == "\"seed=1...3\": a range has two dots, as in 1..3");
  CHECK(problem({"seed=1,,2"}) == "\"seed=1,,2\": expected a value between commas");
  CHECK(problem({"seed=1..5:-1"}) == "\"seed=1..5:-1\": expected a step that leads from 1 to 5");
  CHECK(problem({"seed=1..5:0"}).find("expected a step") != std::string::npos);
  CHECK(problem({"seed=1", "seed=2"}) == "\"seed=2\": \"seed\" is swept already");
  CHECK(problem({"seed=1..1000000000"}) == "more than 10000 variations; sweep over fewer values");
  CHECK(problem({"a=1..1000", "b=1..1000"}) == "more than 10000 variations; sweep over fewer values");
}

TEST_CASE("tables are read from CSV and JSON") {
  const TemporaryFolder folder;
  const fs::path csv = folder.path() / "t.csv", json = folder.path() / "t.json";
  write_text(csv, "seed,out,layout.note\r\n1,\"a, \"\"b\"\"\",x\r\n\r\n2,,\"two\nlines\"\r\n");
  CHECK(labels(read_table(csv)) == "seed=1, out=a, \"b\", layout.note=x | seed=2, layout.note=two\nlines");
  write_text(json, R"([{"seed": 1, "size": [4, 8]}, {"out": "b", "wrap": true}])");
  CHECK(labels(read_table(json)) == "seed=1, size=[4, 8] | out=b, wrap=true");
  CHECK(labels(combined(read_table(json), swept({"x=1,2"}))) ==
        "seed=1, size=[4, 8], x=1 | seed=1, size=[4, 8], x=2 | out=b, wrap=true, x=1 | out=b, wrap=true, x=2");
}

TEST_CASE("what is wrong with a table is said with its line") {
  const TemporaryFolder folder;
  const fs::path csv = folder.path() / "t.csv", json = folder.path() / "t.json";
  const auto problem = [&](const fs::path& file, const std::string& text) {
    write_text(file, text);
    const std::string out = trouble([&] { read_table(file); });
    return out.substr(std::min(out.size(), out.find("t.") == out.npos ? 0 : out.find("t.")));
  };
  CHECK(problem(csv, "seed\n") == "t.csv: expected a line of names and at least one line of values");
  CHECK(problem(csv, "seed,out\n1\n") == "t.csv:2: expected 2 cells as in the first line, found 1");
  CHECK(problem(csv, "seed,\n1,2\n") == "t.csv:1: column 2 has no name");
  CHECK(problem(csv, "seed,out,seed\n1,a,2\n") ==
        "t.csv:1: columns 1 and 3 are both named \"seed\"; a value is given once");
  CHECK(problem(csv, "\xEF\xBB\xBFout,\"out\"\n1,2\n") ==
        "t.csv:1: columns 1 and 2 are both named \"out\"; a value is given once");
  CHECK(problem(json, R"([{"seed": 1, "seed": 2}])").find("t.json:1:14: ") == 0);
  CHECK(problem(csv, "seed\n\"1\n\n") == "t.csv:2: a quote is opened and not closed");
  CHECK(problem(csv, "seed\n\"1\"2\n") == "t.csv:2: expected a comma or the end of the line after a cell in quotes");
  CHECK(problem(json, "{}").find("t.json:1:1: expected a list of objects") == 0);
  CHECK(problem(json, "[3]").find("t.json:1:2: expected a list of objects") == 0);
  CHECK(problem(json, "[{]").find("t.json:1:3") == 0);
  CHECK(trouble([&] { read_table(folder.path() / "none.csv"); }).find("there is no such table") != std::string::npos);
}

TEST_CASE("a sweep lists at most as many values as there may be variations, and each keeps only its beginning") {
  std::string list = "n=1";
  for (int i = 1; i < 10000; i++) list += ",1";
  const std::vector<Variation> all = swept({list});
  CHECK(all.size() == 10000);
  CHECK(all.front().origins.at("n").where.size() < 120);
  CHECK(trouble([&] { swept({list + ",1"}); }).find("more than 10000 variations") != std::string::npos);
}

TEST_CASE("a variation that is there twice is merged once") {
  GraphMerger merger;
  const std::string text =
      document(R"("a": {"type": "photo", "file": "$f"})", R"("f": {"type": "path", "default": "x"})");
  merger.add(load_fake(text, {"f=a"}).graph, "f=a");
  merger.add(load_fake(text, {"f=b"}).graph, "f=b");
  merger.add_again(1);
  const MergedGraph all = merger.merged();
  CHECK(all.graph.nodes.size() == 2);
  CHECK(all.names[1] == all.names[2]);
  CHECK(all.names[0] != all.names[1]);
}

TEST_CASE("what a table and a sweep both give is refused") {
  const TemporaryFolder folder;
  const fs::path csv = folder.path() / "t.csv";
  write_text(csv, "seed,out\n1,a\n,b\n");
  CHECK(trouble([&] {
          combined(read_table(csv), swept({"size=1,2", "seed=1..3"}));
        }) == "\"seed\" is given twice: by column \"seed\" of " + csv.string() + " and by --sweep \"seed=1..3\"");
}

TEST_CASE("integers in sweeps are exact, up to the limits of 64 bits") {
  CHECK(labels(swept({"seed=9007199254740993..9007199254740996"})) ==
        "seed=9007199254740993 | seed=9007199254740994 | seed=9007199254740995 | seed=9007199254740996");
  CHECK(labels(swept({"seed=9223372036854775805..9223372036854775807"})) ==
        "seed=9223372036854775805 | seed=9223372036854775806 | seed=9223372036854775807");
  CHECK(labels(swept({"seed=-9223372036854775808..9223372036854775807:9223372036854775807"})) ==
        "seed=-9223372036854775808 | seed=-1 | seed=9223372036854775806");
  CHECK(labels(swept({"seed=9223372036854775807..-9223372036854775808:-9223372036854775808"})) ==
        "seed=9223372036854775807 | seed=-1");
  CHECK(labels(swept({"seed=9007199254740993..9007199254740993"})) == "seed=9007199254740993");
  CHECK(labels(swept({"seed=9007199254740994..9007199254740992"})) ==
        "seed=9007199254740994 | seed=9007199254740993 | seed=9007199254740992");
  CHECK(trouble([] { swept({"seed=9223372036854775807..9223372036854775808"}); }) ==
        "\"seed=9223372036854775807..9223372036854775808\": expected integers from -9223372036854775808 to "
        "9223372036854775807, found 9223372036854775808");
  CHECK(trouble([] { swept({"seed=9007199254740993..9007199254740992:1"}); }).find("a step that leads from") !=
        std::string::npos);
  CHECK(trouble([] { swept({"seed=-9223372036854775808..9223372036854775807"}); }).find("more than 10000") == 0);
  CHECK(trouble([] { swept({"x=9007199254740993..9007199254740995:0.5"}); }) ==
        "\"x=9007199254740993..9007199254740995:0.5\": beyond 9007199254740992 a step must be an integer");
}

TEST_CASE("merged variations share what is the same, and differ where their values do") {
  const std::string text =
      document(R"("a": {"type": "photo", "file": "a.png"}, "b": {"type": "adjust", "image": "@a", "steps": "$n"},)"
               R"("c": {"type": "adjust", "image": "@b"}, "d": {"type": "adjust", "image": "@a", "steps": 7})",
               R"("n": {"type": "int", "default": 1})");
  const std::vector<Variation> all = swept({"n=1,2,2.0"});
  std::vector<Graph> graphs;
  std::vector<std::string> names;
  for (const Variation& v : all) {
    graphs.push_back(load_fake(text, {v.label()}).graph);
    names.push_back(v.label());
  }
  const MergedGraph one = merged(graphs, names);
  std::vector<std::string> nodes;
  for (const GraphNode& n : one.graph.nodes) nodes.push_back(n.name);
  // The third variation is the second one, written otherwise.
  CHECK(nodes == std::vector<std::string>{"a", "b [n=1]", "c [n=1]", "d", "b [n=2]", "c [n=2]"});
  CHECK(one.graph.find("c [n=2]")->inputs.at("image").front().node == "b [n=2]");
  CHECK(one.names[2].at("c") == "c [n=2]");
  CHECK(one.names[1].at("d") == "d");
  CHECK(merged({}, {}).graph.nodes.empty());
}

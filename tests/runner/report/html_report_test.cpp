#include "runner/report/html_report.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runner/report/page.h"
#include "runner/report/shown_nodes.h"
#include "tests/runner/fakes.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// Runs the graph, writes its report, and reads that.
struct ReportedRun {
  std::string page;
  nlohmann::json data;

  explicit ReportedRun(const Graph& graph, const std::vector<std::string>& keep = {}) {
    TemporaryFolder folder;
    RunOptions options;
    options.targets.keep = keep;
    const Plan plan = make_plan(graph, nullptr, options.targets);
    write_html_report(plan, run_plan(plan, options), folder.path() / "run.html");
    page = read_text(folder.path() / "run.html");
    const std::string start = "<script type=\"application/json\" id=\"data\">";
    const size_t from = page.find(start) + start.size();
    data = nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
  }
  const nlohmann::json& node(const std::string& name) const {
    for (const nlohmann::json& n : data["nodes"])
      if (n["name"] == name) return n;
    throw std::logic_error("no node " + name);
  }
};

size_t count(const std::string& text, const std::string& part) {
  size_t n = 0;
  for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) n++;
  return n;
}

}  // namespace

TEST_CASE("a report says with which parameters, and seeds, everything was made") {
  FakeTypes t;
  t.number.params.push_back({.name = "seed", .type = ParamType::integer, .fallback = int64_t{0}});
  Graph g;
  add(g, "a", t.number, {{"value", 4.0}, {"seed", int64_t{77}}});
  add(g, "total", t.sum, {{"plus", 0.0}}, {"a"});
  g.nodes.back().comment = "what comes out";
  g.settings = {{"amount", ParamValue(4.0), "how much", true}};
  const ReportedRun run(g, {"total"});
  CHECK(run.data["settings"][0]["name"] == "amount");
  CHECK(run.data["settings"][0]["value"] == 4);
  CHECK(run.data["settings"][0]["given"] == true);
  CHECK(run.data["seeds"]["a"] == 77);
  CHECK(run.node("total")["comment"] == "what comes out");
  CHECK(run.node("total")["state"] == "run");
  CHECK(run.node("total")["parameters"][0]["name"] == "plus");
  CHECK(run.node("total")["parameters"][0]["default"] == true);
  CHECK(run.node("total")["inputs"]["in"][0] == "a.out");
  const std::string picture = run.node("total")["pictures"][0]["id"];
  CHECK(contains(run.page, "id=\"" + picture + "\" src=\"data:image/png;base64,"));
  CHECK(contains(run.page, "<td>a</td><td class=\"number\">77</td>"));
  CHECK(count(run.page, "class=\"node\"") == 2);
}

TEST_CASE("nothing in a report can end its scripts or become markup") {
  FakeTypes t;
  const std::string hostile = "</script><img src=x onerror=alert(1)>\"'&";
  Graph g;
  g.summary = hostile;
  g.file = hostile;
  add(g, hostile, t.number, {{"value", 1.0}});
  g.nodes.back().comment = hostile;
  g.settings = {{hostile, ParamValue(hostile), hostile, true}};
  const ReportedRun run(g, {hostile});
  CHECK(run.data["summary"] == hostile);
  CHECK(run.data["settings"][0]["value"] == hostile);
  CHECK(run.node(hostile)["comment"] == hostile);
  CHECK_FALSE(contains(run.page, "<img src=x"));
  CHECK(count(run.page, "</script>") == 2);
}

TEST_CASE("a report of a failed run says what failed, and draws it") {
  FakeTypes t;
  Graph g = small_graph(t);
  add(g, "last", t.fail, {}, {"total"});
  const ReportedRun run(g);
  CHECK(run.data["ok"] == false);
  CHECK(run.node("last")["state"] == "failed");
  CHECK(contains(run.data["failures"][0]["message"], "these numbers cannot be added"));
  CHECK(contains(run.page, "<p class=\"failed\">Failed: "));
}

TEST_CASE("nodes of many variations fold, those of one that failed are open; few nodes are one table") {
  FakeTypes t;
  const auto page_of = [&](int variations) {
    Graph g;
    add(g, "shared", t.number, {{"value", 1.0}});
    for (int i = 0; i < variations; i++)
      add(g, fmt::format("total [seed {}]", i), t.sum, {{"plus", double(i)}}, {"shared"});
    add(g, "broken [seed 3]", t.fail, {}, {"shared"});
    return ReportedRun(g).page;
  };
  const std::string many = page_of(60), few = page_of(8);
  CHECK(count(many, "<details><summary><b>seed ") == 59);
  CHECK(count(many, "<details open><summary><b>seed 3</b>") == 1);
  CHECK(count(many, "<table class=\"sortable stages\">") == 61);
  CHECK(count(many, "<tr><td>shared</td>") == 1);
  CHECK(count(few, "<table class=\"sortable stages\">") == 1);
  CHECK(count(few, "<b>seed ") == 0);
}

TEST_CASE("what many nodes say alike stands in a report once, and long lists fold") {
  FakeTypes t;
  t.sum.compute = [compute = t.sum.compute](NodeContext& node) {
    node.warn("too <bright>");
    node.note(fmt::format("plus {}", node.number("plus")));
    compute(node);
  };
  Graph g;
  add(g, "shared", t.number, {{"value", 1.0}});
  for (int i = 0; i < 40; i++) add(g, fmt::format("total {}", i), t.sum, {{"plus", double(i)}}, {"shared"});
  const std::string page = ReportedRun(g).page;
  CHECK(count(page, "total 0 and 39 more nodes: ") == 2);  // above, and among the notes
  CHECK(count(page, "<li>") == 1 + 41);
  CHECK(count(page, "<details><summary>41 notes</summary>") == 1);
}

TEST_CASE("what is up to date is not computed for a report's origins") {
  FakeTypes t;
  t.number.category = "source";
  TemporaryFolder folder;
  Session session({.cache = folder.path() / "cache"}), without_cache({.use_cache = false});
  Graph g;
  add(g, "a", t.number, {{"value", 4.0}});
  add(g, "total", t.sum, {}, {"a"});
  add(g, "file", t.write, {{"path", (folder.path() / "out.txt").string()}}, {"total"});
  CHECK(nodes_for_report(g, {}, without_cache) == std::vector<std::string>{"total", "a"});
  REQUIRE(session.run(g).ok());
  const std::vector<std::string> kept = nodes_for_report(g, {}, session);
  CHECK(kept == std::vector<std::string>{"total", "a"});
  const int runs = t.runs("number");
  REQUIRE(session.run(g, {.keep = kept}).ok());
  CHECK(t.runs("number") == runs);
}

TEST_CASE("a report's page has its figures with bars and its pictures") {
  TemporaryFolder folder;
  const ReportPtr report = Report::make("A < B", {{"swd", 0.25, "lower is better"}, {"text", "some", "help"}},
                                        {{"sheet", number_image(0.5)}});
  write_report_page(*report, folder.path() / "page.html");
  const std::string page = read_text(folder.path() / "page.html");
  CHECK(contains(page, "<h1>terrazzo: A &lt; B</h1>"));
  CHECK(contains(page, "style=\"width:25.0%\""));
  CHECK(count(page, "<img class=\"picture\"") == 1);
}

TEST_CASE("a page of variations has a row and a picture for each; equal pictures are stored once") {
  TemporaryFolder folder;
  std::vector<std::vector<std::string>> table = {{"seed"}};
  std::vector<Report::Picture> pictures;
  for (int i = 0; i < 5; i++) {
    table.push_back({std::to_string(i)});
    pictures.push_back({fmt::format("seed={}", i), number_image(i % 2)});
  }
  write_variations_page("Variations", table, pictures, folder.path() / "page.html");
  const std::string page = read_text(folder.path() / "page.html");
  CHECK(count(page, "<tr data-row=") == 5);
  CHECK(count(page, "<img class=\"picture\"") == 5);
  CHECK(count(page, "src=\"data:image") == 2);
  CHECK(contains(page, "loading=\"lazy\""));
}

TEST_CASE("many pictures are smaller ones") {
  CHECK(side_for(1, 512) == 512);
  CHECK(side_for(300, 512) < 256);
  CHECK(side_for(100000, 512) == 128);
  CHECK(side_for(5, 64) == 64);
}

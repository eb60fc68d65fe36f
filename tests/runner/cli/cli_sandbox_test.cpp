#include <doctest/doctest.h>

#include "runner/engine/sandbox.h"
#include "tests/runner/fakes.h"
#include "tests/runner/workplace.h"

/// Runs of graphs that one does not trust.
using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

/// A graph in a folder, and things around that it is not to touch.
struct Prison : Workplace {
  Prison() {
    fs::create_directories(path / "in");
    write_picture(path / "in/photo.png", 5);
    write_picture(path / "secret.png", 7);
    fs::create_directories(path / "outside");
    fs::create_symlink(path / "outside", path / "in/away");
    fs::create_symlink(path / "secret.png", path / "in/link.png");
  }
  ProgramRun run_graph(const std::string& source, const std::string& target, std::vector<std::string> more = {}) const {
    write_text(path / "in/graph.json", R"({"terrazzo": 1, "parameters": {"out": {"type": "path", "default": ")" +
                                           target + R"("}}, "nodes": {
  "photo": {"type": "load_map", "path": ")" +
                                           source + R"("},
  "files": {"type": "export", "material": "@photo", "path": "$out/{map}.png"}
}})");
    std::vector<std::string> args = {"run", "in/graph.json", "--sandbox", "in"};
    args.insert(args.end(), more.begin(), more.end());
    return run(args);
  }
};

}  // namespace

TEST_CASE("in a sandbox nodes read and write nothing elsewhere, through links neither, and it is said where and why") {
  const Prison w;
  const ProgramRun good = w.run_graph("photo.png", "out");
  CHECK_MESSAGE(good.code == 0, good.err);
  CHECK(listing(w.path / "in/out") == std::vector<std::string>{"base_color.png"});
  struct Case {
    const char* source;
    const char* target;
    const char* says;
  };
  for (const Case& c : {Case{"../secret.png", "out2", "node \"photo\" (load_map), parameter \"path\": may not read "},
                        Case{"link.png", "out2", "node \"photo\" (load_map), parameter \"path\": may not read "},
                        Case{"away/x.png", "out2", "node \"photo\" (load_map), parameter \"path\": may not read "},
                        Case{"photo.png", "../out", "node \"files\" (export), parameter \"path\""},
                        Case{"photo.png", "away", "node \"files\" (export), parameter \"path\""},
                        Case{"photo.png", "away/deep/er", "node \"files\" (export), parameter \"path\""}}) {
    for (const bool dry : {false, true}) {
      const ProgramRun r =
          w.run_graph(c.source, c.target, dry ? std::vector<std::string>{"--dry-run"} : std::vector<std::string>{});
      CHECK(r.code == 2);
      CHECK_MESSAGE(r.err.find(c.says) != std::string::npos, r.err);
      CHECK_MESSAGE(
          r.err.find("is outside the sandbox in; give it to a parameter of type path with --set") != std::string::npos,
          r.err);
    }
  }
  CHECK(fs::is_empty(w.path / "outside"));
  CHECK_FALSE(fs::exists(w.path / "out"));
  CHECK_FALSE(fs::exists(w.path / "in/out2"));
}

TEST_CASE("what --set names is allowed in a sandbox, and nothing beside it") {
  const Prison w;
  const ProgramRun named =
      w.run_graph("../secret.png", "out", {"--set", "photo.path=secret.png", "--set", "out=result"});
  CHECK_MESSAGE(named.code == 0, named.err);
  CHECK(listing(w.path / "result") == std::vector<std::string>{"base_color.png"});
  CHECK(w.run_graph("../secret.png", "out", {"--set", "out=result"}).code == 2);
  CHECK(w.run_graph("photo.png", "../results", {"--set", "photo.path=secret.png"}).code == 2);
  const ProgramRun synth = w.run({"synth", "nowhere", "-o", "out", "--sandbox", "gone"});
  CHECK(synth.code == 2);
}

TEST_CASE("only parameters of type path open what --set names") {
  const Prison w;
  write_text(w.path / "in/graph.json", R"({"terrazzo": 1, "parameters": {
  "label": {"type": "text", "default": "x"}, "file": {"type": "path", "default": "photo.png"},
  "source": {"type": "path", "default": "../secret.png"}}, "nodes": {
  "photo": {"type": "load_map", "path": "$source"},
  "sum": {"type": "blur", "image": "@photo", "radius": 1, "comment": "$label $file"},
  "files": {"type": "export", "material": "@sum", "path": "out/$label.png", "color_space": "keep"}
}})");
  const std::string folder = w.path.string();
  const auto code = [&](const std::string& set) {
    return w.run({"run", "in/graph.json", "--sandbox", "in", "--set", set}).code;
  };
  CHECK(code("label=" + folder) == 2);
  CHECK(code("label=" + folder + "/secret.png") == 2);
  CHECK(code("files.color_space=" + folder) == 2);
  CHECK(code("source=$label") == 2);
  CHECK(code("source=='" + folder + "/' + 'secret.png'") == 2);
  CHECK(code("source=" + folder + "/secret.png") == 0);
  CHECK(code("photo.path=" + folder + "/secret.png") == 0);
}

TEST_CASE("in a sandbox loops list nothing elsewhere, and read no tables there") {
  const Prison w;
  write_picture(w.path / "outside/plan-of-attack.png", 3);
  write_text(w.path / "outside/table.csv", "file\nphoto.png\n");
  const auto run_loop = [&](const std::string& loop, std::vector<std::string> more = {}) {
    write_text(w.path / "in/graph.json", R"({"terrazzo": 1,
  "parameters": {"scans": {"type": "path", "default": "*.png"}, "words": {"type": "text", "default": "*.png"}},
  "graphs": {"one": {"parameters": {"name": {"type": "text"}}, "nodes": {
    "photo": {"type": "load_map", "path": "photo.png"},
    "file": {"type": "export", "material": "@photo", "path": "out/$name.png"}}}},
  "nodes": {"all": {"type": "one", "foreach": {)" +
                                             loop + R"(, "as": "scan"}, "name": "$scan_name"}}})");
    std::vector<std::string> args = {"run", "in/graph.json", "--sandbox", "in"};
    args.insert(args.end(), more.begin(), more.end());
    return w.run(args);
  };
  for (const std::string loop :
       {R"("files": "../outside/*.png")", R"("files": "away/*.png")", R"("files": "*/plan*.png")",
        R"("files": "away/plan-of-attack.png")", R"("folders": "../*")", R"("table": "../outside/table.csv")",
        R"("table": "away/table.csv")", R"("files": "../outside/none*")"}) {
    CAPTURE(loop);
    const ProgramRun r = run_loop(loop);
    CHECK(r.code == 2);
    CHECK_MESSAGE(r.err.find("may not read ") != std::string::npos, r.err);
    if (loop.find("plan-of-attack") == loop.npos) CHECK(r.err.find("plan-of-attack") == std::string::npos);
  }
  CHECK_FALSE(fs::exists(w.path / "in/out"));
  fs::remove(w.path / "in/link.png");
  const ProgramRun inside = run_loop(R"("files": "*.png")");
  CHECK_MESSAGE(inside.code == 0, inside.err);
  const ProgramRun named = run_loop(R"("files": "$scans")", {"--set", "scans=outside/*.png"});
  CHECK_MESSAGE(named.code == 0, named.err);
  CHECK(fs::exists(w.path / "in/out/plan-of-attack.png"));
  CHECK(run_loop(R"("files": "$words")", {"--set", "words=" + (w.path / "outside").string() + "/*.png"}).code == 2);
}

TEST_CASE("in a sandbox an expression learns nothing of files elsewhere") {
  const Prison w;
  write_text(w.path / "in/graph.json", R"({"terrazzo": 1, "nodes": {
  "photo": {"type": "load_map", "path": "../secret.png"},
  "noise": {"type": "noise", "size": "=@photo.size"},
  "file": {"type": "export", "material": "@noise", "path": "out/{map}.png"}}})");
  const ProgramRun r = w.run({"run", "in/graph.json", "--sandbox", "in", "--only", "noise"});
  CHECK(r.code == 2);
  CHECK_MESSAGE(r.err.find("node \"photo\" (load_map), parameter \"path\": may not read ") != std::string::npos, r.err);
}

TEST_CASE("in a sandbox colour configurations and their look-up files are read nowhere else") {
  const Prison w;
  write_text(w.path / "outside/half.spi1d", "Version 1\nFrom 0 1\nLength 2\nComponents 1\n{\n0.0\n0.5\n}\n");
  const auto config = [&](const fs::path& file, const std::string& src) {
    write_text(w.path / file,
               "ocio_profile_version: 2\nroles: {default: raw}\n"
               "displays: {d: [!<View> {name: v, colorspace: raw}]}\ncolorspaces:\n"
               "  - !<ColorSpace> {name: raw, isdata: true}\n  - !<ColorSpace> {name: lin_rec709}\n"
               "  - !<ColorSpace> {name: looked, to_scene_reference: !<FileTransform> {src: " +
                   src + "}}\n");
  };
  const auto run_with = [&](const std::string& path, std::vector<std::string> more = {}) {
    write_text(w.path / "in/graph.json", R"({"terrazzo": 1, "nodes": {
  "photo": {"type": "load_map", "path": "photo.png"},
  "lin": {"type": "convert_color", "image": "@photo", "from": "looked", "to": "lin_rec709", "config": ")" +
                                             path + R"("},
  "file": {"type": "export", "material": "@lin", "path": "out/{map}.png", "color_space": "keep"}}})");
    std::vector<std::string> args = {"run", "in/graph.json", "--sandbox", "in", "--progress", "none"};
    args.insert(args.end(), more.begin(), more.end());
    return w.run(args);
  };
  config("outside/config.ocio", "half.spi1d");
  for (const char* src : {"../outside/half.spi1d", "away/half.spi1d"}) {
    config("in/config.ocio", src);
    const ProgramRun r = run_with("config.ocio");
    CHECK(r.code == 2);
    CHECK_MESSAGE(r.err.find("may not read ") != std::string::npos, r.err);
  }
  CHECK(run_with("../outside/config.ocio").code == 2);
  CHECK(run_with("/etc/passwd").err.find("root:") == std::string::npos);
  fs::copy(w.path / "outside/half.spi1d", w.path / "in/half.spi1d");
  config("in/config.ocio", "half.spi1d");
  const ProgramRun inside = run_with("config.ocio");
  CHECK_MESSAGE(inside.code == 0, inside.err);
  const ProgramRun named = run_with("none.ocio", {"--set", "lin.config=outside/config.ocio"});
  CHECK_MESSAGE(named.code == 2, named.err);  // the table beside it has not been named
}

TEST_CASE("a link that comes to lead outside of the sandbox after the plan was made is refused when the node runs") {
  const Prison w;
  fs::create_directories(w.path / "in/out");
  FakeTypes t;
  Graph g;
  add(g, "a", t.number, {{"value", 1.0}});
  t.during_sum = [&](NodeContext&) {
    fs::remove(w.path / "in/out");
    fs::create_symlink(w.path / "outside", w.path / "in/out");
    fs::remove(w.path / "in/number.txt");
    fs::create_symlink(w.path / "number.txt", w.path / "in/number.txt");
  };
  write_text(w.path / "number.txt", "7");
  write_text(w.path / "in/number.txt", "7");
  add(g, "evil", t.sum, {}, {"a"});
  add(g, "file", t.write, {{"path", (w.path / "in/out/x.txt").string()}}, {"evil"});
  add(g, "source", t.file, {{"path", (w.path / "in/number.txt").string()}});
  add(g, "late", t.sum, {}, {"source"});
  const Sandbox sandbox(w.path / "in");
  REQUIRE(sandbox_problems(g.nodes, sandbox).empty());
  RunOptions options;
  options.sandbox = &sandbox;
  const RunResult r = run_graph(g, options);
  REQUIRE(r.failures.size() == 1);
  CHECK(r.failures[0].node == "file");
  CHECK_MESSAGE(r.failures[0].message.find("may not write ") != std::string::npos, r.failures[0].message);
  CHECK(fs::is_empty(w.path / "outside"));

  RunOptions reading = keeping({"source"});
  reading.sandbox = &sandbox;
  const RunResult read = run_graph(g, reading);
  REQUIRE(read.failures.size() == 1);
  CHECK_MESSAGE(read.failures[0].message.find("may not read ") != std::string::npos, read.failures[0].message);
}

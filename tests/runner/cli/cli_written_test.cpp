#include <doctest/doctest.h>

#include "tests/odd_images.h"
#include "tests/runner/fakes.h"
#include "tests/runner/workplace.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

struct Refused {
  std::vector<std::string> args;
  std::string says;
};

/// All are refused with code 2, and no file of the folder changes.
void check_refused(const Workplace& w, const std::vector<Refused>& all) {
  const auto content = [&] {
    std::map<std::string, Bytes> files;
    for (const auto& e : fs::recursive_directory_iterator(w.path))
      if (const std::string name = e.path().filename().string();
          e.is_regular_file() && name != "stdout" && name != "stderr" && !contains(e.path().string(), "/cache/"))
        files[e.path().string()] = read_bytes(e.path());
    return files;
  };
  const auto before = content();
  for (const Refused& r : all) {
    std::string line;
    for (const std::string& arg : r.args) line += arg + " ";
    CAPTURE(line);
    const ProgramRun run = w.run(r.args);
    CHECK(run.code == 2);
    CHECK_MESSAGE(contains(run.err, r.says), run.err);
    CHECK(content() == before);
  }
}

}  // namespace

TEST_CASE("no option overwrites what the command reads or what its nodes write, by whatever link") {
  const Workplace w;
  write_picture(w.path / "maps/stone_basecolor.png", 5);
  write_text(w.path / "soft.presets.json", R"({"strong": {"set": {"radius": 4}}})");
  write_text(w.path / "seeds.csv", "radius\n1\n2\n");
  write_text(w.path / "set.json", R"({"radius": 3})");
  fs::create_hard_link(w.path / "photo.png", w.path / "hard.html");
  fs::create_symlink("soft.json", w.path / "soft.html");
  fs::create_symlink("photo.png", w.path / "link.json");
  write_text(w.path / "saves.json", R"({"terrazzo": 1, "nodes": {
    "photo": {"type": "load_map", "path": "photo.png"},
    "features": {"type": "weight", "material": "@photo"},
    "space": {"type": "pca", "features": "@features"},
    "index": {"type": "index", "appearance": "@space"},
    "file": {"type": "save_analysis", "index": "@index", "path": "saves.json"}}})");
  check_refused(
      w,
      {
          {{"run", "soft.json", "--force", "--report", "hard.html"}, "the node \"photo\" reads it"},
          {{"run", "soft.json", "--force", "--report", "soft.html"}, "it is the graph file; name another file"},
          {{"run", "soft.json", "--force", "--trace", "link.json"}, "the node \"photo\" reads it"},
          {{"run", "soft.json", "--force", "--trace", "photo.png"}, "the node \"photo\" reads it"},
          {{"run", "soft.json", "--force", "--trace", "soft.json"}, "it is the graph file"},
          {{"run", "soft.json", "--force", "--trace", "soft.presets.json"}, "it holds the graph's presets"},
          {{"run", "soft.json", "--force", "--params", "set.json", "--trace", "set.json"}, "--params reads it"},
          {{"run", "soft.json", "--force", "--trace", "out/base_color.png"}, "the node \"files\" writes it"},
          {{"run", "soft.json", "--force", "--trace", "a.html", "--report", "a.html"}, "--report names the same file"},
          {{"run", "soft.json", "--force", "--table", "seeds.csv", "--figures", "seeds.csv", "--set",
            "out=='out/' + radius"},
           "it is the table of --table"},
          {{"run", "saves.json", "--set", "file.path=saves.json"},
           "saves.json exists and is not an analysis; name another file"},
          {{"synth", "maps", "-o", "out", "--force", "--trace", "maps/stone_basecolor.png"},
           "the node \"exemplar\" reads it"},
          {{"upgrade", "soft.json", "--force", "-o", "soft.html"}, "it is the graph file"},
          {{"format", "soft.json", "--force", "-o", "./soft.json"}, "it is the graph file"},
          {{"draw", "soft.json", "--force", "-o", "soft.json"}, "-o takes a file that ends in .svg or .dot"},
          {{"pack", "soft.json", "--force", "-o", "photo.png"}, "the node \"photo\" reads it"},
          {{"pack", "soft.json", "--force", "-o", "soft.json"}, "it is the graph file"},
          {{"compare", "photo.png", "photo.png", "--force", "--sheet", "hard.html"}, "reads it"},
          {{"compare", "photo.png", "photo.png", "--force", "--sheet", "photo.png"}, "reads it"},
          {{"new", "maps", "--force", "-o", "maps/stone_basecolor.png"}, "it belongs to the exemplar"},
      });
}

TEST_CASE("files of another kind are overwritten with --force only") {
  const Workplace w;
  write_text(w.path / "thesis.html", "<!doctype html><p>mine");
  write_text(w.path / "data.json", "{\"mine\": 1}");
  write_text(w.path / "sketch.svg", "no drawing");
  write_text(w.path / "picture.png", "no picture");
  write_text(w.path / "analysis", "no analysis");
  const std::string& report = "--report";
  check_refused(w, {
                       {{"run", "soft.json", report, "thesis.html"}, "is no page of terrazzo; name another, or"},
                       {{"run", "soft.json", "--trace", "data.json"}, "no timeline of terrazzo"},
                       {{"run", "soft.json", "--trace", "photo.png"}, "no timeline of terrazzo"},
                       {{"upgrade", "soft.json", "-o", "data.json"}, "no graph file"},
                       {{"draw", "soft.json", "-o", "sketch.svg"}, "no drawing of a graph"},
                       {{"pack", "soft.json", "-o", "data.json"}, "no pack"},
                       {{"compare", "photo.png", "photo.png", "--sheet", "picture.png"}, "no picture"},
                       {{"compare", "photo.png", "photo.png", "--sheet", "thesis.html"}, "no page of terrazzo"},
                   });
  for (const bool again : {false, true}) {
    CAPTURE(again);  // the second time they are of the right kind
    std::vector<std::vector<std::string>> all = {
        {"run", "soft.json", "--report", "thesis.html", "--trace", "data.json"},
        {"draw", "soft.json", "-o", "sketch.svg"},
        {"compare", "photo.png", "photo.png", "--sheet", "picture.png"},
    };
    for (std::vector<std::string>& args : all) {
      if (!again) args.emplace_back("--force");
      const ProgramRun run = w.run(args);
      CHECK_MESSAGE(run.code == 0, run.err);
    }
  }
  CHECK(contains(read_text(w.path / "thesis.html"), "A blurred picture"));
  CHECK(w.run({"upgrade", "soft.json", "-o", "second.json"}).code == 0);
  CHECK(w.run({"upgrade", "soft.json", "-o", "second.json"}).code == 0);
  CHECK(w.run({"run", "soft.json", "--trace", "/dev/null"}).code == 0);
}

TEST_CASE("names that cannot be written are found before anything runs") {
  const Workplace w;
  const std::string longest(251, 'n');
  const ProgramRun too_long = w.run({"run", "soft.json", "--set", "files.path=out/" + longest + "n.png"});
  CHECK(too_long.code == 2);
  CHECK_MESSAGE(contains(too_long.err, "is too long: 256 bytes; names have at most 255 here"), too_long.err);
  CHECK_FALSE(fs::exists(w.path / "out"));
  CHECK(w.run({"run", "soft.json", "--set", "files.path=out/" + longest + ".png"}).code == 0);
  std::string deep = "out";
  for (int i = 0; i < 20; i++) deep += "/" + longest;
  CHECK(contains(w.run({"run", "soft.json", "--set", "files.path=" + deep + "/a.png"}).err, "is too long: "));

  for (const bool folder_first : {false, true}) {
    CAPTURE(folder_first);
    write_text(w.path / "two.json", std::string(R"({"terrazzo": 1, "nodes": {
      "photo": {"type": "load_map", "path": "photo.png"},
      "first": {"type": "export", "material": "@photo", "path": ")") +
                                        (folder_first ? "x.png/y.png" : "x.png") + R"("},
      "second": {"type": "export", "material": "@photo", "path": ")" +
                                        (folder_first ? "x.png" : "x.png/y.png") + R"("}}})");
    const ProgramRun run = w.run({"run", "two.json"});
    CHECK(run.code == 2);
    CHECK_MESSAGE(contains(run.err, "x.png would be both a file"), run.err);
    CHECK_FALSE(fs::exists(w.path / "x.png"));
  }
}

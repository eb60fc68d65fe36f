#include <filesystem>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "core/image_io/image_file.h"
#include "test_paths.h"
#include "tests/runner/program.h"
#include "tests/runner/workplace.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

const std::string graphs = TERRAZZO_SOURCE_DIR "/graphs/";

/// Two materials, and a library that has the analysis of the first.
struct Stones : Workplace {
  Stones() {
    for (const char* kind : {"gravel", "bricks"})
      REQUIRE(run({"run", graphs + "generate-exemplar.json", "--set", std::string("type=") + kind, "--set", "size=96",
                   "--set", std::string("out=") + kind})
                  .code == 0);
    const ProgramRun added = run({"library", "add", "stone/gravel", "gravel", "--tag", "Small", "--summary", "grey"});
    CAPTURE(added.err);
    REQUIRE(added.code == 0);
  }

  ProgramRun lay_out(const std::string& analysis, const std::string& material) const {
    return run({"run", graphs + "from_analysis.json", "--set", "size=128", "--set", "quality=draft", "--set",
                "analysis=" + analysis, "--set", "material=" + material, "--set", "out=out"});
  }
};

}  // namespace

TEST_CASE("graphs take an analysis, and its maps, from the library by name") {
  const Stones w;
  CHECK(w.lay_out("library:stone/gravel", "library:stone/gravel").code == 0);
  const std::string picture = read_text(w.path / "out/height.png");
  CHECK(w.lay_out("library:stone/gravel", "gravel").code == 0);
  CHECK(read_text(w.path / "out/height.png") == picture);
  // Laying out needs no maps.
  fs::rename(w.path / "gravel", w.path / "elsewhere");
  CHECK(w.run({"run", graphs + "from_analysis.json", "--set", "analysis=library:stone/gravel", "--only", "layout"})
            .code == 0);
  const json entry = json::parse(w.run({"library", "list", "--json"}).out).at(0);
  const std::string digest = entry["content"];
  CHECK(w.lay_out("library:stone/gravel@" + digest.substr(0, 8), "elsewhere").code == 0);
  const ProgramRun other = w.lay_out("library:stone/gravel@00" + digest.substr(0, 6), "elsewhere");
  CHECK(other.code == 2);
  CHECK(contains(other.err, "it has been replaced, or the digest is misspelt"));
}

TEST_CASE("a picture is analysed, and stands for its material") {
  const Stones w;
  fs::copy_file(w.path / "bricks/base_color.png", w.path / "shot.png");
  const ProgramRun added = w.run({"library", "add", "photo", "shot.png"});
  CHECK_MESSAGE(added.code == 0, added.err);
  CHECK(w.lay_out("library:photo", "library:photo").code == 0);
  CHECK(fs::exists(w.path / "out/base_color.png"));
  CHECK(w.run({"library", "check", "photo"}).code == 0);
  fs::copy_file(w.path / "gravel/base_color.png", w.path / "shot.png", fs::copy_options::overwrite_existing);
  const ProgramRun changed = w.run({"library", "check", "photo"});
  CHECK_MESSAGE(contains(changed.out, "shot.png has changed since it was analysed"), changed.out);
}

TEST_CASE("an analysis is refused for another material, and for what takes none") {
  const Stones w;
  const ProgramRun run = w.lay_out("library:stone/gravel", "bricks");
  CHECK(run.code == 1);
  CHECK(contains(run.err, "this is not the exemplar that was analysed"));
  CHECK(w.run({"run", graphs + "from_analysis.json", "--set", "analysis=library:stone/gravel", "--set",
               "material=bricks", "--set", "result.other_material=true", "--set", "quality=draft", "--set", "out=out"})
            .code == 0);
  const ProgramRun unknown = w.lay_out("library:stone/gravle", "gravel");
  CHECK(unknown.code == 2);
  CHECK(contains(unknown.err, "did you mean \"stone/gravel\"?"));
  const ProgramRun sink = w.run({"run", graphs + "analyse.json", "--set", "material=gravel", "--set", "out=library:x"});
  CHECK(sink.code == 2);
  CHECK(contains(sink.err, "only load_analysis, and load_material for its maps, take an analysis by name"));
}

TEST_CASE("library add takes a folder or an analysis, and replaces only by force") {
  const Stones w;
  REQUIRE(w.run({"run", graphs + "analyse.json", "--set", "material=bricks", "--set", "out=b.analysis"}).code == 0);
  CHECK(w.run({"library", "add", "bricks", "b.analysis", "--material", "bricks"}).code == 0);
  CHECK(w.run({"library", "add", "plain", "b.analysis"}).code == 0);
  CHECK(w.lay_out("library:bricks", "library:bricks").code == 0);
  const ProgramRun unplaced = w.lay_out("library:plain", "library:plain");
  CHECK(unplaced.code == 2);
  CHECK(contains(unplaced.err, "does not say where the maps of plain are"));
  const auto refused = [&](const std::vector<std::string>& args, const std::string& why) {
    std::vector<std::string> words = {"library", "add"};
    words.insert(words.end(), args.begin(), args.end());
    const ProgramRun run = w.run(words);
    CAPTURE(run.err);
    CHECK(run.code != 0);
    CHECK(contains(run.err, why));
  };
  refused({"bricks", "bricks"}, "--force replaces it");
  CHECK(w.run({"library", "add", "bricks", "bricks", "--force"}).code == 0);
  refused({"other", "b.analysis", "--material", "gravel"}, "these are not the maps that were analysed");
  refused({"other", "b.analysis", "--set", "weighted.weights.height=2"}, "--set needs a folder");
  refused({"other", "bricks", "--material", "bricks"}, "--material needs an analysis");
  refused({"../other", "bricks"}, "cannot be the name of an entry");
  refused({"other", "nothing-here"}, "SOURCE: cannot read");
  refused({"other", "library"}, "SOURCE: no maps recognised");
  refused({"other", "bricks", "--set", "weighted.wieghts=2"}, "weights");
  for (const auto& file : fs::directory_iterator(w.path / "library"))  // nothing is left of what failed
    CHECK_FALSE(file.path().filename().string().starts_with("new"));
}

TEST_CASE("library list finds by words and tags, and shows pictures") {
  const Stones w;
  REQUIRE(w.run({"library", "add", "bricks", "bricks", "--tag", "wall", "--set", "weighted.weights.height=2"}).code ==
          0);
  CHECK(contains(w.run({"library", "list"}).out, "bricks"));
  CHECK_FALSE(contains(w.run({"library", "list", "--tag", "small"}).out, "bricks"));
  CHECK(contains(w.run({"library", "list", "--tag", "small"}).out, "stone/gravel  96x96"));
  CHECK_FALSE(contains(w.run({"library", "list", "GREY"}).out, "bricks"));
  const ProgramRun none = w.run({"library", "list", "marble"});
  CHECK(none.code == 0);
  CHECK(contains(none.err, "holds nothing like that"));
  CHECK_FALSE(contains(none.err, "tag"));
  CHECK(contains(w.run({"library", "list", "--tag", "wal"}).err,
                 "no entry has the tag \"wal\" (did you mean \"wall\"?)"));
  CHECK_FALSE(contains(w.run({"library", "list", "marble", "--tag", "Wall"}).err, "has the tag"));
  const json all = json::parse(w.run({"library", "list", "--json", "--sheet", "sheet.html"}).out);
  REQUIRE(all.size() == 2);
  CHECK(all[0]["settings"][0] == "weighted.weights.height=2");
  CHECK(read_image_info(all[1]["picture"].get<std::string>()).size.width == 256);
  CHECK(contains(read_text(w.path / "sheet.html"), "stone/gravel"));
  CHECK(w.run({"library", "list", "--sheet", "sheet.png"}).code == 0);
  CHECK(read_image_info(w.path / "sheet.png").size.width > 512);
}

TEST_CASE("library check tells of damage and of changed maps; remove removes") {
  const Stones w;
  CHECK(w.run({"library", "check"}).code == 0);
  write_text(w.path / "gravel/height.png", "");
  ProgramRun run = w.run({"library", "check"});
  CHECK(run.code == 1);
  CHECK(contains(run.out, "height.png has changed since it was analysed"));
  const fs::path entry = w.path / "library/stone/gravel.json";
  std::string text = read_text(entry);
  REQUIRE(contains(text, "\"pca\": "));
  write_text(entry, text.replace(text.find("\"pca\": ") + 7, 1, "999"));
  CHECK(contains(w.run({"library", "check", "stone/gravel"}).out, "version 999 of pca made it"));
  CHECK(w.run({"library", "check", "marble"}).code == 2);
  CHECK(w.run({"library", "remove", "stone/gravel"}).code == 0);
  CHECK(listing(w.path / "library") == std::vector<std::string>{".lock"});
}

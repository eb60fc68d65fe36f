#include <cstdlib>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/image_io/image_file.h"
#include "test_paths.h"
#include "tests/runner/fakes.h"
#include "tests/runner/workplace.h"

/// What people get to read: warnings, silence, help.
using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

/// A folder with a height map of -2 to 50.
void write_tall_material(const fs::path& folder) {
  write_picture(folder / "stone_basecolor.png", 5);
  const ImagePtr height = make_image(
      {32, 24}, 1, [](int x, int y, int) { return x == 0 && y == 0 ? -2.0f
                                                  : x < 16         ? 0.5f
                                                                   : 50.0f; },
      Semantic::height);
  write_image(*height, folder / "stone_height.exr", {.format = FileFormat::exr, .depth = Depth::f32}, [](double) {});
}

}  // namespace

TEST_CASE(
    "clipped maps are a warning at the end, in every mode of progress, again when nothing runs, and in the report") {
  const Workplace w;
  write_tall_material(w.path / "tall");
  const std::string warning = "warning: node \"files\": height: ";
  for (const std::string mode : {"plain", "none", "bar", "plain"}) {
    const ProgramRun r = w.run(
        {"synth", "tall", "-o", "out", "--size", "48x48", "--progress", mode, "--no-cache", "--report", "page.html"});
    CHECK_MESSAGE(r.code == 0, r.err);
    const size_t at = r.err.find(warning);
    REQUIRE_MESSAGE(at != std::string::npos, r.err);
    CHECK(r.err.find(warning, at + 1) == std::string::npos);
    CHECK(contains(r.err, "and were clipped by uint16; write it as .exr"));
    if (mode == "none") CHECK(r.err.find('\n') + 1 == r.err.size());
    CHECK(contains(read_text(w.path / "page.html"), "<span class=\"failed\">files: warning: height: "));
  }
  const ProgramRun again = w.run({"synth", "tall", "-o", "out", "--size", "48x48"});
  CHECK(contains(again.err, warning));
  CHECK(contains(w.run({"synth", "tall", "-o", "out", "--size", "48x48"}).err, warning));

  const ProgramRun json = w.run({"synth", "tall", "-o", "out", "--size", "48x48", "--progress", "json"});
  CHECK(contains(json.err, "{\"event\":\"warning\",\"node\":\"files\",\"message\":\"height: "));
}

TEST_CASE("synth writes the format that is asked for, and float maps keep their values") {
  const Workplace w;
  write_tall_material(w.path / "tall");
  const ProgramRun r = w.run({"synth", "tall", "-o", "out", "--size", "48x48", "--format", "exr"});
  CHECK_MESSAGE(r.code == 0, r.err);
  CHECK_FALSE(contains(r.err, "warning"));
  CHECK(listing(w.path / "out") == std::vector<std::string>{"base_color.exr", "height.exr"});
}

TEST_CASE("maps that another run has left in the folder are named, and stay") {
  const Workplace w;
  write_picture(w.path / "two/wall_basecolor.png", 5);
  write_picture(w.path / "two/wall_height.png", 6, Semantic::height);
  write_picture(w.path / "one/floor_basecolor.png", 7);
  const auto synth = [&](const std::string& folder, const std::string& format, const std::string& mode = "plain") {
    const ProgramRun r =
        w.run({"synth", folder, "-o", "out", "--size", "32x32", "--format", format, "--progress", mode});
    REQUIRE_MESSAGE(r.code == 0, r.err);
    return r.err;
  };
  const auto note_on = [&](const std::string& files) {
    return "note: node \"files\": " + (w.path / "out").string() + " also holds " + files +
           ", which this graph does not write: remove them if they belong to another material, or write to another "
           "folder\n";
  };
  CHECK_FALSE(contains(synth("two", "png"), "also holds"));
  CHECK_FALSE(contains(synth("two", "png"), "also holds"));
  write_text(w.path / "out/old_height.png", "of another material, under its own name");
  write_text(w.path / "out/height_2.png", "of another variation");
  write_text(w.path / "out/notes.txt", "");
  write_picture(w.path / "out/preview.png", 5);
  CHECK(contains(synth("one", "png"), note_on("height.png")));
  CHECK_FALSE(contains(synth("one", "png"), "also holds"));
  CHECK(contains(synth("two", "exr"), note_on("base_color.png, height.png")));
  CHECK(contains(synth("one", "jpg", "json"), "{\"event\":\"note\",\"node\":\"files\",\"message\":\""));
  CHECK(listing(w.path / "out").size() == 9);
}

TEST_CASE("what other nodes of the graph write beside a material's maps is not left over") {
  const Workplace w;
  write_picture(w.path / "maps/wall_basecolor.png", 5);
  write_picture(w.path / "maps/wall_height.png", 6, Semantic::height);
  write_text(w.path / "apart.json", R"({
  "terrazzo": 1,
  "parameters": {"scale": {"type": "number", "default": 1}},
  "nodes": {
    "maps":   {"type": "load_material", "path": "maps"},
    "small":  {"type": "resize", "material": "@maps", "scale": "$scale"},
    "color":  {"type": "export", "material": "@small", "maps": ["base_color"], "path": "out/{map}.png"},
    "height": {"type": "export", "material": "@maps", "maps": ["height"], "path": "out/{map}.png", "depth": "uint16"}
  }
})");
  for (const std::vector<std::string>& args : {std::vector<std::string>{"run", "apart.json"},
                                               {"run", "apart.json", "--set", "scale=0.5"},
                                               {"run", "apart.json", "--set", "scale=0.25", "--only", "color"}}) {
    const ProgramRun r = w.run(args);
    CHECK_MESSAGE(r.code == 0, r.err);
    CHECK(contains(r.err, "wrote"));
    CHECK_FALSE(contains(r.err, "also holds"));
  }
}

TEST_CASE("progress none writes nothing but warnings and errors") {
  const Workplace w;
  const ProgramRun quiet = w.run({"run", "soft.json", "--progress", "none"});
  CHECK(quiet.code == 0);
  CHECK(quiet.out == "");
  CHECK(quiet.err == "");
  CHECK(fs::exists(w.path / "out/base_color.png"));
  std::string damaged = read_text(w.path / "photo.png");
  damaged.replace(damaged.size() / 2, 8, "no pixel");
  write_text(w.path / "photo.png", damaged);
  const ProgramRun failed = w.run({"run", "soft.json", "--progress", "none"});
  CHECK(failed.code == 1);
  CHECK_MESSAGE(failed.err.find("error: ") == 0, failed.err);
  CHECK(failed.err.find('\n') + 1 == failed.err.size());
}

TEST_CASE("synth says of its folder that the maps differ in shape, once, before anything runs") {
  const Workplace w;
  write_picture(w.path / "odd/a_basecolor.png", 5);
  write_picture(w.path / "odd/a_height.png", 5, Semantic::height, {64, 24});
  const ProgramRun r = w.run({"synth", "odd", "-o", "out"});
  CHECK(r.code == 2);
  CHECK_MESSAGE(
      r.err ==
          "error: FOLDER: all maps must show the same area, but their aspect ratios differ: 32x24 (base_color), "
          "64x24 (height). Crop or scale the files to one aspect ratio, or leave some out; in a graph, use \"crop\" "
          "and \"resize\"\n",
      r.err);
}

TEST_CASE("the help of every command shows its own examples") {
  const Workplace w;
  for (const std::string command :
       {"run", "synth", "new", "check", "upgrade", "draw", "nodes", "schema", "cache", "compare", "help"}) {
    const ProgramRun r = w.run({command, "--help"});
    CHECK(r.code == 0);
    const size_t at = r.out.find("Example");
    REQUIRE_MESSAGE(at != std::string::npos, r.out);
    std::istringstream lines(r.out.substr(at));
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line))
      if (line.starts_with("  terrazzo")) CHECK_MESSAGE(line.starts_with("  terrazzo " + command), line);
  }
}

TEST_CASE("help, with or without a command, says what --help says, and knows no others") {
  const Workplace w;
  CHECK(w.run({"help"}).out == w.run({"--help"}).out);
  CHECK(w.run({"help", "run"}).out == w.run({"run", "--help"}).out);
  CHECK(w.run({"help", "cache", "gc"}).out == w.run({"cache", "gc", "--help"}).out);
  CHECK(w.run({"help", "run"}).code == 0);
  const ProgramRun wrong = w.run({"help", "rum"});
  CHECK(wrong.code == 2);
  CHECK_MESSAGE(wrong.err == "error: unknown command rum (did you mean \"run\"?)\n", wrong.err);
}

TEST_CASE("what cannot be written to standard output ends every command with code 1 and a message") {
  const Workplace w;
  REQUIRE(w.run({"run", "soft.json"}).code == 0);
  for (const std::string command :
       {"nodes", "nodes blur", "nodes --json", "schema", "check soft.json", "run soft.json --dry-run", "cache status",
        "cache verify", "cache gc", "compare photo.png photo.png", "--help", "nodes --help", "--version"}) {
    CAPTURE(command);
    const auto code_of = [&](const std::string& target) {
      const std::string line =
          fmt::format("cd '{}' && {{ TERRAZZO_CACHE=cache '{}' {} >{} 2>messages; echo $? > code; }}", w.path.string(),
                      TERRAZZO_PROGRAM, command, target);
      REQUIRE(std::system(line.c_str()) == 0);
      return read_text(w.path / "code");
    };
    CHECK(code_of("/dev/full") == "1\n");
    CHECK(read_text(w.path / "messages") == "error: cannot write to standard output: No space left on device\n");
    CHECK(code_of("&-") == "1\n");
    CHECK(read_text(w.path / "messages") == "error: cannot write to standard output: Bad file descriptor\n");
  }
  REQUIRE(w.run({"run", "soft.json"}).code == 0);
}

TEST_CASE("of what a sweep or a table gives, problems say where it is") {
  const Workplace w;
  const auto said = [&](const std::vector<std::string>& variations) {
    std::vector<std::string> words = {"run", "soft.json"};
    words.insert(words.end(), variations.begin(), variations.end());
    const ProgramRun r = w.run(words);
    CHECK(r.code == 2);
    return r.err;
  };
  CHECK(said({"--sweep", "soft.radius=1-8"}).find("soft.json: --sweep \"soft.radius=1-8\": expected a number") == 7);
  CHECK(said({"--sweep", "soft.radius=1-8"}).find("; a range is written soft.radius=1..8\n") != std::string::npos);
  CHECK(said({"--sweep", "soft.radius=1...3"}).find("a range has two dots, as in 1..3") != std::string::npos);
  write_text(w.path / "t.csv", "photo.path,soft.radius\nphoto.png,1\nphoto.png,wide\n");
  CHECK(said({"--table", "t.csv"}).find("error: t.csv:3:11: column \"soft.radius\": expected a number") !=
        std::string::npos);
  write_text(w.path / "t.csv", "\"photo.path\",soft.radios\nphoto.png,1\n");
  const std::string wrong_name = said({"--table", "t.csv"});
  CHECK_MESSAGE(wrong_name.find("t.csv:2:11: column \"soft.radios\": ") == 7, wrong_name);
  CHECK(wrong_name.find("(did you mean \"radius\"?)") != std::string::npos);
  write_text(w.path / "t.json", "[{\"soft.radius\": 1},\n {\"soft.radios\": 2}]");
  CHECK(said({"--table", "t.json"}).find("error: t.json:2:3: member \"soft.radios\": ") != std::string::npos);
}

TEST_CASE("a file that is no image is called what it is") {
  const Workplace w;
  const auto said = [&](const std::string& bytes) {
    write_text(w.path / "photo.png", bytes);
    const ProgramRun r = w.run({"run", "soft.json"});
    CHECK(r.code == 2);
    return r.err;
  };
  CHECK(said("%PDF-1.7 and so on")
            .find("photo.png: it is a PDF document, whatever its name says; save the image as PNG") !=
        std::string::npos);
  CHECK(said("  <!DOCTYPE html><html>").find("it is an HTML page, as a download that failed is") != std::string::npos);
  CHECK(said("version https://git-lfs.github.com/spec/v1\noid").find("\"git lfs pull\"") != std::string::npos);
  CHECK(said("nothing but words").find("it is text, whatever") != std::string::npos);
}

TEST_CASE("a folder with the name of a map is told of") {
  const Workplace w;
  write_picture(w.path / "maps/stone_basecolor.png", 5);
  std::filesystem::create_directories(w.path / "maps/stone_height.png");
  write_text(w.path / "maps.json", R"({"terrazzo": 1, "nodes": {"all": {"type": "load_material", "path": "maps"}}})");
  const ProgramRun r = w.run({"run", "maps.json"});
  CHECK_MESSAGE(r.code == 0, r.err);
  CHECK_MESSAGE(r.err.find("warning: node \"all\": stone_height.png is a folder, not a map") != std::string::npos,
                r.err);
}

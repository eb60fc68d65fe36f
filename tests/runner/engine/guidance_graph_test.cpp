#include <doctest/doctest.h>

#include "core/image_io/image_file.h"
#include "tests/exemplars.h"
#include "tests/runner/fakes.h"
#include "tests/runner/program.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

const char* const guided_graph = R"({
  "terrazzo": 1,
  "summary": "Two exemplars and turned copies, guided by everything that can guide",
  "nodes": {
    "wall":     {"type": "load_map", "path": "wall.png"},
    "other":    {"type": "load_map", "path": "other.png"},
    "both":     {"type": "combine", "materials": ["@wall", "@other"], "gap": 4},
    "exemplar": {"type": "variants", "material": "@both.material", "mask": "@both.mask", "rotations": [180, 20]},
    "colors":   {"type": "get_map", "material": "@exemplar.material", "map": "base_color"},
    "weighted": {"type": "weight", "material": "@exemplar.material", "tiles": "no"},
    "grey":     {"type": "grayscale", "image": "@colors"},
    "joints":   {"type": "threshold", "image": "@grey", "auto": true},
    "rims":     {"type": "distance", "mask": "@joints", "signed": true, "limit": 8},
    "bank":     {"type": "filter_bank", "material": "@colors", "scale": 0.5, "tiles": "no"},
    "worn":     {"type": "progression", "material": "@colors", "tiles": "no"},
    "wear":     {"type": "match_histogram", "image": "@worn", "reference": "@grey"},
    "parts":    {"type": "cluster", "features": "@weighted", "images": ["@bank.bars"], "k": 3},
    "space":    {"type": "pca", "features": "@weighted",
                 "guidance": ["@rims", "@bank.edges", "@bank.bars", "@bank.blobs", "@parts.labels", "@parts.distance",
                              "@wear", "@joints", "@exemplar.labels"]},
    "index":    {"type": "index", "appearance": "@space"},
    "layout":   {"type": "synthesize", "index": "@index", "size": [64, 64]},
    "result":   {"type": "resolve_uv", "uv": "@layout", "material": "@exemplar.material"},
    "files":    {"type": "export", "material": "@result", "path": "out/{map}.png"}
  }
})";

}  // namespace

TEST_CASE("every kind of guidance goes through a whole graph, and over several exemplars at once") {
  const TemporaryFolder folder;
  const auto write = [&](const char* name, Size size) {
    write_image(*wall(size), folder.path() / name, {.format = FileFormat::png, .depth = Depth::u8}, [](double) {});
  };
  write("wall.png", {48, 40});
  write("other.png", {32, 56});
  write_text(folder.path() / "guided.json", guided_graph);
  const ProgramRun run = run_program(folder.path(), {"run", "guided.json"});
  CHECK_MESSAGE(run.code == 0, run.err);
  CHECK(read_image_info(folder.path() / "out" / "base_color.png").size == Size{64, 64});
}

#include <filesystem>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "core/image_io/image_file.h"
#include "graphs/document/load.h"
#include "test_paths.h"
#include "tests/runner/fakes.h"
#include "tests/runner/program.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

namespace fs = std::filesystem;

const std::string root = TERRAZZO_SOURCE_DIR "/";

}  // namespace

TEST_CASE("a sweep makes a contact sheet of its variants out of one folder of maps") {
  const TemporaryFolder folder;
  const ProgramRun exemplar = run_program(folder.path(), {"run", root + "graphs/generate-exemplar.json", "--set",
                                                          "type=bricks", "--set", "size=32x32", "--set", "out=bricks"});
  REQUIRE_MESSAGE(exemplar.code == 0, exemplar.err);
  const ProgramRun run =
      run_program(folder.path(), {"run", root + "examples/sweeps/jitter.json", "--set", "material=bricks", "--set",
                                  "exemplar_size=32x32", "--set", "size=40x36", "--set", "out=sheets"});
  REQUIRE_MESSAGE(run.code == 0, run.err);
  const Size size = read_image_info(folder.path() / "sheets/jitter.png").size;
  CHECK(size.width == 8 + 5 * (40 + 8));
  CHECK(size.height > 8 + 2 * (36 + 8));
}

TEST_CASE("every picture of a sweep has a caption") {
  int sheets = 0;
  for (const auto& file : fs::directory_iterator(root + "examples/sweeps")) {
    const LoadedGraph loaded = load_graph(file.path(), {override_of("material", root + "examples")});
    for (const GraphNode& node : loaded.graph.nodes) {
      if (node.type->name != "contact_sheet") continue;
      CHECK_MESSAGE(node.inputs.at("images").size() == std::get<Texts>(node.params.at("captions")).size(),
                    file.path().string());
      sheets++;
    }
  }
  CHECK(sheets == 5);
}

TEST_CASE("the captions of the guidance sweep name the weights that its graph sets") {
  const nlohmann::json nodes = nlohmann::json::parse(read_text(root + "examples/sweeps/guidance.json"))["nodes"];
  int weights = 0;
  for (size_t i = 0; i < nodes["sheet"]["images"].size(); i++) {
    const std::string picture = nodes["sheet"]["images"][i], caption = nodes["sheet"]["captions"][i];
    const size_t comma = caption.rfind(", ");
    if (comma == caption.npos) continue;
    CHECK_MESSAGE(
        nodes[picture.substr(1) + "_space"].value("guidance_weight", -1.0) == std::stod(caption.substr(comma + 2)),
        caption);
    weights++;
  }
  CHECK(weights == 5);
}

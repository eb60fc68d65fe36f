#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <doctest/doctest.h>

#include "../run_node.h"
#include "core/image_file.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

TEST_CASE("the exemplars are recognised, each normal map with the convention that fits its height") {
  const char* given = std::getenv("TERRAZZO_EXEMPLARS");
  const fs::path folder = given ? given : fs::path(TERRAZZO_SOURCE_DIR) / "../shared/exemplars";
  if (!fs::is_directory(folder)) {
    MESSAGE("skipped: no exemplars in ", folder.string(), " (set TERRAZZO_EXEMPLARS)");
    return;
  }
  for (const fs::directory_entry& e : fs::directory_iterator(folder)) {
    const NodeRun run = run_node("load_material", {{"path", e.path().string()}});
    for (const std::string& n : run.notes) MESSAGE(e.path().filename().string(), ": ", n);
    CHECK(run.get<Material>("material")->find(Semantic::base_color));
  }
}

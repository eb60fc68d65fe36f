#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "tests/run_node.h"
#include "tests/runner/program.h"

namespace terrazzo::test {

/// Writes a PNG; `step` tells pictures apart. Makes its folder.
void write_picture(const std::filesystem::path& path, int step, Semantic semantic = Semantic::base_color,
                   Size size = {32, 24});

/// A folder with a small graph, soft.json, that blurs one picture.
struct Workplace {
  TemporaryFolder folder;
  const std::filesystem::path& path = folder.path();

  Workplace();
  ProgramRun run(const std::vector<std::string>& args) const { return run_program(path, args); }
};

}  // namespace terrazzo::test

#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/run_node.h"
#include "tests/runner/cache/environment.h"
#include "tests/texts.h"

namespace terrazzo::test {

/// Programs of a test's own, found before the machine's; no cluster of the machine's is seen.
class Tools {
 public:
  void add(const std::string& name, const std::string& script) const {
    const std::filesystem::path file = folder_.path() / name;
    write_text(file, "#!/bin/sh\ncd '" + folder_.path().string() + "'\n" + script);
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  }
  std::string text(const std::string& name) const { return read_text(folder_.path() / name); }

 private:
  TemporaryFolder folder_;
  Environment path_{"PATH", (folder_.path().string() + ":" + std::getenv("PATH")).c_str()};
  Environment configuration_{"SLURM_CONF", nullptr};
};

}  // namespace terrazzo::test

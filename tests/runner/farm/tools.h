#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/run_node.h"
#include "tests/texts.h"

namespace terrazzo::test {

/// Programs of a test's own, found before the machine's.
class Tools {
 public:
  Tools() : path_(std::getenv("PATH")) { ::setenv("PATH", (folder_.path().string() + ":" + path_).c_str(), 1); }
  ~Tools() { ::setenv("PATH", path_.c_str(), 1); }
  Tools(const Tools&) = delete;
  Tools& operator=(const Tools&) = delete;

  void add(const std::string& name, const std::string& script) const {
    const std::filesystem::path file = folder_.path() / name;
    write_text(file, "#!/bin/sh\ncd '" + folder_.path().string() + "'\n" + script);
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  }
  std::string text(const std::string& name) const { return read_text(folder_.path() / name); }

 private:
  TemporaryFolder folder_;
  std::string path_;
};

}  // namespace terrazzo::test

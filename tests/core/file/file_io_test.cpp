#include "core/file/file_io.h"

#include <doctest/doctest.h>
#include <sys/stat.h>

#include "core/file/tar.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("only regular files are opened, and nothing waits for a pipe") {
  const TemporaryFolder folder;
  const std::filesystem::path pipe = folder.path() / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  const auto trouble = [](const std::filesystem::path& path) {
    try {
      read_file(path);
    } catch (const FileError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  CHECK(contains(trouble(pipe), "pipe: it is a pipe; expected a regular file"));
  CHECK(contains(trouble("/dev/zero"), "it is a device"));
  CHECK(contains(trouble(folder.path()), "it is a folder"));
  CHECK(contains(trouble(folder.path() / "none"), "No such file"));
  CHECK(trouble("/proc/self/status") == "");
  CHECK_FALSE(content_digest(pipe));
  CHECK_FALSE(content_digest(std::filesystem::path("/dev/zero")));
  CHECK_THROWS_AS(tar_entries(pipe), FileError);
  write_file(folder.path() / "file", std::string(100000, 'x'));
  CHECK(read_file(folder.path() / "file") == std::string(100000, 'x'));
  CHECK_THROWS_AS(read_file(folder.path() / "file", 99999), FileError);
}

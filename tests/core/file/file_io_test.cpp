#include "core/file/file_io.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "core/file/archive.h"
#include "core/integrity/file_integrity.h"
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
  CHECK_THROWS_AS(read_archive(pipe), FileError);
  write_file(folder.path() / "file", std::string(100000, 'x'));
  CHECK(read_file(folder.path() / "file") == std::string(100000, 'x'));
  CHECK_THROWS_AS(read_file(folder.path() / "file", 99999), FileError);
}

TEST_CASE("a file that the limit on open files keeps closed is not called cut off") {
  const TemporaryFolder folder;
  write_text(folder.path() / "a.png", "\x89PNG\r\n\x1a\n");
  const int next = File::open(folder.path() / "a.png", O_RDONLY).descriptor();
  rlimit before{};
  REQUIRE(::getrlimit(RLIMIT_NOFILE, &before) == 0);
  const rlimit small{rlim_t(next), before.rlim_max};
  REQUIRE(::setrlimit(RLIMIT_NOFILE, &small) == 0);
  std::string said;
  try {
    seems_complete(folder.path() / "a.png");
  } catch (const FileError& e) {
    said = e.what();
  }
  ::setrlimit(RLIMIT_NOFILE, &before);
  CHECK(contains(said, "a.png: the program has as many files open as its limit on open files allows (ulimit -n)"));
}

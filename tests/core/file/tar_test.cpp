#include "core/file/tar.h"

#include <cstdlib>
#include <filesystem>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

const std::string long_name = std::string(150, 'n') + "/" + std::string(90, 'm') + ".png";

fs::path archive_in(const fs::path& folder) {
  const fs::path path = folder / "a.tar";
  write_text(folder / "data", std::string(1300, 'd'));
  TarWriter writer(path);
  writer.add("first.txt", "one");
  writer.add_file("data", folder / "data");
  writer.add(long_name, "deep");
  writer.add("empty", "");
  writer.finish();
  return path;
}

std::string content(const fs::path& archive, const TarEntry& entry, const fs::path& folder) {
  extract(archive, entry, folder / "out");
  return read_text(folder / "out");
}

}  // namespace

TEST_CASE("what goes into an archive comes out of it, names of any length included") {
  const TemporaryFolder folder;
  const fs::path path = archive_in(folder.path());
  CHECK(is_tar(path));
  const std::vector<TarEntry> entries = tar_entries(path);
  REQUIRE(entries.size() == 4);
  CHECK(content(path, entries[0], folder.path()) == "one");
  CHECK(content(path, entries[1], folder.path()) == std::string(1300, 'd'));
  CHECK(entries[2].name == long_name);
  CHECK(content(path, entries[2], folder.path()) == "deep");
  CHECK(content(path, entries[3], folder.path()).empty());
  CHECK(listing(folder.path()) == std::vector<std::string>{"a.tar", "data", "out"});
}

TEST_CASE("the usual tool reads an archive") {
  const TemporaryFolder folder;
  const fs::path path = archive_in(folder.path());
  const std::string command =
      "tar xf '" + path.string() + "' -C '" + folder.path().string() + "' first.txt '" + long_name + "'";
  REQUIRE(std::system(command.c_str()) == 0);
  CHECK(read_text(folder.path() / "first.txt") == "one");
  CHECK(read_text(folder.path() / long_name) == "deep");
}

TEST_CASE("the same content gives the same bytes, and an archive that is not finished leaves nothing") {
  const TemporaryFolder one, other;
  CHECK(read_text(archive_in(one.path())) == read_text(archive_in(other.path())));
  {
    TarWriter writer(one.path() / "b.tar");
    writer.add("x", "y");
  }
  CHECK(listing(one.path()) == std::vector<std::string>{"a.tar", "data"});
  CHECK_THROWS_AS(TarWriter(one.path() / "data" / "c.tar"), Error);
}

TEST_CASE("damaged and cut archives are refused") {
  const TemporaryFolder folder;
  const fs::path path = archive_in(folder.path());
  const std::string whole = read_text(path);
  int refused = 0;
  for (size_t length = 0; length < whole.size() - 1024; length += 173) {
    replace_text(path, whole.substr(0, length));
    CHECK_THROWS_AS(tar_entries(path), Error);
    refused++;
  }
  CHECK(refused > 10);
  for (const size_t at : {0, 100, 124, 156, 512 * 2 + 130}) {
    std::string damaged = whole;
    damaged[at] ^= 4;
    replace_text(path, damaged);
    CHECK_THROWS_AS(tar_entries(path), Error);
  }
  replace_text(path, "{\"terrazzo\": 1}");
  CHECK_FALSE(is_tar(path));
  CHECK_FALSE(is_tar(folder.path()));
}

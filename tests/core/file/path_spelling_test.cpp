#include "core/file/path_spelling.h"

#include <doctest/doctest.h>

#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("paths that are written as on Windows, or that JSON has read as escapes, are told") {
  const TemporaryFolder folder;
  const auto advice = [&](const char* text) { return path_advice(folder.path(), text); };
  CHECK(advice("scans/brick") == "");
  CHECK(advice("") == "");
  CHECK(advice("scans\\brick") == "folders are separated by /: write \"scans/brick\"");
  CHECK(advice("..\\scans\\\\brick\\{map}.png") == "folders are separated by /: write \"../scans/brick/{map}.png\"");
  CHECK(advice("scans\brick") == "folders are separated by /: write \"scans/brick\"");
  CHECK(advice("out\textures\new") == "folders are separated by /: write \"out/textures/new\"");
  CHECK(advice("C:\\scans\\brick") ==
        "C: is a drive of Windows; name the place as this system knows it, such as /mnt/c/scans/brick");
  CHECK(advice("d:/scans") == "d: is a drive of Windows; name the place as this system knows it, such as /mnt/d/scans");
}

TEST_CASE("a file that has a backslash in its name can be read, and files beside it written") {
  const TemporaryFolder folder;
  write_text(folder.path() / "scans\\brick.png", "");
  CHECK(path_advice(folder.path(), "scans\\brick.png") == "");
  CHECK_FALSE(path_advice(folder.path(), "scans\\brock.png").empty());
  std::filesystem::create_directories(folder.path() / "a\\b");
  CHECK(path_advice("", (folder.path() / "a\\b/new.png").string()) == "");
}

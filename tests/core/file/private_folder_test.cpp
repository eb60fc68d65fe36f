#include "core/file/private_folder.h"

#include <filesystem>

#include <doctest/doctest.h>

#include "core/file/file_io.h"
#include "tests/texts.h"

using namespace terrazzo;
namespace fs = std::filesystem;

TEST_CASE("a temporary folder is the user's alone, and goes with all that is in it") {
  const fs::path parent = fs::temp_directory_path() / "terrazzo temporary folder test/new";
  fs::path one;
  {
    const PrivateFolder a(parent, "a"), b(parent, "a");
    one = a.path();
    CHECK(a.path() != b.path());
    CHECK((fs::status(one).permissions() & fs::perms::all) == fs::perms::owner_all);
    test::write_text(one / "file", "text");
    CHECK_THROWS_AS(PrivateFolder(one / "file", "a"), Error);
  }
  CHECK(!fs::exists(one));
  CHECK(fs::is_empty(parent));
  fs::remove_all(parent.parent_path());
}

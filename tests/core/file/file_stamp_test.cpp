#include "core/file/file_stamp.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include "core/file/file_io.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("what was found in a file is known until the file changes") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "a.txt";
  write_text(file, "one");
  FileFacts<std::string> facts;
  int looks = 0;
  const auto look = [&](const std::string& name) {
    return facts.of(file, name, [&] {
      looks++;
      return name + read_text(file);
    });
  };
  // What has just been written may change again within the same tick of the clock.
  CHECK(look("") == "one");
  CHECK(look("") == "one");
  CHECK(looks == 2);
  CHECK_FALSE(stamp_of(file)->is_settled(now_ns()));
  CHECK(stamp_of(file)->is_settled(now_ns() + 3'000'000'000));

  while (!stamp_of(file)->is_settled(now_ns())) usleep(50000);
  CHECK(look("") == "one");
  CHECK(look("") == "one");
  CHECK(looks == 3);
  CHECK(look("layer ") == "layer one");
  CHECK(looks == 4);

  const auto before = std::filesystem::last_write_time(file);
  write_text(file, "two");
  std::filesystem::last_write_time(file, before);  // as some tools do
  CHECK(look("") == "two");
  std::filesystem::remove(file);
  CHECK(look("") == "");
  CHECK_FALSE(stamp_of(file));
  CHECK_FALSE(stamp_of(folder.path()));
}

TEST_CASE("what cannot be found is looked for again") {
  FileFacts<int> facts;
  int looks = 0;
  for (int i = 0; i < 2; i++)
    CHECK_THROWS_AS(facts.of("/usr/bin/env", "",
                             [&]() -> int {
                               looks++;
                               throw Error("no");
                             }),
                    Error);
  CHECK(looks == 2);
}

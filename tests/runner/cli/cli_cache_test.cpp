#include <doctest/doctest.h>

#include "tests/runner/fakes.h"
#include "tests/runner/workplace.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

TEST_CASE("the cache commands make no folder: a name that was misspelt is an error with the one that is near") {
  const Workplace w;
  for (const char* command : {"status", "verify", "gc", "clear"}) {
    const ProgramRun none = w.run({"cache", command});
    CHECK(none.code == 0);
    CHECK(none.out == "there is no cache yet in " + (w.path / "cache").string() + "; the first run makes it\n");
    CHECK_FALSE(fs::exists(w.path / "cache"));
  }
  REQUIRE(w.run({"run", "soft.json"}).code == 0);
  fs::create_directory(w.path / "pictures");
  for (const char* command : {"status", "verify", "gc", "clear"}) {
    const ProgramRun wrong = w.run({"cache", command, "--cache", "cashe"});
    CHECK(wrong.code == 2);
    CHECK(wrong.err.find("error: --cache cashe: there is no such folder (did you mean \"cache\"?)") == 0);
    CHECK_FALSE(fs::exists(w.path / "cashe"));
    const ProgramRun other = w.run({"cache", command, "--cache", "pictures"});
    CHECK(other.code == 2);
    CHECK_MESSAGE(other.err.find("error: pictures is not a cache: ") == 0, other.err);
    CHECK(fs::is_empty(w.path / "pictures"));
  }
}

TEST_CASE("the cache command says how large the cache is, checks it and clears it") {
  const Workplace w;
  REQUIRE(w.run({"run", "soft.json"}).code == 0);
  const ProgramRun status = w.run({"cache", "status"});
  CHECK(status.code == 0);
  CHECK(status.out.find("folder  " + (w.path / "cache").string()) == 0);
  CHECK(status.out.find("stages  3") != std::string::npos);
  CHECK(w.run({"cache", "verify"}).out == "every entry is sound\n");
  CHECK(w.run({"cache", "gc", "--limit", "1K"}).code == 0);
  CHECK(w.run({"cache", "clear"}).out.find(" freed\n") != std::string::npos);
  CHECK(w.run({"cache", "status", "--cache", "cache"}).out.find("stages  0") != std::string::npos);
}

TEST_CASE("a run takes the size of the cache from --cache-size, and evicts at its end") {
  const Workplace w;
  REQUIRE(w.run({"run", "soft.json"}).code == 0);
  const auto status = [&] { return w.run({"cache", "status"}).out; };
  CHECK(status().find(" of 10.0 GiB\nlimit   from the default\n") != std::string::npos);
  write_text(w.path / "cache/settings.txt", "size = 5G\n");
  CHECK_MESSAGE(
      status().find(" of 5.0 GiB\nlimit   from " + (w.path / "cache/settings.txt").string()) != std::string::npos,
      status());
  CHECK(status().find("graphs  1\n") != std::string::npos);
  REQUIRE(w.run({"run", "soft.json", "--set", "radius=3", "--cache-size", "1K"}).code == 0);
  CHECK(status().find("values  0\n") != std::string::npos);
  const ProgramRun wrong = w.run({"run", "soft.json", "--cache-size", "lots"});
  CHECK(wrong.code == 2);
  CHECK(wrong.err.find("error: --cache-size takes a number with a unit") == 0);
  write_text(w.path / "cache/settings.txt", "size = lots\n");
  const ProgramRun settings = w.run({"run", "soft.json"});
  CHECK(settings.code == 2);
  CHECK_MESSAGE(settings.err.find("settings.txt:1: size takes a number with a unit") != std::string::npos,
                settings.err);
  CHECK(w.run({"run", "soft.json", "--cache-size", "1G"}).code == 0);
}

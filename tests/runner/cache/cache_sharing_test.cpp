#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "runner/cache/cache.h"
#include "runner/cache/cache_folder.h"
#include "tests/run_node.h"
#include "tests/sample_values.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr const char* folder_variable = "TERRAZZO_TEST_CACHE";
constexpr int image_count = 10;

ImagePtr shared_image(int number) {
  return sample_image({30 + number, 20}, number);
}

/// Asks, loads, stores and collects, as the runs of many users would. Returns how many values were wrong.
int hammer(const std::filesystem::path& folder, int who, int rounds) {
  int wrong = 0;
  for (int round = 0; round < rounds; round++) {
    Cache cache(folder, 12000);
    for (int step = 0; step < 6; step++) {
      const int number = int(random_bits(uint64_t(who), round, step) % image_count);
      const ImagePtr image = shared_image(number);
      const Digest key{uint64_t(number), 1};
      const auto record = cache.find_stage(key);
      if (record && record->outputs.at("image") != image->digest()) wrong++;
      const auto value = cache.load_value(image->digest());
      if (value && !same_content(*value, image)) wrong++;
      if (!value) cache.store_value(image, number + 1, Task());
      // What this object has asked for stays, whatever the others do.
      if (!cache.load_value(image->digest())) wrong++;
      if (!record) cache.store_stage(key, {{{"image", image->digest()}}, {}, {}, 1});
    }
    cache.collect();
    if (!cache.take_warnings().empty()) wrong++;
  }
  return wrong;
}

/// A process of this very program that runs one test case.
class Process {
 public:
  explicit Process(const std::string& test_case) {
    std::string program = std::filesystem::read_symlink("/proc/self/exe"), filter = "-tc=" + test_case;
    std::string all = "--no-skip", quiet = "-o=/dev/null";
    char* arguments[] = {program.data(), filter.data(), all.data(), quiet.data(), nullptr};
    REQUIRE(::posix_spawn(&id_, program.c_str(), nullptr, nullptr, arguments, environ) == 0);
  }
  /// The exit status, or minus the signal that ended it.
  int wait() {
    int status = 0;
    REQUIRE(::waitpid(id_, &status, 0) == id_);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  void kill() { ::kill(id_, SIGKILL); }

 private:
  pid_t id_ = 0;
};

std::filesystem::path given_folder() {
  const char* folder = std::getenv(folder_variable);
  REQUIRE_MESSAGE(folder, folder_variable << " is not set; other tests run this one");
  return folder;
}

}  // namespace

TEST_CASE("in another process: hammer a cache" * doctest::skip()) {
  CHECK(hammer(given_folder(), int(::getpid()), 8) == 0);
}

TEST_CASE("in another process: store without end" * doctest::skip()) {
  Cache cache(given_folder());
  for (int i = 0;; i++) cache.store_value(sample_image({400, 400}, i), 1, Task());
}

TEST_CASE("threads with a cache object each share a folder and never see a wrong value") {
  const TemporaryFolder folder;
  int wrong_here = 0, wrong_there = 0;
  std::thread other([&] { wrong_there = hammer(folder.path(), 1, 8); });
  wrong_here = hammer(folder.path(), 2, 8);
  other.join();
  CHECK(wrong_here == 0);
  CHECK(wrong_there == 0);
  CHECK(Cache(folder.path()).verify(Task()).damaged.empty());
}

TEST_CASE("threads share one cache object") {
  const TemporaryFolder folder;
  Cache cache(folder.path());
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; t++)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 12; i++) {
        const ImagePtr image = shared_image((i + t) % 4);
        cache.store_value(image, 1, Task());
        const auto value = cache.load_value(image->digest());
        if (!value || !same_content(*value, image)) wrong++;
      }
    });
  for (std::thread& t : threads) t.join();
  CHECK(wrong == 0);
  CHECK(cache.status().values == 4);
}

TEST_CASE("processes share a folder and never see a wrong value") {
  const TemporaryFolder folder;
  ::setenv(folder_variable, folder.path().c_str(), 1);
  Process one("in another process: hammer a cache"), two("in another process: hammer a cache");
  CHECK(hammer(folder.path(), 3, 8) == 0);
  CHECK(one.wait() == 0);
  CHECK(two.wait() == 0);
  Cache cache(folder.path());
  CHECK(cache.verify(Task()).damaged.empty());
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path() / "v1" / "pins"), {}) == 1);
}

TEST_CASE("a process killed while storing leaves a usable cache, and its pins and half-written files go") {
  const TemporaryFolder folder;
  ::setenv(folder_variable, folder.path().c_str(), 1);
  Process victim("in another process: store without end");
  while (Cache(folder.path()).status().values < 3) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  victim.kill();
  CHECK(victim.wait() == -SIGKILL);
  Cache cache(folder.path());
  CHECK(cache.verify(Task()).damaged.empty());
  const ImagePtr image = sample_image({400, 400}, 0);
  const auto value = cache.load_value(image->digest());
  REQUIRE(value);
  CHECK(same_content(*value, image));
  cache.collect();
  CHECK(CacheFolder(folder.path()).scan().temporaries.empty());
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path() / "v1" / "pins"), {}) <= 2);
  Cache(folder.path()).clear();
  CHECK(cache.status().values == 1);  // what this object asked for
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path() / "v1" / "pins"), {}) == 1);
}

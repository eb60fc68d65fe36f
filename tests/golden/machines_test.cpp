#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <optional>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <hwy/targets.h>
#include <sys/wait.h>
#include <unistd.h>

#include "test_paths.h"
#include "tests/golden/documents.h"

/// Golden results do not depend on what the processor can do.
using namespace terrazzo;
using namespace terrazzo::test;

namespace {

namespace fs = std::filesystem;

using Digests = std::map<std::string, std::string>;  // by case, node type and output

void add(const std::vector<GoldenLine>& lines, Digests& out) {
  for (const GoldenLine& l : lines) out[fmt::format("{} ({}), {}", l.name, l.type, l.port)] = l.content.digest.hex();
}

Digests digests_of(const std::vector<std::string>& groups) {
  Digests out;
  const GoldenSession session;
  for (const std::string& group : groups)
    for (const GoldenDocument& document : documents_of(group))
      for (const GoldenCase& c : session.run(document)) add(c.lines, out);
  return out;
}

/// What is in the golden files of a folder.
Digests recorded_in(const fs::path& folder) {
  Digests out;
  for (const char* file : {"source", "image", "analysis", "synthesis", "sink", "graphs"})
    add(read_golden(folder / (std::string(file) + ".txt")).lines, out);
  return out;
}

/// The differing ones of `now`, all of which have to be expected.
std::vector<std::string> differences(const Digests& now, const Digests& expected) {
  std::vector<std::string> out;
  for (const auto& [name, digest] : now) {
    const auto found = expected.find(name);
    if (found == expected.end() || found->second != digest) out.push_back(name);
  }
  return out;
}

/// Numbers from functions of which the C library has several forms for different processors: they tell which it took.
Digest library_function_digest() {
  Hasher h;
  for (int i = 1; i < 20000; i++) {
    const volatile double x = i * 0.00123456789;
    h.add(std::exp(x)).add(std::log(x)).add(std::pow(x, 0.41666)).add(std::sin(x)).add(std::atan(x));
  }
  return h.digest();
}

/// Everything beyond the oldest processors of the family.
constexpr const char* newer_instructions =
    "glibc.cpu.hwcaps=-AVX512F,-AVX512VL,-AVX512BW,-AVX2,-AVX,-FMA,-FMA4,-SSE4_1,-SSE4_2,-SSSE3,-ERMS,-BMI2,-MOVBE";

/// Runs this program again, with the C library kept from some instructions unless `tunables` is null; it records its
/// golden results in `folder`.
int record_apart(const fs::path& folder, const char* tunables) {
  fs::create_directories(folder);
  const pid_t pid = ::fork();
  if (pid == 0) {
    if (tunables) ::setenv("GLIBC_TUNABLES", tunables, 1);
    ::setenv("TERRAZZO_GOLDEN_RECORD", folder.c_str(), 1);
    const std::string log = (folder / "log").string();
    if (!std::freopen(log.c_str(), "w", stdout)) ::_exit(126);
    ::execl("/proc/self/exe", "terrazzo_tests", "-ts=golden", "-tc=golden results:*,what the C library gives", nullptr);
    ::_exit(127);
  }
  int status = -1;
  ::waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

std::string text_of(const fs::path& path) {
  std::string out;
  if (FILE* in = std::fopen(path.c_str(), "r")) {
    for (int c = std::fgetc(in); c != EOF; c = std::fgetc(in)) out += char(c);
    std::fclose(in);
  }
  return out;
}

/// What usually comes out on this machine: what is recorded or, if that was recorded with other libraries or before a
/// change so that `now` differs from it, what `make` makes.
Digests usual(const Digests& now, const std::function<Digests()>& make) {
  const fs::path folder = fs::path(TERRAZZO_SOURCE_DIR) / "tests" / "golden";
  const bool same_libraries = read_golden(folder / "image.txt").libraries == library_versions();
  Digests recorded = recorded_in(folder);
  return same_libraries && differences(now, recorded).empty() ? recorded : make();
}

}  // namespace

TEST_SUITE_BEGIN("golden");

TEST_CASE("golden results are the same on every instruction set") {
  const std::vector<std::string> groups = {"analysis", "synthesis"};  // whose nodes have code of their own for each
  const auto best = [&] {
    hwy::SetSupportedTargetsForTest(0);
    return digests_of(groups);
  };
  std::optional<Digests> expected;
  // The lowest bit is the best one, which the other tests run on.
  for (int64_t left = hwy::SupportedTargets() & (hwy::SupportedTargets() - 1); left != 0; left &= left - 1) {
    const int64_t target = left & -left;
    CAPTURE(std::string(hwy::TargetName(target)));
    hwy::SetSupportedTargetsForTest(target);
    const Digests now = digests_of(groups);
    CHECK(now.size() > 100);
    if (!expected) expected = usual(now, best);
    for (const std::string& name : differences(now, *expected)) FAIL_CHECK(name << " differs");
  }
  hwy::SetSupportedTargetsForTest(0);
}

// Helps the next one; says something by itself only where a golden record is made.
TEST_CASE("what the C library gives") {
  if (const char* folder = std::getenv("TERRAZZO_GOLDEN_RECORD"))
    if (FILE* out = std::fopen((fs::path(folder) / "functions").c_str(), "w")) {
      std::fputs(library_function_digest().hex().c_str(), out);
      std::fclose(out);
    }
  CHECK(library_function_digest() == library_function_digest());
}

TEST_CASE("golden results do not depend on the C library's choice of instructions") {
  const TemporaryFolder folder;
  const fs::path restricted = folder.path() / "restricted";
  CHECK_MESSAGE(record_apart(restricted, newer_instructions) == 0, text_of(restricted / "log"));
  const Digests now = recorded_in(restricted);
  const Digests expected = usual(now, [&] {
    CHECK(record_apart(folder.path() / "usual", nullptr) == 0);
    return recorded_in(folder.path() / "usual");
  });
  CHECK(now.size() == expected.size());
  for (const std::string& name : differences(now, expected)) FAIL_CHECK(name << " differs");
  // Else this has shown nothing.
  if (__builtin_cpu_supports("fma")) CHECK(text_of(restricted / "functions") != library_function_digest().hex());
}

TEST_SUITE_END();

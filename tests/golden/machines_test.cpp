#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <hwy/targets.h>
#include <sys/wait.h>
#include <unistd.h>

#include "test_paths.h"
#include "tests/golden/documents.h"

/// Golden results do not depend on what the processor can do. Instruction sets between the oldest and the best are left
/// to the tests of what is compiled for each.
using namespace terrazzo;
using namespace terrazzo::test;

namespace {

namespace fs = std::filesystem;

using Digests = std::map<std::string, std::string>;  // by case, node type and output

void add(const std::vector<GoldenLine>& lines, Digests& out) {
  for (const GoldenLine& l : lines) out[fmt::format("{} ({}), {}", l.name, l.type, l.port)] = l.content.digest.hex();
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

/// Runs this program again, on the oldest processors as far as their instructions can be taken away, if asked to; it
/// records its golden results in `folder`.
int record_apart(const fs::path& folder, bool oldest) {
  fs::create_directories(folder);
  const pid_t pid = ::fork();
  if (pid == 0) {
    if (oldest) {
      ::setenv("GLIBC_TUNABLES", newer_instructions, 1);
      ::setenv("TERRAZZO_GOLDEN_OLDEST", "1", 1);
    }
    ::setenv("TERRAZZO_GOLDEN_RECORD", folder.c_str(), 1);
    const std::string log = (folder / "log").string();
    if (!std::freopen(log.c_str(), "w", stdout)) ::_exit(126);
    ::execl("/proc/self/exe", "terrazzo_tests", "-ts=golden", "-tc=golden results:*,which instructions are in use",
            nullptr);
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
/// change so that `now` differs from it, what this program makes.
Digests usual(const Digests& now, const fs::path& scratch) {
  const fs::path folder = fs::path(TERRAZZO_SOURCE_DIR) / "tests" / "golden";
  const bool same_libraries = read_golden(folder / "image.txt").libraries == library_versions();
  Digests recorded = recorded_in(folder);
  if (same_libraries && differences(now, recorded).empty()) return recorded;
  CHECK(record_apart(scratch, false) == 0);
  return recorded_in(scratch);
}

std::string instructions_in_use() {
  const int64_t best = hwy::SupportedTargets() & -hwy::SupportedTargets();
  return fmt::format("{}\n{}\n", hwy::TargetName(best), library_function_digest().hex());
}

/// The path without its ending and, of kernels, without that.
std::string tested_stem(const fs::path& source) {
  const std::string stem = source.stem().string();
  return stem.ends_with("_kernel") ? stem.substr(0, stem.size() - 7) : stem;
}

}  // namespace

TEST_SUITE_BEGIN("golden");

// For the next one, which has it run elsewhere.
TEST_CASE("which instructions are in use" * doctest::skip(!std::getenv("TERRAZZO_GOLDEN_RECORD"))) {
  const GoldenSession session;
  std::ofstream out(fs::path(std::getenv("TERRAZZO_GOLDEN_RECORD")) / "instructions");
  out << instructions_in_use();
  CHECK(out.flush());
}

TEST_CASE("golden results are the same on the oldest processors, whose C library computes in other ways") {
  const TemporaryFolder folder;
  const fs::path oldest = folder.path() / "oldest";
  CHECK_MESSAGE(record_apart(oldest, true) == 0, text_of(oldest / "log"));
  const Digests now = recorded_in(oldest), expected = usual(now, folder.path() / "usual");
  CHECK(now.size() > 1000);
  CHECK(now.size() == expected.size());
  for (const std::string& name : differences(now, expected)) FAIL_CHECK(name << " differs");
  // Else this has shown nothing.
  std::istringstream in_use(text_of(oldest / "instructions")), here(instructions_in_use());
  std::string target, functions, best_target, best_functions;
  in_use >> target >> functions;
  here >> best_target >> best_functions;
  if (std::popcount(uint64_t(hwy::SupportedTargets())) > 1) CHECK(target != best_target);
  if (__builtin_cpu_supports("fma")) CHECK(functions != best_functions);
}

TEST_CASE("code that is compiled for several instruction sets has a test on each of them") {
  const fs::path root = TERRAZZO_SOURCE_DIR;
  int found = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / "core")) {
    if (entry.path().extension() != ".cpp" || text_of(entry.path()).find("HWY_EXPORT(") == std::string::npos) continue;
    found++;
    const fs::path room = entry.path().parent_path().lexically_relative(root);
    const fs::path test = root / "tests" / room / (tested_stem(entry.path()) + "_test.cpp");
    CHECK_MESSAGE(text_of(test).find("hwy::SetSupportedTargetsForTest(") != std::string::npos, test.string());
  }
  CHECK(found >= 3);
}

TEST_SUITE_END();

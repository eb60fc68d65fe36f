#include "core/base/thread_limits.h"

#include <fstream>
#include <functional>
#include <string>

#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error.h"

using namespace terrazzo;

namespace {

/// What a process of its own says that runs this; "" if it throws nothing.
std::string error_in_child(const std::function<void()>& code) {
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    std::string said;
    try {
      code();
    } catch (const Error& e) {
      said = e.what();
    }
    const bool written = ::write(ends[1], said.data(), said.size()) == ssize_t(said.size());
    ::_exit(written ? 0 : 1);
  }
  ::close(ends[1]);
  std::string said;
  char buffer[512];
  for (ssize_t n = 0; (n = ::read(ends[0], buffer, sizeof buffer)) > 0;) said.append(buffer, size_t(n));
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  CHECK(status == 0);
  return said;
}

void limit(decltype(RLIMIT_AS) resource, rlim_t value) {
  const rlimit both{value, value};
  ::setrlimit(resource, &both);
}

}  // namespace

TEST_CASE("threads that can be started are no error") {
  CHECK_NOTHROW(require_threads(0));
  CHECK_NOTHROW(require_threads(2));
}

// The sanitizers' own memory does not fit into such a limit.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_CASE("threads that cannot be started are an error that names the limit") {
  const std::string said = error_in_child([] {
    size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlim_t address_space = rlim_t(pages) * rlim_t(::sysconf(_SC_PAGESIZE));
    limit(RLIMIT_AS, address_space + (rlim_t{20} << 20));  // two stacks of 8 MiB, and some that are kept
    require_threads(64);
  });
  CHECK(said.starts_with("cannot start threads: 64 needed, the system started "));
  CHECK(said.find("the limit of memory (ulimit -v) is ") != std::string::npos);
  CHECK(said.find("--threads") != std::string::npos);
}
#endif

TEST_CASE("a stack that is too small is an error that names the limit; one that may grow grows") {
  CHECK_NOTHROW(require_stack());
  CHECK(error_in_child([] {
          limit(RLIMIT_STACK, 32 << 10);
          require_stack();
        }) == "the limit of the stack (ulimit -s) is 32 KiB, at least 512 are needed: raise it");
  CHECK(error_in_child([] {
          const rlimit low{64 << 10, rlim_t{16} << 20};
          ::setrlimit(RLIMIT_STACK, &low);
          require_stack();
          rlimit now{};
          ::getrlimit(RLIMIT_STACK, &now);
          if (now.rlim_cur != rlim_t{8} << 20) throw Error("it has not grown");
        }).empty());
}

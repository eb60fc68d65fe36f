#include <cstdint>
#include <cstdlib>
#include <new>
#include <string>

#include <malloc.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "core/image/pixel_maker.h"
#include "runner/cli/cli_commands.h"

namespace {

pid_t main_process = 0;

/// If a node or library calls exit, the program must not end as if it had succeeded. Other threads are running, so
/// nothing is cleaned up.
[[noreturn]] void end(int code) {
  if (::getpid() == main_process) {
    const std::string node = terrazzo::PixelMaker::name();
    const std::string message =
        "error: " + (node.empty() ? std::string("code of a node or a library") : "code of the node \"" + node + "\"") +
        " called exit() before the command was done\n";
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, message.data(), message.size());
    code = terrazzo::exit_failed;
  }
  ::syscall(SYS_exit_group, code);
  __builtin_trap();
}

}  // namespace

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
namespace {

/// Asks for huge pages around large memory: it is written as a whole, and page by page that costs a fifth of a layout
/// (tests/bench/performance.md).
void* in_huge_pages(void* memory, size_t bytes) {
  constexpr uintptr_t page = 2 << 20, large = 1 << 20;
  if (bytes < large) return memory;
  const auto at = reinterpret_cast<uintptr_t>(memory);
  const uintptr_t first = at / page * page, end = (at + bytes + page - 1) / page * page;
  // Without them, or where parts of the range belong to nobody, memory works as before.
  [[maybe_unused]] const int failed = ::madvise(static_cast<char*>(memory) - (at - first), end - first, MADV_HUGEPAGE);
  return memory;
}

}  // namespace

// These replace the C++ library's operators, with which all others are written.
[[gnu::visibility("default")]] void* operator new(size_t bytes) {
  while (true) {
    if (void* memory = std::malloc(bytes ? bytes : 1)) return in_huge_pages(memory, bytes);
    const std::new_handler handler = std::get_new_handler();
    if (!handler) throw std::bad_alloc();
    handler();
  }
}
[[gnu::visibility("default")]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::visibility("default")]] void operator delete(void* memory, size_t) noexcept {
  std::free(memory);
}
#endif

// These replace the C library's functions, which returning from main does not use.
extern "C" {
__attribute__((noreturn, visibility("default"))) void exit(int code) noexcept {
  end(code);
}
__attribute__((noreturn, visibility("default"))) void quick_exit(int code) noexcept {
  end(code);
}
__attribute__((noreturn, visibility("default"))) void _exit(int code) {
  end(code);
}
__attribute__((noreturn, visibility("default"))) void _Exit(int code) noexcept {
  end(code);
}
}

int main(int argc, char** argv) {
  main_process = ::getpid();
  // Stages repeatedly allocate buffers of some megabytes. Keeping them instead of returning them to the system saves a
  // fiftieth of a run with one map.
  constexpr int kept = 64 << 20, mapped_from = 16 << 20;
  mallopt(M_TRIM_THRESHOLD, kept);
  mallopt(M_MMAP_THRESHOLD, mapped_from);
  return terrazzo::run_command_line(argc, argv);
}

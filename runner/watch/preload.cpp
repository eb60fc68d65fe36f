// Reports which files are opened and which environment variables are read. Preloaded (LD_PRELOAD) only in checked runs,
// see runner/engine/checked.h. Independent of the rest of terrazzo.
#include <atomic>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>

#include <dlfcn.h>
#include <fcntl.h>

namespace {

/// `by`: an address in the calling code.
using Tell = void (*)(char kind, const char* what, int flags, const void* by);
std::atomic<Tell> teller = nullptr;

/// Inline, so that the address is in the code that called the function which tells.
[[gnu::always_inline]] inline void tell(char kind, const char* what, int flags) {
  const Tell now = teller.load();
  if (now && what) now(kind, what, flags, __builtin_return_address(0));
}

template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

/// The argument that open(2) has only where it may create a file.
mode_t mode_behind(va_list arguments, int flags) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;
}

}  // namespace

extern "C" {

/// Null stops reporting.
void terrazzo_watch(Tell to) {
  teller = to;
}

int open(const char* path, int flags, ...) {
  static auto* const real = next<decltype(open)>("open");
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_behind(arguments, flags);
  va_end(arguments);
  tell('f', path, flags);
  return real(path, flags, mode);
}

int openat(int folder, const char* path, int flags, ...) {
  static auto* const real = next<decltype(openat)>("openat");
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_behind(arguments, flags);
  va_end(arguments);
  tell('f', path, flags);
  return real(folder, path, flags, mode);
}

FILE* fopen(const char* path, const char* mode) {
  static auto* const real = next<decltype(fopen)>("fopen");
  const bool writes = mode && (mode[0] == 'w' || mode[0] == 'a');
  tell('f', path, writes ? O_WRONLY | O_CREAT : O_RDONLY);
  return real(path, mode);
}

char* getenv(const char* variable) noexcept {
  static auto* const real = next<decltype(getenv)>("getenv");
  tell('v', variable, 0);
  return real(variable);
}

// The same on 64-bit systems, and in programs without a set-user-ID bit, which are the only ones that preload.
int open64(const char* path, int flags, ...) __attribute__((alias("open")));
int openat64(int folder, const char* path, int flags, ...) __attribute__((alias("openat")));
FILE* fopen64(const char* path, const char* mode) __attribute__((alias("fopen")));
char* secure_getenv(const char* variable) noexcept __attribute__((alias("getenv")));

}  // extern "C"

// Reports which files are opened and which environment variables are read. Preloaded (LD_PRELOAD) only in checked runs,
// see runner/engine/checked.h. Independent of the rest of terrazzo.
#include <atomic>
#include <cstdarg>
#include <cstdio>

#include <dlfcn.h>
#include <fcntl.h>

namespace {

/// `by`: an address in the calling code.
using Tell = void (*)(char kind, const char* what, int flags, const void* by);
std::atomic<Tell> teller = nullptr;

void tell(char kind, const char* what, int flags, const void* by) {
  const Tell now = teller.load();
  if (now && what) now(kind, what, flags, by);
}

template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

int flags_of(const char* mode) {
  const bool writes = mode && (mode[0] == 'w' || mode[0] == 'a');
  return writes ? O_WRONLY | O_CREAT : O_RDONLY;
}

int mode_behind(va_list arguments, int flags) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, int) : 0;
}

}  // namespace

extern "C" {

/// Null stops reporting.
void terrazzo_watch(Tell to) {
  teller = to;
}

#define WATCHED_OPEN(name)                                             \
  int name(const char* path, int flags, ...) {                         \
    static auto* const real = next<int(const char*, int, int)>(#name); \
    va_list arguments;                                                 \
    va_start(arguments, flags);                                        \
    const int mode = mode_behind(arguments, flags);                    \
    va_end(arguments);                                                 \
    tell('f', path, flags, __builtin_return_address(0));               \
    return real(path, flags, mode);                                    \
  }
#define WATCHED_OPENAT(name)                                                \
  int name(int folder, const char* path, int flags, ...) {                  \
    static auto* const real = next<int(int, const char*, int, int)>(#name); \
    va_list arguments;                                                      \
    va_start(arguments, flags);                                             \
    const int mode = mode_behind(arguments, flags);                         \
    va_end(arguments);                                                      \
    tell('f', path, flags, __builtin_return_address(0));                    \
    return real(folder, path, flags, mode);                                 \
  }
#define WATCHED_FOPEN(name)                                                 \
  FILE* name(const char* path, const char* mode) {                          \
    static auto* const real = next<FILE*(const char*, const char*)>(#name); \
    tell('f', path, flags_of(mode), __builtin_return_address(0));           \
    return real(path, mode);                                                \
  }
#define WATCHED_GETENV(name)                                   \
  char* name(const char* variable) noexcept {                  \
    static auto* const real = next<char*(const char*)>(#name); \
    tell('v', variable, 0, __builtin_return_address(0));       \
    return real(variable);                                     \
  }

WATCHED_OPEN(open)
WATCHED_OPEN(open64)
WATCHED_OPENAT(openat)
WATCHED_OPENAT(openat64)
WATCHED_FOPEN(fopen)
WATCHED_FOPEN(fopen64)
WATCHED_GETENV(getenv)
WATCHED_GETENV(secure_getenv)

}  // extern "C"

#include "core/base/thread_limits.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <vector>

#include <fmt/format.h>
#include <pthread.h>
#include <sys/resource.h>

#include "core/base/error.h"

namespace terrazzo {

namespace {

constexpr rlim_t usual_stack = rlim_t{8} << 20;
/// Includes a reserve: some runs succeeded with 64 KiB.
constexpr rlim_t least_stack = rlim_t{512} << 10;

/// Idle threads that wait until they are told to end.
class IdleThreads {
 public:
  IdleThreads() = default;
  IdleThreads(const IdleThreads&) = delete;
  IdleThreads& operator=(const IdleThreads&) = delete;
  ~IdleThreads() {
    over_ = true;
    over_.notify_all();
    for (const pthread_t thread : threads_) ::pthread_join(thread, nullptr);
  }

  /// 0, or the error that prevents further threads.
  int start_one() {
    pthread_t thread{};
    const int error = ::pthread_create(&thread, nullptr, &IdleThreads::wait, &over_);
    if (error == 0) threads_.push_back(thread);
    return error;
  }
  size_t count() const { return threads_.size(); }

 private:
  static void* wait(void* over) {
    static_cast<std::atomic<bool>*>(over)->wait(false);
    return nullptr;
  }

  std::atomic<bool> over_{false};
  std::vector<pthread_t> threads_;
};

rlimit limit_of(decltype(RLIMIT_NPROC) resource) {
  rlimit limit{};
  ::getrlimit(resource, &limit);
  return limit;
}

}  // namespace

void require_threads(int count) {
  IdleThreads threads;
  while (int(threads.count()) < count) {
    const int error = threads.start_one();
    if (error == 0) continue;
    const rlim_t processes = limit_of(RLIMIT_NPROC).rlim_cur, memory = limit_of(RLIMIT_AS).rlim_cur;
    std::string limits;
    if (processes != RLIM_INFINITY)
      limits += fmt::format("; the user's limit of processes (ulimit -u) is {}", processes);
    if (memory != RLIM_INFINITY) limits += fmt::format("; the limit of memory (ulimit -v) is {} KiB", memory >> 10);
    if (limits.empty()) limits = "; a container or service may limit them (pids.max)";
    throw Error(
        fmt::format("cannot start threads: {} needed, the system started {} ({}){}. Raise the limit, or give "
                    "fewer with --threads",
                    count, threads.count(), std::strerror(error), limits));
  }
}

void require_stack() {
  rlimit limit = limit_of(RLIMIT_STACK);
  if (limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur >= usual_stack) return;
  limit.rlim_cur = std::min(usual_stack, limit.rlim_max);
  ::setrlimit(RLIMIT_STACK, &limit);
  const rlim_t allowed = limit_of(RLIMIT_STACK).rlim_cur;
  if (allowed < least_stack)
    throw Error(fmt::format("the limit of the stack (ulimit -s) is {} KiB, at least {} are needed: raise it",
                            allowed >> 10, least_stack >> 10));
  // The default for new threads was read from the limit at program start.
  pthread_attr_t attributes;
  if (::pthread_getattr_default_np(&attributes) != 0) return;
  ::pthread_attr_setstacksize(&attributes, allowed);
  ::pthread_setattr_default_np(&attributes);
  ::pthread_attr_destroy(&attributes);
}

}  // namespace terrazzo

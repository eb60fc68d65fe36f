// Tells ThreadSanitizer the order that oneTBB gives to its tasks. The packaged library is not instrumented, so the
// sanitizer sees nothing of the queues through which a task goes from one thread to another and would call every
// parallel loop a race. Part of builds with TERRAZZO_SANITIZE=thread only: the functions below stand in front of the
// library's own entry points and pass on.
//
// Declared: what came before handing out a task is visible to the task; what a task did is visible to whoever waited
// for it; memory that the library recycles is new memory. Nothing else is: two tasks of one loop stay unordered, so a
// race between them is found.

#include <cstdio>
#include <cstdlib>

#include <dlfcn.h>
#include <sanitizer/tsan_interface.h>
#include <tbb/cache_aligned_allocator.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

extern "C" {
void AnnotateIgnoreWritesBegin(const char* file, int line);
void AnnotateIgnoreWritesEnd(const char* file, int line);
}

namespace {

using tbb::detail::d1::delegate_base;
using tbb::detail::d1::execution_data;
using tbb::detail::d1::small_object_pool;
using tbb::detail::d1::task;
using tbb::detail::d1::task_arena_base;
using tbb::detail::d1::task_group_context;
using tbb::detail::d1::wait_context;

/// The library's own function of a mangled name.
template <typename Function>
Function* library_function(const char* mangled_name) {
  void* found = ::dlsym(RTLD_NEXT, mangled_name);
  if (!found) {
    std::fprintf(stderr, "tests/tsan/tbb_order.cpp: this version of oneTBB has no %s; adapt the file to it\n",
                 mangled_name);
    std::abort();
  }
  return reinterpret_cast<Function*>(found);
}

/// Handed out in place of a task: orders the task after its handing out, on whatever thread it comes to run.
class OrderedTask final : public task {
 public:
  explicit OrderedTask(task& inner) : inner_(&inner) { __tsan_release(this); }

  // A task that throws is cancelled next, so this one may go only when the inner one has returned.
  task* execute(execution_data& data) override {
    __tsan_acquire(this);
    return leave(inner_->execute(data));
  }
  task* cancel(execution_data& data) override {
    __tsan_acquire(this);
    return leave(inner_->cancel(data));
  }

 private:
  task* leave(task* next) {
    delete this;
    return next;
  }

  task* inner_;
};

/// The same for a function that an arena may run on another thread while the caller waits.
class OrderedDelegate final : public delegate_base {
 public:
  explicit OrderedDelegate(delegate_base& inner) : inner_(inner) { __tsan_release(&order_); }

  // The caller waits for the function's end, or for its exception.
  ~OrderedDelegate() { __tsan_acquire(&order_); }
  OrderedDelegate(const OrderedDelegate&) = delete;
  OrderedDelegate& operator=(const OrderedDelegate&) = delete;

  bool operator()() const override {
    __tsan_acquire(&order_);
    const Release release{&order_};
    return inner_();
  }

 private:
  struct Release {
    char* order;
    ~Release() { __tsan_release(order); }
  };

  delegate_base& inner_;
  mutable char order_ = 0;
};

/// Tasks count themselves off on the atomic number after a wait_context's first word; the library reads it unseen.
/// Waits end with a task's exception, too, which the waiting thread then reads.
class AcquireFinished {
 public:
  explicit AcquireFinished(wait_context& finished) : finished_(finished) {}
  AcquireFinished(const AcquireFinished&) = delete;
  AcquireFinished& operator=(const AcquireFinished&) = delete;
  ~AcquireFinished() {
    static_assert(sizeof(wait_context) == 2 * sizeof(std::uint64_t));
    __tsan_acquire(reinterpret_cast<std::uint64_t*>(&finished_) + 1);
  }

 private:
  wait_context& finished_;
};

}  // namespace

namespace tbb::detail::r1 {

void spawn(task& handed, task_group_context& context) {
  static const auto next = library_function<void(task&, task_group_context&)>(
      "_ZN3tbb6detail2r15spawnERNS0_2d14taskERNS2_18task_group_contextE");
  next(*new OrderedTask(handed), context);
}

void spawn(task& handed, task_group_context& context, d1::slot_id slot) {
  static const auto next = library_function<void(task&, task_group_context&, d1::slot_id)>(
      "_ZN3tbb6detail2r15spawnERNS0_2d14taskERNS2_18task_group_contextEt");
  next(*new OrderedTask(handed), context, slot);
}

void submit(task& handed, task_group_context& context, arena* where, std::uintptr_t as_critical) {
  static const auto next = library_function<void(task&, task_group_context&, arena*, std::uintptr_t)>(
      "_ZN3tbb6detail2r16submitERNS0_2d14taskERNS2_18task_group_contextEPNS1_5arenaEm");
  next(*new OrderedTask(handed), context, where, as_critical);
}

void enqueue(task& handed, task_arena_base* where) {
  static const auto next = library_function<void(task&, task_arena_base*)>(
      "_ZN3tbb6detail2r17enqueueERNS0_2d14taskEPNS2_15task_arena_baseE");
  next(*new OrderedTask(handed), where);
}

void enqueue(task& handed, task_group_context& context, task_arena_base* where) {
  static const auto next = library_function<void(task&, task_group_context&, task_arena_base*)>(
      "_ZN3tbb6detail2r17enqueueERNS0_2d14taskERNS2_18task_group_contextEPNS2_15task_arena_baseE");
  next(*new OrderedTask(handed), context, where);
}

void execute_and_wait(task& first, task_group_context& first_context, wait_context& finished,
                      task_group_context& wait_group) {
  static const auto next = library_function<void(task&, task_group_context&, wait_context&, task_group_context&)>(
      "_ZN3tbb6detail2r116execute_and_waitERNS0_2d14taskERNS2_18task_group_contextERNS2_12wait_contextES6_");
  const AcquireFinished acquire(finished);
  next(first, first_context, finished, wait_group);
}

void wait(wait_context& finished, task_group_context& context) {
  static const auto next = library_function<void(wait_context&, task_group_context&)>(
      "_ZN3tbb6detail2r14waitERNS0_2d112wait_contextERNS2_18task_group_contextE");
  const AcquireFinished acquire(finished);
  next(finished, context);
}

void execute(task_arena_base& where, delegate_base& work) {
  static const auto next = library_function<void(task_arena_base&, delegate_base&)>(
      "_ZN3tbb6detail2r17executeERNS0_2d115task_arena_baseERNS2_13delegate_baseE");
  OrderedDelegate ordered(work);
  next(where, ordered);
}

void* allocate(small_object_pool*& pool, std::size_t bytes, const execution_data& data) {
  static const auto next = library_function<void*(small_object_pool*&, std::size_t, const execution_data&)>(
      "_ZN3tbb6detail2r18allocateERPNS0_2d117small_object_poolEmRKNS2_14execution_dataE");
  void* block = next(pool, bytes, data);
  __tsan_acquire(block);
  return block;
}

void* allocate(small_object_pool*& pool, std::size_t bytes) {
  static const auto next = library_function<void*(small_object_pool*&, std::size_t)>(
      "_ZN3tbb6detail2r18allocateERPNS0_2d117small_object_poolEm");
  void* block = next(pool, bytes);
  __tsan_acquire(block);
  return block;
}

void deallocate(small_object_pool& pool, void* block, std::size_t bytes, const execution_data& data) {
  static const auto next = library_function<void(small_object_pool&, void*, std::size_t, const execution_data&)>(
      "_ZN3tbb6detail2r110deallocateERNS0_2d117small_object_poolEPvmRKNS2_14execution_dataE");
  __tsan_release(block);
  next(pool, block, bytes, data);
}

void deallocate(small_object_pool& pool, void* block, std::size_t bytes) {
  static const auto next = library_function<void(small_object_pool&, void*, std::size_t)>(
      "_ZN3tbb6detail2r110deallocateERNS0_2d117small_object_poolEPvm");
  __tsan_release(block);
  next(pool, block, bytes);
}

// The library's general allocator may be tbbmalloc, which the sanitizer does not know either; the C library's it knows.
void* cache_aligned_allocate(std::size_t bytes) {
  constexpr std::size_t line = 128;
  void* block = std::aligned_alloc(line, (bytes + line - 1) / line * line);
  if (!block) throw std::bad_alloc();
  return block;
}

// The library counts the users of a block and frees it after the last one, often a worker as the program ends.
void cache_aligned_deallocate(void* block) {
  AnnotateIgnoreWritesBegin(__FILE__, __LINE__);
  std::free(block);
  AnnotateIgnoreWritesEnd(__FILE__, __LINE__);
}

}  // namespace tbb::detail::r1

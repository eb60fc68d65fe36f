#include "runner/engine/checked.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <mutex>

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/file/module_path.h"
#include "core/file/path_relation.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

using Tell = void (*)(char kind, const char* what, int flags, const void* by);
using Watch = void (*)(Tell);

constexpr const char* library_name = "terrazzo_watch.so";
constexpr const char* preload = "LD_PRELOAD";
/// Variables that are already in the keys of nodes that convert colours, the first by the content of its file.
constexpr std::array<std::string_view, 2> color_variables = {"OCIO", "OCIO_OPTIMIZATION_FLAGS"};
constexpr const char* started = "TERRAZZO_WATCHED";

Watch watch() {
  return reinterpret_cast<Watch>(::dlsym(RTLD_DEFAULT, "terrazzo_watch"));
}

std::string reason;
std::mutex turn;  ///< serialises watching: checked runs may be concurrent
std::mutex mutex;
WatchedReads* now = nullptr;
thread_local bool is_telling = false;  ///< ignores reads by the reporting code itself

/// Compares pixels even of lazy outputs, whose digests name only the recipe.
void add_pixels(Hasher& hasher, const Image& image) {
  hasher.add(image.width()).add(image.height()).add(image.channels());
  for_each_strip(image, [&](const Rect& r, const float* pixels) {
    hasher.stream(pixels, size_t(r.area()) * size_t(image.channels()) * sizeof(float));
  });
}

Digest content_of(const Value& value) {
  Hasher hasher;
  if (const auto* image = std::get_if<ImagePtr>(&value)) {
    add_pixels(hasher, **image);
  } else if (const auto* material = std::get_if<MaterialPtr>(&value)) {
    for (const Map& m : (*material)->maps()) {
      hasher.add(m.name);
      add_pixels(hasher, *m.image);
    }
  } else {
    hasher.add(digest_of(value));
  }
  return hasher.digest();
}

/// What the system's libraries read independently of nodes.
bool is_of_the_system(const fs::path& path) {
  constexpr std::array<const char*, 7> folders = {"/usr", "/lib", "/lib64", "/etc", "/proc", "/sys", "/dev"};
  return std::ranges::any_of(folders, [&](const char* f) { return lies_in(f, path); });
}

/// Whether the address is in a system library: these read variables on their own.
bool is_code_of_the_system(const void* address) {
  Dl_info place{};
  return ::dladdr(address, &place) != 0 && place.dli_fname && is_of_the_system(fs::path(place.dli_fname));
}

bool is_random(const fs::path& path) {
  return path == "/dev/urandom" || path == "/dev/random";
}

void require_declared(const Stage& stage, const NodeContext& context, const WatchedReads& reads) {
  const NodeType& type = stage.type();
  std::set<fs::path> declared;
  std::error_code unresolved;
  if (type.files_read)
    for (const fs::path& f : type.files_read(stage.node->params)) declared.insert(fs::weakly_canonical(f, unresolved));
  for (const StagedFile& f : context.staged())
    for (const fs::path& file : {f.temporary, f.target}) declared.insert(fs::weakly_canonical(file, unresolved));
  for (const fs::path& file : reads.files()) {
    const fs::path path = fs::weakly_canonical(file, unresolved);
    if (is_random(path))
      throw Error(fmt::format("checked: {} reads random numbers from {}; its results cannot be cached", type.name,
                              path.string()));
    if (declared.contains(path) || is_of_the_system(path) || !fs::is_regular_file(path, unresolved)) continue;
    const std::string_view declares =
        type.origin.name == "Python" ? "no parameter of type Path names" : "its `files_read` does not name";
    throw Error(fmt::format("checked: {} reads {}, which {}: when that file changes, outdated results would be reused",
                            type.name, path.string(), declares));
  }
  for (const std::string& variable : reads.variables())
    if (std::ranges::find(color_variables, variable) == color_variables.end())
      throw Error(
          fmt::format("checked: {} reads the variable {} of the environment, which is not in its key: make it a "
                      "parameter",
                      type.name, variable));
}

/// Throws if a node's forecasts do not hold.
void require_foreseen(NodeContext& node) {
  for (const auto& [port, forecast] : node.inferred()) {
    const auto value = node.outputs().find(port);
    if (value == node.outputs().end()) continue;
    if (const std::string what = contradiction(forecast, value->second); !what.empty())
      throw Error(
          fmt::format("checked: the output \"{}\" of {} is {}; mend its `infer`", port, node.type().name, what));
  }
}

void require_same_files(const NodeContext& first, const NodeContext& again, const std::string& type) {
  const auto content = [](const StagedFile& f) { return digest_of_file(nullptr, f.temporary); };
  const auto same = [&](const StagedFile& a, const StagedFile& b) {
    return a.target == b.target && content(a) == content(b);
  };
  if (!std::ranges::equal(first.staged(), again.staged(), same))
    throw Error(fmt::format("checked: {} writes other files when it runs again with the same inputs", type));
}

/// Removes the staged files of a second run at its end.
struct StagedRemoval {
  ~StagedRemoval() {
    std::error_code ignored;
    for (const StagedFile& f : context.staged()) fs::remove(f.temporary, ignored);
  }
  const NodeContext& context;
};

}  // namespace

bool is_watching() {
  return watch() != nullptr;
}

void start_watching(const char* const* argv) {
  if (is_watching()) return;
  if (std::getenv(started)) {
    reason = "the watching library was not loaded";
    return;
  }
  try {
    const std::string library = module_path(library_name, "the module for checked runs").string();
    const char* others = std::getenv(preload);
    ::setenv(preload, (library + (others ? std::string(":") + others : "")).c_str(), 1);
    ::setenv(started, "1", 1);
    ::execv("/proc/self/exe", const_cast<char* const*>(argv));
    reason = "the program cannot be started again";
  } catch (const Error& e) {
    reason = e.what();
  }
}

std::string why_not_watching() {
  return is_watching() ? "" : reason.empty() ? "only the program terrazzo watches" : reason;
}

void tell_opened(const char* path, int flags) {
  WatchedReads::tell('f', path, flags, nullptr);
}

void WatchedReads::tell(char kind, const char* what, int flags, const void* by) {
  if (is_telling) return;
  is_telling = true;
  {
    const std::lock_guard lock(mutex);
    const bool is_read = (flags & (O_WRONLY | O_RDWR | O_DIRECTORY)) == 0;
    if (now && kind == 'v' && !is_code_of_the_system(by)) now->variables_.emplace(what);
    if (now && kind == 'f' && is_read) now->files_.insert(fs::absolute(what));
  }
  is_telling = false;
}

WatchedReads::WatchedReads() : turn_(turn) {
  const std::lock_guard lock(mutex);
  now = this;
  if (is_watching()) watch()(&tell);
}

void WatchedReads::stop() {
  const std::lock_guard lock(mutex);
  if (now != this) return;
  if (is_watching()) watch()(nullptr);
  now = nullptr;
  turn_.unlock();
}

void check_node(const Stage& stage, NodeContext& first, NodeContext& again, const WatchedReads& reads) {
  const std::string& type = stage.type().name;
  require_declared(stage, first, reads);
  require_foreseen(first);
  const StagedRemoval removal{again};
  tbb::this_task_arena::isolate([&] { again.compute(); });
  for (const auto& [port, value] : first.outputs()) {
    const auto at = again.outputs().find(port);
    if (at == again.outputs().end() || content_of(at->second) != content_of(value))
      throw Error(
          fmt::format("checked: {} gives another \"{}\" when it runs again with the same inputs. Random numbers, "
                      "the clock, the order of threads and memory that was not set are the usual causes",
                      type, port));
  }
  require_same_files(first, again, type);
}

}  // namespace terrazzo

#include "runner/api/plugin.h"

#include <cstdlib>
#include <mutex>
#include <sstream>

#include <dlfcn.h>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/suggest.h"
#include "runner/cache/cache.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

std::mutex mutex;

std::vector<LoadedPlugin>& all_plugins() {
  static std::vector<LoadedPlugin> all;
  return all;
}

[[noreturn]] void fail(const fs::path& file, const std::string& reason) {
  throw Error(fmt::format("cannot load the plug-in {}: {}", file.string(), reason));
}

/// Calls a function of a plug-in. Adds the plug-in's name to exceptions other than Error.
template <typename Call>
auto guarded(const std::string& plugin, const Call& call) -> decltype(call()) {
  try {
    return call();
  } catch (const Error&) {
    throw;
  } catch (const Cancelled&) {
    throw;
  } catch (const std::exception& e) {
    throw Error(fmt::format("plug-in \"{}\" failed: {}", plugin, e.what()));
  } catch (...) {
    throw Error(fmt::format("plug-in \"{}\" failed, and threw something other than a std::exception", plugin));
  }
}

template <typename Result, typename... Arguments>
void guard(std::function<Result(Arguments...)>& function, const std::string& plugin) {
  if (!function) return;
  function = [inner = std::move(function), plugin](Arguments... arguments) {
    return guarded(plugin, [&] { return inner(std::forward<Arguments>(arguments)...); });
  };
}

void guard(NodeType& type) {
  const std::string& plugin = type.origin.name;
  guard(type.compute, plugin);
  guard(type.files_read, plugin);
  guard(type.memory_hint, plugin);
  guard(type.memory_ahead, plugin);
  guard(type.check, plugin);
  guard(type.infer, plugin);
  guard(type.preflight, plugin);
  guard(type.lint, plugin);
}

void require_file(const fs::path& file) {
  std::error_code failure;
  if (fs::is_regular_file(file, failure)) return;
  if (fs::exists(file, failure)) fail(file, "it is no file");
  std::vector<std::string> others;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  for (const fs::directory_entry& e : fs::directory_iterator(folder, failure))
    others.push_back(e.path().filename().string());
  fail(file, "there is no such file" + did_you_mean(file.filename().string(), others));
}

const PluginInfo& info_of(const fs::path& file) {
  void* library = guarded(file.filename().string(), [&] { return ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL); });
  if (!library) fail(file, ::dlerror());
  void* symbol = ::dlsym(library, "terrazzo_plugin");
  if (!symbol) fail(file, "it is not a plug-in of terrazzo: it has no TERRAZZO_PLUGIN");
  const PluginInfo* info =
      guarded(file.filename().string(), [&] { return reinterpret_cast<const PluginInfo* (*)()>(symbol)(); });
  if (!info) fail(file, "it says nothing of itself");
  if (info->abi != plugin_abi || info->node_type_size != sizeof(NodeType))
    fail(file, fmt::format("it was compiled for another terrazzo (interface {}; this one has {}); compile it anew",
                           info->abi, plugin_abi));
  if (!info->name || !*info->name || !info->version || !info->node_types)
    fail(file, "it does not say its name, its version and its node types");
  return *info;
}

LoadedPlugin load(const fs::path& file) {
  const Digest content = file_content_digest(file);
  const PluginInfo& info = info_of(file);
  for (const LoadedPlugin& p : all_plugins())
    if (p.origin.name == info.name)
      fail(file, fmt::format("another plug-in of the name \"{}\" is loaded already, {}", info.name, p.file.string()));
  LoadedPlugin plugin{file, {info.name, info.version, content}, {}};
  for (NodeType& type : guarded(info.name, info.node_types)) {
    plugin.types.push_back(type.name);
    type.origin = plugin.origin;
    guard(type);
    try {
      register_node_type(std::move(type));
    } catch (const Error& e) {
      fail(file, e.what());
    }
  }
  return plugin;
}

}  // namespace

LoadedPlugin load_plugin(const fs::path& file) {
  require_file(file);
  const std::lock_guard lock(mutex);
  std::error_code unresolved;
  const fs::path place = fs::canonical(file, unresolved);
  for (const LoadedPlugin& p : all_plugins())
    if (p.file == place) return p;
  return all_plugins().emplace_back(load(place));
}

void load_plugins_of_environment() {
  const char* files = std::getenv("TERRAZZO_PLUGINS");
  if (!files) return;
  std::istringstream list(files);
  for (std::string file; std::getline(list, file, ':');)
    if (!file.empty()) load_plugin(file);
}

std::vector<LoadedPlugin> loaded_plugins() {
  const std::lock_guard lock(mutex);
  return all_plugins();
}

}  // namespace terrazzo

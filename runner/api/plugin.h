#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/node/node.h"
#include "nodes/common/registry.h"

/// Node types from shared libraries. A plug-in is compiled against these headers and linked to libterrazzo:
///
///     std::vector<terrazzo::NodeType> my_types() { ... }
///     TERRAZZO_PLUGIN("my nodes", "1.0", my_types)
///
/// `--plugin FILE` or TERRAZZO_PLUGINS (files, with colons between them) load it. Its types then appear in `terrazzo
/// nodes` and the schema, and graphs can use them. The plug-in's name, version and file content are part of its cache
/// keys: another build never reuses this one's results.
namespace terrazzo {

/// Raised whenever the memory layout of descriptors, values or contexts changes. Plug-ins must then be recompiled.
inline constexpr int plugin_abi = 3;

/// What a plug-in exports. The first two members never move.
struct PluginInfo {
  int abi = plugin_abi;
  size_t node_type_size = sizeof(NodeType);
  const char* name = nullptr;
  const char* version = nullptr;
  std::vector<NodeType> (*node_types)() = nullptr;
};

/// A plug-in that has been loaded.
struct LoadedPlugin {
  std::filesystem::path file;
  NodeOrigin origin;
  std::vector<std::string> types;  ///< the names of its node types
};

/// Loads a plug-in and registers its node types. Loading a file twice has no effect. Exceptions from its functions
/// become Error with the plug-in's name. Throws Error if the file is missing, is no plug-in, was compiled for another
/// version, uses a name that is taken, or fails to load. Thread-safe.
LoadedPlugin load_plugin(const std::filesystem::path& file);

/// Loads the plug-ins that TERRAZZO_PLUGINS lists. Throws as load_plugin.
void load_plugins_of_environment();

/// All loaded plug-ins, in the order of loading. Thread-safe.
std::vector<LoadedPlugin> loaded_plugins();

}  // namespace terrazzo

#define TERRAZZO_PLUGIN(plugin_name, plugin_version, types_function)                                      \
  extern "C" __attribute__((visibility("default"))) const terrazzo::PluginInfo* terrazzo_plugin() {       \
    static const terrazzo::PluginInfo info{terrazzo::plugin_abi, sizeof(terrazzo::NodeType), plugin_name, \
                                           plugin_version, types_function};                               \
    return &info;                                                                                         \
  }

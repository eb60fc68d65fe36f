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
/// `--plugin FILE` or TERRAZZO_PLUGINS (files, with colons between them) load it. Its types are in `terrazzo nodes`,
/// the schema and graphs like others. The plug-in's name, its version and the content of its file are in the keys of
/// its results: another build never takes what this one has cached.
namespace terrazzo {

/// Raised whenever descriptors, values or contexts change in memory, so that plug-ins must be compiled anew.
inline constexpr int plugin_abi = 2;

/// What a plug-in says of itself. The first two members never move.
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

/// Loads a plug-in and registers its node types. A file that has been loaded is not loaded again. Whatever its
/// functions throw becomes Error with its name. Throws Error if the file is missing, is no plug-in, was compiled for
/// another version, takes a name that is taken, or fails. Thread-safe.
LoadedPlugin load_plugin(const std::filesystem::path& file);

/// Loads those that TERRAZZO_PLUGINS names.
void load_plugins_of_environment();

/// All that have been loaded, in their order.
std::vector<LoadedPlugin> loaded_plugins();

}  // namespace terrazzo

#define TERRAZZO_PLUGIN(plugin_name, plugin_version, types_function)                                      \
  extern "C" __attribute__((visibility("default"))) const terrazzo::PluginInfo* terrazzo_plugin() {       \
    static const terrazzo::PluginInfo info{terrazzo::plugin_abi, sizeof(terrazzo::NodeType), plugin_name, \
                                           plugin_version, types_function};                               \
    return &info;                                                                                         \
  }

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "graphs/text/diagnostics.h"
#include "graphs/text/json.h"

namespace terrazzo {

struct Param;

/// A value for a graph's parameter, or for a parameter or port of one of its nodes, from the command line, a settings
/// file or a preset.
struct Override {
  std::string node;  ///< empty for a graph parameter
  std::string name;
  std::string value;                ///< as spelled on the command line
  std::optional<JsonValue> json{};  ///< replaces `value` if it comes from a file
  std::filesystem::path base;       ///< absolute; relative paths start here
  std::string where;                ///< for messages
  Place place{};                    ///< for overrides in the graph file itself

  Diagnostics diagnostics(std::vector<Problem>& all) const;
  /// The unexpanded value for this parameter.
  JsonValue json_for(const Param& param) const;
};

/// Sets one member of `map` to the override's value. Nullopt, after a problem, if `map` is no object.
std::optional<JsonValue> with_member(JsonValue map, const std::string& member, const Override& by,
                                     std::vector<Problem>& problems);

/// Problem::where for the override with this spelling.
std::string where_of_override(const std::string& spelled);

/// `name=value` for a graph parameter, `node.parameter=value` (or a port) for a node. Relative paths start at `base`.
/// Texts without "=" or without a name become problems.
std::vector<Override> read_overrides(const std::vector<std::string>& texts, const std::filesystem::path& base,
                                     std::vector<Problem>& problems);

/// The members of an object, {"seed": 3, "weighted.weights": {"height": 2}}, as overrides. `where`: a prefix for
/// messages. `in_graph`: the object is in the graph file itself, so problems have places in it.
std::vector<Override> read_override_object(const JsonValue& object, const std::filesystem::path& base,
                                           const std::string& where, bool in_graph, std::vector<Problem>& problems);

/// The same for a settings file, which holds such an object. Relative paths start at its folder. Errors in the file
/// become problems.
std::vector<Override> read_settings(const std::filesystem::path& file, std::vector<Problem>& problems);

}  // namespace terrazzo

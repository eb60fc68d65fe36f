#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "graphs/text/diagnostics.h"
#include "graphs/text/json.h"

namespace terrazzo {

struct Param;

/// A value for a graph's parameter, or for a parameter or port of one of its nodes: from the command line, a settings
/// file or a preset.
struct Override {
  std::string node;  ///< empty for a graph parameter
  std::string name;
  std::string value;                ///< as the command line has it
  std::optional<JsonValue> json{};  ///< instead of it, from a file
  std::filesystem::path base;       ///< absolute; where relative paths lie
  std::string where;                ///< for messages
  Place place{};                    ///< if it comes from the graph file itself

  Diagnostics diagnostics(std::vector<Problem>& all) const;
  /// The value for this parameter, not expanded.
  JsonValue json_for(const Param& param) const;
};

/// A map with what the override says for one of its members, `member`; `map` is what it is otherwise. Empty, after a
/// problem, if that is no object.
std::optional<JsonValue> with_member(JsonValue map, const std::string& member, const Override& by,
                                     std::vector<Problem>& problems);

/// How problems say (as Problem::where) that they are about the override of this spelling.
std::string where_of_override(const std::string& spelled);

/// `name=value` for a graph parameter, `node.parameter=value` (or a port) for a node. Relative paths lie in `base`.
/// Texts without "=" or without a name become problems.
std::vector<Override> read_overrides(const std::vector<std::string>& texts, const std::filesystem::path& base,
                                     std::vector<Problem>& problems);

/// The members of an object, {"seed": 3, "weighted.weights": {"height": 2}}, as overrides. `where` begins their
/// messages; `in_graph`: they stand in the graph file itself, so that problems have its lines.
std::vector<Override> read_override_object(const JsonValue& object, const std::filesystem::path& base,
                                           const std::string& where, bool in_graph, std::vector<Problem>& problems);

/// The same for a settings file, which holds such an object; relative paths lie in its folder. What is wrong with the
/// file becomes a problem.
std::vector<Override> read_settings(const std::filesystem::path& file, std::vector<Problem>& problems);

}  // namespace terrazzo

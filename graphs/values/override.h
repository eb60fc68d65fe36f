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
  /// Where a value comes from, if from outside of the document.
  struct Source {
    std::string file{};  ///< for messages, with the place in it; may be empty
    Place place{};
    std::string advice{};  ///< is added to messages
  };
  std::string node{};               ///< empty for a graph parameter
  std::string name{};               ///< parameter or port, or part of a map: "weights.height"; empty: malformed
  std::string value{};              ///< as spelled on the command line
  std::optional<JsonValue> json{};  ///< replaces `value` if it comes from a file
  std::filesystem::path base{};     ///< absolute; relative paths start here; empty: the working folder
  std::string where{};              ///< for messages
  Place place{};                    ///< for overrides in the graph file itself
  Source source{};
  bool allows_reading = false;  ///< a sandbox lets nodes read the path that it names
  /// Its position among those given to load_graph, which sets it; empty for others, such as those of presets.
  std::optional<size_t> position{};

  Diagnostics diagnostics(std::vector<Problem>& all) const;
  /// The unexpanded value for this parameter.
  JsonValue json_for(const Param& param) const;
};

/// Sets one member of `map` to the override's value. Nullopt, after a problem, if `map` is no object.
std::optional<JsonValue> with_member(JsonValue map, const std::string& member, const Override& by,
                                     std::vector<Problem>& problems);

/// Sets `target`, a graph parameter ("seed") or one of a node ("layout.seed", also a port), to a value as the command
/// line spells it. Loading reports targets that are malformed.
Override override_of(const std::string& target, const std::string& value);

/// The same for texts: `name=value`, `node.parameter=value`.
std::vector<Override> overrides_from(const std::vector<std::string>& texts);

/// The members of an object, {"seed": 3, "weighted.weights": {"height": 2}}, as overrides. `where`: a prefix for
/// messages. `in_graph`: the object is in the graph file itself, so problems have places in it.
std::vector<Override> read_override_object(const JsonValue& object, const std::filesystem::path& base,
                                           const std::string& where, bool in_graph, std::vector<Problem>& problems);

/// The same for a settings file, which holds such an object. Relative paths start at its folder. Errors in the file
/// become problems.
std::vector<Override> read_settings(const std::filesystem::path& file, std::vector<Problem>& problems);

}  // namespace terrazzo

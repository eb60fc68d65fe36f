#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "graphs/text/graph.h"

namespace terrazzo {

/// One thing that a stage's result depends on. `what` and `digest` are in the key; `shown` is for display only, and may
/// name files and nodes.
struct Ingredient {
  std::string what;  ///< "type", "parameter seed", "input features", "file height.png"
  Digest digest;
  std::string shown;
};

/// Digests of the values at a node's inputs, by port, in the document's order.
using InputNames = std::map<std::string, std::vector<Digest>>;

/// Everything a stage's result depends on: its type and version, its parameters, the names of its inputs, and the
/// content of the files it reads. A path whose content is covered by `files_read` counts by that content and by the
/// files' places relative to it, not by where it lies.
std::vector<Ingredient> ingredients_of(const GraphNode& node, const InputNames& inputs,
                                       const std::function<Digest(const std::filesystem::path&)>& file_digest);

/// Where `file` lies below `path`: "." if it is that path; empty if it lies elsewhere.
std::filesystem::path place_under(const std::filesystem::path& path, const std::filesystem::path& file);

/// The key of a stage made of these ingredients.
Digest key_of(const std::vector<Ingredient>& ingredients);

/// The digest of a lazy output: it names the recipe, before anything is computed.
Digest derived_name(const Digest& key, std::string_view port);

/// A parameter's value for display, shortened if long.
std::string shown_value(const ParamValue& value);

}  // namespace terrazzo

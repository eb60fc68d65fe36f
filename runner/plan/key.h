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
/// content of the files it reads. A path parameter whose content is covered by `files_read` contributes that content
/// and the files' relative paths, not its own location.
std::vector<Ingredient> ingredients_of(const GraphNode& node, const InputNames& inputs,
                                       const std::function<Digest(const std::filesystem::path&)>& file_digest);

/// The path of `file` relative to `path`: "." if they are equal; empty if it is not below `path`.
std::filesystem::path place_under(const std::filesystem::path& path, const std::filesystem::path& file);

/// The key of a stage made of these ingredients.
Digest key_of(const std::vector<Ingredient>& ingredients);

/// The digest of a lazy output: the digest of its recipe, known before anything is computed.
Digest derived_name(const Digest& key, std::string_view port);

/// A parameter's value for display, shortened if long.
std::string shown_value(const ParamValue& value);

}  // namespace terrazzo

#pragma once

#include <filesystem>
#include <string>

#include "core/filter/lone_feature.h"
#include "core/node/node.h"

namespace terrazzo {

/// For NodeType::lint of nodes that read an exemplar's colours: warns if most of it has one colour, if it is lit
/// from one side, or if it shows something only once. Each message begins with `subject`. Reads the file and ignores
/// errors in it.
Lints lint_of_colour(const std::string& subject, const std::filesystem::path& file);

/// What to say of something that an exemplar shows only once.
std::string lone_feature_message(const std::string& subject, const LoneFeature& lone);

}  // namespace terrazzo

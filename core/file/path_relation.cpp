#include "core/file/path_relation.h"

namespace terrazzo {

bool lies_in(const std::filesystem::path& folder, const std::filesystem::path& path) {
  const std::filesystem::path inside = path.lexically_relative(folder);
  return !inside.empty() && *inside.begin() != "..";
}

}  // namespace terrazzo

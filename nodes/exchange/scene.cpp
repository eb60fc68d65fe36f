#include "nodes/exchange/scene.h"

#include <algorithm>

#include "core/base/text.h"

namespace terrazzo {

const SceneFile* MaterialScene::find(std::string_view map) const {
  const auto at = std::ranges::find_if(files, [&](const SceneFile& f) { return f.content->find(map) != nullptr; });
  return at == files.end() ? nullptr : &*at;
}

const SceneFile* MaterialScene::find_alone(std::string_view map) const {
  const auto at = std::ranges::find_if(files, [&](const SceneFile& f) { return f.content->whole_map() == map; });
  return at == files.end() ? nullptr : &*at;
}

std::string identifier(const std::string& name) {
  std::string out;
  for (const char c : name) out += is_word(c) ? c : '_';
  return out.empty() || is_digit(out.front()) ? "m_" + out : out;
}

}  // namespace terrazzo

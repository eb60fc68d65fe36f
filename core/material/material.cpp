#include "core/material/material.h"

#include <stdexcept>

#include <fmt/format.h>

#include "core/base/error.h"

namespace terrazzo {

std::optional<Semantic> semantic_of_map(const std::string& map) {
  for (const std::string_view name : semantic_names)
    if (map == name || map.starts_with(std::string(name) + "_")) return semantic_from(name);
  return std::nullopt;
}

Material::Material(std::string name, std::vector<Map> maps, PhysicalSize metres)
    : name_(std::move(name)), maps_(std::move(maps)), metres_(metres) {
  Hasher h;
  h.add("material").add(name_).add(int64_t(maps_.size()));
  for (const Map& m : maps_) h.add(m.name).add(m.image->digest());
  if (metres_.is_known()) h.add(metres_.width).add(metres_.height);
  digest_ = h.digest();
}

MaterialPtr Material::make(std::string name, std::vector<Map> maps, PhysicalSize metres) {
  if (maps.empty()) throw Error("a material needs at least one map");
  for (const Map& m : maps)
    if (!m.image) throw std::logic_error(fmt::format("the map \"{}\" of a material is null", m.name));
  for (size_t i = 0; i < maps.size(); i++)
    for (size_t j = 0; j < i; j++)
      if (maps[i].name == maps[j].name)
        throw Error(fmt::format("the material has two maps named \"{}\"", maps[i].name));
  return MaterialPtr(new Material(std::move(name), std::move(maps), metres));
}

MaterialPtr Material::of(const ImagePtr& image) {
  const std::string name(name_of(image->info().semantic));
  return make(name, {{name, image}});
}

ImagePtr Material::find(std::string_view map) const {
  for (const Map& m : maps_)
    if (m.name == map) return m.image;
  return nullptr;
}

ImagePtr Material::find(Semantic semantic) const {
  for (const Map& m : maps_)
    if (m.image->info().semantic == semantic) return m.image;
  return nullptr;
}

Size Material::size() const {
  Size best;
  for (const Map& m : maps_)
    if (m.image->size().area() > best.area()) best = m.image->size();
  return best;
}

std::string Material::map_names() const {
  std::string names;
  for (const Map& m : maps_) names += (names.empty() ? "" : ", ") + m.name;
  return names;
}

}  // namespace terrazzo

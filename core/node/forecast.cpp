#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/exemplar/appearance.h"
#include "core/exemplar/features.h"
#include "core/node/node.h"

namespace terrazzo {

namespace {

struct ForecastOf {
  Forecast operator()(const ImagePtr& image) const { return {.images = {{"", facts_of(image->info())}}}; }
  Forecast operator()(const MaterialPtr& material) const {
    Forecast out{.possible_maps = Texts{}};
    for (const Map& m : material->maps()) {
      out.maps.push_back(m.name);
      out.images[m.name] = facts_of(m.image->info());
    }
    return out;
  }
  Forecast operator()(const FeaturesPtr& features) const { return {.size = features->size()}; }
  Forecast operator()(const AppearancePtr& appearance) const { return {.size = appearance->size()}; }
  Forecast operator()(const IndexPtr& index) const { return {.size = index->appearance()->size()}; }
  Forecast operator()(const UvMapPtr& uv) const { return {.size = uv->size(), .exemplar = uv->exemplar()}; }
  Forecast operator()(const ReportPtr&) const { return {}; }
};

std::string contradiction(const ImageFacts& foreseen, const ImageInfo& image) {
  if (agrees(foreseen, image)) return {};
  return fmt::format("{} in {}, where {} in {} was foreseen", describe(facts_of(image)), image.color_space,
                     describe(foreseen), foreseen.color_space.value_or("some colour space"));
}

std::string contradiction(const Forecast& foreseen, const Material& material) {
  const auto is_listed = [](const std::vector<std::string>& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
  };
  for (const std::string& map : foreseen.maps)
    if (!material.find(map)) return fmt::format("no map \"{}\", which was foreseen", map);
  for (const Map& m : material.maps()) {
    if (foreseen.possible_maps && !is_listed(foreseen.maps, m.name) && !is_listed(*foreseen.possible_maps, m.name))
      return fmt::format("a map \"{}\", where only {} were foreseen", m.name, fmt::join(foreseen.maps, ", "));
    const auto facts = foreseen.images.find(m.name);
    if (facts == foreseen.images.end()) continue;
    if (const std::string what = contradiction(facts->second, m.image->info()); !what.empty())
      return fmt::format("{}: {}", m.name, what);
  }
  return {};
}

std::string contradiction(const char* what, const std::optional<Size>& foreseen, const std::optional<Size>& found) {
  if (!foreseen || !found || *foreseen == *found) return {};
  return fmt::format("{} {}, where {} was foreseen", what, describe(*found), describe(*foreseen));
}

}  // namespace

Forecast forecast_of(const Value& value) {
  return std::visit(ForecastOf{}, value);
}

Forecast converted(const Forecast& forecast, ValueType from, ValueType to) {
  if (from != ValueType::image || to != ValueType::material) return forecast;
  const auto image = forecast.images.find("");
  if (image == forecast.images.end() || !image->second.semantic) return {};
  const std::string name(name_of(*image->second.semantic));
  return {.maps = {name}, .possible_maps = Texts{}, .images = {{name, image->second}}};
}

std::string contradiction(const Forecast& forecast, const Value& value) {
  if (const auto* image = std::get_if<ImagePtr>(&value)) {
    const auto facts = forecast.images.find("");
    return facts == forecast.images.end() ? "" : contradiction(facts->second, (*image)->info());
  }
  if (const auto* material = std::get_if<MaterialPtr>(&value)) return contradiction(forecast, **material);
  const Forecast found = forecast_of(value);
  const std::string size = contradiction("a size of", forecast.size, found.size);
  return size.empty() ? contradiction("an exemplar of", forecast.exemplar, found.exemplar) : size;
}

}  // namespace terrazzo

#include "runner/plan/memory_advice.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

/// The input of a node that could be scaled down.
struct Source {
  const char* what = "";
  Size size{};
};

std::optional<Size> size_of(const Forecast& value, ValueType type) {
  if (type == ValueType::image) {
    const auto image = value.images.find("");
    return image == value.images.end() ? std::nullopt : image->second.size;
  }
  return value.size ? value.size : material_size(value);
}

/// The largest exemplar, else the largest image. Uv maps are results and do not count.
Source source_of(const NodeType& type, const InputForecasts& inputs) {
  Source exemplar{"exemplar"}, image{"image"};
  for (const auto& [port, wires] : inputs) {
    const ValueType value = type.find_input(port)->type;
    if (value == ValueType::uv_map) continue;
    Source& source = value == ValueType::image ? image : exemplar;
    for (const Forecast& f : wires)
      if (const Size size = size_of(f, value).value_or(Size{}); size.area() > source.size.area()) source.size = size;
  }
  return exemplar.size.area() > 0 ? exemplar : image;
}

Size scaled(Size size, double factor) {
  return {std::max(1, int(size.width * factor)), std::max(1, int(size.height * factor))};
}

/// The inputs for a scaled source; results keep their size.
InputForecasts scaled(const NodeType& type, InputForecasts inputs, double factor) {
  for (auto& [port, wires] : inputs)
    for (Forecast& f : wires) {
      if (f.exemplar) f.exemplar = scaled(*f.exemplar, factor);
      if (f.size && type.find_input(port)->type != ValueType::uv_map) f.size = scaled(*f.size, factor);
      for (auto& [map, image] : f.images)
        if (image.size) image.size = scaled(*image.size, factor);
    }
  return inputs;
}

/// Approximately the largest scale of the source for which the budget suffices; nullopt if there is none.
std::optional<double> fitting_scale(const NodeType& type, const Params& params, const InputForecasts& inputs,
                                    uint64_t least, uint64_t budget) {
  constexpr int most_tries = 6;
  constexpr double least_scale = 1.0 / 16,
                   margin = 0.95;  // not measured: for memory that does not shrink with the source
  double scale = 1;
  for (int i = 0; i < most_tries && scale >= least_scale; i++) {
    if (least <= budget) return scale;
    scale *= std::sqrt(double(budget) / double(least)) * (i > 0 ? margin : 1);
    least = type.memory_ahead(params, scaled(type, inputs, scale));
  }
  return std::nullopt;
}

}  // namespace

std::string memory_advice(const NodeType& type, const Params& params, const InputForecasts& inputs, uint64_t least,
                          uint64_t budget) {
  constexpr uint64_t mib = 1 << 20;
  const uint64_t takes = (least + mib - 1) / mib;
  const Source source = source_of(type, inputs);
  const std::optional<double> scale =
      source.size.area() > 0 ? fitting_scale(type, params, inputs, takes * mib, budget) : std::nullopt;
  const std::string otherwise = scale ? fmt::format("scale the {} to {} first, as the node type \"resize\" does",
                                                    source.what, describe(scaled(source.size, *scale)))
                                      : "make a smaller result";
  return fmt::format("it takes about {} MiB{}, and --memory gives {:.0f} MiB. Give --memory {}M, or {}", takes,
                     scale ? fmt::format(" for an {} of {}", source.what, describe(source.size)) : "",
                     double(budget) / double(mib), takes, otherwise);
}

}  // namespace terrazzo

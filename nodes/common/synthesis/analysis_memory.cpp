#include "nodes/common/synthesis/analysis_memory.h"

#include "core/exemplar/features.h"
#include "core/image_io/color.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

size_t AnalysisMemory::of(const Material& exemplar) const {
  int values = 0;
  for (const Map& map : exemplar.maps()) values += map.image->channels();
  return size_t(exemplar.size().area()) * (per_pixel + uint64_t(values) * per_value);
}

size_t AnalysisMemory::of(const Features& features) const {
  return size_t(features.size().area()) * (per_pixel + uint64_t(features.channel_count()) * per_value);
}

uint64_t AnalysisMemory::of(const Forecast& exemplar) const {
  const std::optional<Size> size = exemplar.size ? exemplar.size : material_size(exemplar);
  if (!size) return 0;
  const int values = exemplar.values > 0 ? exemplar.values : values_of(exemplar);
  return uint64_t(size->area()) * (per_pixel + uint64_t(values) * per_value);
}

int values_of(const Forecast& material) {
  int values = 0;
  for (const std::string& map : material.maps) values += value_channels(map_of(material, map)).value_or(1);
  return values;
}

void set_analysis_memory(NodeType& type, const std::string& port, const AnalysisMemory& memory) {
  type.memory_ahead = [port, memory](const Params&, const InputForecasts& inputs) {
    return memory.of(inputs.at(port).front());
  };
  const bool is_material = type.find_input(port)->type == ValueType::material;
  type.memory_hint = [port, memory, is_material](const NodeContext& node) {
    return is_material ? memory.of(*node.input<Material>(port)) : memory.of(*node.input<Features>(port));
  };
}

}  // namespace terrazzo

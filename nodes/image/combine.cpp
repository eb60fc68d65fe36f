#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/color.h"
#include "core/material/map_names.h"
#include "nodes/common/exemplar_atlas.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

void require_masks(size_t masks, size_t materials) {
  if (masks == 0 || masks == materials) return;
  throw Error("masks", fmt::format("expected {}, one for each material, or none; found {}",
                                   counted(int64_t(materials), "mask"), masks));
}

void compute(NodeContext& node) {
  const auto materials = node.list<Material>("materials");
  const auto masks = node.list<Image>("masks");
  std::vector<Exemplar> exemplars;
  for (size_t i = 0; i < materials.size(); i++)
    exemplars.push_back(masked_exemplar(materials[i], masks.empty() ? nullptr : masks[i]));
  output_atlas(node, exemplars, "fewer materials");
}

OutputForecasts infer(const Params& params, const InputForecasts& inputs) {
  std::vector<KnownMaps> materials;
  for (const Forecast& f : inputs.at("materials")) materials.push_back({"", f.maps, f.possible_maps});
  check_all([&] { require_same_maps("materials", materials); },
            [&] { require_masks(wires_at(inputs, "masks"), materials.size()); });
  for (size_t i = 0; i < materials.size(); i++) require_mask_of(inputs, "masks", i, inputs.at("materials")[i]);
  return atlas_forecast(inputs.at("materials"), int(std::get<int64_t>(params.at("gap"))),
                        [](const std::vector<MaterialPtr>& all) {
                          std::vector<Exemplar> exemplars;
                          for (const MaterialPtr& m : all) exemplars.push_back({m, nullptr});
                          return exemplars;
                        });
}

}  // namespace

NodeType combine_node() {
  NodeType t;
  t.name = "combine";
  t.category = "image";
  t.summary = "Lays several exemplars side by side as one";
  t.help =
      "For making one result from several exemplars of a surface, such as photographs of neighbouring spots, or a "
      "clean and a worn one. The material goes wherever an exemplar goes: weight, guidance, resolve_uv. Connect the "
      "mask to \"weight\", so that the gaps are never shown, and set \"tiles\" to no in all analysis nodes. Connect "
      "the labels to \"regularity\", so that each exemplar gets its own lattice and joints of bricks and tiles meet, "
      "or to \"transfer\", to steer which exemplar is used where. Exemplars must have the same maps; sizes may differ. "
      "Pixels do not change, except that colours and normals take the first exemplar's colour space and convention.";
  t.inputs = {{.name = "materials", .type = ValueType::material, .help = "the exemplars", .list = true},
              {.name = "masks",
               .type = ValueType::image,
               .help = "for each exemplar where it may be sampled: white (above 0.5), 1 channel",
               .optional = true,
               .list = true}};
  t.outputs = atlas_outputs();
  t.params = atlas_params();
  t.persist = Persist::derived;
  t.files_read = [](const Params&) { return color_config_files(); };
  t.compute = compute;
  t.infer = infer;
  return t;
}

}  // namespace terrazzo

#include "core/procedural/noise.h"

#include <algorithm>

#include "nodes/common/node_helpers.h"

namespace terrazzo {

namespace {

const std::vector<std::string>& basis_names() {
  static const std::vector<std::string> names = {"value", "perlin", "simplex", "worley", "worley_edges"};
  return names;
}

const std::vector<std::string>& fractal_names() {
  static const std::vector<std::string> names = {"fbm", "ridged", "turbulence"};
  return names;
}

std::vector<std::string> meanings() {
  std::vector<std::string> names;
  for (const std::string_view n : semantic_names)
    if (n != name_of(Semantic::normal)) names.emplace_back(n);
  return names;
}

template <typename T>
T chosen(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<T>(std::find(names.begin(), names.end(), name) - names.begin());
}

void compute_noise(NodeContext& node) {
  const ImageInfo info = generated_info(node, 1);
  NoiseSpec spec;
  spec.basis = chosen<NoiseBasis>(basis_names(), node.text("basis"));
  spec.fractal = chosen<Fractal>(fractal_names(), node.text("fractal"));
  spec.across = node.text("unit") == "pixels" ? info.size.width / node.number("scale") : node.number("scale");
  spec.octaves = int(node.integer("octaves"));
  spec.lacunarity = node.number("lacunarity");
  spec.gain = node.number("gain");
  spec.seed = uint64_t(node.integer("seed"));
  spec.tileable = node.flag("tileable");
  node.output("image", noise_image(spec, info, node.key()));
}

std::vector<Param> noise_params() {
  return {
      {.name = "basis",
       .type = ParamType::choice,
       .fallback = "perlin",
       .help = "The noise of one octave.",
       .choices = basis_names()},
      {.name = "fractal",
       .type = ParamType::choice,
       .fallback = "fbm",
       .help = "How octaves are summed: as they are (fbm), as sharp crests (ridged), or folded at the middle "
               "(turbulence).",
       .choices = fractal_names()},
      generated_size_param(),
      {.name = "scale",
       .type = ParamType::number,
       .fallback = 8.0,
       .help = "Number or size of the coarsest features, see unit.",
       .min = 0.01,
       .max = 65536},
      {.name = "unit",
       .type = ParamType::choice,
       .fallback = "across",
       .help = "What scale counts: features across the image's width (more is finer), or pixels per feature (more is "
               "coarser).",
       .choices = {"across", "pixels"}},
      {.name = "octaves",
       .type = ParamType::integer,
       .fallback = int64_t{5},
       .help = "Layers of noise. More adds finer detail; 1 is the basis alone.",
       .min = 1,
       .max = 16},
      {.name = "lacunarity",
       .type = ParamType::number,
       .fallback = 2.0,
       .help = "How many times finer each octave is than the one before.",
       .min = 1,
       .max = 4},
      {.name = "gain",
       .type = ParamType::number,
       .fallback = 0.5,
       .help = "Amplitude of each octave relative to the one before. Higher is rougher.",
       .min = 0,
       .max = 1},
      {.name = "seed",
       .type = ParamType::integer,
       .fallback = int64_t{1},
       .help = "Another number gives another noise of the same kind.",
       .min = 0},
      {.name = "tileable",
       .type = ParamType::boolean,
       .fallback = false,
       .help = "The noise wraps around without a seam; features per octave are rounded to whole numbers."},
      generated_semantic_param("height", meanings()),
  };
}

}  // namespace

NodeType noise_node() {
  NodeType t;
  t.name = "noise";
  t.category = "source";
  t.summary = "Generates procedural noise";
  t.help =
      "Value, Perlin (gradient) and simplex noise, Worley's distance to scattered points (worley) or to the borders "
      "between them (worley_edges), summed over octaves. Pixels are computed on demand, so a huge noise costs nothing "
      "until it is read. Values are in 0..1 and fit a 16-bit file.";
  t.outputs = {{.name = "image", .type = ValueType::image, .help = "one channel, 0..1"}};
  t.params = noise_params();
  t.persist = Persist::derived;
  t.infer = [](const Params& params, const InputForecasts&) { return forecast_of_generated(params, 1); };
  t.compute = compute_noise;
  return t;
}

}  // namespace terrazzo

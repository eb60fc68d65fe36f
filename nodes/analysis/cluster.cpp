#include <fmt/format.h>

#include "core/analysis/space/clusters.h"
#include "core/analysis/space/weighting.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/image_facts.h"
#include "core/image_io/color.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

/// Pixels with the channels of both.
Planes joined(const Planes& a, const Planes& b) {
  Planes out{a.size, a.channels + b.channels, a.wraps, {}};
  out.values.reserve(a.values.size() + b.values.size());
  for (int y = 0; y < a.size.height; y++)
    for (int x = 0; x < a.size.width; x++) {
      out.values.insert(out.values.end(), a.at(x, y), a.at(x, y) + a.channels);
      out.values.insert(out.values.end(), b.at(x, y), b.at(x, y) + b.channels);
    }
  return out;
}

void require_any(bool features, bool images) {
  if (!features && !images)
    throw Error("features", "expected something to cluster by: connect \"features\" or \"images\", or both");
}

Planes planes_of(const NodeContext& node) {
  const auto features = node.optional_input<Features>("features");
  std::vector<ImagePtr> images;
  for (const ImagePtr& image : node.list<Image>("images")) images.push_back(analysis_image(image));
  const Size size = features ? features->size() : images.front()->size();
  if (images.empty()) return *weighted_planes(*features, node.task());
  std::vector<FeatureImage> channels;
  for (const ImagePtr& image : images) channels.push_back({image, std::vector<double>(size_t(image->channels()), 1.0)});
  const bool wraps = features && features->wraps();
  const Planes of_images = *weighted_planes(*Features::make(size, std::move(channels), wraps), node.task());
  return features ? joined(*weighted_planes(*features, node.task()), of_images) : of_images;
}

OutputForecasts infer_cluster(const Params&, const InputForecasts& inputs) {
  const Forecast* features = forecast_at(inputs, "features");
  const size_t images = wires_at(inputs, "images");
  require_any(features != nullptr, images > 0);
  const std::optional<Size> size = features ? features->size : image_at(inputs, "images").size;
  for (size_t i = 0; i < images; i++)
    if (const ImageFacts image = image_at(inputs, "images", i); size && image.size && *image.size != *size)
      throw Error("images", fmt::format("expected {}, the size of the {}; found {}", describe(*size),
                                        features ? "features" : "first image", describe(image)));
  const Forecast out = forecast_of_image(values_facts(size, Semantic::guidance));
  return {{"labels", out}, {"distance", out}};
}

std::string described(const Clusters& clusters) {
  std::vector<int64_t> counts(size_t(clusters.count), 0);
  for (const uint8_t label : clusters.labels) counts[label]++;
  std::string text = fmt::format("{}:", counted(clusters.count, "cluster"));
  for (const int64_t n : counts) text += fmt::format(" {:.1f} %", 100.0 * double(n) / double(clusters.labels.size()));
  return text;
}

void compute_cluster(NodeContext& node) {
  const Planes planes = box_blurred(planes_of(node), node.number("smoothing"), node.task());
  const ClusterOptions options{int(node.integer("k")), int(node.integer("iterations")), uint64_t(node.integer("seed"))};
  Clusters clusters = find_clusters(planes, options, node.task());
  node.note(described(clusters));
  ImageInfo info{.size = planes.size, .channels = 1, .semantic = Semantic::guidance};
  node.output("distance", Image::from_floats(info, std::move(clusters.distances)));
  info.depth = Depth::u16;
  std::vector<float> labels(clusters.labels.size());
  const double steps = std::max(1, clusters.count - 1);
  std::transform(clusters.labels.begin(), clusters.labels.end(), labels.begin(),
                 [steps](uint8_t label) { return float(label / steps); });
  node.output("labels", Image::from_floats(info, std::move(labels)));
}

}  // namespace

NodeType cluster_node() {
  NodeType t;
  t.name = "cluster";
  t.category = "analysis";
  t.summary = "Sorts pixels into groups of similar values (k-means)";
  t.help =
      "Segments an exemplar into what it is made of: stones and mortar, rust and paint. k-means (Lloyd 1982) with "
      "k-means++ seeds (Arthur & Vassilvitskii 2007) on features, images or both; images are first normalised to equal "
      "variance. Connect the responses of \"filter_bank\" to segment by texture. Use the labels as guidance, as "
      "controls of \"transfer\", or through \"threshold\" as masks. Clusters are ordered by their first channel, dark "
      "to light for colours, so that seeds that find the same clusters give the same labels.";
  t.inputs = {{.name = "features", .type = ValueType::features, .help = "weighted channels", .optional = true},
              {.name = "images",
               .type = ValueType::image,
               .help = "images of the same size, colours compared in Oklab",
               .optional = true,
               .list = true}};
  t.outputs = {image_port("labels", "cluster number, 0 for the first to 1 for the last: i / (clusters - 1)"),
               image_port("distance", "distance of each pixel from its cluster's centre, in standard deviations")};
  t.params = {{.name = "k",
               .type = ParamType::integer,
               .fallback = int64_t{4},
               .help = "Number of clusters; fewer if there are fewer different values.",
               .min = 1,
               .max = 64},
              {.name = "smoothing",
               .type = ParamType::number,
               .fallback = 0.0,
               .help = "Standard deviation of a Gaussian blur beforehand; more gives larger, smoother regions.",
               .min = 0,
               .max = 1000,
               .unit = "pixels"},
              {.name = "iterations",
               .type = ParamType::integer,
               .fallback = int64_t{50},
               .help = "Maximum number of iterations; ends earlier once no pixel changes its cluster.",
               .min = 1,
               .max = 1000},
              {.name = "seed",
               .type = ParamType::integer,
               .fallback = int64_t{1},
               .help = "Another number starts from other pixels.",
               .min = 0}};
  t.files_read = [](const Params&) { return color_config_files(); };
  t.compute = compute_cluster;
  t.infer = infer_cluster;
  return t;
}

}  // namespace terrazzo

#pragma once

#include <string_view>
#include <vector>

#include "core/node/node.h"
#include "core/synthesis/synthesize.h"

/// Helpers for synthesis nodes.
namespace terrazzo {

Port index_port();
Port uv_output();

/// Parameter "size" of the result.
Param result_size_param();
/// A parameter for the size of a whole surface; sides from `least` to largest_surface pixels.
inline constexpr int largest_surface = 65536;
Param surface_param(std::string name, std::string help, int least);
/// Parameter "tileable": directions in which the result wraps around.
Param tileable_param();
/// Parameter "whole_bricks", of nodes that make whole surfaces.
Param whole_bricks_param();
/// The same for nodes that keep pixels; courses are not laid between kept pixels.
Param whole_bricks_between_kept_param();
/// The node's `own` parameters, followed by those of every synthesis node: seed, quality, coherence, evenness and
/// jitter.
std::vector<Param> with_synthesis_params(std::vector<Param> own);
/// Checks these parameters; for NodeType::check.
std::vector<std::string> check_synthesis_params(const Params& params);

/// The values of the parameters above; "size", "tileable" and "whole_bricks" if the node has them.
SynthesisOptions synthesis_options(const NodeContext& node, const Index& index);

/// For NodeType::infer: throws Error about port "uv" if its uv map is known to refer to another exemplar than "index".
void require_same_exemplar(const InputForecasts& inputs);

/// Warns if a wrapping result does not fit (nearly) a whole number of the exemplar's repeats: states the `consequence`
/// and names the nearest size that fits.
void warn_unless_repeats_fit(NodeContext& node, const Index& index, const SynthesisOptions& options,
                             std::string_view consequence);

/// For exemplars of several parts: notes each part's share of the result. If `all_expected`, warns of parts that are
/// missing although there is room for them.
void tell_of_parts(NodeContext& node, const Index& index, const UvMap& result, bool all_expected);

/// Warns if a result shows less surface than its exemplar, which is probably unintended.
void warn_of_less_surface(NodeContext& node, const Index& index, Size result);

/// A mask of the result: 1 for new pixels, 0 for kept ones.
ImagePtr new_pixels_mask(const UvMap& result, const ExistingPixels& kept);

}  // namespace terrazzo

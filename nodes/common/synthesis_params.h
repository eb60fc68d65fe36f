#pragma once

#include <string_view>
#include <vector>

#include "core/node/node.h"
#include "core/synthesis/synthesize.h"

/// What synthesis nodes share.
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
/// The same parameter of nodes that keep pixels: courses are not laid between those.
Param whole_bricks_between_kept_param();
/// `own` parameters, followed by those of every synthesis: seed, quality, coherence, evenness, and jitter.
std::vector<Param> with_synthesis_params(std::vector<Param> own);
/// Checks them; for NodeType::check.
std::vector<std::string> check_synthesis_params(const Params& params);

/// The values of the parameters above; "size", "tileable" and "whole_bricks" if the node has them.
SynthesisOptions synthesis_options(const NodeContext& node, const Index& index);

/// For rules of shapes: throws Error about port "uv" if its uv map was certainly not made for the exemplar of "index".
void require_same_exemplar(const InputForecasts& inputs);

/// Warns if a result that wraps does not hold (nearly) a whole number of the exemplar's repeats: states the
/// `consequence` and names the nearest size that does.
void warn_unless_repeats_fit(NodeContext& node, const Index& index, const SynthesisOptions& options,
                             std::string_view consequence);

/// For exemplars of several parts: notes the share of the result that shows each and, if `all_expected`, warns of parts
/// that are not shown although there is room.
void tell_of_parts(NodeContext& node, const Index& index, const UvMap& result, bool all_expected);

/// Warns if a result shows less surface than its exemplar, which is hardly what anyone wants.
void warn_of_less_surface(NodeContext& node, const Index& index, Size result);

/// A mask of a result: white where it does not show the kept pixels.
ImagePtr new_pixels_mask(const UvMap& result, const ExistingPixels& kept);

}  // namespace terrazzo

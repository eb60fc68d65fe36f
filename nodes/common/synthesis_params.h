#pragma once

#include <string_view>
#include <vector>

#include "core/node/node.h"
#include "core/synthesis/synthesize.h"

/// What nodes that synthesize share.
namespace terrazzo {

Port index_port();
Port uv_output();

/// Parameter "size" of the result.
Param result_size_param();
/// A parameter for the size of a whole surface.
inline constexpr int largest_surface = 65536;
Param surface_param(std::string name, std::string help, int least);
/// Parameter "tileable": directions in which the result wraps around.
Param tileable_param();
/// Parameter "whole_bricks", of nodes that make surfaces anew.
Param whole_bricks_param();
/// `own` parameters, followed by those of every synthesis: seed, quality, coherence, evenness, and jitter.
std::vector<Param> with_synthesis_params(std::vector<Param> own);
/// Checks them; for NodeType::check.
std::vector<std::string> check_synthesis_params(const Params& params);

/// What the parameters above say; "size", "tileable" and "whole_bricks" if the node has them.
SynthesisOptions synthesis_options(const NodeContext& node, const Index& index);

/// Throws Error about port "uv" unless the uv map was made for the exemplar of the index.
void require_same_exemplar(const UvMap& uv, const Index& index);

/// Unless a result that wraps holds a whole number of the exemplar's repeats, or nearly so, warns what becomes of them
/// and names a size near it that does.
void warn_unless_repeats_fit(NodeContext& node, const Index& index, const SynthesisOptions& options,
                             std::string_view consequence);

/// Of an exemplar of several parts: notes how much of the result shows which and, if all are expected, warns of those
/// of which nothing is shown, though there is room for all.
void tell_of_parts(NodeContext& node, const Index& index, const UvMap& result, bool all_expected);

/// A mask of a result: white where it no longer shows what was kept.
ImagePtr made_anew(const UvMap& result, const KeptPixels& kept);

/// What synthesis of so many output pixels needs.
size_t synthesis_memory(Size size);
/// What the coarse levels of a surface need.
size_t coarse_memory(Size surface);

}  // namespace terrazzo

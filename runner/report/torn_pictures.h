#pragma once

#include <string>
#include <vector>

#include "runner/api/session.h"
#include "runner/report/shown_nodes.h"

/// Where results are to be doubted, as pictures.
namespace terrazzo {

/// A result of which most elements are torn: its base colour, dark where nothing is wrong.
struct TornPicture {
  std::string node;
  ImagePtr picture;
};

/// Of every kept uv map whose index was kept, too, and whose elements are broken. `results`: materials of the page;
/// without one that shows the uv map's pixels, the picture is the mask alone. Throws Cancelled.
std::vector<TornPicture> torn_pictures(const Graph& graph, const RunResult& result,
                                       const std::vector<ShownMaterial>& results, const Task& task);

}  // namespace terrazzo

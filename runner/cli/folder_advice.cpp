#include "runner/cli/folder_advice.h"

#include <fmt/format.h>

#include "nodes/source/material_folder.h"

namespace terrazzo {

std::string for_command_line(std::string message, const std::string& folder) {
  const auto replace = [&](std::string_view graph_advice, const std::string& advice) {
    if (const size_t at = message.find(graph_advice); at != message.npos)
      message.replace(at, graph_advice.size(), advice);
  };
  replace(advice_on_map_names,
          fmt::format("rename the files, or name them outright: `terrazzo run graphs/material.json --set material={} "
                      "--set 'exemplar.maps={{\"base_color\": \"FILE\"}}' --set out=OUT`",
                      folder));
  replace(advice_on_one_file,
          fmt::format("for a single picture: `terrazzo run graphs/texture.json --set image={} --set out=OUT`", folder));
  return message;
}

}  // namespace terrazzo

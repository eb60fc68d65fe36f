#include <fmt/format.h>

#include "core/block_file/block_file.h"
#include "core/node/node.h"
#include "core/node/serialize.h"

namespace terrazzo {

namespace {

/// Any file name is allowed, so a typo could overwrite an unrelated file.
void require_no_other_kind(const std::filesystem::path& path) {
  std::error_code missing;
  if (!std::filesystem::is_regular_file(path, missing) || std::filesystem::file_size(path, missing) == 0) return;
  try {
    read_block_file_header(path);
  } catch (const OutdatedFile&) {
    return;  // an analysis of an earlier terrazzo
  } catch (const DamagedFile&) {
    throw Error("path",
                fmt::format("{} exists and is not an analysis; name another file, or remove it", path.string()));
  }
}

}  // namespace

NodeType save_analysis_node() {
  NodeType t;
  t.name = "save_analysis";
  t.category = "sink";
  t.summary = "Writes an index as one portable file";
  t.help =
      "The file holds all that synthesis needs, and none of the exemplar's pixels: make it once and keep or share it "
      "with the material. load_analysis reads it on any machine. It is compressed, versioned and checksummed.";
  t.inputs = {{.name = "index", .type = ValueType::index, .help = "the analysed exemplar"}};
  t.params = {{.name = "path",
               .type = ParamType::path,
               .help = "The file to write, such as bricks.analysis; any name will do."}};
  t.compute = [](NodeContext& node) {
    save_value(node.input<Index>("index"), node.stage(node.text("path")), node.task());
  };
  t.preflight = [](const Params& params, const InputForecasts&) {
    const std::filesystem::path path = std::get<std::string>(params.at("path"));
    require_no_other_kind(path);
    return Forecast{.files = {{"path", path.parent_path(), path.filename().string()}}};
  };
  return t;
}

}  // namespace terrazzo

#include <cerrno>
#include <filesystem>

#include <fcntl.h>
#include <fmt/format.h>

#include "core/file_io.h"
#include "core/node.h"
#include "core/serialize.h"

namespace terrazzo {

namespace {

Value loaded(const std::filesystem::path& path) {
  const ValueFileSummary file = summarize_value_file(path);
  if (file.type != ValueType::index)
    throw Error(fmt::format("expected an index as save_analysis writes it; {} holds a value of type {}", path.string(),
                            name_of(file.type)));
  return load_value(path);
}

void compute(NodeContext& node) {
  try {
    node.output("index", loaded(node.text("path")));
  } catch (const DamagedFile& e) {
    throw Error("path", fmt::format("{}; expected a file that save_analysis wrote", e.what()));
  } catch (const Error& e) {
    throw Error("path", e.what());
  }
}

}  // namespace

NodeType load_analysis_node() {
  NodeType t;
  t.name = "load_analysis";
  t.category = "source";
  t.summary = "Reads an index that save_analysis wrote";
  t.help =
      "Synthesis from the file gives the same uv map, bit for bit, as from the index that was saved, and needs nothing "
      "else. The exemplar's maps come in only where pixels are wanted, and may be other maps than those that were "
      "analysed, or larger ones (see `scale` of resolve_uv): {\"index\": {\"type\": \"load_analysis\", \"path\": "
      "\"bricks.analysis\"}, \"layout\": {\"type\": \"synthesize\", \"index\": \"@index\"}, \"exemplar\": {\"type\": "
      "\"load_material\", \"path\": \"bricks\"}, \"result\": {\"type\": \"resolve_uv\", \"uv\": \"@layout\", "
      "\"material\": \"@exemplar\"}}. A file that is damaged, cut short, of a newer version, or no analysis at all is "
      "refused.";
  t.outputs = {{.name = "index", .type = ValueType::index, .help = "all that synthesis needs"}};
  t.params = {{.name = "path", .type = ParamType::path, .help = "The file."}};
  t.persist = Persist::digest;
  t.files_read = [](const Params& params) {
    return std::vector<std::filesystem::path>{std::get<std::string>(params.at("path"))};
  };
  t.memory_hint = [](const NodeContext& node) {
    std::error_code missing;
    const auto bytes = std::filesystem::file_size(node.text("path"), missing);
    return missing ? size_t{0} : size_t(bytes) * 3;
  };
  t.foresee = [](const Params& params, const InputForecasts&) {
    const std::filesystem::path path = std::get<std::string>(params.at("path"));
    if (!File::open(path, O_RDONLY | O_NONBLOCK).ok()) throw_system_error("read", path, errno);
    return Forecast{};
  };
  t.compute = compute;
  return t;
}

}  // namespace terrazzo

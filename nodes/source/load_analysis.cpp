#include <filesystem>

#include <fmt/format.h>

#include "core/node/node.h"
#include "core/node/serialize.h"

namespace terrazzo {

namespace {

/// Checks that need not read the whole file.
void require_analysis(const std::filesystem::path& path) {
  const ValueFileSummary file = summarize_value_file(path);
  if (file.type != ValueType::index)
    throw Error(fmt::format("expected an index as save_analysis writes it; {} holds a value of type {}", path.string(),
                            name_of(file.type)));
}

/// Rethrows errors of `read` about the parameter "path".
template <class Read>
auto naming_remedy(const Read& read) {
  try {
    return read();
  } catch (const DamagedFile& e) {
    throw Error(
        "path",
        fmt::format("{}; expected a whole file as save_analysis writes it: copy it again, or recreate it", e.what()));
  } catch (const Error& e) {
    throw Error("path", e.what());
  }
}

void compute_load_analysis(NodeContext& node) {
  node.output("index", naming_remedy([&] {
                const std::filesystem::path path = node.text("path");
                require_analysis(path);
                return load_value(path);
              }));
}

}  // namespace

NodeType load_analysis_node() {
  NodeType t;
  t.name = "load_analysis";
  t.category = "source";
  t.summary = "Reads an index that save_analysis wrote";
  t.help =
      "Synthesis from the file gives the same uv map, bit for bit, as from the saved index. The exemplar's maps are "
      "needed only by resolve_uv, and may be more maps than the analysed ones, or larger (see `scale` there): "
      "{\"index\": {\"type\": \"load_analysis\", \"path\": \"bricks.analysis\"}, \"layout\": {\"type\": "
      "\"synthesize\", \"index\": \"@index\"}, \"exemplar\": {\"type\": \"load_material\", \"path\": \"bricks\"}, "
      "\"result\": {\"type\": \"resolve_uv\", \"uv\": \"@layout\", \"material\": \"@exemplar\"}}. Files that are "
      "damaged, truncated, of a newer version, or no analysis are refused.";
  t.outputs = {{.name = "index", .type = ValueType::index, .help = "all that synthesis needs"}};
  t.params = {{.name = "path",
               .type = ParamType::path,
               .help = "The file, or \"library:NAME\" for a named analysis (terrazzo library).",
               .library = LibraryFile::analysis}};
  t.persist = Persist::digest;
  t.files_read = [](const Params& params) {
    return std::vector<std::filesystem::path>{std::get<std::string>(params.at("path"))};
  };
  t.memory_hint = [](const NodeContext& node) {
    std::error_code missing;
    const auto bytes = std::filesystem::file_size(node.text("path"), missing);
    return missing ? size_t{0} : size_t(bytes) * 3;
  };
  t.preflight = [](const Params& params, const InputForecasts&) {
    return naming_remedy([&] {
      const std::filesystem::path path = std::get<std::string>(params.at("path"));
      require_analysis(path);
      return Forecast{.size = exemplar_of_index_file(path)};
    });
  };
  t.compute = compute_load_analysis;
  return t;
}

}  // namespace terrazzo

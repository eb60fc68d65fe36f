#include "graphs/text/read_document.h"

#include <algorithm>
#include <cerrno>
#include <vector>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "core/file/archive.h"
#include "core/file/file_io.h"
#include "core/file/path_spelling.h"
#include "core/image_io/image_file.h"
#include "graphs/text/stock_graphs.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

/// A suggestion for a wrong path.
std::string file_suggestion(const fs::path& path) {
  std::vector<std::string> names;
  std::error_code ended;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  for (fs::directory_iterator at(folder, ended), end; !ended && at != end; at.increment(ended))
    names.push_back(at->path().filename().string());
  std::sort(names.begin(), names.end());
  const std::string best = nearest(path.filename().string(), names);
  return best.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", (path.parent_path() / best).string());
}

}  // namespace

std::string read_document(const fs::path& path, const std::string& what) {
  constexpr uintmax_t most = 64 << 20;
  const auto refuse = [&](const std::string& message) -> GraphError {
    return GraphError(path.string(), {{{}, "", message}});
  };
  if (is_stock(path.string())) try {
      return std::string(named_stock_graph(path.string()));
    } catch (const Error& e) {
      throw refuse(e.what());
    }
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (!fs::exists(status)) {
    const std::string advice = path_advice("", path.string());
    throw refuse(fmt::format("there is no such {}{}", what, advice.empty() ? file_suggestion(path) : "; " + advice));
  }
  if (fs::is_directory(status)) throw refuse(fmt::format("expected a {}, found a folder", what));
  if (is_archive(path))
    throw refuse(
        fmt::format("expected a {}, found a pack or another tar archive; `terrazzo run`, `check`, `draw` and `submit` "
                    "take packs, `tar -xf` unpacks them",
                    what));
  if (looks_like_image(path))
    throw refuse(fmt::format("expected a {}, found an image; graphs load images by their nodes", what));
  if (const std::string kind = irregular_kind(status.type()); !kind.empty())
    throw refuse(fmt::format("expected a {}, found {}; save it as a file first", what, kind));
  try {
    return read_file(path, most);
  } catch (const FileError& e) {
    if (e.code() == EFBIG) throw refuse(fmt::format("expected a {} of at most 64 MiB, found a larger file", what));
    throw refuse(fmt::format("the {} cannot be read: {}", what, system_message(e.code())));
  }
}

std::optional<JsonValue> read_json_document(const fs::path& path, const std::string& what,
                                            std::vector<Problem>& problems) {
  try {
    ParsedJson parsed = parse_json(read_document(path, what));
    for (const Problem& p : parsed.problems)
      problems.push_back({{}, fmt::format("{}:{}:{}", path.string(), p.place.line, p.place.column), p.message});
    return std::move(parsed.value);
  } catch (const GraphError& e) {
    for (const Problem& p : e.problems()) problems.push_back({{}, path.string(), p.message});
    return std::nullopt;
  }
}

}  // namespace terrazzo

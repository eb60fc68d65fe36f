#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/base64.h"
#include "core/file/atomic_file.h"
#include "runner/editor/previews/uv_piece.h"
#include "runner/editor/previews/value_counts.h"
#include "runner/editor/server.h"

namespace terrazzo {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr size_t most_entries = 5000;
constexpr int most_pixels_asked = 64 * 64;

std::string asked_text(const Json& request, const char* name) {
  const auto at = request.find(name);
  if (at == request.end() || at->is_null()) return "";
  if (!at->is_string()) throw Error(fmt::format("expected a text as \"{}\"", name));
  return at->get<std::string>();
}

int asked_number(const Json& request, const char* name) {
  const auto at = request.find(name);
  if (at == request.end() || !at->is_number_integer())
    throw Error(fmt::format("expected a whole number as \"{}\"", name));
  return at->get<int>();
}

/// A name for a file beside the graph: no folders, no hidden files, and an ending that says it is a picture.
void require_picture_name(const std::string& name) {
  constexpr size_t longest = 100;
  const bool is_plain =
      !name.empty() && name.size() <= longest && !name.starts_with('.') && std::ranges::all_of(name, [](char c) {
        return c == '-' || c == '_' || c == '.' || c == ' ' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
               (c >= 'A' && c <= 'Z');
      });
  if (!is_plain || !name.ends_with(".png"))
    throw Error("a picture's name may have letters, digits, spaces, and - _ ., and ends in .png");
}

/// Says nothing of where a link leads.
void require_inside(const Sandbox& sandbox, const char* verb, const fs::path& path) {
  if (!sandbox.trouble_with(verb, path).empty())
    throw Error(fmt::format("{} lies outside of the folders that the editor may use; --allow adds one", path.string()));
}

}  // namespace

void EditorServer::add_calls() {
  calls_ = {
      {"types", [this](const Json&) { return document_.types(); }},
      {"state",
       [this](const Json&) {
         Json out;
         within(sandbox_, [&] { out = document_.state(runs_->findings()); });
         return out;
       }},
      {"edit", editing([this](const Json& request) { return document_.edit(request); })},
      {"undo", editing([this](const Json&) { return document_.undo(); })},
      {"redo", editing([this](const Json&) { return document_.redo(); })},
      {"format", editing([this](const Json&) { return document_.format(); })},
      {"resolve", editing([this](const Json& request) { return document_.resolve(request); })},
      {"copy", [this](const Json& request) { return document_.copy(request); }},
      {"diff", [this](const Json&) { return document_.diff(); }},
      {"presets", [this](const Json& request) { return document_.preset(request); }},
      {"show",
       [this](const Json& request) {
         runs_->show(request);
         return Json::object();
       }},
      {"run", [this](const Json& request) { return start_run(request); }},
      {"cancel",
       [this](const Json&) {
         runs_->cancel();
         return Json::object();
       }},
      {"sweep", [this](const Json& request) { return runs_->sweep(request); }},
      {"end_sweep",
       [this](const Json&) {
         runs_->end_sweep();
         return Json::object();
       }},
      {"plan", [this](const Json&) { return runs_->plan(); }},
      {"files", [this](const Json& request) { return files_in(request); }},
      {"save_picture", [this](const Json& request) { return save_picture(request); }},
      {"pixels", [this](const Json& request) { return pixels_of(request); }},
      {"piece", [this](const Json& request) { return piece_of(request); }},
      {"histogram", [this](const Json& request) { return histogram_of_picture(request); }},
  };
}

Json EditorServer::start_run(const Json& request) {
  const bool sinks = request.value("sinks", false);
  if (sinks && document_.is_read_only()) throw Error("the graph is shown read-only: nothing is written");
  std::vector<NodeOfDocument> nodes;
  if (const auto asked = request.find("nodes"); asked != request.end() && !asked->is_null())
    for (const Json& n : *asked)
      nodes.push_back(n.is_string() ? NodeOfDocument{"", n.get<std::string>()}
                                    : NodeOfDocument{asked_text(n, "level"), asked_text(n, "node")});
  runs_->run(std::move(nodes), sinks);
  return Json::object();
}

/// The folders that may be listed are named by the server; below them, a path. Links that lead out are left out.
Json EditorServer::files_in(const Json& request) const {
  const std::string asked = asked_text(request, "folder");
  const fs::path folder = asked.empty() ? folders_.front() : folders_.front() / asked;
  require_inside(sandbox_, "read", folder);
  std::error_code failure;
  const fs::path resolved = fs::canonical(folder, failure);
  if (failure || !fs::is_directory(resolved, failure)) throw Error(fmt::format("{} is no folder", folder.string()));
  std::vector<std::pair<std::string, bool>> found;
  for (fs::directory_iterator at(resolved, failure), end; !failure && at != end; at.increment(failure)) {
    const std::string name = at->path().filename().string();
    if (name.starts_with('.') || !sandbox_.trouble_with("read", at->path()).empty()) continue;
    std::error_code missing;
    const bool is_folder = fs::is_directory(at->path(), missing);
    if (is_folder || fs::is_regular_file(at->path(), missing)) found.emplace_back(name, is_folder);
    if (found.size() >= most_entries) break;
  }
  std::ranges::sort(found, [](const auto& a, const auto& b) {
    return std::pair(!a.second, a.first) < std::pair(!b.second, b.first);
  });
  Json entries = Json::array();
  for (const auto& [name, is_folder] : found)
    entries.push_back({{"name", name}, {"kind", is_folder ? "folder" : "file"}});
  Json roots = Json::array();
  for (const fs::path& root : folders_) roots.push_back(root.string());
  return {{"folder", resolved.string()}, {"entries", std::move(entries)}, {"roots", std::move(roots)}};
}

Json EditorServer::save_picture(const Json& request) const {
  if (document_.is_read_only()) throw Error("the graph is shown read-only");
  const std::string name = asked_text(request, "name");
  require_picture_name(name);
  const std::optional<std::string> bytes = from_base64(asked_text(request, "png"));
  constexpr std::string_view png = "\x89PNG\r\n\x1a\n";
  if (!bytes || !bytes->starts_with(png)) throw Error("expected a PNG picture in base64");
  const fs::path path = folders_.front() / name;
  require_inside(sandbox_, "write", path);
  std::error_code missing;
  if (fs::is_symlink(fs::symlink_status(path, missing))) throw Error(fmt::format("{} is a link", path.string()));
  write_whole_file(path, *bytes);
  return {{"path", name}};
}

Json EditorServer::pixels_of(const Json& request) {
  const ImagePtr image = pictures_.image(asked_text(request, "digest"));
  if (!image) throw Error("this picture's values are not at hand any more");
  const Rect region{asked_number(request, "x"), asked_number(request, "y"), asked_number(request, "width"),
                    asked_number(request, "height")};
  if (region.x < 0 || region.y < 0 || region.width < 1 || region.height < 1 ||
      region.width > most_pixels_asked / region.height || region.x > image->width() - region.width ||
      region.y > image->height() - region.height)
    throw Error(
        fmt::format("expected up to {} pixels inside of {}x{}", most_pixels_asked, image->width(), image->height()));
  std::vector<float> values(size_t(region.width) * size_t(region.height) * size_t(image->channels()));
  image->read(region, values.data());
  return {{"channels", image->channels()}, {"values", values}};
}

/// Of a picture's exact values, in 128 bins: {low, high, counts: [[..] by channel]}.
Json EditorServer::histogram_of_picture(const Json& request) {
  constexpr int bins = 128;
  const ImagePtr image = pictures_.image(asked_text(request, "digest"));
  if (!image) throw Error("this picture's values are not at hand any more");
  const ValueCounts found = value_counts(*image, bins);
  return {{"low", found.low}, {"high", found.high}, {"counts", found.counts}};
}

/// Of a uv map whose picture is shown: {digest, x, y, exemplar: {width, height}}.
Json EditorServer::piece_of(const Json& request) {
  const ImagePtr image = pictures_.image(asked_text(request, "digest"));
  if (!image) throw Error("this picture's values are not at hand any more");
  const int x = asked_number(request, "x"), y = asked_number(request, "y");
  if (x < 0 || y < 0 || x >= image->width() || y >= image->height())
    throw Error(fmt::format("expected a pixel inside of {}x{}", image->width(), image->height()));
  const Json exemplar = request.value("exemplar", Json::object());
  const UvPiece piece = uv_piece_at(*image, {asked_number(exemplar, "width"), asked_number(exemplar, "height")}, x, y);
  Json runs = Json::array();
  for (const UvPiece::Run& r : piece.runs) {
    runs.push_back(r.y);
    runs.push_back(r.begin);
    runs.push_back(r.end);
  }
  return {{"shift", piece.shift}, {"area", piece.area}, {"whole", piece.is_whole}, {"runs", std::move(runs)}};
}

}  // namespace terrazzo

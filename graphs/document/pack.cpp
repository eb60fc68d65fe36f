#include "graphs/document/pack.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/file/atomic_file.h"
#include "core/file/file_io.h"
#include "core/file/path_relation.h"
#include "core/file/tar.h"
#include "graphs/document/convert.h"
#include "graphs/document/format.h"
#include "graphs/document/read_document.h"
#include "graphs/document/subgraphs.h"
#include "nodes/common/registry.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

JsonValue& member(JsonValue& object, const std::string& name) {
  if (!object.find(name)) object.set(name, JsonValue::empty_object());
  return *object.find(name);
}

/// Takes the graphs that a document's nodes name by file into its section `graphs`.
class Embedding {
 public:
  explicit Embedding(JsonValue& document) : document_(document) {
    if (const JsonValue* graphs = document.find("graphs"))
      for (const JsonMember& m : graphs->members) taken_.insert(m.name);
  }

  void run(const fs::path& folder) {
    embed_in(*document_.find("nodes"), folder);
    if (JsonValue* graphs = document_.find("graphs"))
      for (JsonMember& m : graphs->members)
        if (JsonValue* nodes = m.value.find("nodes")) embed_in(*nodes, folder);
    for (JsonMember& m : embedded_) member(document_, "graphs").members.push_back(std::move(m));
  }

 private:
  void embed_in(JsonValue& nodes, const fs::path& folder) {
    for (JsonMember& m : nodes.members)
      if (JsonValue* type = m.value.find("type"); type && type->text.ends_with(".json"))
        type->text = name_of((folder / type->text).lexically_normal());
  }

  /// The name that the graph in a file has here.
  std::string name_of(const fs::path& file) {
    const auto [at, is_new] = names_.emplace(file, free_name(file.stem().string()));
    std::string name = at->second;
    if (!is_new) return name;
    JsonValue graph = current_document(read_document(file), file.string());
    std::map<std::string, std::string> own;  // the names of its own section `graphs`, here
    std::vector<JsonMember> inner;
    if (const JsonValue* graphs = graph.find("graphs"))
      for (const JsonMember& m : graphs->members) {
        own[m.name] = free_name(m.name);
        inner.push_back({own[m.name], {}, m.value});
      }
    inner.push_back({name, {}, graph});
    for (JsonMember& m : inner) {
      std::erase_if(m.value.members, [](const JsonMember& key) {
        return std::ranges::find(subgraph_keys(), key.name) == subgraph_keys().end();
      });
      JsonValue* nodes = m.value.find("nodes");
      if (!nodes) continue;
      for (JsonMember& n : nodes->members)
        if (JsonValue* type = n.value.find("type"); type && own.contains(type->text)) type->text = own[type->text];
      embed_in(*nodes, file.parent_path());
    }
    for (JsonMember& m : inner) embedded_.push_back(std::move(m));
    return name;
  }

  std::string free_name(const std::string& wanted) {
    std::string plain;
    for (const char c : wanted) plain += is_node_name(std::string(1, c)) ? c : '_';
    std::string out = plain;
    for (int i = 2; find_node_type(out) || !taken_.insert(out).second; i++) out = fmt::format("{}_{}", plain, i);
    return out;
  }

  JsonValue& document_;
  std::set<std::string> taken_;
  std::map<fs::path, std::string> names_;
  std::vector<JsonMember> embedded_;
};

/// Whether a file is this one, or lies in this folder.
class Packing {
 public:
  Packing(const fs::path& graph, const LoadedGraph& loaded, const fs::path& target)
      : file_(graph), loaded_(loaded), archive_(target), settings_(JsonValue::empty_object()) {}

  PackedFiles run() {
    JsonValue document = current_document(read_document(file_), file_.string());
    Embedding(document).run(fs::absolute(file_).parent_path());
    add_presets(document);
    for (const GraphNode& node : loaded_.graph.nodes) pack_inputs(node);
    for (const LoopSource& loop : loaded_.loops) pack_loop(loop);
    for (const GraphParameter& p : loaded_.parameters) set_parameter(document, p);
    archive_.add("graph.json", formatted(document));
    archive_.add("settings.json", formatted(settings_));
    archive_.finish();
    return std::move(out_);
  }

 private:
  void add_presets(JsonValue& document) {
    fs::path beside = file_;
    beside.replace_extension(".presets.json");
    std::error_code missing;
    if (!fs::exists(beside, missing)) return;
    const ParsedJson parsed = parse_json(read_document(beside));
    for (const JsonMember& m : parsed.value->members) member(document, "presets").members.push_back(m);
  }

  void add_file(const std::string& name, const fs::path& file) {
    archive_.add_file(name, file);
    std::error_code missing;
    out_.count++;
    out_.bytes += fs::file_size(file, missing);
  }

  /// Where a file or folder lies in the pack; its files, of which `all` are read, go into it.
  std::string place_of(const fs::path& path, const std::vector<fs::path>& all) {
    const auto [at, is_new] = places_.try_emplace(path);
    if (is_new) at->second = fmt::format("inputs/{}/{}", places_.size(), path.filename().string());
    std::error_code missing;
    for (const fs::path& file : all) {
      const fs::path inside = file.lexically_relative(path);
      if (!fs::is_regular_file(file, missing) || !lies_in(path, file)) continue;
      const std::string name = inside == "." ? at->second : (fs::path(at->second) / inside).generic_string();
      if (packed_.insert(name).second) add_file(name, file);
    }
    return at->second;
  }

  void pack_inputs(const GraphNode& node) {
    if (!node.type->files_read) return;
    const std::vector<fs::path> files = node.type->files_read(node.params);
    std::set<fs::path> rest(files.begin(), files.end());
    for (const Param& param : node.type->params) {
      const auto value = node.params.find(param.name);
      if (param.type != ParamType::path || value == node.params.end()) continue;
      const fs::path path = std::get<std::string>(value->second);
      const auto is_inside = [&](const fs::path& file) { return lies_in(path, file); };
      if (path.empty() || std::ranges::none_of(files, is_inside)) continue;
      std::erase_if(rest, is_inside);
      settings_.set(node.name + "." + param.name, JsonValue::of(place_of(path, files)));
    }
    for (const fs::path& file : rest) out_.left_out.push_back(file.string());
  }

  /// What a loop finds, and only its names: its nodes have their inputs by settings of their own.
  void pack_loop(const LoopSource& loop) {
    const std::string place = fmt::format("loops/{}", loops_++);
    JsonValue given = JsonValue::empty_object();
    std::string what = place + "/" + loop.path.filename().string();
    if (loop.kind == "table") {
      add_file(what, loop.path);
    } else {
      what = place + "/*";
      const std::string prefix = loop.node + "[";
      std::set<std::string> names;
      for (const GraphNode& n : loaded_.graph.nodes)
        if (n.name.starts_with(prefix))
          names.insert(n.name.substr(prefix.size(), n.name.find(']', prefix.size()) - prefix.size()));
      const std::string extension = loop.kind == "files" ? loop.path.extension().string() : "/kept";
      for (const std::string& name : names) archive_.add(place + "/" + name + extension, "");
    }
    given.set(loop.kind, JsonValue::of(what));
    given.set("as", JsonValue::of(loop.as));
    settings_.set(loop.node + ".foreach", std::move(given));
  }

  /// A value that the graph was given becomes the default of its parameter, or, of an input, a setting.
  void set_parameter(JsonValue& document, const GraphParameter& p) {
    if (!p.value) return;
    const bool is_path = p.param.type == ParamType::path;
    if (is_path) {
      const auto place = places_.find(fs::path(std::get<std::string>(*p.value)));
      if (place != places_.end()) {
        settings_.set(p.param.name, JsonValue::of(place->second));
        return;
      }
    }
    if (!p.overridden) return;
    JsonValue& declared = member(member(document, "parameters"), p.param.name);
    declared.set("default", is_path ? JsonValue::of(p.as_written) : json_of(*p.value));
  }

  const fs::path& file_;
  const LoadedGraph& loaded_;
  TarWriter archive_;
  JsonValue settings_;
  PackedFiles out_;
  std::map<fs::path, std::string> places_;
  std::set<std::string> packed_;
  int loops_ = 0;
};

/// Whether unpacking a file of this name stays in the folder.
bool is_safe(const std::string& name) {
  const fs::path path(name);
  bool goes_up = false;
  for (const fs::path& part : path) goes_up |= part == "..";
  return !name.empty() && !path.is_absolute() && !goes_up && !name.ends_with('/') &&
         (name == "graph.json" || name == "settings.json" || name.starts_with("inputs/") || name.starts_with("loops/"));
}

void remove_unused(const fs::path& folder) {
  std::error_code failure;
  const auto month = std::chrono::hours(24 * 30);
  for (const auto& entry : fs::directory_iterator(folder, failure))
    if (fs::file_time_type::clock::now() - entry.last_write_time(failure) > month) fs::remove_all(entry, failure);
}

}  // namespace

PackedFiles write_pack(const fs::path& graph, const std::vector<std::string>& overrides, const LoadOptions& options,
                       const fs::path& target) {
  const LoadedGraph loaded = load_graph(graph, overrides, options);
  return Packing(graph, loaded, target).run();
}

bool is_pack(const fs::path& file) {
  return is_tar(file);
}

fs::path unpacked(const fs::path& pack, const fs::path& folder) {
  const std::vector<TarEntry> entries = tar_entries(pack);
  const auto has = [&](const char* name) { return std::ranges::find(entries, name, &TarEntry::name) != entries.end(); };
  if (!has("graph.json") || !has("settings.json"))
    throw Error(fmt::format(
        "{}: expected a pack (terrazzo pack), found an archive without graph.json and settings.json", pack.string()));
  for (const TarEntry& e : entries)
    if (!is_safe(e.name))
      throw Error(
          fmt::format("{}: the pack holds a file of a name that packs do not have: \"{}\"", pack.string(), e.name));
  fs::path place = folder / content_digest(pack).value_or(Digest()).hex();
  std::error_code failure;
  if (fs::exists(place / "settings.json", failure)) {
    fs::last_write_time(place, fs::file_time_type::clock::now(), failure);
    return place;
  }
  fs::create_directories(folder, failure);
  remove_unused(folder);
  const fs::path temporary = temporary_beside(place);
  for (const TarEntry& e : entries) {
    fs::create_directories((temporary / e.name).parent_path(), failure);
    extract(pack, e, temporary / e.name);
  }
  fs::rename(temporary, place, failure);  // another process may have been faster
  if (failure) fs::remove_all(temporary, failure);
  return place;
}

}  // namespace terrazzo

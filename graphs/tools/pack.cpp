#include "graphs/tools/pack.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/file/archive.h"
#include "core/file/file_io.h"
#include "core/file/path_relation.h"
#include "graphs/document/subgraphs.h"
#include "graphs/text/format.h"
#include "graphs/text/read_document.h"
#include "graphs/values/convert.h"
#include "nodes/common/registry.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

JsonValue& member(JsonValue& object, const std::string& name) {
  if (!object.find(name)) object.set(name, JsonValue::empty_object());
  return *object.find(name);
}

JsonValue object_of(std::map<std::string, JsonValue>& members) {
  JsonValue out = JsonValue::empty_object();
  for (auto& [name, value] : members) out.members.push_back({name, {}, std::move(value)});
  return out;
}

/// Moves graph files that a document's nodes use into its section `graphs`.
class Embedding {
 public:
  explicit Embedding(JsonValue& document) : document_(document) {
    if (const JsonValue* graphs = document.find("graphs"))
      for (const JsonMember& m : graphs->members) taken_.insert(m.name);
  }

  /// Returns sentences about renamed graphs.
  std::vector<std::string> run(const fs::path& folder) {
    embed_in(*document_.find("nodes"), folder);
    if (JsonValue* graphs = document_.find("graphs"))
      for (JsonMember& m : graphs->members)
        if (JsonValue* nodes = m.value.find("nodes")) embed_in(*nodes, folder);
    for (JsonMember& m : embedded_) member(document_, "graphs").members.push_back(std::move(m));
    return std::move(renamed_);
  }

 private:
  void embed_in(JsonValue& nodes, const fs::path& folder) {
    for (JsonMember& m : nodes.members)
      if (JsonValue* type = m.value.find("type"); type && type->text.ends_with(".json"))
        type->text = name_of((folder / type->text).lexically_normal());
  }

  /// The new name of the graph in a file.
  std::string name_of(const fs::path& file) {
    if (const auto known = names_.find(file); known != names_.end()) return known->second;
    std::string name = names_[file] = free_name(file.stem().string(), file.string());
    JsonValue graph = current_document(read_document(file), file.string());
    std::map<std::string, std::string> own;  // new names of the entries of its own section `graphs`
    std::vector<JsonMember> inner;
    if (const JsonValue* graphs = graph.find("graphs"))
      for (const JsonMember& m : graphs->members) {
        own[m.name] = free_name(m.name, fmt::format("\"{}\" of {}", m.name, file.string()));
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

  /// `what`: what the name belongs to, for messages.
  std::string free_name(const std::string& wanted, const std::string& what) {
    std::string plain;
    for (const char c : wanted) plain += is_node_name(std::string(1, c)) ? c : '_';
    std::string out = plain;
    for (int i = 2; find_node_type(out) || !taken_.insert(out).second; i++) out = fmt::format("{}_{}", plain, i);
    if (out != wanted) renamed_.push_back(fmt::format("the subgraph {} is called {} in the pack", what, out));
    return out;
  }

  JsonValue& document_;
  std::set<std::string> taken_;
  std::vector<std::string> renamed_;
  std::map<fs::path, std::string> names_;
  std::vector<JsonMember> embedded_;
};

class Packing {
 public:
  Packing(const fs::path& graph, const LoadedGraph& loaded, const fs::path& target)
      : file_(graph), loaded_(loaded), archive_(write_archive(target)) {
    for (const GraphNode& node : loaded.graph.nodes)
      if (node.type->is_sink())
        for (const auto& [param, sources] : loaded.set_by.at(node.name))
          for (const Settable& s : sources)
            if (s.node.empty()) written_.insert(s.name);
  }

  PackedFiles run() {
    JsonValue document = current_document(read_document(file_), file_.string());
    out_.renamed = Embedding(document).run(fs::absolute(file_).parent_path());
    add_presets(document);
    for (const GraphNode& node : loaded_.graph.nodes) pack_inputs(node);
    for (const LoopSource& loop : loaded_.loops) pack_loop(loop);
    for (const GraphParameter& p : loaded_.parameters) set_parameter(document, p);
    archive_->add("graph.json", formatted(document));
    archive_->add("settings.json", formatted(object_of(settings_)));
    archive_->add("sources.json", formatted(object_of(sources_)));
    archive_->finish();
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
    archive_->add_file(name, file);
    std::error_code missing;
    out_.count++;
    out_.bytes += fs::file_size(file, missing);
  }

  /// The path of a file or folder in the pack. Adds those of its files that are in `all`, the files that are read.
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
      const SetBy& set_by = loaded_.set_by.at(node.name);
      const auto by = set_by.find(param.name);
      add_setting(node.name, param.name, JsonValue::of(place_of(path, files)),
                  by == set_by.end() ? std::vector<Settable>() : by->second);
    }
    for (const fs::path& file : rest) out_.left_out.push_back(file.string());
  }

  /// Removes the labels of loops that do not iterate over any of `sources`: "sub/n" for "sub[a]/n".
  static std::string in_all_iterations(const std::string& node, const std::vector<Settable>& sources) {
    std::string out;
    for (size_t at = 0; at < node.size();) {
      const size_t label = std::min(node.find('[', at), node.size());
      const size_t end = label == node.size() ? label : node.find(']', label) + 1;
      out += node.substr(at, label - at);
      const auto goes_over = [&](const Settable& s) { return s.name == "foreach" && s.node == node.substr(0, label); };
      if (std::ranges::any_of(sources, goes_over)) out += node.substr(label, end - label);
      at = end;
    }
    return out;
  }

  /// Sets a node's parameter or input, unless one of `sources` is set.
  void add_setting(const std::string& node, const std::string& name, JsonValue value,
                   const std::vector<Settable>& sources) {
    const std::string target = in_all_iterations(node, sources) + "." + name;
    JsonValue names;
    names.kind = JsonValue::Kind::list;
    for (const Settable& s : sources)
      names.items.push_back(JsonValue::of(s.node.empty() ? s.name : in_all_iterations(s.node, sources) + "." + s.name));
    settings_.insert_or_assign(target, std::move(value));
    if (!names.items.empty()) sources_.insert_or_assign(target, std::move(names));
  }

  /// Packs the names that a loop finds, without content: its nodes get their inputs by their own settings.
  void pack_loop(const LoopSource& loop) {
    const std::string place = fmt::format("loops/{}", loops_++);
    JsonValue given = JsonValue::empty_object();
    std::string what = place + "/" + loop.path.filename().string();
    if (loop.kind == "table") {
      add_file(what, loop.path);
    } else {
      what = place + "/*/*";
      for (size_t i = 0; i < loop.names.size(); i++)
        archive_->add(fmt::format("{}/{:05}/{}{}", place, i, loop.names[i], loop.kind == "folders" ? "/kept" : ""), "");
    }
    given.set(loop.kind, JsonValue::of(what));
    given.set("as", JsonValue::of(loop.as));
    add_setting(loop.node, "foreach", std::move(given), loop.set_by);
  }

  /// Values given to the graph become defaults of its parameters or, for inputs, settings.
  void set_parameter(JsonValue& document, const GraphParameter& p) {
    if (!p.value) return;
    const bool is_path = p.param.type == ParamType::path;
    if (is_path) {
      const auto place = places_.find(fs::path(std::get<std::string>(*p.value)));
      // Output paths are relative to the pack; derived values follow their parameters.
      if (place != places_.end() && !written_.contains(p.param.name) && !p.formula) {
        settings_.insert_or_assign(p.param.name, JsonValue::of(place->second));
        return;
      }
    }
    if (!p.overridden) return;
    JsonValue& declared = member(member(document, "parameters"), p.param.name);
    declared.set("default", is_path ? JsonValue::of(p.as_written) : json_of(*p.value));
  }

  const fs::path& file_;
  const LoadedGraph& loaded_;
  std::unique_ptr<ArchiveWriter> archive_;
  std::map<std::string, JsonValue> settings_, sources_;  ///< sources: the names that can be set instead
  std::set<std::string> written_;                        ///< parameters of the graph with output paths
  PackedFiles out_;
  std::map<fs::path, std::string> places_;
  std::set<std::string> packed_;
  int loops_ = 0;
};

}  // namespace

PackedFiles write_pack(const fs::path& graph, const std::vector<Override>& overrides, const LoadOptions& options,
                       const fs::path& target) {
  LoadOptions tracing = options;
  tracing.traces = true;
  const LoadedGraph loaded = load_graph(graph, overrides, tracing);
  return Packing(graph, loaded, target).run();
}

}  // namespace terrazzo

#include "runner/farm/frozen_graph.h"

#include <algorithm>
#include <cctype>
#include <set>

#include <fmt/format.h>

#include "core/base/paths.h"
#include "core/file/atomic_file.h"
#include "core/file/file_io.h"
#include "graphs/text/format.h"
#include "graphs/values/convert.h"
#include "runner/farm/farm_folder.h"
#include "runner/plan/key.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

constexpr const char* document_name = "graph.json";

/// Names of nodes that a document may have in wires: "layout [seed=3]" becomes "layout_seed_3".
class PlainNames {
 public:
  std::string of(const std::string& name) {
    std::string plain;
    for (const char c : name)
      if (std::isalnum(static_cast<unsigned char>(c)) || c == '-')
        plain += c;
      else if (!plain.empty() && plain.back() != '_')
        plain += '_';
    while (plain.ends_with('_')) plain.pop_back();
    if (plain.empty()) plain = "node";
    std::string unique = plain;
    for (int count = 2; !used_.insert(unique).second; count++) unique = fmt::format("{}_{}", plain, count);
    return unique;
  }

 private:
  std::set<std::string> used_;
};

/// Escapes a text so that it is not read as a wire, an expression or a parameter.
std::string plainly(const std::string& text) {
  std::string out;
  if (text.starts_with('@') || text.starts_with('=')) out += text.front();
  for (const char c : text) out += c == '$' ? "$$" : std::string(1, c);
  return out;
}

void write_plainly(JsonValue& value) {
  if (value.is_text()) value.text = plainly(value.text);
  for (JsonValue& item : value.items) write_plainly(item);
  for (JsonMember& member : value.members) write_plainly(member.value);
}

/// Builds the document node by node.
class Freezer {
 public:
  Freezer(const Plan& plan, Cache* cache) : plan_(plan), cache_(cache) {}

  FrozenGraph made() {
    for (const Stage& s : plan_.stages)
      if (s.needed) out_.names.emplace(s.node->name, names_.of(s.node->name));
    JsonValue nodes = JsonValue::empty_object();
    for (const Stage& s : plan_.stages) {
      if (!s.needed) continue;
      const std::string& name = out_.names.at(s.node->name);
      nodes.set(name, entry_of(*s.node));
      if (s.target) out_.targets.push_back(name);
    }
    JsonValue document = JsonValue::empty_object();
    document.set("terrazzo", JsonValue::of(int64_t{1}));
    if (!plan_.graph->summary.empty()) document.set("summary", JsonValue::of(plan_.graph->summary));
    document.set("nodes", std::move(nodes));
    out_.text = formatted(document);
    Hasher h;
    h.add("frozen graph").add(out_.text);
    for (const std::string& t : out_.targets) h.add(t);
    for (const FrozenInput& f : out_.inputs) h.add(f.to.string()).add(f.content);
    out_.id = h.digest();
    return std::move(out_);
  }

 private:
  JsonValue entry_of(const GraphNode& node) {
    JsonValue entry = JsonValue::empty_object();
    entry.set("type", JsonValue::of(node.type->name));
    for (const auto& [port, wires] : node.inputs) entry.set(port, wires_of(wires, node.type->find_input(port)->list));
    const std::vector<fs::path> files =
        node.type->files_read ? node.type->files_read(node.params) : std::vector<fs::path>();
    for (const auto& [name, value] : node.params) {
      const Param* param = node.type->find_param(name);
      if (param && param->fallback && *param->fallback == value) continue;
      JsonValue json = json_of(value);
      if (param && param->type == ParamType::path && !node.type->is_sink())
        json = JsonValue::of(frozen_path(std::get<std::string>(value), files));
      write_plainly(json);
      entry.set(name, std::move(json));
    }
    return entry;
  }

  JsonValue wires_of(const std::vector<Wire>& wires, bool is_list) const {
    JsonValue list;
    list.kind = JsonValue::Kind::list;
    for (const Wire& w : wires) list.items.push_back(JsonValue::of("@" + out_.names.at(w.node) + "." + w.port));
    return is_list ? list : list.items.front();
  }

  /// The path of the copy in the document: a folder named by content that contains the file or folder under its own
  /// name, which may be significant. If none of the files lies under the path (it may be a pattern), they are copied
  /// beside it.
  std::string frozen_path(const std::string& text, const std::vector<fs::path>& files) {
    const fs::path path = without_trailing_slash(text);
    std::vector<std::pair<fs::path, fs::path>> copies;  // from, and where below the folder
    for (const fs::path& f : files)
      if (const fs::path place = place_under(path, f); !place.empty())
        copies.emplace_back(f, place == "." ? path.filename() : path.filename() / place);
    if (copies.empty())
      for (const fs::path& f : files)
        if (f.parent_path() == path.parent_path()) copies.emplace_back(f, f.filename());
    std::erase_if(copies, [](const auto& copy) {
      std::error_code missing;
      return !fs::is_regular_file(copy.first, missing);
    });
    if (copies.empty()) return text;

    Hasher h;
    std::vector<Digest> contents;
    for (const auto& [from, place] : copies) {
      contents.push_back(digest_of_file(cache_, from));
      h.add(place.generic_string()).add(contents.back());
    }
    const fs::path folder = h.digest().hex();
    out_.origins.emplace(folder.string(), path.parent_path().string());
    for (size_t i = 0; i < copies.size(); i++) {
      const fs::path to = folder / copies[i].second;
      if (std::ranges::find(out_.inputs, to, &FrozenInput::to) == out_.inputs.end())
        out_.inputs.push_back({copies[i].first, to, contents[i]});
    }
    return (inputs_from_job() / folder / path.filename()).generic_string();
  }

  const Plan& plan_;
  Cache* cache_;
  PlainNames names_;
  FrozenGraph out_;
};

}  // namespace

FrozenGraph frozen(const Plan& plan, Cache* cache) {
  return Freezer(plan, cache).made();
}

std::vector<fs::path> strangers_in(const fs::path& folder, const std::function<bool(const fs::path&)>& is_known) {
  std::vector<fs::path> out;
  std::error_code missing;
  for (fs::recursive_directory_iterator at(folder, missing), end; !missing && at != end; at.increment(missing))
    // Hidden files are unfinished copies; nodes do not see them.
    if (!at->path().filename().string().starts_with('.') && !at->is_directory(missing) && !is_known(at->path()))
      out.push_back(at->path());
  return out;
}

std::vector<fs::path> write_frozen(const FrozenGraph& graph, const fs::path& job) {
  const fs::path inputs = FarmFolder::of_job(job).inputs();
  std::vector<fs::path> changed;
  std::set<fs::path> copies;
  std::error_code failure;
  for (const FrozenInput& f : graph.inputs) {
    const fs::path to = inputs / f.to;
    copies.insert(to);
    if (content_digest(to) == f.content) continue;
    fs::create_directories(to.parent_path());
    const fs::path temporary = temporary_beside(to);
    fs::copy_file(f.from, temporary, fs::copy_options::overwrite_existing, failure);
    if (failure) throw_system_error("copy", f.from, failure.value());
    if (content_digest(temporary) != f.content) {
      fs::remove(temporary, failure);
      throw FileError(fmt::format("{} has changed while it was copied; submit again", f.from.string()), 0);
    }
    publish_file(temporary, to, true);
    changed.push_back(to);
  }
  for (const auto& [folder, origin] : graph.origins)
    for (const fs::path& stranger :
         strangers_in(inputs / folder, [&](const fs::path& f) { return copies.contains(f); }))
      if (fs::remove(stranger, failure)) changed.push_back(stranger);
  if (write_if_other(job / document_name, graph.text)) changed.push_back(job / document_name);
  return changed;
}

LoadedGraph load_frozen(const fs::path& job, const Digest& document) {
  const fs::path file = job / document_name;
  FrozenGraph found;
  try {
    found.text = read_file(file);
  } catch (const FileError& e) {
    throw DamagedJob(e.what());
  }
  if (found.document() != document)
    throw DamagedJob(
        fmt::format("{} is not the graph that was submitted: it has been altered or damaged", file.string()));
  return load_graph_text(found.text, file);
}

}  // namespace terrazzo

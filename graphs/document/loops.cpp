#include "graphs/document/loops.h"

#include <algorithm>
#include <set>

#include <dirent.h>
#include <fmt/format.h>
#include <glob.h>
#include <sys/stat.h>

#include "core/base/suggest.h"
#include "core/base/text.h"
#include "core/file/path_spelling.h"
#include "core/file/read_guard.h"
#include "graphs/text/format.h"
#include "graphs/values/convert.h"
#include "graphs/values/variations.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

const std::vector<std::string> kinds = {"files", "folders", "table", "values"};

/// A table cell as a value: a number if it can be parsed as one.
JsonValue value_in_cell(const std::string& text) {
  const ParsedJson parsed = parse_json(text);
  const bool is_plain = parsed.value && (parsed.value->is_number() || parsed.value->kind == JsonValue::Kind::boolean);
  return is_plain ? *parsed.value : JsonValue::of(text);
}

/// The one type that all values have; empty if there is none.
std::optional<ParamType> common_type(const std::vector<JsonValue>& values) {
  const auto all = [&](auto is) { return std::ranges::all_of(values, is); };
  if (all([](const JsonValue& v) { return v.kind == JsonValue::Kind::integer; })) return ParamType::integer;
  if (all([](const JsonValue& v) { return v.is_number(); })) return ParamType::number;
  if (all([](const JsonValue& v) { return v.kind == JsonValue::Kind::boolean; })) return ParamType::boolean;
  if (all([](const JsonValue& v) { return v.is_text(); })) return ParamType::text;
  const auto is_size = [](const JsonValue& v) {
    return v.is_list() && v.items.size() == 2 &&
           std::ranges::all_of(v.items, [](const JsonValue& i) { return i.kind == JsonValue::Kind::integer; });
  };
  if (all(is_size)) return ParamType::size;
  return std::nullopt;
}

/// Converts a text to a part of a node's name.
std::string label_of(const std::string& text) {
  std::string out;
  for (const char c : text) out += static_cast<unsigned char>(c) < ' ' || c == '/' || c == '[' || c == ']' ? '_' : c;
  return out;
}

/// The part of a pattern before the first name with a wildcard.
fs::path fixed_part(const fs::path& pattern) {
  fs::path out;
  for (const fs::path& part : pattern) {
    if (part.string().find_first_of("*?[") != std::string::npos) break;
    out /= part;
  }
  return out;
}

/// The problem of an empty loop: a misspelt folder, or files where folders are expected.
std::string nothing_like(const fs::path& pattern, bool folders, size_t others) {
  std::string message = fmt::format("no {} is named like {}", folders ? "folder" : "file", pattern.string());
  if (others > 0)
    return fmt::format("{}; {} {}: use \"{}\"", message, counted(int64_t(others), folders ? "file" : "folder"),
                       others == 1 ? "is" : "are", folders ? "files" : "folders");
  fs::path folder;
  for (const fs::path& part : fixed_part(pattern.parent_path())) {
    folder /= part;
    std::error_code failure;
    if (!fs::is_directory(folder, failure)) return fmt::format("{}; there is no folder {}", message, folder.string());
  }
  return message;
}

/// Lists the paths that match a pattern, where ReadGuard allows it; throws as ReadGuard.
std::vector<fs::path> paths_like(const fs::path& pattern) {
  ReadGuard::check(fixed_part(pattern));
  static thread_local std::exception_ptr refused;  // exceptions must not pass through glob, which is C
  refused = nullptr;
  glob_t found{};
  found.gl_opendir = [](const char* folder) -> void* {
    try {
      if (!refused) ReadGuard::check(folder);
    } catch (...) {
      refused = std::current_exception();
    }
    if (!refused) return ::opendir(folder);
    errno = EACCES;
    return nullptr;
  };
  found.gl_readdir = [](void* folder) { return ::readdir(static_cast<DIR*>(folder)); };
  found.gl_closedir = [](void* folder) { ::closedir(static_cast<DIR*>(folder)); };
  found.gl_lstat = [](const char* path, struct stat* out) { return ::lstat(path, out); };
  found.gl_stat = [](const char* path, struct stat* out) { return ::stat(path, out); };
  const int code = ::glob(pattern.c_str(), GLOB_ALTDIRFUNC, nullptr, &found);
  std::vector<fs::path> paths;
  for (size_t i = 0; code == 0 && i < found.gl_pathc; i++) paths.emplace_back(found.gl_pathv[i]);
  ::globfree(&found);
  if (refused) std::rethrow_exception(std::exchange(refused, nullptr));
  for (const fs::path& path : paths) ReadGuard::check(path);
  return paths;
}

class LoopReader {
 public:
  LoopReader(const JsonValue& loop, const fs::path& folder, Substitution& substitution, Diagnostics& diagnostics,
             Lacking& lacking, std::vector<LoopSource>& made_from)
      : loop_(loop),
        folder_(folder),
        substitution_(substitution),
        diagnostics_(diagnostics),
        lacking_(lacking),
        made_from_(made_from) {}

  std::optional<std::vector<LoopIteration>> read() {
    const JsonMember* kind = read_keys();
    if (!kind) return std::nullopt;
    place_ = kind->value.place;
    const bool is_path = kind->name != "values";
    std::optional<JsonValue> given = substitution_.expand(
        kind->value, {.name = kind->name, .type = is_path ? ParamType::path : ParamType::numbers}, diagnostics_);
    const Lacking lacking = substitution_.take_lacking();
    lacking_.add(lacking);
    if (!lacking.nodes.empty()) report("a loop cannot depend on the results of nodes");
    if (!given) return std::nullopt;
    if (is_path && !given->is_text()) {
      report(fmt::format("expected a text for \"{}\", found {}", kind->name, found(*given)));
      return std::nullopt;
    }
    if (is_path)
      if (const std::string advice = path_advice(folder_, given->text); !advice.empty()) report(advice);
    if (failed_) return std::nullopt;
    if (kind->name == "table") {
      read_table_of(folder_ / given->text);
    } else if (is_path) {
      try {
        find_paths((folder_ / given->text).lexically_normal(), kind->name == "folders");
      } catch (const Error& e) {
        report(e.what());
      }
    } else {
      read_values(*given);
    }
    if (failed_) return std::nullopt;
    make_labels_unlike();
    return std::move(iterations_);
  }

 private:
  void report(const std::string& message) {
    diagnostics_.add(place_, message);
    failed_ = true;
  }

  /// The key that names the loop's source; null after a problem.
  const JsonMember* read_keys() {
    place_ = loop_.place;
    const JsonMember* out = nullptr;
    const std::string expected =
        "expected an object such as {\"folders\": \"scans/*\", \"as\": \"scan\"}, with one of " + listed(kinds);
    if (!loop_.is_object()) {
      report(fmt::format("{}; found {}", expected, found(loop_)));
      return nullptr;
    }
    for (const JsonMember& m : loop_.members) {
      if (m.name == "as") {
        if (m.value.is_text() && is_parameter_name(m.value.text))
          as_ = m.value.text;
        else
          diagnostics_.add(m.value.place,
                           "expected a name of letters, digits and _ for \"as\", found " + found(m.value));
      } else if (std::ranges::find(kinds, m.name) == kinds.end()) {
        std::vector<std::string> keys = kinds;
        keys.emplace_back("as");
        diagnostics_.add(m.place, fmt::format("unknown key {}{}", in_quotes(m.name), suggestion(m.name, keys)));
        failed_ = true;
      } else if (out) {
        report(fmt::format("expected one of {}, found two", listed(kinds)));
      } else {
        out = &m;
      }
    }
    if (!out && !failed_) report(expected);
    return failed_ ? nullptr : out;
  }

  void add(LoopIteration& iteration, const std::string& name, ParamType type, const JsonValue& value) {
    const Param param{.name = name, .type = type};
    GraphParameter& out = iteration.variables.emplace_back(
        GraphParameter{.param = param, .place = place_, .value = {}, .as_written = ""});
    out.value = read_param(value, param, folder_, diagnostics_);
    if (value.is_text()) out.as_written = value.text;
  }

  void add_iteration(const JsonValue& value, ParamType type, const std::string& name) {
    LoopIteration& iteration = iterations_.emplace_back(LoopIteration{label_of(name), {}});
    add(iteration, as_, type, value);
    add_name(iteration, name);
  }

  void add_name(LoopIteration& iteration, const std::string& name) {
    add(iteration, as_ + "_name", ParamType::text, JsonValue::of(name));
    add(iteration, as_ + "_index", ParamType::integer, JsonValue::of(int64_t(iterations_.size()) - 1));
  }

  void refuse_values(const JsonValue& given) {
    report("expected a list of values, or a range such as \"1..8\", found " + found(given));
  }

  void read_values(const JsonValue& given) {
    std::vector<JsonValue> values = given.items;
    if (given.is_text() && given.text.find("..") != std::string::npos) {
      try {
        const std::vector<Variation> range = swept({"values=" + given.text});
        if (range.front().values.front().second == given.text) return refuse_values(given);
        for (const Variation& v : range) values.push_back(value_in_cell(v.values.front().second));
      } catch (const Error& e) {
        return report(e.what());
      }
    } else if (!given.is_list()) {
      return refuse_values(given);
    }
    if (values.empty())
      return report(
          "expected at least one value, found an empty list; no wire could come from a node without iterations: give a "
          "value, or remove the node");
    if (values.size() > most_variations)
      return report(fmt::format("expected at most {} values, found {}", most_variations, values.size()));
    const std::optional<ParamType> type = common_type(values);
    if (!type) return report("expected values of one kind: numbers, texts, sizes, or true and false");
    for (const JsonValue& v : values) add_iteration(v, *type, v.is_text() ? v.text : compact(v));
  }

  void find_paths(const fs::path& pattern, bool folders) {
    made_from_.push_back({.kind = folders ? "folders" : "files", .path = pattern, .as = as_});
    std::vector<fs::path> paths;
    size_t others = 0;
    for (const fs::path& path : paths_like(pattern)) {
      std::error_code failure;
      if (folders ? fs::is_directory(path, failure) : fs::is_regular_file(path, failure))
        paths.push_back(path);
      else
        others += folders ? fs::is_regular_file(path, failure) : fs::is_directory(path, failure);
    }
    if (paths.empty()) return report(nothing_like(pattern, folders, others));
    if (paths.size() > most_variations)
      return report(fmt::format("expected at most {} of them, found {}", most_variations, paths.size()));
    std::ranges::sort(paths);
    for (const fs::path& p : paths) made_from_.back().names.push_back(p.filename().string());
    for (const fs::path& p : paths)
      add_iteration(JsonValue::of(p.string()), ParamType::path, (folders ? p.filename() : p.stem()).string());
  }

  void read_table_of(const fs::path& file) {
    made_from_.push_back({.kind = "table", .path = file, .as = as_});
    std::vector<Variation> rows;
    try {
      ReadGuard::check(file);
      rows = read_table(file);
    } catch (const Error& e) {
      return report(e.what());
    }
    const auto& columns = rows.front().values;
    for (size_t c = 0; c < columns.size(); c++) {
      const std::string& name = columns[c].first;
      if (!is_parameter_name(name))
        return report(fmt::format("{}: expected names of letters, digits and _ for columns, found {}", file.string(),
                                  in_quotes(name)));
      std::vector<JsonValue> values;
      for (size_t r = 0; r < rows.size(); r++) {
        const auto& cells = rows[r].values;
        const auto cell = std::ranges::find(cells, name, &std::pair<std::string, std::string>::first);
        if (cell == cells.end() || cells.size() != columns.size())
          return report(fmt::format("{}: row {} has other columns than the first one; a loop needs a value in each",
                                    file.string(), r + 1));
        values.push_back(value_in_cell(cell->second));
      }
      const ParamType type = common_type(values).value_or(ParamType::text);
      for (size_t r = 0; r < rows.size(); r++) {
        if (c == 0) iterations_.push_back({label_of(rows[r].values.front().second), {}});
        add(iterations_[r], name, type, type == ParamType::text ? JsonValue::of(rows[r].values[c].second) : values[r]);
      }
    }
    for (size_t r = 0; r < rows.size(); r++) {
      add(iterations_[r], as_ + "_name", ParamType::text, JsonValue::of(rows[r].values.front().second));
      add(iterations_[r], as_ + "_index", ParamType::integer, JsonValue::of(int64_t(r)));
    }
  }

  void make_labels_unlike() {
    std::set<std::string> taken;
    for (LoopIteration& r : iterations_) {
      const std::string plain = r.label;
      for (int i = 2; !taken.insert(r.label).second; i++) r.label = fmt::format("{} {}", plain, i);
    }
  }

  const JsonValue& loop_;
  const fs::path& folder_;
  Substitution& substitution_;
  Diagnostics& diagnostics_;
  Lacking& lacking_;
  std::vector<LoopSource>& made_from_;
  Place place_;
  std::string as_ = "item";
  std::vector<LoopIteration> iterations_;
  bool failed_ = false;
};

}  // namespace

std::optional<std::vector<LoopIteration>> read_loop(const JsonValue& loop, const fs::path& folder,
                                                    Substitution& substitution, Diagnostics& diagnostics,
                                                    Lacking& lacking, std::vector<LoopSource>& made_from) {
  return LoopReader(loop, folder, substitution, diagnostics, lacking, made_from).read();
}

}  // namespace terrazzo

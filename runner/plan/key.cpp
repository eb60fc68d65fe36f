#include "runner/plan/key.h"

#include <fmt/format.h>

#include "core/base/paths.h"
#include "core/base/tuning.h"
#include "core/base/variables_read.h"
#include "graphs/text/format.h"
#include "graphs/text/problem.h"
#include "graphs/values/convert.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

/// Raise it whenever the construction of keys changes.
constexpr int key_scheme = 1;

Digest digest_of_param(const std::string& name, const ParamValue& value) {
  Hasher h;
  add_to(h, {{name, value}});
  return h.digest();
}

std::vector<fs::path> files_read_by(const GraphNode& node) {
  try {
    return node.type->files_read ? node.type->files_read(node.params) : std::vector<fs::path>();
  } catch (const Error& e) {
    throw GraphError("", {problem_of(node, e.about(), e.what())});
  }
}

}  // namespace

fs::path place_under(const fs::path& path, const fs::path& file) {
  const fs::path relative = file.lexically_normal().lexically_relative(path);
  return relative.empty() || *relative.begin() == ".." ? fs::path() : relative;
}

std::string shown_value(const ParamValue& value) {
  constexpr size_t longest = 48;
  const std::string text = compact(json_of(value));
  return text.size() <= longest ? text : text.substr(0, longest - 3) + "...";
}

std::vector<Ingredient> ingredients_of(const GraphNode& node, const InputNames& inputs,
                                       const std::function<Digest(const fs::path&)>& file_digest) {
  const NodeType& type = *node.type;
  std::vector<Ingredient> out;
  out.push_back({"type", Hasher().add(type.name).add(type.version).digest(),
                 fmt::format("{} version {}", type.name, type.version)});
  if (const NodeOrigin& from = type.origin; !from.name.empty())
    out.push_back({"plug-in", Hasher().add(from.name).add(from.version).add(from.content).digest(),
                   fmt::format("{} {}", from.name, from.version)});
  if (const std::string tuning = overridden_tuning(); !tuning.empty())
    out.push_back({"tuning", Hasher().add(tuning).digest(), tuning});

  const VariablesRead variables;
  const std::vector<fs::path> files = files_read_by(node);
  for (const auto& [name, value] : variables.all())
    out.push_back({"variable " + name, Hasher().add(value).digest(), value});
  std::vector<std::string> places;
  for (const fs::path& f : files) places.push_back(f.string());
  for (const auto& [name, value] : node.params) {
    bool covered = false;
    const Param* param = type.find_param(name);
    if (param && param->type == ParamType::path) {
      const fs::path path = without_trailing_slash(std::get<std::string>(value));
      for (size_t i = 0; i < files.size(); i++) {
        const fs::path place = place_under(path, files[i]);
        if (place.empty()) continue;
        covered = true;
        // A folder's own name may become the material's, so it is part of the key.
        places[i] = place == "." ? "." : (path.filename() / place).generic_string();
      }
    }
    if (!covered) out.push_back({"parameter " + name, digest_of_param(name, value), shown_value(value)});
  }

  for (const auto& [port, names] : inputs)
    for (size_t i = 0; i < names.size(); i++)
      out.push_back({fmt::format("input {}{}", port, names.size() > 1 ? fmt::format("[{}]", i) : ""), names[i],
                     "@" + node.inputs.at(port)[i].node});
  for (size_t i = 0; i < files.size(); i++)
    out.push_back({"file " + places[i], file_digest(files[i]), files[i].string()});
  return out;
}

Digest key_of(const std::vector<Ingredient>& ingredients) {
  Hasher h;
  h.add("stage").add(key_scheme).add(int64_t(ingredients.size()));
  for (const Ingredient& i : ingredients) h.add(i.what).add(i.digest);
  return h.digest();
}

Digest derived_name(const Digest& key, std::string_view port) {
  return Hasher().add("derived").add(key).add(port).digest();
}

}  // namespace terrazzo

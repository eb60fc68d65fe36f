#include "runner/engine/stale_outputs.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/paths.h"
#include "core/image/image.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

/// The maps of materials. Masks, guidance and other data are files for many other purposes.
constexpr std::array surfaces = {Semantic::base_color, Semantic::normal,   Semantic::height,
                                 Semantic::roughness,  Semantic::metallic, Semantic::ambient_occlusion,
                                 Semantic::opacity,    Semantic::emission, Semantic::specular};

/// Possible names of other maps, or of the same map in another format, for a map with this file name.
std::set<std::string> sibling_names(const fs::path& file) {
  std::set<std::string> siblings;
  const std::string stem = file.stem().string();
  for (const Semantic mine : surfaces) {
    const size_t at = stem.rfind(name_of(mine));
    if (at == std::string::npos) continue;
    for (const Semantic other : surfaces) {
      const std::string renamed = std::string(stem).replace(at, name_of(mine).size(), name_of(other));
      for (const char* extension : {".png", ".tif", ".tiff", ".exr", ".jpg", ".jpeg"})
        siblings.insert(renamed + extension);
    }
  }
  return siblings;
}

/// The files that the graph reads or writes.
std::set<fs::path> files_of(const Plan& plan, const std::vector<StageOutcome>& outcomes) {
  std::set<fs::path> files;
  for (const Stage& s : plan.stages)
    if (s.type().files_read)
      for (const fs::path& file : s.type().files_read(s.node->params)) files.insert(place_of_file(file));
  for (const StageOutcome& o : outcomes)
    for (const OutputFile& file : o.files) files.insert(place_of_file(file.path));
  return files;
}

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  std::error_code ended;
  for (fs::directory_iterator at(folder, ended), end; !ended && at != end; at.increment(ended))
    names.insert(at->path().filename().string());
  return names;
}

}  // namespace

std::vector<std::pair<int, std::string>> notes_on_stale_outputs(const Plan& plan,
                                                                const std::vector<StageOutcome>& outcomes) {
  if (std::any_of(plan.stages.begin(), plan.stages.end(),
                  [](const Stage& s) { return s.type().is_sink() && !s.needed; }))
    return {};
  const std::set<fs::path> known = files_of(plan, outcomes);
  std::set<fs::path> said;
  std::vector<std::pair<int, std::string>> notes;
  for (size_t i = 0; i < outcomes.size(); i++) {
    if (outcomes[i].kind != StageOutcome::Kind::run) continue;
    std::map<fs::path, std::set<std::string>> siblings;
    for (const OutputFile& file : outcomes[i].files) siblings[file.path.parent_path()].merge(sibling_names(file.path));
    for (const auto& [folder, names] : siblings) {
      std::vector<std::string> left_over;
      if (names.empty()) continue;
      for (const std::string& name : names_in(folder))
        if (names.count(name) == 1 && known.count(place_of_file(folder / name)) == 0 &&
            said.insert(place_of_file(folder / name)).second)
          left_over.push_back(name);
      if (!left_over.empty())
        notes.emplace_back(int(i), fmt::format("{} also holds {}, which this graph does not write: remove them if they "
                                               "belong to another material, or write to another folder",
                                               folder.string(), fmt::join(left_over, ", ")));
    }
  }
  return notes;
}

}  // namespace terrazzo

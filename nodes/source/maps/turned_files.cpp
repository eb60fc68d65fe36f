#include "nodes/source/maps/turned_files.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/tuning.h"
#include "core/filter/structure_match.h"
#include "core/naming/interpretation.h"

namespace terrazzo {

namespace {

struct TurnedFilesTuning {
  double clear = 0.1;
  double share = 0.6;
};
const Tunable<TurnedFilesTuning> turned_files_tuning(
    "turned_files",
    {
        {&TurnedFilesTuning::clear, "clear", "correlation",
         "of the structures of two maps. Higher: more files are refused; lower: noise decides", "turned_files", 0, 1},
        {&TurnedFilesTuning::share, "share", "of the better correlation",
         "that the worse may have. Higher: mirrored regular patterns are decided by noise; lower: they are refused",
         "turned_files", 0, 1},
    });

Size stored_size(const OrientedFile& f) {
  const bool is_turned = f.info.orientation >= 5;
  return is_turned ? Size{f.info.size.height, f.info.size.width} : f.info.size;
}

std::string ignored(const OrientedFile& f, const std::string& why) {
  return fmt::format("{}{}: its orientation tag ({}) is ignored: {}. {} follows the tag", warning_mark, f.name,
                     f.info.orientation, why, advice_to_interpret(f.map, "as_tagged"));
}

/// The evidence from the agreement with another file.
struct Vote {
  double tagged = 0, stored = 0;
  std::string other;
  bool is_clear() const {
    const double best = std::max(tagged, stored);
    return best >= turned_files_tuning->clear && std::min(tagged, stored) <= turned_files_tuning->share * best;
  }
};

/// The strongest evidence; nullopt if there is none, or if it is contradictory.
std::optional<Vote> verdict(const std::vector<Vote>& votes) {
  std::optional<Vote> best;
  for (const Vote& v : votes) {
    if (!v.is_clear()) continue;
    if (best && (best->tagged > best->stored) != (v.tagged > v.stored)) return std::nullopt;
    if (!best || std::max(v.tagged, v.stored) > std::max(best->tagged, best->stored)) best = v;
  }
  return best;
}

bool looks_the_same(const ImagePtr& a, const ImagePtr& b) {
  const Size grid = structure_grid(a->size(), b->size());
  const Structure one = structure_of(a, grid), other = structure_of(b, grid);
  return one.values == other.values && one.edges == other.edges;
}

}  // namespace

Size OrientedFile::size() const {
  return as_stored ? stored_size(*this) : info.size;
}

void settle_orientations_by_shape(std::vector<OrientedFile>& files, std::vector<std::string>& notes) {
  std::map<int, int> counts;  // of files by tag
  for (OrientedFile& f : files) {
    f.as_stored = f.asked.value_or(false);
    if (!f.asked) counts[f.info.orientation]++;
  }
  const auto most = std::ranges::max_element(counts, {}, &std::pair<const int, int>::second);
  const bool has_settled = std::ranges::any_of(files, [](const OrientedFile& f) { return f.asked.has_value(); });
  const int trusted = counts.count(1) || has_settled || counts.empty() ? 1 : most->first;
  for (OrientedFile& f : files) {
    if (f.asked || f.info.orientation == trusted) continue;
    f.is_open = true;
    bool fits_tagged = true, fits_stored = true;
    for (const OrientedFile& other : files) {
      if (!other.asked && other.info.orientation != trusted) continue;
      fits_tagged &= same_shape(f.info.size, other.size());
      fits_stored &= same_shape(stored_size(f), other.size());
    }
    if (fits_tagged == fits_stored) continue;
    f.is_open = false;
    f.as_stored = fits_stored;
    if (fits_stored)
      notes.push_back(
          ignored(f, fmt::format("as stored, {}, it has the shape of the other maps", describe(stored_size(f)))));
  }
}

void settle_orientations_by_pixels(std::vector<OrientedFile>& files, std::vector<ImagePtr>& pictures,
                                   const std::function<ImagePtr(size_t)>& read_as_stored,
                                   std::vector<std::string>& notes) {
  std::map<int, std::vector<size_t>> open;  // by tag: files from one camera or program are decided together
  for (size_t i = 0; i < files.size(); i++)
    if (files[i].is_open) open[files[i].info.orientation].push_back(i);
  for (const auto& [orientation, group] : open) {
    std::vector<Vote> votes;
    std::vector<ImagePtr> stored;
    bool are_same = true;
    for (const size_t i : group) {
      const ImagePtr& as_stored = stored.emplace_back(read_as_stored(i));
      are_same &= looks_the_same(pictures[i], as_stored);
      for (size_t k = 0; k < files.size(); k++) {
        if (files[k].is_open) continue;
        const Size grid = structure_grid(pictures[i]->size(), pictures[k]->size());
        const Structure other = structure_of(pictures[k], grid);
        votes.push_back({agreement(structure_of(pictures[i], grid), other),
                         agreement(structure_of(as_stored, grid), other), files[k].name});
      }
    }
    if (are_same) continue;
    const std::optional<Vote> found = verdict(votes);
    OrientedFile& first = files[group.front()];
    if (!found)
      throw Error("path",
                  fmt::format("{}: its orientation tag ({}) turns it, other maps have another, and the pixels do "
                              "not say whether it fits them so or as stored. Say it by {}, or \"as_tagged\"",
                              first.name, orientation, advice_to_interpret(first.map, "as_stored")));
    const bool ignores = found->stored > found->tagged;
    for (size_t i = 0; i < group.size(); i++) {
      OrientedFile& f = files[group[i]];
      f.as_stored = ignores;
      if (ignores) pictures[group[i]] = stored[i];
      if (ignores)
        notes.push_back(ignored(f, fmt::format("as stored it fits {} (correlation {:.2f}, turned {:.2f})", found->other,
                                               found->stored, found->tagged)));
      else
        notes.push_back(fmt::format("{}: turned so, it fits {} (correlation {:.2f}, as stored {:.2f})", f.name,
                                    found->other, found->tagged, found->stored));
    }
  }
}

}  // namespace terrazzo
